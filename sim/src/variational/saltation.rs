//! Time difference between a motion and a neighbouring motion at a switching surface.

use crate::ode::System;

/// Step of finite differences relative to the size of a state: large compared with the rounding of a switching
/// function, small enough that its curvature is negligible.
const DIFFERENCE_FRACTION: f64 = 1e-3;

/// Largest relative difference of crossing times of two functions that describe the same surface.
const MAX_TIME_DIFFERENCE_FRACTION: f64 = 1e-6;

pub(super) struct Surfaces<'a> {
    pub system: &'a dyn System,
    /// Sizes of the states for finite differences; 0 if unknown.
    pub sizes: &'a [f64],
}

impl Surfaces<'_> {
    fn evaluate(&self, t: f64, y: &[f64]) -> Vec<f64> {
        let mut guards = vec![0.0; self.system.guard_count()];
        self.system.guards(t, y, &mut guards);
        guards
    }

    /// Returns the derivatives of all functions: one row for time, then one per state.
    fn derivatives(&self, t: f64, y: &[f64], time: f64) -> Vec<Vec<f64>> {
        let quotient = |(above, below): (Vec<f64>, Vec<f64>), width: f64| -> Vec<f64> {
            let pairs = above.into_iter().zip(below);
            pairs
                .map(|(above, below)| (above - below) / width)
                .collect()
        };
        let (late, soon) = (t + time, t - time);
        let mut rows = vec![quotient(
            (self.evaluate(late, y), self.evaluate(soon, y)),
            late - soon,
        )];
        let mut moved = y.to_vec();
        for state in 0..y.len() {
            let size = self.sizes[state].max(y[state].abs());
            // A state that has always been 0 has the size 1 in its unit.
            let step = DIFFERENCE_FRACTION * if size > 0.0 { size } else { 1.0 };
            let (high, low) = (y[state] + step, y[state] - step);
            moved[state] = high;
            let above = self.evaluate(t, &moved);
            moved[state] = low;
            let below = self.evaluate(t, &moved);
            moved[state] = y[state];
            rows.push(quotient((above, below), high - low));
        }
        rows
    }
}

/// Returns the delay (s) with which a neighbouring motion at the distance `v` reaches the surface between two
/// points; `from` are the rates on the near side. Returns `None` if there are several surfaces with different
/// delays, or if the motion only touches the surface.
pub(super) fn find_delay(
    surfaces: &Surfaces<'_>,
    (before, near): (f64, &[f64]),
    (t, beyond): (f64, &[f64]),
    from: &[f64],
    v: &[f64],
) -> Option<f64> {
    let (near, far) = (
        surfaces.evaluate(before, near),
        surfaces.evaluate(t, beyond),
    );
    // Shortest time in which a state changes by its size; it is the time step for surfaces that depend on time.
    let times = from.iter().zip(surfaces.sizes);
    let times = times.filter(|(rate, size)| **rate != 0.0 && **size > 0.0);
    let time = times
        .map(|(rate, size)| size / rate.abs())
        .fold(1.0, f64::min);
    let derivatives = surfaces.derivatives(t, beyond, DIFFERENCE_FRACTION * time);
    let crossed = (0..near.len()).filter(|guard| near[*guard] * far[*guard] < 0.0);
    let mut delays = crossed.map(|guard| {
        let by = |row: usize| derivatives[row][guard];
        let along = |direction: &[f64]| -> f64 {
            let entries = direction.iter().enumerate();
            entries.map(|(state, entry)| by(state + 1) * entry).sum()
        };
        -along(v) / (by(0) + along(from))
    });
    let first = delays.next()?;
    let agree =
        delays.all(|delay| (delay - first).abs() <= MAX_TIME_DIFFERENCE_FRACTION * first.abs());
    (agree && first.is_finite()).then_some(first)
}
