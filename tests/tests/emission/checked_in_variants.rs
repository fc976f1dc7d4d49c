//! Test that the checked-in variants equal the generator's output and are bit-identical to the evaluator, interpreted
//! and as machine code.

use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_tests::models::{load, project, samples, variant};
use eomgen_tests::program::eomgen;

const STATES_PER_REGIME: usize = 25;

/// Number of checked-in variants.
const VARIANTS: usize = 9;

const SEED: u64 = 0x5eed_0001;

/// Results at one state, concatenated: rates, observables, energy, power, guards, mass matrix.
type Numbers = Vec<f64>;

fn evaluate(evaluator: &mut Evaluator, point: Point<'_>) -> Numbers {
    let program = evaluator.program();
    let (states, degrees) = (program.states(), program.degrees_of_freedom());
    let scalars = program.observables.len();
    let guard_count = evaluator.guard_count();
    let mut rates = vec![f64::NAN; states];
    let mut observables = vec![f64::NAN; scalars];
    let mut guards = vec![f64::NAN; guard_count];
    let mut mass = vec![f64::NAN; degrees * degrees];
    evaluator.rates(point, &mut rates);
    evaluator.observables(point, &mut observables);
    evaluator.guards(point, &mut guards);
    evaluator.mass_matrix(point, &mut mass);
    let energy_and_power = observables[scalars - 2..].to_vec();
    [rates, observables, energy_and_power, guards, mass].concat()
}

/// Calls `compare_bits` for every checked-in variant.
macro_rules! compare_variants {
    ($($module:ident: $order:literal,)*) => {
        [$({
            use eomgen_generated::$module as module;
            assert_eq!(module::ORDERS, [$order]);
            let coefficients = module::Coefficients::prepare(&module::Parameters::default());
            let inputs = module::Inputs::default();
            compare_bits($order, &module::STATE_NAMES, &module::OBSERVABLE_NAMES, |t, state| {
                let state = state.try_into().expect("a state of this variant");
                [
                    module::rates(t, state, &inputs, &coefficients).to_vec(),
                    module::observables(t, state, &inputs, &coefficients).to_vec(),
                    vec![
                        module::energy(t, state, &inputs, &coefficients),
                        module::power(t, state, &inputs, &coefficients),
                    ],
                    module::guards(t, state, &inputs, &coefficients).to_vec(),
                    module::mass_matrix(t, state, &inputs, &coefficients).concat(),
                ]
                .concat()
            });
            $order
        }),*]
    };
}

#[test]
fn checked_in_arms_match_evaluator_and_machine_code() {
    let orders = compare_variants! {
        planetary_arm_rigid: 0,
        planetary_arm_order_1: 1,
        planetary_arm_order_2: 2,
        planetary_arm_order_3: 3,
        planetary_arm_order_4: 4,
        planetary_arm_order_5: 5,
        planetary_arm_order_6: 6,
        planetary_arm_order_7: 7,
        planetary_arm_order_8: 8,
    };
    assert_eq!(orders.len(), VARIANTS);
}

fn compare_bits(
    order: usize,
    state_names: &[&str],
    observable_names: &[&str],
    emitted: impl Fn(f64, &[f64]) -> Numbers,
) {
    let model = load("planetary_arm");
    let mut evaluator = variant(&model, order).evaluator;
    let mut compiled = eomgen_jit::evaluator(evaluator.program().clone());
    assert_eq!(state_names, evaluator.program().state_names());
    let named = evaluator
        .program()
        .observables
        .iter()
        .map(|observable| observable.name.as_str());
    assert!(named.eq(observable_names.iter().copied()));
    for sample in samples(&model, order, SEED + order as u64, STATES_PER_REGIME) {
        let point = Point {
            t: sample.time,
            state: &sample.state,
            inputs: &sample.inputs,
        };
        let expected = evaluate(&mut evaluator, point);
        let compiled = evaluate(&mut compiled, point);
        let found = emitted(sample.time, &sample.state);
        assert!(
            expected.iter().all(|number| number.is_finite()),
            "{sample:?}: {expected:?}"
        );
        let bits = |numbers: &[f64]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert_eq!(
            bits(&expected),
            bits(&found),
            "{sample:?}: {expected:?} and {found:?}"
        );
        assert_eq!(
            bits(&expected),
            bits(&compiled),
            "{sample:?}: {expected:?} and, as machine code, {compiled:?}"
        );
    }
}

#[test]
fn generate_check_finds_no_difference() {
    let mut command = eomgen();
    let output = command
        .current_dir(project())
        .args(["generate", "--all", "--check", "--json"])
        .output()
        .expect("the program can be run");
    let document: serde_json::Value =
        serde_json::from_slice(&output.stdout).expect("one JSON document");
    assert_eq!(document["different"], serde_json::json!([]), "{document}");
    // The files are one source and one certificate for each variant, and the manifest.
    assert_eq!(document["files"], 2 * VARIANTS + 1);
    assert_eq!(output.status.code(), Some(0));
}
