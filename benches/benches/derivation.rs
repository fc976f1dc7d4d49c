//! Benchmark of derivation, lowering and emission of the arm, separately and together, at a small and at the largest
//! order.

use std::path::Path;

use criterion::{Criterion, criterion_group, criterion_main};
use eomgen_codegen::mechanics::equations::derive;
use eomgen_codegen::program::lowering::lower;
use eomgen_codegen::rust::{Packaging, emit};

fn derivation(criterion: &mut Criterion) {
    let path =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../model-spec/models/planetary_arm.toml");
    let Ok(checked) = eomgen_model_spec::load(&path) else {
        panic!("the shipped specification is valid");
    };
    let model = checked.model;
    let Ok(values) = model.parameter_values() else {
        panic!("its parameters have values");
    };
    for order in [4, 128] {
        let equations = || derive(&model, &[order]).expect("the arm has equations of motion");
        let derived = equations();
        let program = lower(&model, &derived, &values);
        let source = || emit(&program, Packaging::Crate).expect("names are identifiers");
        let mut group = criterion.benchmark_group(format!("derivation_order_{order}"));
        group.bench_function("derive", |bencher| bencher.iter(equations));
        group.bench_function("lower", |bencher| {
            bencher.iter(|| lower(&model, &derived, &values))
        });
        group.bench_function("emit", |bencher| bencher.iter(source));
        group.bench_function("all", |bencher| {
            bencher.iter(|| emit(&lower(&model, &equations(), &values), Packaging::Crate))
        });
        group.finish();
    }
}

criterion_group!(benches, derivation);
criterion_main!(benches);
