//! Cases that [`crate::instructions`] counts. Each is a separate function for callgrind.

use std::hint::black_box;
use std::path::Path;

use eomgen_codegen::rust::{Packaging, emit};
use eomgen_codegen::variant::Variant;
use eomgen_model_spec::model::Model;
use eomgen_validate::references::planetary_arm::dimensionless_equation_22::Equation22;
use eomgen_validate::references::planetary_arm::parameters::PlanetaryArmParameters;

use crate::contenders::equation_22;
use crate::eliminated_arm::EliminatedArm;
use crate::instructions::CALLS;
use crate::{state, variants};

/// Defines a function for each contender at an order, and a function that prepares and calls them. Preparation is not
/// counted.
macro_rules! right_hand_sides {
    ($($order:literal $module:ident $generated:ident $hand_written:ident $equation_22:ident),* $(,)?) => {
        $(
            #[inline(never)]
            fn $generated(
                state: &[f64; variants::$module::STATES],
                coefficients: &variants::$module::Coefficients,
            ) {
                let inputs = variants::$module::Inputs::default();
                let mut rates = *state;
                repeat(|| {
                    variants::$module::rates_into(black_box(0.3), black_box(state), &inputs, coefficients, &mut rates);
                    black_box(&rates);
                });
            }

            #[inline(never)]
            fn $hand_written(state: &[f64; variants::$module::STATES], arm: &EliminatedArm<$order>) {
                let mut rates = *state;
                repeat(|| {
                    black_box(arm).rates(black_box(0.3), black_box(state), &mut rates);
                    black_box(&rates);
                });
            }

            #[inline(never)]
            fn $equation_22(state: &[f64; variants::$module::STATES], arm: &Equation22<$order>) {
                let mut rates = *state;
                repeat(|| {
                    equation_22(black_box(arm), black_box(0.3), black_box(state), &mut rates);
                    black_box(&rates);
                });
            }
        )*

        fn run_right_hand_sides() {
            let parameters = PlanetaryArmParameters::default();
            $({
                use variants::$module as arm;
                let state = state::<{ arm::STATES }>();
                $generated(&state, &arm::Coefficients::prepare(&arm::Parameters::default()));
                $hand_written(&state, &EliminatedArm::new(&parameters));
                $equation_22(&state, &Equation22::new(&parameters, 1.0, 1.0));
            })*
        }
    };
}

right_hand_sides!(
    0 order_0 generated_0 hand_written_0 equation_22_0,
    1 order_1 generated_1 hand_written_1 equation_22_1,
    2 order_2 generated_2 hand_written_2 equation_22_2,
    4 order_4 generated_4 hand_written_4 equation_22_4,
    8 order_8 generated_8 hand_written_8 equation_22_8,
    16 order_16 generated_16 hand_written_16 equation_22_16,
    32 order_32 generated_32 hand_written_32 equation_22_32,
    64 order_64 generated_64 hand_written_64 equation_22_64,
    128 order_128 generated_128 hand_written_128 equation_22_128,
);

/// Repeats the counted call [`CALLS`] times.
#[inline(always)]
fn repeat(mut call: impl FnMut()) {
    for _ in 0..CALLS {
        call();
    }
}

/// Derives and emits a model with all fields at an order.
fn emitted(model: &Model, order: usize) {
    let variant = Variant::derive(model, &vec![order; model.fields.len()]);
    let Ok(variant) = variant else {
        panic!("the shipped model can be derived");
    };
    let source = emit(&variant.program, Packaging::Crate);
    assert!(black_box(source).is_ok());
}

#[inline(never)]
fn derive_and_emit_4(model: &Model) {
    emitted(model, 4);
}

#[inline(never)]
fn derive_and_emit_128(model: &Model) {
    emitted(model, 128);
}

/// Runs every case.
///
/// # Panics
/// If the shipped specification has moved since compilation.
pub fn run() {
    run_right_hand_sides();
    let path =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../model-spec/models/planetary_arm.toml");
    let Ok(checked) = eomgen_model_spec::load(&path) else {
        panic!("the shipped model can be read");
    };
    derive_and_emit_4(&checked.model);
    derive_and_emit_128(&checked.model);
}
