//! Test that the contenders of the benchmark `rates` agree.

use eomgen_benches::eliminated_arm::EliminatedArm;
use eomgen_benches::{state, variants};
use eomgen_validate::references::planetary_arm::equation_22::Coefficients;
use eomgen_validate::references::planetary_arm::parameters::PlanetaryArmParameters;

/// Bound of the rounding error of some tens of operations, relative to the largest term of a row.
const TOLERANCE: f64 = 1e-12;

/// Mesh deflections in m: contact on each side, and separation.
const DEFLECTIONS: [f64; 3] = [-3e-5, 1e-5, 4e-5];

macro_rules! agree {
    ($($order:literal $module:ident $name:ident),*) => {$(
        #[test]
        fn $name() {
            use variants::$module as arm;
            let parameters = PlanetaryArmParameters::default();
            let reference = Coefficients::new(&parameters, $order);
            let eliminated = EliminatedArm::<$order>::new(&parameters);
            let coefficients = arm::Coefficients::prepare(&arm::Parameters::default());
            for (x_sp, x_pr) in DEFLECTIONS.into_iter().flat_map(|a| DEFLECTIONS.map(|b| (a, b))) {
                let mut state = state::<{ arm::STATES }>();
                state[..2].copy_from_slice(&[x_sp, x_pr]);
                let degrees = arm::DEGREES_OF_FREEDOM;
                let expected = reference.evaluate(0.3, &state).expect("as many numbers as states");
                let generated = arm::rates(0.3, &state, &arm::Inputs::default(), &coefficients);
                let mut written = [0.0; arm::STATES];
                eliminated.rates(0.3, &state, &mut written);
                assert_eq!(generated[..degrees], state[degrees..]);
                assert_eq!(written[..degrees], state[degrees..]);
                let between = written[degrees..].iter().zip(&generated[degrees..]).zip(&expected.scales);
                for ((written, generated), scale) in between {
                    let difference = (written - generated).abs();
                    assert!(difference <= TOLERANCE * scale, "{x_sp} {x_pr}: {difference:e}");
                }
                let deviation = expected.deviation(&written[degrees..]);
                assert!(deviation < TOLERANCE, "{x_sp} {x_pr}: {deviation:e} from Eq. (22)");
            }
        }
    )*};
}

agree!(
    0 order_0 rigid, 1 order_1 one_mode, 2 order_2 two_modes, 4 order_4 four_modes,
    8 order_8 eight_modes, 16 order_16 sixteen_modes, 32 order_32 thirty_two_modes,
    64 order_64 sixty_four_modes, 128 order_128 all_modes
);
