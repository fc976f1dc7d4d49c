//! A program with a misplaced value is rejected; it must not compile to code that returns NaN.
#![cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]

use std::path::Path;

use eomgen_codegen::program::{Extent, Op};
use eomgen_codegen::variant::Variant;
use eomgen_model_spec::ids::CoordinateId;

#[test]
fn leaf_computed_by_elements_is_rejected() {
    let models = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../model-spec/models");
    let checked = eomgen_model_spec::load(&models.join("hub_beam_tip_mass.toml"));
    let model = checked
        .unwrap_or_else(|e| panic!("{}", e.render(false)))
        .model;
    let variant = Variant::derive(&model, &[2]);
    let mut program = variant
        .unwrap_or_else(|e| panic!("{}", e.render(false)))
        .program;
    assert!(eomgen_jit::compile(&program).is_ok());
    let vector = program.ids().find(|id| {
        let value = program.value(*id);
        let is_vector = matches!(value.extent, Extent::Vector(_));
        is_vector
            && !value.parameter_only
            && matches!(value.op, Op::Multiply(..) | Op::Subtract(..))
    });
    let vector = vector.expect("a vector that is computed per call");
    program.values[vector.index()].op = Op::Coordinate(CoordinateId::new(0));
    let refused = eomgen_jit::compile(&program)
        .map(|_| ())
        .expect_err("a misplaced leaf");
    let message = refused.to_string();
    assert!(message.contains("CoordinateId(0)"), "{message}");
}
