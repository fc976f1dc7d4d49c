//! Responses to small forces as difference quotients of Runge-Kutta simulations. They are used if
//! tangent vectors are not available.

use crate::ids::WindowId;
use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_compiled_model::Projection;
use nalgebra::DMatrix;

use crate::fit::shooting::{SensorValues, Shooting};
use crate::model::longest_step::LongestStep;
use crate::model::measured_outputs::OutputBuffers;
use crate::model::simulation::TangentDrives;
use crate::thresholds;
use eomgen_sim::ode::runge_kutta::RungeKutta;

/// Time of each Runge-Kutta stage in the step: 0 beginning, 1 middle, 2 end.
const STAGE_POINTS: [usize; 4] = [0, 1, 1, 2];

/// Window of a model that is simulated with Runge-Kutta steps.
pub(crate) struct SteppedWindow<'s> {
    shooting: &'s Shooting<'s>,
    sensors: SensorValues,
    evaluator: Evaluator,
    constraints: Option<Projection>,
    buffers: OutputBuffers,
    window: WindowId,
    longest_step: LongestStep,
}

/// Step of the simulation. `middle`: the time that selects the held inputs. `points`: times and
/// states at the beginning, the middle and the end.
struct Step {
    middle: f64,
    points: [(f64, Vec<f64>); 3],
}

/// Motion without a force.
#[derive(Default)]
struct UnforcedMotion {
    steps: Vec<Step>,
    /// State at each output time.
    states: Vec<Vec<f64>>,
    /// Channel values, one row per output time.
    measured: Vec<f64>,
}

/// Force along the unforced motion: changes of the accelerations and of the rates of first-order
/// states, per unit of the force.
#[derive(Clone, Default)]
struct Force {
    /// Changes at the three points of each step.
    in_steps: Vec<f64>,
    /// Changes at each output time, if accelerations are measured.
    at_times: Vec<f64>,
}

impl<'s> SteppedWindow<'s> {
    /// Creates the window for given unknowns; `None` if the model needs a solver with error
    /// control.
    pub fn new(shooting: &'s Shooting<'s>, theta: &[f64], window: WindowId) -> Option<Self> {
        let model = shooting.model;
        let values = shooting.parameter_values(theta);
        Some(Self {
            sensors: SensorValues {
                bias: vec![0.0; shooting.channel_count()],
                ..shooting.sensor_values(theta)
            },
            evaluator: model.create_evaluator(&values),
            constraints: model.create_projection(&values),
            buffers: model.measured.create_buffers(),
            longest_step: model.longest_step?,
            window,
            shooting,
        })
    }

    /// Returns the response of the outputs to each drive, in standard deviations per unit of the
    /// drive. The drives are evaluated along the unforced motion. `level`: RMS residual, in
    /// standard deviations.
    pub fn compute_responses(
        &mut self,
        start: &[f64],
        driven: TangentDrives<'_>,
        level: f64,
    ) -> Option<DMatrix<f64>> {
        let count = driven.count;
        let own = self.simulate_unforced(start)?;
        let squares = self.sum_squared_rates(&own);
        let forces = self.compute_forces(&own, driven);
        let window = &self.shooting.windows.windows[self.window];
        let samples = self.shooting.output_times(window).samples();
        let mut matrix = DMatrix::zeros(samples * self.shooting.channel_count(), count);
        let wanted = thresholds::FORCE_OUTPUT_CHANGE * level;
        let mut part = thresholds::FIRST_FORCE_ACCELERATION_CHANGE;
        for (column, force) in forces.iter().enumerate() {
            let Some(usual) = compute_usual_size(force, &squares) else {
                continue;
            };
            for _ in 0..thresholds::MAX_SIZE_ATTEMPTS {
                let Some(seen) =
                    self.compute_output_change(start, (&own.measured, force), part * usual)
                else {
                    part /= thresholds::FORCE_REDUCTION_FACTOR;
                    continue;
                };
                matrix.column_mut(column).copy_from_slice(&seen);
                let per_unit = (seen.iter().map(|c| c * c).sum::<f64>() / seen.len() as f64).sqrt();
                // The output change of the first size gives the next size.
                let better = wanted / (per_unit * usual);
                let is_near = (1.0 / thresholds::FORCE_CHANGE_FACTOR
                    ..thresholds::FORCE_CHANGE_FACTOR)
                    .contains(&(better / part));
                if !better.is_finite() || is_near {
                    break;
                }
                part = better;
            }
        }
        let is_finite = matrix.iter().all(|entry| entry.is_finite());
        is_finite.then_some(matrix)
    }

    /// Returns the sum of squares of each acceleration and of the rate of each first-order state.
    fn sum_squared_rates(&mut self, own: &UnforcedMotion) -> Vec<f64> {
        let first = self.evaluator.program().degrees_of_freedom();
        let windows = self.shooting.windows;
        let inputs = windows.inputs(&windows.windows[self.window]);
        let mut rates = vec![0.0; self.evaluator.program().states()];
        let mut squares = vec![0.0; rates.len() - first];
        for step in &own.steps {
            for (t, state) in &step.points {
                let (t, held) = (*t, inputs.last_sample(step.middle));
                let inputs = &inputs.evaluate_with_held(t, held);
                self.evaluator.rates(Point { t, state, inputs }, &mut rates);
                for (square, rate) in squares.iter_mut().zip(&rates[first..]) {
                    *square += rate * rate;
                }
            }
        }
        squares
    }

    /// Returns each drive along the unforced motion.
    fn compute_forces(&self, own: &UnforcedMotion, driven: TangentDrives<'_>) -> Vec<Force> {
        let program = self.evaluator.program();
        let forced = program.states() - program.degrees_of_freedom();
        let windows = self.shooting.windows;
        let window = &windows.windows[self.window];
        let inputs = windows.inputs(window);
        let mut found = vec![Force::default(); driven.count];
        let mut all = vec![0.0; driven.count * forced];
        for step in &own.steps {
            for (t, state) in &step.points {
                let held = inputs.last_sample(step.middle);
                let inputs = &inputs.evaluate_with_held(*t, held);
                driven.drives.write_differences(*t, state, inputs, &mut all);
                for (force, now) in found.iter_mut().zip(all.chunks_exact(forced)) {
                    force.in_steps.extend_from_slice(now);
                }
            }
        }
        if !self.shooting.model.measured.has_rates() {
            return found;
        }
        let times = self.shooting.output_times(window).times;
        for (t, state) in times.iter().zip(&own.states) {
            driven
                .drives
                .write_differences(*t, state, &inputs.evaluate(*t), &mut all);
            for (force, now) in found.iter_mut().zip(all.chunks_exact(forced)) {
                force.at_times.extend_from_slice(now);
            }
        }
        found
    }

    /// Returns the change of the outputs due to a force of size `size`, in standard deviations per
    /// unit.
    fn compute_output_change(
        &mut self,
        start: &[f64],
        (own, force): (&[f64], &Force),
        size: f64,
    ) -> Option<Vec<f64>> {
        let moved = self.simulate(start, Some((size, force)), None)?;
        let changes: Vec<f64> = (moved.iter().zip(own))
            .map(|(a, b)| (a - b) / size)
            .collect();
        let window = &self.shooting.windows.windows[self.window];
        let times = self.shooting.output_times(window);
        let seen = self.shooting.apply_sensors(&times, &self.sensors, &changes);
        Some(self.shooting.map_differences(window, &seen, |seen, _| seen))
    }

    /// Simulates the motion without a force.
    fn simulate_unforced(&mut self, start: &[f64]) -> Option<UnforcedMotion> {
        let mut visited = UnforcedMotion::default();
        visited.measured = self.simulate(start, None, Some(&mut visited))?;
        Some(visited)
    }

    /// Returns the channel values of a motion with or without a force. The steps and states are
    /// stored in `visited`.
    fn simulate(
        &mut self,
        start: &[f64],
        force: Option<(f64, &Force)>,
        mut visited: Option<&mut UnforcedMotion>,
    ) -> Option<Vec<f64>> {
        let degrees = self.evaluator.program().degrees_of_freedom();
        let forced = start.len() - degrees;
        let windows = self.shooting.windows;
        let window = &windows.windows[self.window];
        let inputs = windows.inputs(window);
        let times = self.shooting.output_times(window).times;
        let mut state = start.to_vec();
        let mut method = RungeKutta::new(start.len());
        let mut measured = Vec::with_capacity(times.len() * self.shooting.channel_count());
        let mut number = 0;
        for (index, t) in times.iter().enumerate() {
            let before = index.checked_sub(1).map_or(*t, |before| times[before]);
            let steps = match index {
                0 => 0,
                _ => self.longest_step.count_steps(t - before),
            };
            let h = (t - before) / steps as f64;
            for step in 0..steps {
                let begin = before + step as f64 * h;
                let middle = begin + 0.5 * h;
                let held = inputs.last_sample(middle);
                let mut points = [const { (0.0, Vec::new()) }; 3];
                method.step(&mut state, (begin, h), |stage, t, state, rates| {
                    let point = STAGE_POINTS[stage];
                    let inputs = &inputs.evaluate_with_held(t, held);
                    self.evaluator.rates(Point { t, state, inputs }, rates);
                    if let Some((size, force)) = force {
                        let first = (3 * number + point) * forced;
                        let added = rates[degrees..].iter_mut().zip(&force.in_steps[first..]);
                        added.for_each(|(rate, change)| *rate += size * change);
                    }
                    if visited.is_some() {
                        points[point] = (t, state.to_vec());
                    }
                });
                number += 1;
                if let Some(visited) = &mut visited {
                    visited.steps.push(Step { middle, points });
                }
            }
            let given = &inputs.evaluate(*t);
            if let Some(constraints) = &self.constraints {
                constraints.move_onto_constraints(&mut self.evaluator, (*t, given), &mut state)?;
            }
            let at = Point {
                t: *t,
                state: &state,
                inputs: given,
            };
            let added = force.map(|(size, force)| (size, force.derivatives_at(index, forced)));
            self.append_outputs(at, added, &mut measured);
            if let Some(visited) = &mut visited {
                visited.states.push(state.clone());
            }
        }
        let is_finite = measured.iter().all(|value| value.is_finite());
        is_finite.then_some(measured)
    }

    /// Appends the channel values at a point. The force, multiplied by its size, also changes
    /// measured accelerations directly.
    fn append_outputs(
        &mut self,
        point: Point<'_>,
        force: Option<(f64, &[f64])>,
        values: &mut Vec<f64>,
    ) {
        let measured = &self.shooting.model.measured;
        let first = values.len();
        measured.append(&mut self.evaluator, point, &mut self.buffers, values);
        let Some((size, force)) = force.filter(|(_, force)| !force.is_empty()) else {
            return;
        };
        let changes: Vec<f64> = force.iter().map(|change| size * change).collect();
        let changes = (&changes[..], self.longest_step.0);
        measured.add_to_accelerations(&mut self.evaluator, point, changes, &mut values[first..]);
    }
}

impl Force {
    /// Returns the changes at an output time; empty if no accelerations are measured.
    fn derivatives_at(&self, index: usize, forced: usize) -> &[f64] {
        let own = index * forced..(index + 1) * forced;
        self.at_times.get(own).unwrap_or_default()
    }
}

/// Returns the size at which the RMS change of one acceleration or rate of a first-order state
/// equals the RMS of this quantity, and no other relative change is larger. `None` if the force
/// changes no quantity that is nonzero.
fn compute_usual_size(force: &Force, squares: &[f64]) -> Option<f64> {
    let mut sums = vec![0.0; squares.len()];
    for now in force.in_steps.chunks_exact(squares.len()) {
        for (sum, change) in sums.iter_mut().zip(now) {
            *sum += change * change;
        }
    }
    let moving = sums
        .iter()
        .zip(squares)
        .filter(|(_, square)| **square > 0.0);
    let part = moving.map(|(sum, square)| sum / square).fold(0.0, f64::max);
    (part > 0.0).then(|| 1.0 / part.sqrt())
}
