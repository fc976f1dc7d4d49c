//! Compiled model for fits, with its part that is linear between switches, its measured outputs,
//! and steps that are short enough for the noise of the sensors. Simulations are in
//! [`crate::model::simulation`].

use std::sync::Arc;

use eomgen_codegen::independence::rows::ConstraintRows;
use eomgen_codegen::program::evaluator::Evaluator;
use eomgen_codegen::program::{Program, ProgramGuard};
use eomgen_compiled_model::{
    CompiledModel, Error, ExportedModel, InitialChange, Orders, Projection,
};
use eomgen_model_spec::Checked;
use eomgen_model_spec::diagnostic::Diagnostics;
use eomgen_model_spec::model::{Model, Parameter, ParameterValue};

use crate::error::SimulationError;
use crate::ids::ParameterId;
use crate::model::given_motion::GivenMotion;
use crate::model::linear_outputs::LinearOutputs;
use crate::model::longest_step::LongestStep;
use crate::model::measured_outputs::MeasuredOutputs;
use crate::model::nonlinear_remainder::NonlinearRemainder;
use crate::model::observed_rates::add_observed_rates;
use crate::model::output_times::OutputRate;
use crate::model::simulation::Simulation;
use crate::model::specification_texts::edited_source;
use crate::model::stop::StopRequest;
use crate::model::unknowns::ExpectedSensor;
use crate::model::work::WorkLimit;
use crate::thresholds;
use eomgen_records::dataset::Channel;
use eomgen_records::record::Record;
use eomgen_records::samples::typical_step;
use eomgen_sim::exponential::{ExponentialIntegrator, UnsupportedModel};
use eomgen_sim::inputs::HeldInputs;

/// Derived model with its measured outputs. Copies share the derivation.
#[derive(Clone)]
pub struct EstimationModel {
    /// Compiled equations.
    compiled: Arc<CompiledModel>,
    /// Names of the independent parameters, in the order of their values.
    pub parameters: Vec<String>,
    /// Values of the parameters in the specification, SI.
    pub values: Vec<f64>,
    /// Names of the states.
    pub states: Vec<String>,
    /// Range of each coordinate, if the specification declares one.
    ranges: Vec<Option<(f64, f64)>>,
    linear: Option<LinearPart>,
    pub(crate) measured: MeasuredOutputs,
    /// Expected sensor of each channel.
    pub sensors: Vec<ExpectedSensor>,
    /// Maximum Runge-Kutta step of a model without a linear part; `None` for a solver with error
    /// control.
    pub(crate) longest_step: Option<LongestStep>,
    /// Usual sample interval, s, and number of steps per sample interval if the model has a
    /// nonlinear remainder.
    sample: f64,
    refinement: f64,
    /// Stop request of the simulations.
    pub(crate) stop: StopRequest,
    /// Number of evaluations in simulations, and its limit.
    pub(crate) work: WorkLimit,
}

/// Ratio of the difference between the results of Runge-Kutta steps h and h/2 to the error of the
/// steps h/2. The error decreases with the fourth power of the step.
const RUNGE_KUTTA_ERROR_RATIO: f64 = 15.0;

/// The corresponding ratio for the exponential integrator, whose error decreases with the second
/// power of the step.
const INTEGRATOR_ERROR_RATIO: f64 = 3.0;

/// Part of a model that is linear between switches.
#[derive(Clone)]
enum LinearPart {
    /// The whole model.
    Whole,
    /// Part of the model without the nonlinear terms.
    Part(Arc<LinearTerms>),
}

/// Model of the terms that are linear between switches.
struct LinearTerms {
    compiled: CompiledModel,
    /// Index of each of its parameters in the whole model.
    parameters: Vec<ParameterId>,
}

impl EstimationModel {
    /// Derives the model of a specification. `linear`: text of the same model without the terms
    /// that are nonlinear between switches, if it has such terms.
    ///
    /// # Errors
    ///
    /// An invalid text.
    pub fn derive(
        text: &str,
        linear: Option<&str>,
        name: &str,
        order: Option<usize>,
        channels: &[Channel],
    ) -> Result<Self, Error> {
        let mut model = Self::derive_equations(text, name, order, channels)?;
        model.linear = match (model.compiled.piecewise_linear(), linear) {
            (Ok(_), _) => Some(LinearPart::Whole),
            (Err(_), Some(linear)) => derive_linear_part(linear, name, order, &model),
            (Err(_), None) => None,
        };
        Ok(model)
    }

    /// Derives the equations only, for comparison with another model.
    ///
    /// # Errors
    ///
    /// Errors of [`EstimationModel::derive`].
    pub fn derive_equations(
        text: &str,
        name: &str,
        order: Option<usize>,
        channels: &[Channel],
    ) -> Result<Self, Error> {
        let Checked { mut model, .. } = eomgen_model_spec::check(edited_source(name, text))?;
        let rates = add_observed_rates(&mut model, channels);
        let compiled =
            CompiledModel::derive(model, order.map_or(Orders::Declared, Orders::Uniform))?;
        if let Some(surface) = compiled.first_corner() {
            return Err(Error::Request(format!(
                "{name}: the energies of the model jump where `{surface}` is zero, and the rates with them, which \
                 `compare` and `discover` do not support yet; `simulate` does"
            )));
        }
        let ranges = compiled.model().coordinate_ranges().map_err(|error| {
            Diagnostics::from_one(compiled.model().source.clone(), error.diagnostic())
        })?;
        let program = compiled.program();
        let is_number = |p: &&Parameter| matches!(p.value, ParameterValue::Number(_));
        let independent = compiled.model().parameters.iter().filter(is_number);
        let parameters = independent.map(|p| p.name.clone()).collect();
        Ok(Self {
            measured: MeasuredOutputs::new(channels, &rates, program),
            sensors: channels
                .iter()
                .map(|channel| ExpectedSensor::from_channel(channel, compiled.model()))
                .collect(),
            parameters,
            values: program.default_parameters(),
            states: compiled.state_names(),
            ranges,
            linear: None,
            longest_step: None,
            sample: 0.0,
            refinement: 1.0,
            stop: StopRequest::default(),
            work: WorkLimit::default(),
            compiled: Arc::new(compiled),
        })
    }

    /// Returns the model without a limit on work, because the limit applies to one fit.
    pub(crate) fn without_work_limit(mut self) -> Self {
        self.work = WorkLimit::default();
        self
    }

    /// Clamps the coordinates of a state to their ranges.
    pub fn clamp_state(&self, mut state: Vec<f64>) -> Vec<f64> {
        for (entry, range) in state.iter_mut().zip(&self.ranges) {
            if let Some((low, high)) = range {
                *entry = entry.clamp(*low, *high);
            }
        }
        state
    }

    /// Converts a state of another model to a state of this model. States that exist only in this
    /// model are 0.
    pub fn map_state(&self, other: &Self, state: &[f64]) -> Vec<f64> {
        let value = |name: &String| {
            let index = other.states.iter().position(|known| known == name);
            index.map_or(0.0, |index| state[index])
        };
        self.states.iter().map(value).collect()
    }

    /// Returns true if the coordinates of a state are within their ranges.
    pub fn is_admissible(&self, state: &[f64]) -> bool {
        let ranged = state.iter().zip(&self.ranges);
        ranged
            .filter_map(|(entry, range)| Some((entry, (*range)?)))
            .all(|(entry, (low, high))| (low..=high).contains(entry))
    }

    /// Returns the checked specification.
    pub fn specification(&self) -> &Model {
        self.compiled.model()
    }

    /// Returns the typical sizes of the states in SI, for solvers.
    pub(crate) fn typical_sizes(&self) -> &[f64] {
        self.compiled.typical_sizes()
    }

    /// Returns true if the quantity of a channel jumps at times that depend on the motion:
    /// acceleration with dry friction or impacts.
    pub(crate) fn has_jumps(&self, channel: usize) -> bool {
        let program = self.program();
        self.measured.is_rate(channel) && !(program.guards.is_empty() && program.impacts.is_empty())
    }

    /// Returns the program of the equations.
    pub(crate) fn program(&self) -> &Program {
        self.compiled.program()
    }

    /// Returns the order of each field.
    pub fn orders(&self) -> &[usize] {
        self.compiled.orders()
    }

    /// Returns the index of an independent parameter.
    pub fn find_parameter(&self, name: &str) -> Option<ParameterId> {
        let index = self.parameters.iter().position(|known| known == name)?;
        Some(ParameterId::new(index))
    }

    /// Sets the value of an independent parameter, SI.
    pub fn set_value(&self, values: &mut [f64], parameter: &str, value: f64) {
        if let Some(parameter) = self.find_parameter(parameter) {
            values[parameter.index()] = value;
        }
    }

    /// Returns the number of degrees of freedom. The state begins with this number of coordinates
    /// and the same number of rates.
    pub fn degrees_of_freedom(&self) -> usize {
        self.compiled.program().degrees_of_freedom()
    }

    /// Returns the number of states.
    pub fn state_count(&self) -> usize {
        self.states.len()
    }

    /// Returns true if the whole model is linear between switches.
    pub fn is_linear(&self) -> bool {
        matches!(self.linear, Some(LinearPart::Whole))
    }

    /// Returns the initial state of the specification.
    pub fn initial_state(&self) -> Vec<f64> {
        let given = self.compiled.model().initial_state(self.compiled.orders());
        given.unwrap_or_else(|_| vec![0.0; self.state_count()])
    }

    /// Chooses the number of fixed steps per output interval, tested on the beginning of a record.
    /// The outputs may change by less than a fraction of the noise. `numbers`: number of fitted
    /// values. If no number of steps suffices, a solver with error control is used.
    pub fn choose_steps(
        &mut self,
        record: &Record,
        initial: &[f64],
        noise: &[f64],
        numbers: f64,
        output_rate: OutputRate,
    ) {
        let samples = record.times.len().min(thresholds::STEP_TEST_SAMPLE_COUNT);
        let times = &output_rate.times(&record.times[..samples]).times;
        self.sample = typical_step(times);
        if self.is_linear() {
            return;
        }
        let has_linear_part = self.linear.is_some();
        let run = |model: &mut Self, doubling: u32| {
            if has_linear_part {
                model.refinement = f64::from(1 << doubling);
            } else {
                model.longest_step = Some(LongestStep(model.sample / f64::from(1 << doubling)));
            }
            let mut simulation = model.create_simulation(&model.values).ok()?;
            if has_linear_part && !simulation.uses_integrator() {
                return None;
            }
            let outputs = simulation
                .simulate_outputs(initial, times, &record.inputs)
                .ok()?;
            Some(outputs.values)
        };
        let error = match has_linear_part {
            true => thresholds::MAX_STEP_ERROR,
            false => thresholds::MAX_SUMMED_STEP_ERROR * RUNGE_KUTTA_ERROR_RATIO / numbers.sqrt(),
        };
        let mut coarse = run(self, 0);
        for doubling in 1..thresholds::MAX_STEP_DOUBLINGS {
            let fine = run(self, doubling);
            let near = |(coarse, fine): (&Vec<f64>, &Vec<f64>)| {
                let pairs = coarse.iter().zip(fine).enumerate();
                let square = |(number, (a, b)): (usize, (&f64, &f64))| {
                    ((a - b) / noise[number % noise.len()]).powi(2)
                };
                let sum: f64 = pairs.map(square).sum();
                sum < error.powi(2) * coarse.len() as f64
            };
            if coarse.as_ref().zip(fine.as_ref()).is_some_and(near) {
                if has_linear_part {
                    // Each doubling reduces the error of the integrator by a factor of four, so the
                    // coarser steps suffice.
                    self.refinement = f64::from(1 << (doubling - 1));
                }
                return;
            }
            coarse = fine;
        }
        if has_linear_part {
            self.refinement = 1.0;
        }
        self.longest_step = None;
    }

    /// Returns a copy with half the fixed step. `None` if the model has no fixed steps, or already
    /// the maximum number of them.
    pub(crate) fn with_halved_steps(&self) -> Option<Self> {
        let mut finer = self.clone();
        let steps = match (&self.linear, self.longest_step) {
            (Some(LinearPart::Part(_)), _) => {
                finer.refinement *= 2.0;
                finer.refinement
            }
            (None, Some(LongestStep(step))) => {
                finer.longest_step = Some(LongestStep(step / 2.0));
                self.sample / step * 2.0
            }
            _ => return None,
        };
        (steps <= f64::from(1 << thresholds::MAX_STEP_DOUBLINGS)).then_some(finer)
    }

    /// Returns the ratio of the difference between fixed steps h and h/2 to the error of the steps
    /// h/2.
    pub(crate) fn step_error_ratio(&self) -> f64 {
        match self.linear.is_some() {
            true => INTEGRATOR_ERROR_RATIO,
            false => RUNGE_KUTTA_ERROR_RATIO,
        }
    }

    /// Creates a simulation for given values of the independent parameters.
    ///
    /// # Errors
    ///
    /// Values for which the model cannot be simulated; [`SimulationError::Stopped`].
    pub fn create_simulation(&self, values: &[f64]) -> Result<Simulation<'_>, SimulationError> {
        if self.stop.is_requested() {
            return Err(SimulationError::Stopped);
        }
        let mut evaluator = self.compiled.evaluator(values);
        if !evaluator.pivots_are_positive() {
            return Err(SimulationError::IndefiniteMassMatrix);
        }
        if !self.measured.inputs().is_empty() {
            let given = GivenMotion::from_measured_inputs(&evaluator, &self.measured);
            let given = given.ok_or(SimulationError::StateNotRecorded)?;
            let of = (&self.measured, self.typical_sizes());
            let mut simulation = Simulation::new(of, evaluator, None, None);
            simulation.stop = self.stop.clone();
            simulation.work = self.work.clone();
            simulation.use_given_motion(given);
            return Ok(simulation);
        }
        let linear_outputs = LinearOutputs::linearise_outputs(&self.measured, &mut evaluator);
        let longest_step = self.longest_step;
        let of = (&self.measured, self.typical_sizes());
        let mut simulation = Simulation::new(of, evaluator, linear_outputs, longest_step);
        simulation.stop = self.stop.clone();
        simulation.work = self.work.clone();
        simulation.use_constraints(self.compiled.projection(values));
        if self.measured.has_rates() {
            // If the model cannot be derived with sides, it is simulated without sticking.
            simulation.measure_sticking(self.compiled.sided_model(values).ok().flatten());
        }
        let (linear, own) = match &self.linear {
            None => {
                self.add_sticking(&mut simulation, values);
                return Ok(simulation);
            }
            Some(LinearPart::Whole) => (&*self.compiled, values.to_vec()),
            Some(LinearPart::Part(part)) => {
                let own = part.parameters.iter().map(|id| values[id.index()]);
                (&part.compiled, own.collect())
            }
        };
        let exact = linear
            .piecewise_linear()
            .map_err(|error| SimulationError::Propagator(error.clone()))?;
        let prescribed: Vec<usize> = linear.model().prescribed_inputs().collect();
        let moves_by_inputs = !prescribed.is_empty();
        let affine = exact.evaluator(&own).with_prescribed_states(prescribed);
        let integrator = ExponentialIntegrator::new(affine, self.sample, self.refinement)
            .map(|integrator| integrator.with_typical_sizes(self.typical_sizes()));
        match (integrator, self.is_linear()) {
            // A motion that is much faster than the sampling is not visible in the samples.
            (Err(UnsupportedModel::TooManySteps(steps)), _)
                if steps.is_nan() || steps > thresholds::MAX_PARTS_PER_STEP =>
            {
                return Err(SimulationError::TooFast);
            }
            // The exact propagator requires held inputs.
            (Err(_), _) if moves_by_inputs => self.add_sticking(&mut simulation, values),
            (Err(_), true) => {
                let exact = exact
                    .propagator_at(values)
                    .map_err(SimulationError::Propagator)?;
                simulation.use_propagator(exact);
            }
            (Ok(integrator), true) => simulation.use_integrator(integrator, None),
            (Ok(integrator), false) => {
                let whole = self.compiled.evaluator(values);
                let remainder = NonlinearRemainder::new(whole, linear.evaluator(&own));
                simulation.use_integrator(integrator, Some(remainder));
            }
            (Err(_), false) => self.add_sticking(&mut simulation, values),
        }
        Ok(simulation)
    }

    /// Adds sticking surfaces to a simulation, unless the model cannot be derived with sides.
    fn add_sticking(&self, simulation: &mut Simulation<'_>, values: &[f64]) {
        if let Ok(Some(sided)) = self.compiled.sided_model(values) {
            simulation.use_sticking(sided);
        }
    }

    /// Returns the projection onto the constraints for given parameter values; `None` without
    /// constraints.
    pub(crate) fn create_projection(&self, values: &[f64]) -> Option<Projection> {
        self.compiled.projection(values)
    }

    /// Returns the values of a state at a time (s) that change by its projection onto the
    /// constraints, for the parameters of the specification.
    ///
    /// # Errors
    ///
    /// Constraints that no near state satisfies, or that depend on each other.
    pub(crate) fn list_changes_by_constraints(
        &self,
        state: &[f64],
        (t, inputs): (f64, &HeldInputs),
    ) -> Result<Vec<InitialChange>, Error> {
        let instance = self.compiled.with_declared_parameters()?;
        let (_, changes) = instance.find_consistent_state(state, t, inputs)?;
        Ok(changes)
    }

    /// Returns residuals and derivatives of the constraints for given parameter values; `None`
    /// without constraints.
    pub(crate) fn create_constraint_rows(&self, values: &[f64]) -> Option<ConstraintRows> {
        self.compiled.constraint_rows(values)
    }

    /// Creates an evaluator of the equations for given parameter values.
    pub(crate) fn create_evaluator(&self, values: &[f64]) -> Evaluator {
        self.compiled.evaluator(values)
    }

    /// Returns the model with the parameters of the specification for a page.
    ///
    /// # Errors
    ///
    /// Terms that cannot be derived.
    pub(crate) fn export(&self) -> Result<ExportedModel, Error> {
        ExportedModel::new(&self.compiled.with_declared_parameters()?)
    }

    /// Returns the measured outputs as linear functions of the state, if they are linear.
    pub(crate) fn derive_linear_outputs(&self, values: &[f64]) -> Option<LinearOutputs> {
        LinearOutputs::linearise_outputs(&self.measured, &mut self.create_evaluator(values))
    }
}

/// Returns true if the model of a specification is linear between switches.
pub fn is_linear(text: &str, name: &str, order: Option<usize>) -> bool {
    compile_model(text, name, order).is_ok_and(|compiled| compiled.piecewise_linear().is_ok())
}

/// Derives the linear part of a model from its text; `None` if its states differ from those of the
/// model.
fn derive_linear_part(
    text: &str,
    name: &str,
    order: Option<usize>,
    model: &EstimationModel,
) -> Option<LinearPart> {
    let part = compile_model(text, name, order).ok()?;
    if part.state_names() != model.states || has_more_sticking_surfaces(&model.compiled, &part) {
        return None;
    }
    let own = part.piecewise_linear().ok()?.parameter_names();
    let parameters = own.iter().map(|name| model.find_parameter(name));
    let parameters = parameters.collect::<Option<Vec<ParameterId>>>()?;
    Some(LinearPart::Part(Arc::new(LinearTerms {
        parameters,
        compiled: part,
    })))
}

/// Returns true if a model has sticking surfaces, such as dry friction, that its linear part lacks.
/// The integrator of the linear part would not stop the motion there.
fn has_more_sticking_surfaces(whole: &CompiledModel, part: &CompiledModel) -> bool {
    let known = &part.program().guards;
    let is_known = |guard: &ProgramGuard| known.iter().any(|own| own.formula == guard.formula);
    if whole.program().guards.iter().all(is_known) {
        return false;
    }
    let holding_count = |model: &CompiledModel| {
        let sided = model.sided_model(&model.program().default_parameters());
        sided.ok().flatten().map_or(0, |sided| sided.side_count())
    };
    holding_count(whole) > holding_count(part)
}

/// Compiles the model of a specification text.
fn compile_model(text: &str, name: &str, order: Option<usize>) -> Result<CompiledModel, Error> {
    let Checked { model, .. } = eomgen_model_spec::check(edited_source(name, text))?;
    CompiledModel::derive(model, order.map_or(Orders::Declared, Orders::Uniform))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPEAKER: &str = r#"[model]
name = "speaker"
[parameters]
m = { value = 10, unit = "g" }
b = { value = 5, unit = "mm" }
[coordinates]
y = { unit = "m" }
x = { unit = "m", range = ["-b", "b"] }
[kinetic]
masses = "1/2*m*(dot(x)^2 + dot(y)^2)"
"#;

    const STAGE: &str = r#"[model]
name = "stage"
[parameters]
m = { value = 2, unit = "kg" }
T = { value = 5, unit = "N" }
v_s = { value = 0.1, unit = "m/s" }
[coordinates]
x = { unit = "m", initial_rate = 0.4 }
[kinetic]
table = "1/2*m*dot(x)^2"
[forces]
"#;

    #[test]
    fn motion_stops_when_friction_sticks() {
        let text = |friction: &str| {
            format!("{STAGE}friction = {{ on = \"x\", value = \"{friction}\" }}\n")
        };
        let whole = text("-T*sign(dot(x))*exp(-(dot(x)/v_s)^2) - T*sign(dot(x))/4");
        let simulate = |linear: Option<&str>| {
            let mut model =
                EstimationModel::derive(&whole, linear, "stage", None, &[]).expect("a model");
            (model.sample, model.refinement) = (0.01, 8.0);
            let mut simulation = model
                .create_simulation(&model.values)
                .expect("a simulation");
            let samples: Vec<f64> = (0..80).map(|k| 0.01 * f64::from(k)).collect();
            let inputs = HeldInputs::zero(0);
            let states = simulation.simulate_states(&[0.0, 0.4], &samples, &inputs);
            (
                simulation.uses_integrator(),
                states.expect("states").last().cloned().expect("a state"),
            )
        };
        let (is_integrated, right) = simulate(None);
        assert!(!is_integrated && right[1].abs() < 1e-6, "{right:?}");
        // Without friction, the linear part alone would not stop the motion.
        let (is_integrated, end) = simulate(Some(&format!(
            "{STAGE}free = {{ on = \"x\", value = \"0*T\" }}\n"
        )));
        assert!(!is_integrated && end == right, "{end:?} {right:?}");
        let (is_integrated, end) = simulate(Some(&text("-5/4*T*sign(dot(x))")));
        assert!(is_integrated && end[1].abs() < 1e-6, "{end:?}");
        assert!((end[0] / right[0] - 1.0).abs() < 1e-4, "{end:?} {right:?}");
    }

    #[test]
    fn initial_state_is_clamped_to_ranges() {
        let model =
            EstimationModel::derive_equations(SPEAKER, "speaker", None, &[]).expect("a model");
        let moved = |x: f64| model.clamp_state(vec![9.0, x, 9.0, 9.0]);
        assert_eq!(moved(0.02), [9.0, 0.005, 9.0, 9.0]);
        assert_eq!(moved(-0.02), [9.0, -0.005, 9.0, 9.0]);
        assert_eq!(moved(0.002), [9.0, 0.002, 9.0, 9.0]);
    }
}
