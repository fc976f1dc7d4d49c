//! Reference motion: motion of the records, estimated by a smoother with unknown accelerations, and
//! the model linearised along it. The motion follows the records even if the model lacks an effect.

use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_records::record::Record;
use nalgebra::{DMatrix, DVector};

use crate::fit::fit_result::Fit;
use crate::fit::shooting::{SensorValues, Shooting};
use crate::free_function::smoother::{LocalModel, LocalOutputs, SmoothedRecord, Widths, smooth};
use crate::free_function::transition::Transition;
use crate::model::allowed_directions::find_allowed_directions;
use crate::model::estimation_model::EstimationModel;
use crate::model::measured_outputs::OutputBuffers;
use crate::model::problem::EstimationProblem;
use crate::model::simulation::Simulation;
use crate::thresholds;

/// Reference motion of all records with the linearised model.
pub(crate) struct ReferenceMotion {
    /// Training records, then test records.
    pub records: Vec<ReferenceRecord>,
    /// Number of training records.
    pub training: usize,
    /// Values of the unknowns at which the model is linearised, SI: the declared values.
    pub theta: Vec<f64>,
    /// Values of the model parameters for `theta`.
    pub values: Vec<f64>,
}

/// Reference motion of a record.
pub(crate) struct ReferenceRecord {
    /// Times of the samples, s.
    pub times: Vec<f64>,
    /// Inputs at both ends of the interval after each sample. A held input has its value at the
    /// sample.
    pub inputs: Vec<[Vec<f64>; 2]>,
    /// States at the samples, SI.
    pub states: Vec<Vec<f64>>,
    /// Steps from each sample to the next.
    pub steps: Vec<ReferenceStep>,
    /// Sensor outputs of the states minus measurements, in standard deviations, a row per sample;
    /// NaN if missing.
    pub differences: Vec<DVector<f64>>,
    /// Derivatives of the sensor outputs with respect to the state, in standard deviations.
    pub by_state: Vec<DMatrix<f64>>,
    /// Independent directions of the state at each sample, one per column, SI; empty without
    /// constraints.
    directions: Vec<DMatrix<f64>>,
}

/// Linearised step from one sample to the next. With constraints, the initial state and the drives
/// are projected onto them.
pub(crate) struct ReferenceStep {
    /// Derivatives of the final state with respect to the initial state.
    pub transition: DMatrix<f64>,
    /// Derivatives of the final state with respect to constant changes of the accelerations and of
    /// the rates of first-order states.
    pub drive: DMatrix<f64>,
    /// Final state of the model minus the reference motion.
    pub defect: DVector<f64>,
}

/// Fitted model with the scales of its states.
struct ScaledModel<'a> {
    model: &'a EstimationModel,
    simulation: Simulation<'a>,
    evaluator: Evaluator,
    buffers: OutputBuffers,
    sensors: SensorValues,
    noise: &'a [f64],
    /// Scale of each state.
    ranges: Vec<f64>,
    /// Scale of each acceleration.
    accelerations: Vec<f64>,
}

/// Part of a record that is used.
struct UsedRecord<'a> {
    record: &'a Record,
    times: &'a [f64],
    /// Measurements at the sample times, one row per sample.
    measured: Vec<DVector<f64>>,
}

impl ReferenceMotion {
    /// Smooths the records and linearises the model of a fit at its declared values; `None` if a
    /// channel measures accelerations, if the motion is given, or if the records cannot be followed.
    pub fn follow_records(problem: &EstimationProblem<'_>, fit: &Fit) -> Option<Self> {
        if problem.dataset.gives_motion() || fit.model.measured.has_rates() {
            return None;
        }
        let theta = fit.restart_values();
        let shooting = fit.training_shooting(problem);
        let values = shooting.parameter_values(&theta);
        let mut scaled = ScaledModel::new(&shooting, fit, &theta)?;
        let lists = [
            (&problem.dataset.train, thresholds::MAX_REFERENCE_SAMPLES),
            (&problem.dataset.test, thresholds::MAX_REFERENCE_SAMPLES / 2),
        ];
        let mut records = Vec::new();
        for (list, most) in lists {
            for record in list {
                problem.stop.check_not_stopped().ok()?;
                let used = UsedRecord::new(record, most / list.len().max(1), &scaled.sensors);
                let first = problem.estimate_first_state(scaled.model, record);
                records.push(scaled.follow_record(&used, &first)?);
            }
        }
        Some(Self {
            records,
            training: problem.dataset.train.len(),
            theta,
            values,
        })
    }
}

impl ReferenceRecord {
    /// Returns independent directions of the state at a sample, one per column. Without constraints
    /// these are all states.
    pub fn initial_directions(&self, sample: usize) -> DMatrix<f64> {
        let count = self.states[sample].len();
        let own = self.directions.get(sample).cloned();
        own.unwrap_or_else(|| DMatrix::identity(count, count))
    }

    /// Returns time, state and inputs at the beginning of a step, or at its end with the same held
    /// inputs.
    pub fn end_point(&self, step: usize, is_end: bool) -> Point<'_> {
        let sample = step + usize::from(is_end);
        Point {
            t: self.times[sample],
            state: &self.states[sample],
            inputs: &self.inputs[step][usize::from(is_end)],
        }
    }
}

impl<'a> UsedRecord<'a> {
    fn new(record: &'a Record, most: usize, sensors: &SensorValues) -> Self {
        let times = &record.times[..record.times.len().min(most.max(2))];
        let measured = (0..times.len()).map(|sample| {
            let channels = record.channels.iter().zip(&sensors.delay);
            let values = channels.map(|(column, delay)| {
                interpolate(&record.times, column, times[sample] + delay, sample)
            });
            DVector::from_iterator(record.channels.len(), values)
        });
        Self {
            record,
            times,
            measured: measured.collect(),
        }
    }
}

/// Returns the value of a column at a time near a sample, by linear interpolation.
fn interpolate(times: &[f64], column: &[f64], at: f64, near: usize) -> f64 {
    if at == times[near] {
        return column[near];
    }
    let next = times.partition_point(|t| *t <= at);
    if next == 0 || next == times.len() {
        return f64::NAN;
    }
    let part = (at - times[next - 1]) / (times[next] - times[next - 1]);
    (1.0 - part) * column[next - 1] + part * column[next]
}

impl<'a> ScaledModel<'a> {
    fn new(shooting: &Shooting<'a>, fit: &Fit, theta: &[f64]) -> Option<Self> {
        let values = shooting.parameter_values(theta);
        let model = shooting.model;
        let mut evaluator = model.create_evaluator(&values);
        let first = model.degrees_of_freedom();
        let mut squares = vec![0.0; model.state_count() - first];
        let mut rates = vec![0.0; model.state_count()];
        let windows = shooting.windows.windows.iter();
        for (window, state) in windows.zip(&fit.train.estimate.initial_states) {
            let t = window.times[0];
            let inputs = &shooting.windows.inputs(window).evaluate(t);
            evaluator.rates(Point { t, state, inputs }, &mut rates);
            let pairs = squares.iter_mut().zip(&rates[first..]);
            pairs.for_each(|(sum, rate)| *sum += rate * rate);
        }
        let count = fit.train.estimate.initial_states.len().max(1) as f64;
        let ranges: Vec<f64> = (fit.ranges.iter())
            .map(|range| range.max(f64::MIN_POSITIVE))
            .collect();
        let step = shooting.windows.windows.first().map_or(1.0, |window| {
            (window.times[window.times.len() - 1] - window.times[0]) / window.times.len() as f64
        });
        let accelerations = squares.iter().zip(&ranges[first..]).map(|(sum, range)| {
            // Lower limit for a record at rest.
            let least = thresholds::MIN_ACCELERATION_IN_RANGES * range / step;
            (sum / count).sqrt().max(least)
        });
        Some(Self {
            model,
            simulation: model.create_simulation(&values).ok()?,
            evaluator,
            buffers: model.measured.create_buffers(),
            sensors: shooting.sensor_values(theta),
            noise: shooting.noise,
            accelerations: accelerations.collect(),
            ranges,
        })
    }

    /// Smooths a record twice: linearised along the filter estimates, then along the first smoothed
    /// motion.
    fn follow_record(&mut self, used: &UsedRecord<'_>, first: &[f64]) -> Option<ReferenceRecord> {
        let first = DVector::from_iterator(
            first.len(),
            first.iter().zip(&self.ranges).map(|(x, range)| x / range),
        );
        let mut best: Option<(Widths, SmoothedRecord)> = None;
        for acceleration_step in thresholds::ACCELERATION_STEPS {
            let widths = Widths {
                first_state: 1.0,
                acceleration_step,
            };
            let Some(smoothed) = self.smooth_record(used, &first, widths, None) else {
                continue;
            };
            let is_better = |(_, best): &(Widths, SmoothedRecord)| {
                smoothed.log_likelihood > best.log_likelihood
            };
            if best.as_ref().is_none_or(is_better) {
                best = Some((widths, smoothed));
            }
        }
        let (widths, SmoothedRecord { states: along, .. }) = best?;
        let along = self.project_all(used, along)?;
        let states = match self.smooth_record(used, &first, widths, Some(&along)) {
            Some(smoothed) => self.project_all(used, smoothed.states)?,
            None => along,
        };
        self.linearise_along(used, &states)
    }

    /// Projects the scaled states at the samples onto the constraints.
    fn project_all(
        &self,
        used: &UsedRecord<'_>,
        states: Vec<DVector<f64>>,
    ) -> Option<Vec<DVector<f64>>> {
        if !self.simulation.has_constraints() {
            return Some(states);
        }
        let projected = states.iter().enumerate().map(|(sample, state)| {
            let moved = self.project(used, sample, state)?;
            let pairs = moved.iter().zip(&self.ranges);
            Some(DVector::from_iterator(
                moved.len(),
                pairs.map(|(x, range)| x / range),
            ))
        });
        projected.collect()
    }

    /// Returns the state, SI, on the constraints that is nearest to a scaled state at a sample.
    fn project(
        &self,
        used: &UsedRecord<'_>,
        sample: usize,
        state: &DVector<f64>,
    ) -> Option<Vec<f64>> {
        let (t, inputs) = (used.times[sample], &used.record.inputs);
        let state = &self.unscale(state);
        self.simulation.move_onto_constraints(state, t, inputs).ok()
    }

    /// Returns the derivatives of the projection onto the constraints at a scaled state of a
    /// sample.
    fn differentiate_projection(
        &self,
        used: &UsedRecord<'_>,
        sample: usize,
        state: &[f64],
    ) -> Option<DMatrix<f64>> {
        let at = (used.times[sample], &used.record.inputs);
        self.simulation
            .differentiate_projection(state, at, &self.ranges)
    }

    /// Smooths a record once. `along`: scaled states at which the model is linearised; if absent,
    /// the filter estimates.
    fn smooth_record(
        &mut self,
        used: &UsedRecord<'_>,
        first: &DVector<f64>,
        widths: Widths,
        along: Option<&[DVector<f64>]>,
    ) -> Option<SmoothedRecord> {
        let this = std::cell::RefCell::new(self);
        let accelerations = this.borrow().accelerations.len();
        smooth(
            used.times.len(),
            first,
            accelerations,
            widths,
            &mut |sample, estimate| {
                let state = along.map_or(estimate, |along| &along[sample]);
                this.borrow_mut().linearise_outputs(used, sample, state)
            },
            &mut |sample, estimate| {
                let (state, end) = match along {
                    Some(along) => (&along[sample], Some(&along[sample + 1])),
                    None => (estimate, None),
                };
                this.borrow_mut().linearise_step(used, sample, state, end)
            },
        )
    }

    fn unscale(&self, state: &DVector<f64>) -> Vec<f64> {
        let pairs = state.iter().zip(&self.ranges);
        pairs.map(|(x, range)| x * range).collect()
    }

    /// Linearises the step that starts at a sample. `end`: scaled state at its end, if known.
    fn linearise_step(
        &mut self,
        used: &UsedRecord<'_>,
        sample: usize,
        state: &DVector<f64>,
        end: Option<&DVector<f64>>,
    ) -> Option<LocalModel> {
        let start = self.project(used, sample, state)?;
        let projection = self.differentiate_projection(used, sample, &start)?;
        let times = &used.times[sample..sample + 2];
        let length = times[1] - times[0];
        let ends = self
            .simulation
            .simulate_states(&start, times, &used.record.inputs)
            .ok()?;
        let reached = ends.into_iter().next_back()?;
        let middle = match end {
            Some(end) => self.unscale(&((state + end) / 2.0)),
            None => start,
        };
        let middle_time = times[0] + 0.5 * length;
        let inputs = &used.record.inputs.evaluate(middle_time);
        let point = Point {
            t: middle_time,
            state: &middle,
            inputs,
        };
        let jacobian = self.differentiate_rates(point);
        let transition = Transition::from_step_matrix(&(jacobian * length))?;
        let first = self.model.degrees_of_freedom();
        let count = self.accelerations.len();
        let mut drive = transition.integral.columns(first, count)
            * projection.view((first, first), (count, count))
            * length;
        for (column, acceleration) in self.accelerations.iter().enumerate() {
            let factor = acceleration / self.ranges[first + column];
            drive
                .column_mut(column)
                .iter_mut()
                .for_each(|x| *x *= factor);
        }
        let reached = reached.iter().zip(&self.ranges).map(|(x, range)| x / range);
        Some(LocalModel {
            state: state.clone(),
            end: DVector::from_iterator(state.len(), reached),
            transition: transition.exponential * projection,
            drive,
        })
    }

    /// Returns the derivatives of the scaled rates with respect to the scaled state.
    fn differentiate_rates(&mut self, point: Point<'_>) -> DMatrix<f64> {
        let count = point.state.len();
        let mut rates = vec![0.0; count];
        self.evaluator.rates(point, &mut rates);
        let mut moved_rates = vec![0.0; count];
        let mut state = point.state.to_vec();
        let mut jacobian = DMatrix::zeros(count, count);
        for column in 0..count {
            let step = thresholds::REFERENCE_QUOTIENT_IN_RANGES * self.ranges[column];
            state[column] = point.state[column] + step;
            let moved = Point {
                state: &state,
                ..point
            };
            self.evaluator.rates(moved, &mut moved_rates);
            state[column] = point.state[column];
            for row in 0..count {
                let slope =
                    (moved_rates[row] - rates[row]) / thresholds::REFERENCE_QUOTIENT_IN_RANGES;
                jacobian[(row, column)] = slope / self.ranges[row];
            }
        }
        jacobian
    }

    /// Returns the sensor outputs of a state, in standard deviations.
    fn compute_outputs(&mut self, point: Point<'_>) -> DVector<f64> {
        let mut values = Vec::with_capacity(self.noise.len());
        let (evaluator, buffers) = (&mut self.evaluator, &mut self.buffers);
        self.model
            .measured
            .append(evaluator, point, buffers, &mut values);
        DVector::from_fn(values.len(), |channel, _| {
            (self.sensors.gain[channel] * values[channel] + self.sensors.bias[channel])
                / self.noise[channel]
        })
    }

    fn linearise_outputs(
        &mut self,
        used: &UsedRecord<'_>,
        sample: usize,
        state: &DVector<f64>,
    ) -> Option<LocalOutputs> {
        let t = used.times[sample];
        let inputs = &used.record.inputs.evaluate(t);
        let own = self.project(used, sample, state)?;
        let projection = self.differentiate_projection(used, sample, &own)?;
        let expected = self.compute_outputs(Point {
            t,
            state: &own,
            inputs,
        });
        let mut by_state = DMatrix::zeros(expected.len(), own.len());
        let mut moved = own.clone();
        for column in 0..own.len() {
            moved[column] += thresholds::REFERENCE_QUOTIENT_IN_RANGES * self.ranges[column];
            let point = Point {
                t,
                state: &moved,
                inputs,
            };
            let slope = (self.compute_outputs(point) - &expected)
                / thresholds::REFERENCE_QUOTIENT_IN_RANGES;
            by_state.set_column(column, &slope);
            moved[column] = own[column];
        }
        let measured = &used.measured[sample];
        let difference = DVector::from_fn(expected.len(), |channel, _| {
            measured[channel] / self.noise[channel] - expected[channel]
        });
        (expected.iter().chain(by_state.iter()))
            .all(|x| x.is_finite())
            .then(|| LocalOutputs {
                state: state.clone(),
                difference,
                by_state: by_state * projection,
            })
    }

    /// Linearises the model along the smoothed states, in SI.
    fn linearise_along(
        &mut self,
        used: &UsedRecord<'_>,
        states: &[DVector<f64>],
    ) -> Option<ReferenceRecord> {
        let ranges = self.ranges.clone();
        let mut steps = Vec::with_capacity(states.len().saturating_sub(1));
        for sample in 0..states.len() - 1 {
            let local =
                self.linearise_step(used, sample, &states[sample], Some(&states[sample + 1]))?;
            let unit = |row: usize, column: usize| ranges[row] / ranges[column];
            let count = ranges.len();
            steps.push(ReferenceStep {
                transition: DMatrix::from_fn(count, count, |r, c| {
                    local.transition[(r, c)] * unit(r, c)
                }),
                drive: DMatrix::from_fn(count, self.accelerations.len(), |r, c| {
                    local.drive[(r, c)] * ranges[r] / self.accelerations[c]
                }),
                defect: DVector::from_fn(count, |r, _| {
                    (local.end[r] - states[sample + 1][r]) * ranges[r]
                }),
            });
        }
        let (mut differences, mut by_state) = (Vec::new(), Vec::new());
        let mut directions = Vec::new();
        for (sample, state) in states.iter().enumerate() {
            let local = self.linearise_outputs(used, sample, state)?;
            differences.push(-local.difference);
            by_state.push(DMatrix::from_fn(
                local.by_state.nrows(),
                ranges.len(),
                |r, c| local.by_state[(r, c)] / ranges[c],
            ));
            if self.simulation.has_constraints() {
                let own = self.unscale(state);
                let projection = self.differentiate_projection(used, sample, &own)?;
                directions.push(find_allowed_directions(&projection, &ranges)?);
            }
        }
        let inputs = (0..used.times.len()).map(|sample| {
            let next = used.times.get(sample + 1).unwrap_or(&used.times[sample]);
            // The time of the held sample is half a step later, so that rounding cannot select the
            // previous sample.
            let middle = 0.5 * (used.times[sample] + next);
            let inputs = &used.record.inputs;
            let held = inputs.last_sample(middle);
            [used.times[sample], *next].map(|t| inputs.evaluate_with_held(t, held).into_owned())
        });
        Some(ReferenceRecord {
            times: used.times.to_vec(),
            inputs: inputs.collect(),
            states: states.iter().map(|state| self.unscale(state)).collect(),
            steps,
            differences,
            by_state,
            directions,
        })
    }
}
