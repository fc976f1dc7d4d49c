//! How much later or earlier a neighbouring motion comes to a switching surface.

use crate::ode::System;

/// Differences are taken over this part of a state's size: wide enough for the rounding of a
/// switching function, narrow enough for its bend.
const STEP: f64 = 1e-3;

/// Times that agree within this part are of one surface, written twice.
const SAME: f64 = 1e-6;

/// The switching functions of a system and how large its states are.
pub(super) struct Surfaces<'a, S: System + ?Sized> {
    pub system: &'a S,
    /// For differences; 0 where it is not known.
    pub sizes: &'a [f64],
}

impl<S: System + ?Sized> Surfaces<'_, S> {
    fn at(&self, t: f64, y: &[f64]) -> Vec<f64> {
        let mut guards = vec![0.0; self.system.guard_count()];
        self.system.guards(t, y, &mut guards);
        guards
    }

    /// The derivatives of all functions by the time and the states, a row for each variable.
    fn derivatives(&self, t: f64, y: &[f64], time: f64) -> Vec<Vec<f64>> {
        let quotient = |(above, below): (Vec<f64>, Vec<f64>), width: f64| -> Vec<f64> {
            let pairs = above.into_iter().zip(below);
            pairs
                .map(|(above, below)| (above - below) / width)
                .collect()
        };
        let (late, soon) = (t + time, t - time);
        let mut rows = vec![quotient((self.at(late, y), self.at(soon, y)), late - soon)];
        let mut moved = y.to_vec();
        for state in 0..y.len() {
            let size = self.sizes[state].max(y[state].abs());
            // What has not moved yet is as large as its unit.
            let step = STEP * if size > 0.0 { size } else { 1.0 };
            let (high, low) = (y[state] + step, y[state] - step);
            moved[state] = high;
            let above = self.at(t, &moved);
            moved[state] = low;
            let below = self.at(t, &moved);
            moved[state] = y[state];
            rows.push(quotient((above, below), high - low));
        }
        rows
    }
}

/// How much later (s) than a motion its neighbour at the distance `v` comes to the surface between two
/// points, `from` being the rates on the near side. Nothing where there are several surfaces and
/// different times, or where the motion only touches.
pub(super) fn delay<S: System + ?Sized>(
    surfaces: &Surfaces<'_, S>,
    (before, near): (f64, &[f64]),
    (t, beyond): (f64, &[f64]),
    from: &[f64],
    v: &[f64],
) -> Option<f64> {
    let (near, far) = (surfaces.at(before, near), surfaces.at(t, beyond));
    // In a time in which the state changes by a part of its size, to see a clock in a surface.
    let times = from.iter().zip(surfaces.sizes);
    let times = times.filter(|(rate, size)| **rate != 0.0 && **size > 0.0);
    let time = times
        .map(|(rate, size)| size / rate.abs())
        .fold(1.0, f64::min);
    let derivatives = surfaces.derivatives(t, beyond, STEP * time);
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
    let agree = delays.all(|delay| (delay - first).abs() <= SAME * first.abs());
    (agree && first.is_finite()).then_some(first)
}
