//! Derivatives of the outputs of windows with respect to initial states and unknowns. They are
//! computed with tangent vectors if the exponential integrator is used, otherwise by difference
//! quotients.

use crate::ids::WindowId;
use eomgen_codegen::program::evaluator::Evaluator;
use nalgebra::{DMatrix, DVector, DVectorView};

use crate::fit::acceleration_differences::{AccelerationDifferences, PerturbedEvaluator};
use crate::fit::jump_free_quotients::limit_quotient;
use crate::fit::shooting::{Residual, SensorValues, Shooting};
use crate::model::linear_outputs::LinearOutputs;
use crate::model::output_times::OutputTimes;
use crate::model::simulation::{OutputTangents, Outputs, Simulation, TangentDrives};
use crate::model::unknowns::{Unknown, UnknownKind};
use crate::thresholds;
use eomgen_records::windows::Window;
use eomgen_sim::exponential::MovedParameters;

/// Residuals of a window and their derivatives.
#[derive(Clone)]
pub struct WindowDerivatives {
    /// Simulated minus measured outputs, in standard deviations: one row per sample, one number per
    /// channel; 0 for missing measurements.
    pub residual: DVector<f64>,
    /// Derivatives with respect to the initial state, along `directions`.
    pub by_state: DMatrix<f64>,
    /// Independent directions of the initial state, one per column. With constraints, a basis of
    /// the changes that satisfy them, otherwise all states.
    pub directions: DMatrix<f64>,
    /// Derivatives with respect to the unknowns.
    pub by_unknown: DMatrix<f64>,
    /// State at the end of the window.
    pub end_state: Vec<f64>,
}

/// Evaluator of the model and of models with one changed parameter each.
pub struct SensitivityEvaluator<'a> {
    shooting: Shooting<'a>,
    base: Simulation<'a>,
    /// Equations of the unchanged model.
    equations: Evaluator,
    sensors: SensorValues,
    /// Changed model and step for each unknown that is a model parameter.
    perturbed_parameters: Vec<Option<PerturbedParameter<'a>>>,
    level: f64,
}

/// Model with one changed parameter, and the step of the parameter, SI.
struct PerturbedParameter<'a> {
    perturbed_model: PerturbedModel<'a>,
    step: f64,
    /// Model with the opposite step, if a channel jumps and the step is admissible.
    opposite: Option<Box<Simulation<'a>>>,
}

/// Use of a model with one changed parameter.
enum PerturbedModel<'a> {
    /// The model is simulated.
    Runs(Box<Simulation<'a>>),
    /// Its accelerations and outputs drive a tangent vector. Accelerations are not needed if the
    /// integrator computes derivatives with respect to the parameter.
    Drives {
        evaluator: Option<Box<Evaluator>>,
        linear_outputs: Option<LinearOutputs>,
    },
}

impl<'a> SensitivityEvaluator<'a> {
    /// Moves an initial state of a window to the nearest state within the ranges of the model and
    /// onto its constraints.
    pub fn find_admissible_state(&self, window: WindowId, state: Vec<f64>) -> Vec<f64> {
        let clamped = self.shooting.model.clamp_state(state);
        let samples = &self.shooting.windows.windows[window];
        let inputs = self.shooting.windows.inputs(samples);
        let moved = self
            .base
            .move_onto_constraints(&clamped, samples.times[0], inputs);
        moved.unwrap_or(clamped)
    }

    /// Creates the evaluator for given unknowns; `None` if the model cannot be simulated.
    pub fn new(shooting: &Shooting<'a>, theta: &[f64], level: f64) -> Option<Self> {
        let values = shooting.parameter_values(theta);
        let mut base = shooting.model.create_simulation(&values).ok()?;
        let equations = shooting.model.create_evaluator(&values);
        let is_differentiated = base.has_exact_derivatives();
        if is_differentiated {
            base.differentiate_by(&values, list_moved_parameters(shooting, theta));
        }
        let mut channels = 0..shooting.channel_count();
        let has_jumps =
            !base.has_tangents() && channels.any(|channel| shooting.model.has_jumps(channel));
        let mut perturbed_parameters = Vec::with_capacity(theta.len());
        for (number, unknown) in shooting.unknowns.iter().enumerate() {
            if !unknown.is_model_parameter() {
                perturbed_parameters.push(None);
                continue;
            }
            let step = choose_quotient_step(unknown, theta[number]);
            let mut moved = theta.to_vec();
            moved[number] += step;
            let values = shooting.parameter_values(&moved);
            let perturbed_model = if base.has_tangents() {
                let evaluator = || Box::new(shooting.model.create_evaluator(&values));
                PerturbedModel::Drives {
                    evaluator: (!is_differentiated).then(evaluator),
                    linear_outputs: shooting.model.derive_linear_outputs(&values),
                }
            } else {
                PerturbedModel::Runs(Box::new(shooting.model.create_simulation(&values).ok()?))
            };
            let opposite = has_jumps.then(|| {
                let reach = unknown.bounds.join(unknown.bounds_without_prior);
                moved[number] = theta[number] - step;
                let is_admissible = reach.contains(moved[number]);
                let values = shooting.parameter_values(&moved);
                let opposite = shooting.model.create_simulation(&values).ok();
                opposite.filter(|_| is_admissible).map(Box::new)
            });
            perturbed_parameters.push(Some(PerturbedParameter {
                perturbed_model,
                step,
                opposite: opposite.flatten(),
            }));
        }
        Some(Self {
            base,
            equations,
            sensors: shooting.sensor_values(theta),
            perturbed_parameters,
            level,
            shooting: *shooting,
        })
    }

    /// Creates the evaluator for given unknowns without derivatives with respect to them.
    pub fn with_fixed_unknowns(shooting: &Shooting<'a>, theta: &[f64], level: f64) -> Option<Self> {
        let values = shooting.parameter_values(theta);
        Some(Self {
            base: shooting.model.create_simulation(&values).ok()?,
            equations: shooting.model.create_evaluator(&values),
            sensors: shooting.sensor_values(theta),
            perturbed_parameters: Vec::new(),
            level,
            shooting: *shooting,
        })
    }

    /// Limits the comparison to a fraction of each window, from its beginning.
    pub fn truncate(&mut self, part: f64) {
        self.shooting.fraction = part;
    }

    /// Returns the state of a window at a time, s.
    pub fn propagate(&mut self, window: WindowId, start: &[f64], until: f64) -> Option<Vec<f64>> {
        let samples = &self.shooting.windows.windows[window];
        let inputs = self.shooting.windows.inputs(samples);
        // Steps end where inputs change.
        let before = samples.times.iter().filter(|t| **t < until);
        let times: Vec<f64> = before.copied().chain([until]).collect();
        let states = self.base.simulate_states(start, &times, inputs).ok()?;
        states.into_iter().next_back()
    }

    /// Computes the residuals of a window.
    pub fn compute_residual(&mut self, window: WindowId, start: &[f64]) -> Option<Residual> {
        let shooting = self.shooting;
        shooting.compute_residual(&mut self.base, &self.sensors, window, start)
    }

    /// Computes the residuals and derivatives of a window.
    pub fn linearise(&mut self, window: WindowId, start: &[f64]) -> Option<WindowDerivatives> {
        let found = match self.base.has_tangents() {
            true => self.linearise_by_tangents(window, start)?,
            false => self.linearise_by_quotients(window, start)?,
        };
        let finite = found.residual.iter().chain(found.by_unknown.iter());
        (finite
            .chain(found.by_state.iter())
            .all(|entry| entry.is_finite()))
        .then_some(found)
    }

    /// Computes residuals and derivatives with tangent vectors.
    fn linearise_by_tangents(
        &mut self,
        window: WindowId,
        start: &[f64],
    ) -> Option<WindowDerivatives> {
        let shooting = self.shooting;
        let samples = &shooting.windows.windows[window];
        let inputs = shooting.windows.inputs(samples);
        let times = &shooting.output_times(samples);
        let count = self.perturbed_parameters.iter().flatten().count();
        let moved = self.perturbed_parameters.iter_mut().flatten();
        let moved = moved.filter_map(|of| match &mut of.perturbed_model {
            PerturbedModel::Drives {
                evaluator: Some(evaluator),
                ..
            } => Some(PerturbedEvaluator {
                evaluator,
                change: of.step,
            }),
            PerturbedModel::Drives { .. } | PerturbedModel::Runs(_) => None,
        });
        let mut differences = AccelerationDifferences::new(&mut self.equations, moved.collect());
        let driven = differences.as_drives();
        let by_state = shooting.ranges.is_some();
        let directions = (by_state, count - driven.count);
        let integrated =
            self.base
                .simulate_with_tangents(start, &times.times, inputs, directions, driven)?;
        let seen = shooting.apply_sensors(times, &self.sensors, &integrated.outputs.values);
        let residual = DVector::from_vec(shooting.normalise_differences(samples, &seen));
        let states = if by_state { start.len() } else { 0 };
        let by_state =
            self.apply_sensors_to_derivatives(samples, times, states, &integrated.by_state);
        let by_drive = self.apply_sensors_to_derivatives(
            samples,
            times,
            count,
            &integrated.by_parameter_and_drive,
        );
        let mut by_unknown = DMatrix::zeros(residual.len(), self.perturbed_parameters.len());
        let mut drive = 0;
        for (column, perturbed_model) in self.perturbed_parameters.iter().enumerate() {
            let unknown = &shooting.unknowns[column];
            let Some(PerturbedParameter {
                perturbed_model,
                step,
                ..
            }) = perturbed_model
            else {
                let derivative =
                    self.differentiate_by_sensor(samples, times, unknown, &integrated.outputs);
                by_unknown.set_column(column, &derivative);
                continue;
            };
            by_unknown.set_column(column, &by_drive.column(drive));
            drive += 1;
            let PerturbedModel::Drives {
                linear_outputs: Some(shown),
                ..
            } = perturbed_model
            else {
                continue;
            };
            if Some(shown) != self.base.linear_outputs() {
                let mut moved = Vec::with_capacity(integrated.outputs.values.len());
                for state in &integrated.states {
                    shown.append(state, &mut moved);
                }
                let pairs = moved.iter_mut().zip(&integrated.outputs.values);
                pairs.for_each(|(moved, own)| *moved = (*moved - own) / step);
                let own = self.apply_sensors_to_derivatives(samples, times, 1, &moved);
                let mut column = by_unknown.column_mut(column);
                column += own.column(0);
            }
        }
        Some(WindowDerivatives {
            residual,
            by_state,
            directions: DMatrix::identity(start.len(), states),
            by_unknown,
            end_state: integrated.outputs.end_state,
        })
    }

    /// Returns the response of the residuals of a window to each drive, one column per drive;
    /// `None` if tangent vectors are not available.
    pub(crate) fn compute_drive_response(
        &mut self,
        window: WindowId,
        start: &[f64],
        driven: TangentDrives<'_>,
    ) -> Option<DMatrix<f64>> {
        let shooting = self.shooting;
        let samples = &shooting.windows.windows[window];
        let inputs = shooting.windows.inputs(samples);
        let times = &shooting.output_times(samples);
        let count = driven.count;
        let found =
            self.base
                .simulate_with_tangents(start, &times.times, inputs, (false, 0), driven)?;
        Some(self.apply_sensors_to_derivatives(
            samples,
            times,
            count,
            &found.by_parameter_and_drive,
        ))
    }

    /// Computes residuals and derivatives by difference quotients.
    fn linearise_by_quotients(
        &mut self,
        window: WindowId,
        start: &[f64],
    ) -> Option<WindowDerivatives> {
        let shooting = self.shooting;
        let samples = &shooting.windows.windows[window];
        let inputs = shooting.windows.inputs(samples);
        let times = &shooting.output_times(samples);
        let steps: Vec<f64> = (shooting.ranges.unwrap_or_default().iter())
            .map(|range| thresholds::MAX_QUOTIENT_IN_RANGES * range)
            .collect();
        let tangents = match shooting.ranges {
            Some(_) => self
                .base
                .propagate_with_tangents(start, &times.times, inputs, &steps),
            None => None,
        };
        let (outputs, derivatives) = match tangents {
            Some(OutputTangents { outputs, by_state }) => (outputs, Some(by_state)),
            None => (
                self.base
                    .simulate_outputs(start, &times.times, inputs)
                    .ok()?,
                None,
            ),
        };
        let seen = shooting.apply_sensors(times, &self.sensors, &outputs.values);
        let residual = DVector::from_vec(shooting.normalise_differences(samples, &seen));
        if residual.iter().any(|r| !r.is_finite()) {
            return None;
        }
        let directions = match shooting.ranges {
            Some(ranges) => {
                self.base
                    .find_initial_directions(start, (times.times[0], inputs), ranges)?
            }
            None => DMatrix::zeros(start.len(), 0),
        };
        let by_state = match derivatives {
            Some(derivatives) => {
                self.apply_sensors_to_derivatives(samples, times, start.len(), &derivatives)
            }
            None => self.differentiate_by_state(window, start, &residual, &directions)?,
        };
        let mut by_unknown = DMatrix::zeros(residual.len(), self.perturbed_parameters.len());
        let mut sensed = Vec::new();
        for (column, perturbed_model) in self.perturbed_parameters.iter_mut().enumerate() {
            let unknown = &shooting.unknowns[column];
            let Some(PerturbedParameter {
                perturbed_model,
                step,
                opposite,
            }) = perturbed_model
            else {
                sensed.push((column, unknown));
                continue;
            };
            let PerturbedModel::Runs(simulation) = perturbed_model else {
                return None;
            };
            let run = |simulation: &mut Simulation<'_>| {
                let moved = simulation.simulate_outputs(start, &times.times, inputs);
                let moved = shooting.apply_sensors(times, &self.sensors, &moved.ok()?.values);
                Some(shooting.normalise_differences(samples, &moved))
            };
            let after = run(simulation)?;
            let before = match opposite {
                Some(opposite) => run(opposite),
                None => None,
            };
            for (row, own) in residual.iter().enumerate() {
                let quotient = (after[row] - own) / *step;
                let has_jumps = shooting.model.has_jumps(row % shooting.channel_count());
                by_unknown[(row, column)] = match &before {
                    Some(before) if has_jumps => {
                        limit_quotient(quotient, (own - before[row]) / *step)
                    }
                    _ => quotient,
                };
            }
        }
        for (column, unknown) in sensed {
            let derivative = self.differentiate_by_sensor(samples, times, unknown, &outputs);
            by_unknown.set_column(column, &derivative);
        }
        Some(WindowDerivatives {
            residual,
            by_state,
            directions,
            by_unknown,
            end_state: outputs.end_state,
        })
    }

    /// Returns the derivative of the residuals of a window with respect to a sensor unknown.
    fn differentiate_by_sensor(
        &self,
        samples: &Window,
        times: &OutputTimes<'_>,
        unknown: &Unknown,
        outputs: &Outputs,
    ) -> DVector<f64> {
        let step = thresholds::SENSOR_QUOTIENT_IN_SCALES * unknown.scale;
        let [after, before] = [step, -step].map(|step| {
            let sensors = move_sensors(&self.sensors, unknown, step);
            let seen = self
                .shooting
                .apply_sensors(times, &sensors, &outputs.values);
            DVector::from_vec(self.shooting.normalise_differences(samples, &seen))
        });
        (after - before) / (2.0 * step)
    }

    /// Applies the sensors to derivatives of channel values, in standard deviations. `derivatives`:
    /// for each time, one row per column of the result.
    fn apply_sensors_to_derivatives(
        &self,
        samples: &Window,
        times: &OutputTimes<'_>,
        count: usize,
        derivatives: &[f64],
    ) -> DMatrix<f64> {
        let shooting = &self.shooting;
        let channels = shooting.channel_count();
        let sensors = SensorValues {
            bias: vec![0.0; channels],
            ..self.sensors.clone()
        };
        let mut matrix = DMatrix::zeros(times.samples() * channels, count);
        let mut column = vec![0.0; times.times.len() * channels];
        for number in 0..count {
            for index in 0..times.times.len() {
                let from = (index * count + number) * channels;
                let to = index * channels;
                column[to..to + channels].copy_from_slice(&derivatives[from..from + channels]);
            }
            let seen = shooting.apply_sensors(times, &sensors, &column);
            let differences = shooting.map_differences(samples, &seen, |seen, _| seen);
            matrix.column_mut(number).copy_from_slice(&differences);
        }
        matrix
    }

    /// Returns the derivatives along directions of the initial state.
    fn differentiate_by_state(
        &mut self,
        window: WindowId,
        start: &[f64],
        residual: &DVector<f64>,
        directions: &DMatrix<f64>,
    ) -> Option<DMatrix<f64>> {
        let ranges = self.shooting.ranges.unwrap_or_default();
        let mut matrix = DMatrix::zeros(residual.len(), directions.ncols());
        for (number, direction) in directions.column_iter().enumerate() {
            let mut step =
                thresholds::MAX_QUOTIENT_IN_RANGES * compute_range_along(&direction, ranges);
            // The step is adapted in a few trials, because the influence of states on the outputs
            // differs by orders of magnitude.
            for _ in 0..3 {
                let moved = move_along(start, &direction, step);
                let after = self.compute_residual(window, &moved)?;
                let differences = after.values.iter().zip(residual.iter()).map(|(a, b)| a - b);
                let mut column = matrix.column_mut(number);
                let mut furthest: f64 = 0.0;
                for (slot, difference) in column.iter_mut().zip(differences) {
                    *slot = difference / step;
                    furthest = furthest.max(difference.abs());
                }
                let wanted = thresholds::QUOTIENT_OUTPUT_CHANGE * self.level * 4.0;
                if furthest <= 4.0 * wanted {
                    break;
                }
                step *= wanted / furthest;
            }
        }
        Some(matrix)
    }
}

/// Returns the largest multiple of a direction that changes no state by more than its range.
pub(crate) fn compute_range_along(direction: &DVectorView<'_, f64>, ranges: &[f64]) -> f64 {
    let parts = direction
        .iter()
        .zip(ranges)
        .filter(|(part, _)| **part != 0.0);
    let multiples = parts.map(|(part, range)| range / part.abs());
    multiples.fold(f64::INFINITY, f64::min)
}

/// Returns a state plus a multiple of a direction.
pub(crate) fn move_along(state: &[f64], direction: &DVectorView<'_, f64>, by: f64) -> Vec<f64> {
    let pairs = state.iter().zip(direction.iter());
    pairs.map(|(x, part)| x + by * part).collect()
}

/// Computes the residuals and derivatives of all windows. `level`: RMS residual, in standard
/// deviations, for the steps of difference quotients.
pub fn linearise_windows(
    shooting: &Shooting<'_>,
    theta: &[f64],
    initial_states: &[Vec<f64>],
    level: f64,
) -> Vec<Option<WindowDerivatives>> {
    shooting.map_windows_in_parallel(|windows| {
        let mut sensitivities = SensitivityEvaluator::new(shooting, theta, level);
        windows
            .map(|window| {
                sensitivities
                    .as_mut()?
                    .linearise(window, &initial_states[window])
            })
            .collect()
    })
}

/// Returns the model parameters with a positive and a negative step of each unknown that is a model
/// parameter, within its bounds.
fn list_moved_parameters(shooting: &Shooting<'_>, theta: &[f64]) -> Vec<Vec<MovedParameters>> {
    let unknowns = shooting.unknowns.iter().enumerate();
    let of_model = unknowns.filter(|(_, unknown)| unknown.is_model_parameter());
    let moved = of_model.map(|(number, unknown)| {
        let size = thresholds::CENTRAL_QUOTIENT_IN_SCALES * unknown.scale;
        // A bound that comes only from a prior does not limit the step: the model can be simulated
        // beyond it.
        let reach = unknown.bounds.join(unknown.bounds_without_prior);
        let ends = [-size, size].map(|change| {
            let mut moved = theta.to_vec();
            moved[number] = reach.clamp(theta[number] + change);
            MovedParameters {
                values: shooting.parameter_values(&moved),
                parameter_change: moved[number] - theta[number],
            }
        });
        ends.to_vec()
    });
    moved.collect()
}

/// Returns the step of a parameter's difference quotient; it is negative close to the upper bound.
fn choose_quotient_step(unknown: &Unknown, value: f64) -> f64 {
    let step = thresholds::PARAMETER_QUOTIENT_IN_SCALES * unknown.scale;
    if value + step > unknown.bounds.high {
        -step
    } else {
        step
    }
}

/// Returns the sensor values with one changed unknown.
fn move_sensors(sensors: &SensorValues, unknown: &Unknown, step: f64) -> SensorValues {
    let mut moved = sensors.clone();
    match unknown.kind {
        UnknownKind::Gain(channel) => moved.gain[channel] += step,
        UnknownKind::Bias(channel) => moved.bias[channel] += step,
        UnknownKind::Delay(channel) => moved.delay[channel] += step,
        UnknownKind::InputDelay => moved.delay.iter_mut().for_each(|delay| *delay += step),
        UnknownKind::Parameter(_) | UnknownKind::InverseParameter(_) => {}
    }
    moved
}
