//! Gauss-Newton steps: windows are linearised at an estimate, their initial states are eliminated,
//! and the shared unknowns are bounded.

use nalgebra::{DMatrix, DVector};

use super::fit::{Estimate, Fit, Records, Window, WindowEstimate};
use super::windows::{simulate_window, with_sensor_errors};
use crate::hidden::Sensors;
use crate::machines::Machine;

/// Bound of unknowns with priors, in standard deviations. Larger deviations are effects.
const MAX_DEVIATION_SD: f64 = 3.0;

/// Step of an initial state that the window does not determine, in ranges of its motion.
const UNDETERMINED_STEP: f64 = 0.02;

/// Perturbations of the unknowns for finite differences.
#[derive(Clone, Copy)]
pub struct Perturbations {
    /// Perturbation of initial states, in ranges of their motion.
    start: f64,
    /// Perturbation of shared unknowns, in standard deviations.
    shared: f64,
}

/// Small perturbations for derivatives.
pub const SLOPES: Perturbations = Perturbations {
    start: 1e-6,
    shared: 1e-4,
};

/// Perturbations of about the size of a step, for secants. With impacts, derivatives do not predict
/// a whole step.
pub const SECANTS: Perturbations = Perturbations {
    start: 1e-2,
    shared: 0.3,
};

/// Step of all unknowns.
pub struct Step {
    /// Shared unknowns, in standard deviations.
    pub shared: DVector<f64>,
    /// Initial states of each window, along [`crate::machines::Machine::directions`].
    pub starts: Vec<DVector<f64>>,
}

/// Linearised window with its initial state eliminated.
struct LinearisedWindow {
    residual: DVector<f64>,
    shared: DMatrix<f64>,
    /// Step of the initial state: a constant part, and a part per shared unknown that is
    /// subtracted.
    start: (DVector<f64>, DMatrix<f64>),
}

/// Returns the step from an estimate to the minimum of the linearised cost.
pub fn step(fit: &Fit<'_>, records: &Records, at: &Estimate, perturbations: Perturbations) -> Step {
    let unknowns = at.shared.len();
    let around = PerturbedMachines::new(fit, records, &at.shared, perturbations);
    // The prior of the unknowns is the identity, because they are in standard deviations.
    let mut normal = DMatrix::identity(unknowns, unknowns);
    let mut right = -&at.shared;
    let mut parts = Vec::new();
    for (window, fitted) in records.windows.iter().zip(&at.windows) {
        let part = around.linearise(window, fitted);
        normal += part.shared.transpose() * &part.shared;
        right += part.shared.transpose() * &part.residual;
        parts.push(part);
    }
    let shared = solve_bounded(&normal, &right, &at.shared);
    let start = |part: &LinearisedWindow| &part.start.0 - &part.start.1 * &shared;
    Step {
        starts: parts.iter().map(start).collect(),
        shared,
    }
}

/// Perturbed machines and sensors, shared by all windows.
struct PerturbedMachines<'a> {
    fit: &'a Fit<'a>,
    ranges: &'a [f64],
    perturbations: Perturbations,
    here: (Machine, Sensors),
    /// Machines and sensors with one perturbed shared unknown each.
    nudged: Vec<(Machine, Sensors)>,
}

impl<'a> PerturbedMachines<'a> {
    fn new(
        fit: &'a Fit<'a>,
        records: &'a Records,
        shared: &DVector<f64>,
        perturbations: Perturbations,
    ) -> Self {
        let nudged = (0..shared.len()).map(|unknown| {
            let mut other = shared.clone();
            other[unknown] += perturbations.shared;
            fit.with(&other)
        });
        Self {
            fit,
            ranges: &records.ranges,
            perturbations,
            here: fit.with(shared),
            nudged: nudged.collect(),
        }
    }

    fn linearise(&self, window: &Window, at: &WindowEstimate) -> LinearisedWindow {
        let (samples, size) = (at.residual.len(), self.ranges.len());
        let longer = |seen: DVector<f64>| seen.resize_vertically(samples + size, 0.0);
        let residual = longer(at.residual.clone());
        let columns: Vec<DVector<f64>> =
            (self.shared_directions(window, at).into_iter().map(longer)).collect();
        let directions = DMatrix::from_columns(&columns);
        let factors = self.start_directions(window, at).qr();
        let (q, r) = (factors.q(), factors.r());
        let taken = (q.transpose() * &residual, q.transpose() * &directions);
        let residual = residual - &q * &taken.0;
        let directions = directions - &q * &taken.1;
        // The rows of the identity make the triangular factor regular.
        let inverse = r
            .try_inverse()
            .unwrap_or_else(|| DMatrix::zeros(size, size));
        let scale = DVector::from_column_slice(self.ranges) * UNDETERMINED_STEP;
        let inverse = DMatrix::from_diagonal(&scale) * inverse;
        LinearisedWindow {
            residual,
            shared: directions,
            start: (&inverse * taken.0, inverse * taken.1),
        }
    }

    /// Returns the influence of the initial state on a residual. One row per direction is appended,
    /// which bounds a direction that the window does not determine.
    fn start_directions(&self, window: &Window, at: &WindowEstimate) -> DMatrix<f64> {
        let (machine, sensors) = &self.here;
        let directions = machine.directions();
        let samples = at.residual.len();
        let mut starts = DMatrix::zeros(samples + directions.len(), directions.len());
        for (column, direction) in directions.iter().enumerate() {
            let perturbation = self.perturbations.start * self.ranges[column];
            let moved = move_along(&at.start, direction, perturbation);
            let residual = self.fit.residual(machine, sensors, window, &moved);
            let change = (&at.residual - residual) * (UNDETERMINED_STEP / self.perturbations.start);
            starts
                .view_mut((0, column), (samples, 1))
                .copy_from(&change);
            starts[(samples + column, column)] = 1.0;
        }
        starts
    }

    /// Returns the influence of one standard deviation of each shared unknown on a residual.
    fn shared_directions(&self, window: &Window, at: &WindowEstimate) -> Vec<DVector<f64>> {
        let fit = self.fit;
        let base = simulate_window(&self.here.0, fit.setup, fit.drives, &at.start, window.span);
        let column = |(unknown, (machine, sensors)): (usize, &(Machine, Sensors))| {
            let residual = if unknown < fit.parameters() {
                fit.residual(machine, sensors, window, &at.start)
            } else {
                &window.seen - with_sensor_errors(&base, fit.setup, sensors)
            };
            (&at.residual - residual) / self.perturbations.shared
        };
        self.nudged.iter().enumerate().map(column).collect()
    }
}

/// Solves the normal equations; unknowns beyond their bound are set to it.
fn solve_bounded(normal: &DMatrix<f64>, right: &DVector<f64>, at: &DVector<f64>) -> DVector<f64> {
    let mut step = DVector::zeros(at.len());
    let mut free: Vec<usize> = (0..at.len()).collect();
    loop {
        let rest = (right - normal * &step).select_rows(&free);
        let matrix = normal.select_rows(&free).select_columns(&free);
        let Some(factor) = matrix.cholesky() else {
            return step;
        };
        let solved = factor.solve(&rest);
        let outside: Vec<usize> = (free.iter().zip(solved.iter()))
            .filter(|(place, by)| (at[**place] + **by).abs() > MAX_DEVIATION_SD)
            .map(|(place, by)| {
                step[*place] = MAX_DEVIATION_SD.copysign(at[*place] + by) - at[*place];
                *place
            })
            .collect();
        if outside.is_empty() {
            for (place, by) in free.iter().zip(solved.iter()) {
                step[*place] = *by;
            }
            return step;
        }
        free.retain(|place| !outside.contains(place));
    }
}

/// Returns a state plus a multiple of a direction.
pub fn move_along(state: &[f64], direction: &[f64], by: f64) -> Vec<f64> {
    let moved = state.iter().zip(direction);
    moved.map(|(value, part)| value + by * part).collect()
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::solve_bounded;

    #[test]
    fn step_ends_at_the_bound_and_the_rest_is_optimal() {
        let normal = DMatrix::from_row_slice(2, 2, &[2.0, 1.0, 1.0, 2.0]);
        let at = DVector::from_vec(vec![1.0, 0.0]);
        let free = solve_bounded(&normal, &DVector::from_vec(vec![1.0, 2.0]), &at);
        assert!((free - DVector::from_vec(vec![0.0, 1.0])).norm() < 1e-12);
        // The free solution is 5. With the bound 3 the step is 2, and 2 x + 2 = 1 remains.
        let held = solve_bounded(&normal, &DVector::from_vec(vec![7.75, 1.0]), &at);
        assert!((held - DVector::from_vec(vec![2.0, -0.5])).norm() < 1e-12);
    }
}
