//! One right-hand side of the arm: generated against hand-assembled Eq. (22), both with
//! prepared coefficients and the same sine, in one run.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use generated as g;
use sim::reference::PlanetaryArmParameters;
use sim::reference::equation_22::Equation22;

/// A state in contact on one mesh and free on the other, modes in motion.
fn state<const N: usize>() -> [f64; N] {
    let mut state = [0.0; N];
    let degrees = N / 2;
    state[..3].copy_from_slice(&[3e-5, -1e-5, 0.01]);
    state[degrees..degrees + 3].copy_from_slice(&[0.02, -0.01, 0.1]);
    for mode in 3..degrees {
        state[mode] = 1e-4 / (mode * mode) as f64;
        state[degrees + mode] = 1e-2 / mode as f64;
    }
    state
}

macro_rules! compare {
    ($criterion:ident, $order:literal, $module:ident) => {{
        let mut group = $criterion.benchmark_group(concat!("rates_order_", $order));
        let state = state::<{ g::$module::STATES }>();
        let coefficients = g::$module::Coefficients::prepare(&g::$module::Parameters::default());
        let inputs = g::$module::Inputs::default();
        group.bench_function("generated", |bencher| {
            bencher.iter(|| {
                g::$module::rates(
                    black_box(0.3),
                    black_box(&state),
                    &inputs,
                    black_box(&coefficients),
                )
            })
        });
        let equation = Equation22::<$order>::new(&PlanetaryArmParameters::default(), 1.0, 1.0);
        group.bench_function("equation_22", |bencher| {
            bencher.iter(|| {
                let mut out = [0.0; g::$module::STATES];
                black_box(&equation).rates(black_box(0.3), black_box(&state), &mut out);
                out
            })
        });
        group.finish();
    }};
}

fn rates(criterion: &mut Criterion) {
    compare!(criterion, 1, planetary_arm_order_1);
    compare!(criterion, 2, planetary_arm_order_2);
    compare!(criterion, 4, planetary_arm_order_4);
    compare!(criterion, 8, planetary_arm_order_8);
}

criterion_group!(benches, rates);
criterion_main!(benches);
