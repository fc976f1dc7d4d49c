//! Comparison of the hand-written equations of the arm with each other and with a dense linear solve of the force
//! balance of every inertia.

use approx::assert_abs_diff_eq;
use eomgen_validate::references::evaluation::Evaluation;
use eomgen_validate::references::planetary_arm::dimensionless_equation_22::Equation22;
use eomgen_validate::references::planetary_arm::equation_10::{self, ShaftMotion};
use eomgen_validate::references::planetary_arm::equation_12;
use eomgen_validate::references::planetary_arm::equation_22::Coefficients;
use eomgen_validate::references::planetary_arm::mode_shapes::ModeShape;
use eomgen_validate::references::planetary_arm::parameters::PlanetaryArmParameters;
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

/// Bound of the rounding error of some tens of operations, relative to the largest term of a row.
const TOLERANCE: f64 = 1e-12;

/// Meshes open, or closed on either flank.
const REGIMES: [(f64, f64); 9] = [
    (-1.0, -1.0),
    (-1.0, 0.0),
    (-1.0, 1.0),
    (0.0, -1.0),
    (0.0, 0.0),
    (0.0, 1.0),
    (1.0, -1.0),
    (1.0, 0.0),
    (1.0, 1.0),
];

/// Returns a state of order `order` in the regime `(sp, pr)` from `numbers` in -1..1.
fn state_in(
    regime: (f64, f64),
    order: usize,
    parameters: &PlanetaryArmParameters,
    numbers: &[f64],
) -> Vec<f64> {
    let deflection = |side: f64, number: f64, b: f64| {
        if side == 0.0 {
            0.9 * b * number
        } else {
            side * b * (1.05 + number.abs())
        }
    };
    let mut numbers = numbers.iter().copied().cycle();
    let mut next = || numbers.next().expect("an endless supply");
    let mut state = vec![
        deflection(regime.0, next(), parameters.b_sp),
        deflection(regime.1, next(), parameters.b_pr),
        next(),
    ];
    state.extend((0..order).map(|i| 1e-3 * next() / (i + 1) as f64));
    state.extend([0.02 * next(), 0.02 * next(), next()]);
    state.extend((0..order).map(|_| 0.1 * next()));
    state
}

/// Solves the balance of sun, planets, carrier and modes as one dense system in theta_s, theta_p,
/// theta_c, q by LU, and converts to x_sp, x_pr, x_c, q.
fn dense(parameters: &PlanetaryArmParameters, order: usize, t: f64, state: &[f64]) -> Vec<f64> {
    let n = 3 + order;
    let (r_s, r_p, r_c) = (
        parameters.r_s(),
        parameters.r_p(),
        parameters.r_c_cos_alpha(),
    );
    let contact = |x: f64, b: f64| {
        if x.abs() > b {
            (x - b * x.signum(), 1.0)
        } else {
            (0.0, 0.0)
        }
    };
    let (gap_sp, on_sp) = contact(state[0], parameters.b_sp);
    let (gap_pr, on_pr) = contact(state[1], parameters.b_pr);
    let f_sp = parameters.k_sp * gap_sp + parameters.c_sp * on_sp * state[n];
    let f_pr = parameters.k_pr * gap_pr + parameters.c_pr * on_pr * state[n + 1];
    let theta_s_dot = (state[n] + state[n + 1] + 2.0 * state[n + 2]) / r_s;

    let mut mass = DMatrix::zeros(n, n);
    let mut force = DVector::zeros(n);
    let motor = parameters.a_m + parameters.F_w * (parameters.omega * t).sin();
    mass[(0, 0)] = parameters.I_s;
    force[0] = motor - parameters.b_m * theta_s_dot - 3.0 * r_s * f_sp;
    mass[(1, 1)] = parameters.I_p;
    force[1] = r_p * (f_sp - f_pr);
    mass[(2, 2)] = parameters.I_tot();
    force[2] = 3.0 * r_c * (f_sp + f_pr);
    for i in 0..order {
        // Both sides use the closed forms of the integrals. These have separate tests, and a quadrature of x phi would
        // lose digits as z^2.
        let integrals = ModeShape::clamped_free(i + 1).integrals();
        let line_mass = parameters.rho * parameters.A;
        mass[(2, 3 + i)] = line_mass * parameters.l.powi(2) * integrals.s_phi;
        mass[(3 + i, 2)] = mass[(2, 3 + i)];
        mass[(3 + i, 3 + i)] = line_mass * parameters.l * integrals.phi_squared;
        let stiffness =
            parameters.E * parameters.I / parameters.l.powi(3) * integrals.curvature_squared;
        force[3 + i] = -stiffness * state[3 + i];
    }
    let angles = mass.lu().solve(&force).expect("every inertia is positive");
    let (x_s, x_p, x_c) = (r_s * angles[0], r_p * angles[1], r_c * angles[2]);
    let mut accelerations = vec![x_s - x_p - x_c, x_p - x_c, x_c];
    accelerations.extend(angles.iter().skip(3));
    accelerations
}

fn numbers() -> impl Strategy<Value = Vec<f64>> {
    proptest::collection::vec(-1.0..1.0_f64, 40..60)
}

/// Asserts that every acceleration is equal to within the rounding error of its row.
fn assert_rows_eq(expected: &Evaluation, found: &[f64]) {
    assert_eq!(expected.accelerations.len(), found.len());
    let rows = expected.accelerations.iter().zip(&expected.scales);
    for ((expected, scale), found) in rows.zip(found) {
        assert_abs_diff_eq!(found, expected, epsilon = TOLERANCE * scale);
    }
}

fn evaluate(
    parameters: &PlanetaryArmParameters,
    order: usize,
    t: f64,
    state: &[f64],
) -> Evaluation {
    let coefficients = Coefficients::new(parameters, order);
    coefficients
        .evaluate(t, state)
        .expect("a state of the right length")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn equation_22_matches_a_dense_solve(numbers in numbers(), t in 0.0..10.0_f64) {
        let parameters = PlanetaryArmParameters::default();
        for order in [1, 4, 16, 64] {
            for regime in REGIMES {
                let state = state_in(regime, order, &parameters, &numbers);
                let expected = evaluate(&parameters, order, t, &state);
                assert_rows_eq(&expected, &dense(&parameters, order, t, &state));
            }
        }
    }

    #[test]
    fn equation_22_without_modes_is_equation_12(numbers in numbers(), t in 0.0..10.0_f64) {
        let parameters = PlanetaryArmParameters::default();
        for regime in REGIMES {
            let state = state_in(regime, 0, &parameters, &numbers);
            let rigid = equation_12::corrected_accelerations(&parameters, t, state.as_slice().try_into().unwrap());
            assert_rows_eq(&rigid, &evaluate(&parameters, 0, t, &state).accelerations);
        }
    }

    #[test]
    fn equation_12_satisfies_equation_10(numbers in numbers(), t in 0.0..10.0_f64) {
        let parameters = PlanetaryArmParameters::default();
        for regime in REGIMES {
            let state: [f64; 6] = state_in(regime, 0, &parameters, &numbers).try_into().unwrap();
            let rigid = equation_12::corrected_accelerations(&parameters, t, &state);
            let motion = shafts(&parameters, &state, &rigid.accelerations);
            let balance = equation_10::corrected_residuals(&parameters, t, &motion);
            // At angles of about 10 rad, mesh deflections have a rounding error of r_s 10 eps. The mesh stiffness
            // multiplies it to an error of the force.
            let rounding = 100.0 * f64::EPSILON * parameters.k_sp * parameters.r_c();
            for row in 0..3 {
                let allowed = TOLERANCE * balance.scale[row] + rounding * parameters.r_c();
                assert_abs_diff_eq!(balance.residual[row], 0.0, epsilon = allowed);
            }
        }
    }

    #[test]
    fn scales_do_not_change_the_motion(numbers in numbers(), t in 0.0..10.0_f64) {
        assert_scales_do_not_change_rates::<1>(&numbers, t)?;
        assert_scales_do_not_change_rates::<4>(&numbers, t)?;
        assert_scales_do_not_change_rates::<16>(&numbers, t)?;
        assert_scales_do_not_change_rates::<64>(&numbers, t)?;
    }
}

/// Compares the prepared right-hand side with the named coefficients, with the scales (1, 1) and with the scales of the
/// paper.
fn assert_scales_do_not_change_rates<const S: usize>(
    numbers: &[f64],
    t: f64,
) -> Result<(), TestCaseError> {
    let parameters = PlanetaryArmParameters::default();
    for (omega_n, b_c) in [(1.0, 1.0), (3.0885e4, 25e-6)] {
        let equation = Equation22::<S>::new(&parameters, omega_n, b_c);
        for regime in REGIMES {
            let state = state_in(regime, S, &parameters, numbers);
            let (position, rate) = state.split_at(3 + S);
            let scaled: Vec<f64> = position
                .iter()
                .map(|x| x / b_c)
                .chain(rate.iter().map(|x| x / (b_c * omega_n)))
                .collect();
            let mut out = vec![0.0; scaled.len()];
            equation.rates(omega_n * t, &scaled, &mut out);
            let accelerations: Vec<f64> = out[3 + S..]
                .iter()
                .map(|x| x * b_c * omega_n * omega_n)
                .collect();
            assert_rows_eq(&evaluate(&parameters, S, t, &state), &accelerations);
            prop_assert_eq!(&out[..3 + S], &scaled[3 + S..]);
        }
    }
    Ok(())
}

/// Returns the motion of the shafts at a state of the rigid arm.
fn shafts(
    parameters: &PlanetaryArmParameters,
    state: &[f64; 6],
    accelerations: &[f64],
) -> ShaftMotion {
    let angles = |x: &[f64]| {
        [
            (x[0] + x[1] + 2.0 * x[2]) / parameters.r_s(),
            (x[1] + x[2]) / parameters.r_p(),
            x[2] / parameters.r_c_cos_alpha(),
        ]
    };
    ShaftMotion {
        angle: angles(&state[..3]),
        rate: angles(&state[3..]),
        acceleration: angles(accelerations),
    }
}

#[test]
fn state_of_wrong_length_has_no_value() {
    let coefficients = Coefficients::new(&PlanetaryArmParameters::default(), 4);
    assert_eq!(coefficients.evaluate(0.0, &[0.0; 13]), None);
}
