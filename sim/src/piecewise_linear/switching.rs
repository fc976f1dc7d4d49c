//! Effects of switching on a model, independent of the state.

use eomgen_codegen::program::affine::{AffineEvaluator, AffineSystem};

use super::propagator::Propagator;

/// Irrational number whose multiples are used as sides. Polynomials of practical models have no zero there.
const GOLDEN_RATIO_FRACTION: f64 = 0.618_033_988_749_894_9;

impl Propagator {
    /// Returns true for each state that affects any rate or switching function.
    pub(super) fn influential_states(&mut self) -> Vec<bool> {
        let guards = self.evaluator.guard_count();
        let mut felt = vec![false; self.states];
        // The last case evaluates at values between the sides, for functions that depend on several sides.
        let nested = usize::from(self.has_dependents());
        for case in 0..guards + 2 + nested {
            let side = |guard: usize| match case == guards + 2 {
                true => (0.5 + guard as f64 * GOLDEN_RATIO_FRACTION).fract(),
                false => f64::from(u8::from(case == guards + 1 || case == guard)),
            };
            let sides: Vec<f64> = (0..guards).map(side).collect();
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

/// Returns the fastest rate that switching can add, 1/s: the square root of the largest change of a stiffness.
pub(super) fn find_switched_rate(evaluator: &mut AffineEvaluator, system: &AffineSystem) -> f64 {
    let (guards, states) = (evaluator.guard_count(), evaluator.states());
    let mut largest: f64 = 0.0;
    for guard in 0..guards {
        let sides: Vec<f64> = (0..guards)
            .map(|g| f64::from(u8::from(g == guard)))
            .collect();
        let other = evaluator.system(&sides);
        let rows = system.rates.state.chunks(states.max(1));
        for (a, b) in rows.zip(other.rates.state.chunks(states.max(1))) {
            // Positions are first in the state.
            let positions = a.iter().zip(b).take(system.degrees);
            largest = positions.fold(largest, |m, (a, b)| m.max((a - b).abs()));
        }
    }
    largest.sqrt()
}
