//! Motions with small forces beside the one without, by Runge-Kutta steps, where no integrator
//! carries neighbouring motions. Which forces is decided elsewhere.

use crate::ids::WindowId;
use eomgen_codegen::program::evaluator::{Evaluator, Point};
use nalgebra::DMatrix;

use crate::fit::shooting::{Sensors, Shooting};
use crate::model::longest_step::LongestStep;
use crate::model::measured_outputs::Buffers;
use crate::model::simulation::NeighbourDrives;
use crate::thresholds;
use eomgen_sim::ode::runge_kutta::RungeKutta;

/// Whether each of a step's four slopes is at its beginning, its middle or its end.
const POINTS: [usize; 4] = [0, 1, 1, 2];

/// A window of a model that is run by Runge-Kutta steps.
pub(crate) struct SteppedWindow<'s> {
    shooting: &'s Shooting<'s>,
    sensors: Sensors,
    evaluator: Evaluator,
    buffers: Buffers,
    window: WindowId,
    longest_step: LongestStep,
}

/// A step: the time in its middle, which decides what its inputs are, and the times and states
/// where it begins, is half way and ends.
struct Step {
    middle: f64,
    points: [(f64, Vec<f64>); 3],
}

impl<'s> SteppedWindow<'s> {
    /// A window at these unknowns; none if a solver decides on its steps, or accelerations are measured, to
    /// which a force adds at once.
    pub fn new(shooting: &'s Shooting<'s>, theta: &[f64], window: WindowId) -> Option<Self> {
        let model = shooting.model;
        if model.measured.has_rates() {
            return None;
        }
        Some(Self {
            sensors: Sensors {
                bias: vec![0.0; shooting.channels()],
                ..shooting.sensors(theta)
            },
            evaluator: model.evaluator(&shooting.values(theta)),
            buffers: model.measured.buffers(),
            longest_step: model.longest_step?,
            window,
            shooting,
        })
    }

    /// What each of some drives does to the outputs, in standard deviations per unit of the drive.
    /// The drives are those along the motion without them. `level`: the size of the residuals, in
    /// standard deviations.
    pub fn columns(
        &mut self,
        start: &[f64],
        driven: NeighbourDrives<'_>,
        level: f64,
    ) -> Option<DMatrix<f64>> {
        let first = self.evaluator.program().degrees_of_freedom();
        let (forced, count, drives) = (start.len() - first, driven.count, driven.drives);
        let mut steps = Vec::new();
        let own = self.motion(start, None, Some(&mut steps))?;
        let windows = self.shooting.windows;
        let inputs = windows.inputs(&windows.list[self.window]);
        let mut accelerations = vec![Vec::with_capacity(3 * steps.len() * forced); count];
        let mut all = vec![0.0; count * forced];
        let (mut rates, mut square) = (vec![0.0; start.len()], 0.0);
        for step in &steps {
            for (t, state) in &step.points {
                let inputs = inputs.held_at(step.middle);
                drives.at(*t, state, inputs, &mut all);
                for (force, now) in accelerations.iter_mut().zip(all.chunks_exact(forced)) {
                    force.extend_from_slice(now);
                }
                let t = *t;
                self.evaluator.rates(Point { t, state, inputs }, &mut rates);
                square += rates[first..].iter().map(|a| a * a).sum::<f64>();
            }
        }
        let samples = (self.shooting.output_times(&windows.list[self.window])).samples();
        let mut matrix = DMatrix::zeros(samples * self.shooting.channels(), count);
        let mut part = thresholds::FIRST_FORCE;
        for (column, force) in accelerations.iter().enumerate() {
            let size: f64 = force.iter().map(|a| a * a).sum();
            if size == 0.0 {
                continue;
            }
            let usual = (square / size).sqrt();
            let seen = self.change(start, (&own, force), part * usual)?;
            let moved = (seen.iter().map(|c| c * c).sum::<f64>() / seen.len() as f64).sqrt();
            // What the first moves tells how large the others may be.
            let wanted = thresholds::FORCE_MOVES * level / (moved * usual);
            if wanted.is_finite()
                && (wanted > thresholds::FORCE_NEAR * part
                    || part > thresholds::FORCE_NEAR * wanted)
            {
                part = wanted;
                let seen = self.change(start, (&own, force), part * usual)?;
                matrix.column_mut(column).copy_from_slice(&seen);
                continue;
            }
            matrix.column_mut(column).copy_from_slice(&seen);
        }
        let is_finite = matrix.iter().all(|entry| entry.is_finite());
        is_finite.then_some(matrix)
    }

    /// How far a force of this size moves the outputs, in standard deviations per unit.
    fn change(
        &mut self,
        start: &[f64],
        (own, force): (&[f64], &[f64]),
        size: f64,
    ) -> Option<Vec<f64>> {
        let moved = self.motion(start, Some((size, force)), None)?;
        let changes: Vec<f64> = (moved.iter().zip(own))
            .map(|(a, b)| (a - b) / size)
            .collect();
        let window = &self.shooting.windows.list[self.window];
        let times = self.shooting.output_times(window);
        let seen = self.shooting.seen(&times, &self.sensors, &changes);
        Some(self.shooting.differences(window, &seen, |seen, _| seen))
    }

    /// The quantities along a motion, with a force if there is one, and its steps where they are wanted.
    fn motion(
        &mut self,
        start: &[f64],
        force: Option<(f64, &[f64])>,
        mut visited: Option<&mut Vec<Step>>,
    ) -> Option<Vec<f64>> {
        let degrees = self.evaluator.program().degrees_of_freedom();
        let forced = start.len() - degrees;
        let windows = self.shooting.windows;
        let window = &windows.list[self.window];
        let inputs = windows.inputs(window);
        let times = self.shooting.output_times(window).times;
        let mut state = start.to_vec();
        let mut method = RungeKutta::new(start.len());
        let mut measured = Vec::with_capacity(times.len() * self.shooting.channels());
        self.measure(
            (*times.first()?, &state),
            inputs.held_at(times[0]),
            &mut measured,
        );
        let mut number = 0;
        for pair in times.windows(2) {
            let steps = self.longest_step.steps(pair[1] - pair[0]);
            let h = (pair[1] - pair[0]) / steps as f64;
            for step in 0..steps {
                let begin = pair[0] + step as f64 * h;
                let middle = begin + 0.5 * h;
                let held = inputs.held_at(middle);
                let mut points = [const { (0.0, Vec::new()) }; 3];
                method.step(&mut state, (begin, h), |stage, t, state, rates| {
                    let point = POINTS[stage];
                    let at = Point {
                        t,
                        state,
                        inputs: held,
                    };
                    self.evaluator.rates(at, rates);
                    if let Some((size, force)) = force {
                        let first = (3 * number + point) * forced;
                        let force_responses = rates[degrees..].iter_mut().zip(&force[first..]);
                        force_responses.for_each(|(k, a)| *k += size * a);
                    }
                    if visited.is_some() {
                        points[point] = (t, state.to_vec());
                    }
                });
                number += 1;
                if let Some(visited) = &mut visited {
                    visited.push(Step { middle, points });
                }
            }
            self.measure((pair[1], &state), inputs.held_at(pair[1]), &mut measured);
        }
        let is_finite = measured.iter().all(|value| value.is_finite());
        is_finite.then_some(measured)
    }

    /// Appends the quantities at a state.
    fn measure(&mut self, (t, state): (f64, &[f64]), inputs: &[f64], values: &mut Vec<f64>) {
        let point = Point { t, state, inputs };
        let measured = &self.shooting.model.measured;
        measured.append(&mut self.evaluator, point, &mut self.buffers, values);
    }
}
