//! What switching can do to a model at all, whatever its state.

use codegen::affine::system::{AffineEvaluator, AffineSystem};

use super::propagator::Propagator;

impl Propagator {
    /// Which states any rate or any switching function feels.
    pub(super) fn felt_states(&mut self) -> Vec<bool> {
        let guards = self.evaluator.guard_count();
        let mut felt = vec![false; self.states];
        for case in 0..guards + 2 {
            let sides: Vec<f64> = (0..guards)
                .map(|guard| f64::from(u8::from(case == guards + 1 || case == guard)))
                .collect();
            let system = self.evaluator.system(&sides);
            let rows = [&system.rates.state, &system.guards.state];
            let rows = rows.map(|rows| rows.chunks(self.states.max(1)));
            for row in rows.into_iter().flatten() {
                row.iter()
                    .zip(&mut felt)
                    .for_each(|(entry, felt)| *felt |= *entry != 0.0);
            }
        }
        felt
    }
}

/// The fastest rate that switching can add, 1/s: the root of the largest change of a
/// stiffness.
pub(super) fn switched_rate(evaluator: &mut AffineEvaluator, system: &AffineSystem) -> f64 {
    let (guards, states) = (evaluator.guard_count(), evaluator.states());
    let mut largest: f64 = 0.0;
    for guard in 0..guards {
        let sides: Vec<f64> = (0..guards)
            .map(|g| f64::from(u8::from(g == guard)))
            .collect();
        let other = evaluator.system(&sides);
        let rows = system.rates.state.chunks(states.max(1));
        for (a, b) in rows.zip(other.rates.state.chunks(states.max(1))) {
            let positions = a.iter().zip(b).take(states / 2);
            largest = positions.fold(largest, |m, (a, b)| m.max((a - b).abs()));
        }
    }
    largest.sqrt()
}
