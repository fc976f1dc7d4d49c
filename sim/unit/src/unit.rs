//! Instance of a unit: its modes, settings and variables.

use std::cell::RefCell;
use std::sync::Arc;

use eomgen_codegen::program::evaluator::Evaluator;
use eomgen_compiled_model::{
    CompiledModel, ControlMemory, DrivenModel, Error, Instance, JacobianEvaluator, Simulation,
};
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::{ExternalMotion, Surface, SurfaceMode};

use crate::DEFAULT_TOLERANCE;
use crate::layout::Layout;
use crate::rejection::{Outcome, invalid};

/// Kind of an instance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The importer's solver simulates the model.
    ModelExchange,
    /// The unit simulates the model.
    CoSimulation,
}

/// Mode of an instance. The values are single bits, so that a call can list its permitted modes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Mode {
    Instantiated = 1,
    Initialization = 2,
    Event = 4,
    Continuous = 8,
    Step = 16,
    Terminated = 32,
}

/// Bits of all modes.
pub const ANY_MODE: u8 = 63;

/// Bits of the modes before the start of the motion.
pub const BEFORE_START: u8 = Mode::Instantiated as u8 | Mode::Initialization as u8;

/// Variable part of an instance: the content of a saved state.
#[derive(Clone, Debug, PartialEq)]
pub struct Condition {
    pub mode: Mode,
    /// Time, s.
    pub t: f64,
    pub state: Vec<f64>,
    pub inputs: Vec<f64>,
    /// Inputs before event mode, in which inputs may jump.
    pub earlier_inputs: Vec<f64>,
    /// Independent parameters, SI.
    pub parameters: Vec<f64>,
    /// Relative tolerance.
    pub tolerance: f64,
    /// Stop time, s.
    pub stop: Option<f64>,
    /// Modes of the surfaces with which the motion continues; empty if the state determines them.
    pub surface_modes: Vec<SurfaceMode>,
    /// Memory of the controllers; `None` before the start of the motion, or without controllers.
    pub control: Option<ControlMemory>,
}

/// Motion of an instance for model exchange.
pub type External = ExternalMotion<DrivenModel<RefCell<Evaluator>, HeldInputs>>;

/// Instance of a unit.
pub struct Unit {
    pub compiled: Arc<CompiledModel>,
    pub layout: Layout,
    pub kind: Kind,
    pub now: Condition,
    /// Model with the current parameters; `None` after they changed.
    pub instance: Option<Instance<'static>>,
    /// Motion at the current time and state; `None` after the importer changed these or the parameters.
    pub external: Option<Box<External>>,
    /// Simulation up to the current time; `None` before its start, and after the importer changed time, state
    /// or parameters.
    pub simulation: Option<Box<Simulation<'static>>>,
    pub jacobians: Option<JacobianEvaluator>,
    begin: Condition,
}

/// Returns the switching surfaces of a model, one per event indicator.
///
/// # Errors
/// Same as [`Instance::evaluator`].
pub fn find_surfaces(instance: &Instance<'_>) -> Result<Vec<Surface>, Error> {
    let evaluator = RefCell::new(instance.evaluator()?);
    let system = instance.driven_model(evaluator, instance.default_inputs(), DEFAULT_TOLERANCE)?;
    Ok(system.surfaces())
}

impl Unit {
    /// Creates an instance with the values of the specification.
    ///
    /// # Errors
    /// Invalid values.
    pub fn new(compiled: CompiledModel, kind: Kind) -> Outcome<Self> {
        let compiled = Arc::new(compiled);
        let instance = compiled.share_with_parameters(&[])?;
        let surfaces = find_surfaces(&instance)?;
        let begin = Condition {
            mode: Mode::Instantiated,
            t: 0.0,
            state: instance.initial_state().to_vec(),
            inputs: compiled.default_inputs(),
            earlier_inputs: compiled.default_inputs(),
            parameters: instance.parameters().to_vec(),
            tolerance: DEFAULT_TOLERANCE,
            stop: None,
            surface_modes: Vec::new(),
            control: None,
        };
        Ok(Self {
            layout: Layout::new(&compiled, surfaces.len()),
            compiled,
            kind,
            now: begin.clone(),
            instance: Some(instance),
            external: None,
            simulation: None,
            jacobians: None,
            begin,
        })
    }

    /// Checks that a call is permitted in the current mode.
    pub fn check_mode(&self, modes: u8, call: &str) -> Outcome {
        match self.is_in(modes) {
            true => Ok(()),
            false => Err(invalid(format!(
                "{call} is not permitted in the current state of the FMU"
            ))),
        }
    }

    pub fn is_in(&self, modes: u8) -> bool {
        self.now.mode as u8 & modes != 0
    }

    /// Sets tolerance, start time and stop time of the experiment, s.
    pub fn set_up(&mut self, tolerance: Option<f64>, start: f64, stop: Option<f64>) -> Outcome {
        if !start.is_finite() || stop.is_some_and(|stop| stop.is_nan() || stop <= start) {
            return Err(invalid(
                "the start time is not finite, or the stop time is not later",
            ));
        }
        if let Some(tolerance) =
            tolerance.filter(|tolerance| !(0.0 < *tolerance && *tolerance < 1.0))
        {
            return Err(invalid(format!(
                "tolerance = {tolerance}: not between 0 and 1"
            )));
        }
        self.now.t = start;
        self.now.stop = stop;
        self.now.tolerance = tolerance.unwrap_or(DEFAULT_TOLERANCE);
        self.forget_motion();
        Ok(())
    }

    /// Resets all values to those of the specification.
    pub fn reset(&mut self) {
        self.set_condition(self.begin.clone());
    }

    /// Continues from a condition.
    pub fn set_condition(&mut self, condition: Condition) {
        if self.now.parameters != condition.parameters {
            self.forget_parameters();
        }
        self.now = condition;
        self.forget_motion();
    }

    /// Discards the motion; the next one starts at the current time and state.
    pub fn forget_motion(&mut self) {
        self.external = None;
        self.simulation = None;
    }

    /// Discards everything that depends on the parameters.
    pub fn forget_parameters(&mut self) {
        self.instance = None;
        self.jacobians = None;
        self.forget_motion();
    }

    /// Returns the model with the current parameters.
    ///
    /// # Errors
    /// Parameters that are not admissible together.
    pub fn instance(&mut self) -> Outcome<Instance<'static>> {
        if self.instance.is_none() {
            self.instance = Some(self.instance_at(&self.now.parameters)?);
        }
        let instance = self.instance.clone();
        instance.ok_or_else(|| invalid("the FMU has no model"))
    }

    /// Returns the model with these parameters, SI.
    pub fn instance_at(&self, parameters: &[f64]) -> Outcome<Instance<'static>> {
        let names = self.compiled.parameter_names();
        let declared = &self.compiled.model().parameters;
        let values = names.iter().zip(parameters).zip(&self.begin.parameters);
        let changed = values.filter(|((_, value), begin)| value != begin);
        let settings: Vec<(&str, f64)> = changed
            .filter_map(|((name, value), _)| {
                let known = declared.iter().find(|known| known.name == *name)?;
                Some((name.as_str(), known.unit.from_si(*value)))
            })
            .collect();
        Ok(self.compiled.share_with_parameters(&settings)?)
    }
}
