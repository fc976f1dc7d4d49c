//! Tests of specifications with one language feature each, certified with an oracle that shares no code with the
//! derivation. Each file in `features/` is one test; its orders are listed below.

use std::path::{Path, PathBuf};

use eomgen_codegen::program::evaluator::Point;
use eomgen_codegen::rust::{Packaging, emit};
use eomgen_model_spec::model::Model;
use eomgen_tests::models::{samples, variant};
use eomgen_validate::model_certificate::certify_source;
use eomgen_validate::sampler::Sample;

/// Declares one test for each file, and a test that every file is listed.
macro_rules! features {
    (
        by_every_check { $($name:ident: $orders:expr;)* }
        also_by_differences { $($moving:ident: $moving_orders:expr;)* }
    ) => {
        $(
            #[test]
            fn $name() {
                certify(stringify!($name), &$orders);
            }
        )*

        $(
            #[test]
            fn $moving() {
                certify(stringify!($moving), &$moving_orders);
                assert_power_matches_energy_rate(stringify!($moving), &$moving_orders);
            }
        )*

        #[test]
        fn every_feature_file_is_tested() {
            let tested = [$(stringify!($name),)* $(stringify!($moving)),*];
            for path in folders().iter().flat_map(|folder| std::fs::read_dir(folder).unwrap()) {
                let name = path.unwrap().path().file_stem().unwrap().to_string_lossy().into_owned();
                assert!(tested.contains(&name.as_str()), "{name}.toml is not listed in `features!`");
            }
        }
    };
}

features! {
    by_every_check {
        polynomial_taper: [0, 1, 4];
        exponential_taper: [0, 1, 4];
        offset_domain: [0, 1, 4];
        points_along_the_beam: [0, 1, 4];
        sums_over_modes: [0, 1, 4];
        printed_basis: [0, 1, 4];
        printed_basis_by_sums: [0, 1, 4];
        full_mass_on_springs: [0, 1, 4];
        two_fields: [0, 1, 3];
        cubic_stiffness: [0, 1, 3];
        quadratic_drag: [0, 2];
        gravity_arm: [0, 1, 4];
        centrifugal_stiffening: [0, 1, 4];
        structural_damping: [0, 1, 3];
        lever_mass: [1, 2, 4];
        lever_mass_turning: [1, 2, 4];
        lever_mass_expanded: [1, 2, 4];
        mass_by_sum: [1, 4];
        sum_with_coordinate: [1, 4];
        massless_beam: [1];
        massless_beam_by_sum: [1];
        folding_arm: [0, 1, 2, 4];
        functions: [0];
        shorter_functions: [0];
        pendulum_chain: [0];
        gimbal: [0];
        heavy_top: [0];
        vectors: [0, 1, 3];
        states_of_first_order: [0, 1, 3];
        piecewise_linear_states: [0];
    }
    // In these models the energy also changes by explicit time dependence, so the power is also compared with central
    // differences of the energy.
    also_by_differences {
        prescribed_motion: [0, 2];
        moving_constraints: [0];
        ball_joint: [0];
        flexible_coupler: [0, 1, 4];
        rolling_disc: [0];
        redundant_rods: [0];
        bicycle: [0];
        squeezing_mechanism: [0];
        bouncing_ball: [0];
        dropped_box: [0];
        box_with_friction: [0];
        woodpecker: [0];
        beam_stop: [0, 1, 4];
        rheonomic: [0, 1, 4];
        mass_of_time: [0];
        nonquadratic_kinetic: [0];
        gyroscopic: [0];
    }
}

fn folders() -> [PathBuf; 3] {
    let tests = Path::new(env!("CARGO_MANIFEST_DIR"));
    [
        tests.join("features"),
        tests.join("../examples/constrained"),
        tests.join("../examples/impacts"),
    ]
}

fn load(name: &str) -> Model {
    let files = folders().map(|folder| folder.join(format!("{name}.toml")));
    let file = files.iter().find(|file| file.exists()).unwrap_or(&files[0]);
    eomgen_model_spec::load(file)
        .unwrap_or_else(|found| panic!("{}", found.render(false)))
        .model
}

fn certify(name: &str, orders: &[usize]) {
    let model = load(name);
    let mut failures = Vec::new();
    for &order in orders {
        let orders = vec![order; model.fields.len().max(1)];
        let source = emit_source(&model, order);
        let certificate = certify_source(&model, &orders, &[], source).unwrap();
        failures.extend(certificate.failures().map(|check| {
            format!(
                "order {order}, {}: {:?} ({})",
                check.name, check.value, check.detail
            )
        }));
    }
    assert!(failures.is_empty(), "{name}:\n{}", failures.join("\n"));
}

/// Compares the power with the central difference of the energy along the motion. With steps of about 1e-5 of the
/// fastest period, truncation and rounding errors of E are about 1e-8 of the terms.
fn assert_power_matches_energy_rate(name: &str, orders: &[usize]) {
    let model = load(name);
    for &order in orders {
        let mut evaluator = variant(&model, order).evaluator;
        let count = evaluator.program().observables.len();
        for sample in samples(&model, order, 0x0b5e, 20) {
            let mut rates = vec![0.0; sample.state.len()];
            evaluator.rates(point_of(&sample), &mut rates);
            let mut values = |step: f64| {
                let moved: Vec<f64> = sample
                    .state
                    .iter()
                    .zip(&rates)
                    .map(|(y, rate)| y + step * rate)
                    .collect();
                let mut out = vec![0.0; count];
                // Prescribed motion advances with its given rates.
                let inputs = model
                    .inputs
                    .iter()
                    .zip(&sample.inputs)
                    .map(|(input, value)| {
                        let rate = input.rate.map_or(0.0, |rate| sample.inputs[rate.index()]);
                        value + step * rate
                    });
                let moved = Sample {
                    time: sample.time + step,
                    state: moved,
                    inputs: inputs.collect(),
                };
                evaluator.observables(point_of(&moved), &mut out);
                (out[count - 2], out[count - 1])
            };
            let fastest = sample
                .state
                .iter()
                .zip(&rates)
                .map(|(y, rate)| (rate / y).abs());
            let step = 1e-5 / fastest.fold(1.0, f64::max);
            let (after, before, (energy, power)) = (values(step).0, values(-step).0, values(0.0));
            let rate = (after - before) / (2.0 * step);
            let scale = power.abs() + 1e-4 * energy.abs() / step;
            assert!(
                (rate - power).abs() < 1e-6 * scale,
                "{name}, order {order}: {rate} and {power}"
            );
        }
    }
}

fn point_of(sample: &Sample) -> Point<'_> {
    Point {
        t: sample.time,
        state: &sample.state,
        inputs: &sample.inputs,
    }
}

fn emit_source(model: &Model, order: usize) -> String {
    emit(variant(model, order).evaluator.program(), Packaging::Crate).unwrap()
}
