//! Benchmark of the arm's right-hand side: generated, hand-written in O(S), and hand-assembled Eq. (22), with prepared
//! coefficients and the same sine. The floor is one sine and a copy of the rates. No call is inlined.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use eomgen_benches::contenders::{equation_22, floor};
use eomgen_benches::eliminated_arm::EliminatedArm;
use eomgen_benches::{at_all_orders, generated, state, variants};
use eomgen_validate::references::planetary_arm::dimensionless_equation_22::Equation22;
use eomgen_validate::references::planetary_arm::parameters::PlanetaryArmParameters;

/// Results are passed to `black_box` by reference, so that the time of a copy is not included.
macro_rules! compare {
    ($criterion:ident, $($order:literal $module:ident),*) => {$({
        use variants::$module as arm;
        let mut group = $criterion.benchmark_group(concat!("rates_order_", $order));
        let state = state::<{ arm::STATES }>();
        let mut rates = state;
        let parameters = PlanetaryArmParameters::default();
        group.bench_function("floor", |bencher| {
            bencher.iter(|| {
                floor(black_box(0.3), black_box(&state), black_box(31.4), &mut rates);
                black_box(&rates);
            })
        });
        generated!(arm);
        let coefficients = arm::Coefficients::prepare(&arm::Parameters::default());
        group.bench_function("generated", |bencher| {
            bencher.iter(|| {
                generated(black_box(0.3), black_box(&state), black_box(&coefficients), &mut rates);
                black_box(&rates);
            })
        });
        let eliminated = EliminatedArm::<$order>::new(&parameters);
        group.bench_function("hand_written", |bencher| {
            bencher.iter(|| {
                black_box(&eliminated).rates(black_box(0.3), black_box(&state), &mut rates);
                black_box(&rates);
            })
        });
        let equation = Equation22::<$order>::new(&parameters, 1.0, 1.0);
        group.bench_function("equation_22", |bencher| {
            bencher.iter(|| {
                equation_22(black_box(&equation), black_box(0.3), black_box(&state), &mut rates);
                black_box(&rates);
            })
        });
        group.finish();
    })*};
}

fn rates(criterion: &mut Criterion) {
    macro_rules! compare_all {
        ($($order:literal $module:ident),*) => { compare!(criterion, $($order $module),*) };
    }
    at_all_orders!(compare_all);
}

criterion_group!(benches, rates);
criterion_main!(benches);
