//! Benchmark of the arm's right-hand side as emitted Rust, as just-in-time compiled machine code, and interpreted, and
//! of the time to generate the machine code.

use std::hint::black_box;
use std::path::Path;

use criterion::{Criterion, criterion_group, criterion_main};
use eomgen_benches::{generated, state, variants};
use eomgen_codegen::mechanics::equations::derive;
use eomgen_codegen::program::Program;
use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_codegen::program::lowering::lower;

fn program(order: usize) -> Program {
    let path =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../model-spec/models/planetary_arm.toml");
    let Ok(checked) = eomgen_model_spec::load(&path) else {
        panic!("the shipped specification is valid");
    };
    let model = checked.model;
    let Ok(values) = model.parameter_values() else {
        panic!("its parameters have values");
    };
    let equations = derive(&model, &[order]).expect("the arm has equations of motion");
    lower(&model, &equations, &values)
}

/// Results are passed to `black_box` by reference, so that the time of a copy is not included.
macro_rules! compare {
    ($criterion:ident, $($order:literal $module:ident),*) => {$({
        use variants::$module as arm;
        let mut group = $criterion.benchmark_group(concat!("machine_code_order_", $order));
        let state = state::<{ arm::STATES }>();
        generated!(arm);
        let mut rates = state;
        let coefficients = arm::Coefficients::prepare(&arm::Parameters::default());
        group.bench_function("generated", |bencher| {
            bencher.iter(|| {
                generated(black_box(0.3), black_box(&state), black_box(&coefficients), &mut rates);
                black_box(&rates);
            })
        });
        let program = program($order);
        let point = Point { t: 0.3, state: &state, inputs: &[] };
        for (name, mut evaluator) in [
            ("machine_code", eomgen_jit::evaluator(program.clone())),
            ("interpreted", Evaluator::new(program.clone())),
        ] {
            group.bench_function(name, |bencher| {
                let mut out = [0.0; arm::STATES];
                bencher.iter(|| {
                    evaluator.rates(black_box(point), &mut out);
                    black_box(&out);
                })
            });
        }
        group.bench_function("start", |bencher| {
            bencher.iter(|| eomgen_jit::evaluator(black_box(program.clone())))
        });
        group.finish();
    })*};
}

fn machine_code(criterion: &mut Criterion) {
    compare!(criterion, 4 order_4, 16 order_16, 64 order_64);
}

criterion_group!(benches, machine_code);
criterion_main!(benches);
