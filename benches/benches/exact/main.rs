//! Benchmark of the exact propagator and of general solvers at equal error. First a table lists the required tolerance
//! of each peer, its error, and the time per simulated second. Then Criterion measures the times.
//!
//! The case is the arm at S = 4, b = 25 um, omega = 10 pi, one second from rest. The error is the largest |x_sp -
//! reference| on a grid of 1 ms, with the exact propagator as the reference. The last line of the table is the distance
//! of the exact propagator from the most accurate peer. `arm` has the right-hand sides, `peers` the solvers, `table`
//! the search for tolerances.

mod arm;
mod peers;
mod table;

use std::hint::black_box;
use std::path::Path;

use criterion::{Criterion, criterion_group, criterion_main};
use eomgen_model_spec::model::Model;
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::Trajectory;
use eomgen_sim::piecewise_linear::{PiecewiseLinear, Propagator};

/// Orders at which the time per switch is printed.
const ORDERS: [usize; 4] = [0, 4, 16, 64];

/// Exact propagator at one order.
struct Exact {
    order: usize,
    derived: PiecewiseLinear,
    propagator: Propagator,
    model: Model,
    initial: Vec<f64>,
}

impl Exact {
    fn new(order: usize) -> Self {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
        let path = folder.join("../model-spec/models/planetary_arm.toml");
        let model = eomgen_model_spec::load(&path).expect("a model").model;
        let derived = PiecewiseLinear::derive(&model, &[order]).expect("piecewise linear");
        Self {
            order,
            propagator: derived
                .propagator_for_model(&model)
                .expect("finite matrices"),
            initial: model.initial_state(&[order]).expect("a start"),
            derived,
            model,
        }
    }

    /// Simulates one second from rest, with cached regimes.
    fn simulate_cached(&mut self, samples: &[f64]) -> Trajectory {
        let none = HeldInputs::zero(0);
        self.propagator
            .simulate(&self.initial, (0.0, 1.0), samples, &none, &mut |_| {})
            .expect("a simulation")
    }

    /// Simulates one second from rest at new parameters, without cached regimes.
    fn simulate_uncached(&mut self) -> Trajectory {
        self.propagator = self
            .derived
            .propagator_for_model(&self.model)
            .expect("finite matrices");
        self.simulate_cached(&[])
    }
}

fn exact(criterion: &mut Criterion) {
    let mut orders: Vec<Exact> = ORDERS.into_iter().map(Exact::new).collect();
    let tuned = table::print(&mut orders);
    let mut group = criterion.benchmark_group("one_second_order_4");
    for (peer, tolerance) in &tuned.peers {
        group.bench_function(peer.name(), |bencher| {
            bencher.iter(|| peer.end(black_box(&tuned.problem), *tolerance));
        });
    }
    group.finish();
    let mut group = criterion.benchmark_group("one_second_exact");
    for arm in &mut orders {
        group.bench_function(format!("order_{}", arm.order), |bencher| {
            bencher.iter(|| arm.simulate_cached(black_box(&[])).final_state);
        });
    }
    group.finish();
}

criterion_group!(benches, exact);
criterion_main!(benches);
