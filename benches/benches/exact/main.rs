//! The exact propagator against general solvers at equal error, in one run: first a table
//! (the tolerance each peer needs, its error, the time of one simulated second), then
//! criterion's measurements of the same.
//!
//! The case is the arm at S = 4, b = 25 um, omega = 10 pi, one second from rest. The error
//! is the largest |x_sp - reference| on a grid of 1 ms; the reference is the exact
//! propagator's, and the table ends with its distance from the tightest peer. Pipeline:
//! `arm` (right-hand sides), `peers` (solvers), `table` (search for tolerances, print).

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

/// The orders at which the cost of a switch is told.
const ORDERS: [usize; 4] = [0, 4, 16, 64];

/// The exact propagator at one order.
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
        let derived = PiecewiseLinear::of(&model, &[order]).expect("piecewise linear");
        Self {
            order,
            propagator: derived.propagator(&model).expect("finite matrices"),
            initial: model.initial_state(&[order]).expect("a start"),
            derived,
            model,
        }
    }

    /// One second from rest, its regimes kept from the last call.
    fn second(&mut self, samples: &[f64]) -> Trajectory {
        let none = HeldInputs::zero(0);
        self.propagator
            .simulate(&self.initial, (0.0, 1.0), samples, &none, &mut |_| {})
            .expect("a simulation")
    }

    /// One second from rest at parameters never seen before: every regime is made anew.
    fn anew(&mut self) -> Trajectory {
        self.propagator = self
            .derived
            .propagator(&self.model)
            .expect("finite matrices");
        self.second(&[])
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
            bencher.iter(|| arm.second(black_box(&[])).last);
        });
    }
    group.finish();
}

criterion_group!(benches, exact);
criterion_main!(benches);
