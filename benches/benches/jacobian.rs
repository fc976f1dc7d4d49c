//! Benchmark of the Jacobian of the arm's rates by the state and of its products with a vector, compared with the
//! right-hand side. The time per structural nonzero is measured too.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use eomgen_benches::{generated, state, variants};

/// Results are passed to `black_box` by reference, so that the time of a copy is not included.
macro_rules! compare {
    ($criterion:ident, $($order:literal $module:ident),*) => {$({
        use variants::$module as arm;
        type State = [f64; arm::STATES];
        generated!(arm);
        #[inline(never)]
        fn forward(t: f64, state: &State, c: &arm::Coefficients, direction: &State) -> State {
            let inputs = arm::Inputs::default();
            arm::jacobian_vector_product(t, state, &inputs, c, direction, &inputs)
        }
        #[inline(never)]
        fn reverse(t: f64, state: &State, c: &arm::Coefficients, weights: &State) -> State {
            arm::vector_jacobian_product(t, state, &arm::Inputs::default(), c, weights).0
        }
        #[inline(never)]
        fn by_parameters(
            t: f64,
            state: &State,
            c: &arm::Coefficients,
            weights: &State,
        ) -> [f64; arm::PARAMETERS] {
            arm::vector_jacobian_product_by_parameters(t, state, &arm::Inputs::default(), c, weights)
        }
        #[inline(never)]
        fn jacobian(
            t: f64,
            state: &State,
            c: &arm::Coefficients,
        ) -> [f64; arm::RATES_BY_STATE_NONZEROS] {
            arm::rates_by_state(t, state, &arm::Inputs::default(), c)
        }
        let mut group = $criterion.benchmark_group(concat!("jacobian_order_", $order));
        let state = state::<{ arm::STATES }>();
        let mut rates = state;
        let coefficients = arm::Coefficients::prepare(&arm::Parameters::default());
        group.bench_function("rates", |bencher| {
            bencher.iter(|| {
                generated(black_box(0.3), black_box(&state), black_box(&coefficients), &mut rates);
                black_box(&rates);
            })
        });
        group.bench_function("jacobian_vector_product", |bencher| {
            bencher.iter(|| {
                let direction = black_box(&state);
                black_box(&forward(black_box(0.3), black_box(&state), black_box(&coefficients), direction));
            })
        });
        group.bench_function("vector_jacobian_product", |bencher| {
            bencher.iter(|| {
                let weights = black_box(&state);
                black_box(&reverse(black_box(0.3), black_box(&state), black_box(&coefficients), weights));
            })
        });
        group.bench_function("product_by_parameters", |bencher| {
            bencher.iter(|| {
                let weights = black_box(&state);
                black_box(&by_parameters(black_box(0.3), black_box(&state), black_box(&coefficients), weights));
            })
        });
        group.throughput(Throughput::Elements(arm::RATES_BY_STATE_NONZEROS as u64));
        group.bench_function("jacobian", |bencher| {
            bencher.iter(|| {
                black_box(&jacobian(black_box(0.3), black_box(&state), black_box(&coefficients)));
            })
        });
        group.finish();
    })*};
}

fn jacobian(criterion: &mut Criterion) {
    compare!(criterion, 4 full_order_4, 16 full_order_16, 64 full_order_64);
}

criterion_group!(benches, jacobian);
criterion_main!(benches);
