//! Check of a motion for overlapping bodies: distances of impacts that are negative beyond the solver's errors.

use eomgen_codegen::program::Op;
use eomgen_codegen::program::evaluator::{Enclosure, Evaluator, Point, Stretch};
use eomgen_sim::ode::{Trajectory, UNMOVED_SIZE_FRACTION};

use crate::audit::{TOLERANCE_ERROR_FACTOR, find_allowed_change};
use crate::error::Error;
use crate::instance::Instance;
use crate::motion::{Motion, Solver};

/// A sample at which bodies overlap.
#[derive(Clone, Debug, PartialEq)]
pub struct Overlap {
    /// Name of the impact.
    pub impact: String,
    /// Time, s.
    pub t: f64,
    /// Distance, SI; negative.
    pub distance: f64,
    /// Largest overlap that errors of the solver can cause, SI.
    pub tolerance: f64,
}

impl Overlap {
    /// Returns a warning with the impact, its distance and the time.
    pub fn warning_message(&self) -> String {
        let Self {
            impact,
            t,
            distance,
            tolerance,
        } = self;
        format!(
            "bodies overlap at the impact `{impact}`: its distance is {distance:.4e} (SI) at t = {t} s, more than \
             the solver's error of {tolerance:.1e} can explain; reduce the tolerance or the longest step"
        )
    }
}

impl Instance<'_> {
    /// Returns the first sample at which bodies overlap by more than the solver's errors at the given relative
    /// tolerance can cause. Fixed steps detect a contact up to one step late.
    ///
    /// # Errors
    /// See [`Instance::evaluator`].
    pub fn find_first_overlap(
        &self,
        motion: &Motion,
        tolerance: f64,
    ) -> Result<Option<Overlap>, Error> {
        let impacts = &self.model().model().impacts;
        if impacts.is_empty() {
            return Ok(None);
        }
        let mut evaluator = self.evaluator()?;
        let degrees = evaluator.program().degrees_of_freedom();
        let trajectory = &motion.trajectory;
        let step = (motion.solver == Solver::Fixed).then(|| compute_mean_step(trajectory));
        let typical = self.model().typical_sizes().iter();
        let mut sizes: Vec<f64> = typical.map(|size| UNMOVED_SIZE_FRACTION * size).collect();
        for (&t, state) in trajectory.times.iter().zip(&trajectory.states) {
            for (size, entry) in sizes.iter_mut().zip(state) {
                *size = size.max(entry.abs());
            }
            let inputs = &motion.inputs.evaluate(t);
            let distances = evaluate_distances(&mut evaluator, Point { t, state, inputs });
            for (place, distance) in distances.iter().enumerate() {
                if *distance >= 0.0 {
                    continue;
                }
                let of_impact = &mut |state: &[f64]| {
                    let point = Point { t, state, inputs };
                    self::evaluate_distances(&mut evaluator, point)[place]
                };
                let change = find_allowed_change(state, &sizes, tolerance, of_impact);
                let moved = step.map_or(0.0, |step| {
                    let moves = estimate_moves_in_step(&sizes, step, degrees);
                    find_allowed_change(state, &moves, 1.0, of_impact)
                });
                let point = Point { t, state, inputs };
                let rounding = find_largest_distance(&mut evaluator, point, place) - distance;
                let tolerance = TOLERANCE_ERROR_FACTOR * change + rounding + moved;
                if distance.is_nan() || *distance < -tolerance {
                    return Ok(Some(Overlap {
                        impact: impacts[place].name.clone(),
                        t,
                        distance: *distance,
                        tolerance,
                    }));
                }
            }
        }
        Ok(None)
    }

    pub(crate) fn find_input_driven_impact(&self) -> Option<&str> {
        let program = self.model().program();
        let is_driven = |op: &Op| matches!(op, Op::Input(_));
        let mut impacts = program.impacts.iter();
        let place = impacts.position(|impact| {
            let slip = impact.friction.as_ref().map(|friction| friction.slip);
            let values: Vec<_> = std::iter::once(impact.distance).chain(slip).collect();
            let values = program.reachable(&values);
            values
                .iter()
                .any(|value| is_driven(&program.value(*value).op))
        })?;
        let impact = self.model().model().impacts.get(place)?;
        Some(&impact.name)
    }
}

/// Returns the upper bound of the exact distance of an impact at a point.
fn find_largest_distance(evaluator: &mut Evaluator, point: Point<'_>, place: usize) -> f64 {
    // Enclosures of polynomials include rounding errors; enclosures of numbers do not.
    let still = |value: f64| Enclosure::polynomial(std::array::from_fn(|_| value), 0.0);
    let all = |values: &[f64]| -> Vec<Enclosure> { values.iter().copied().map(still).collect() };
    let stretch = Stretch {
        t: still(point.t),
        state: &all(point.state),
        inputs: &all(point.inputs),
    };
    let mut bounds = vec![Enclosure::UNKNOWN; evaluator.program().impacts.len()];
    evaluator.bound_distances(&stretch, &mut bounds);
    bounds[place].value().high
}

fn evaluate_distances(evaluator: &mut Evaluator, point: Point<'_>) -> Vec<f64> {
    let mut distances = vec![0.0; evaluator.program().impacts.len()];
    evaluator.distances(point, &mut distances);
    distances
}

/// Returns the mean length of the steps of a motion, s.
fn compute_mean_step(trajectory: &Trajectory) -> f64 {
    match (trajectory.times.first(), trajectory.times.last()) {
        (Some(first), Some(last)) if trajectory.statistics.steps > 0 => {
            (last - first) / trajectory.statistics.steps as f64
        }
        _ => 0.0,
    }
}

/// Returns the largest change of each state in a step, from the magnitudes of the states; coordinates move with their
/// rates.
fn estimate_moves_in_step(sizes: &[f64], step: f64, degrees: usize) -> Vec<f64> {
    let rates = sizes[degrees..2 * degrees].iter().map(|rate| step * rate);
    rates.chain(sizes[degrees..].iter().map(|_| 0.0)).collect()
}
