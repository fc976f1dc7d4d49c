//! A compiled model at one set of parameter values.

use eomgen_codegen::independence::rows::ConstraintRows;
use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics};
use eomgen_model_spec::model::{ParameterValue, STABILISATION_RATE};
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::NOT_POSITIVE;
use eomgen_sim::piecewise_linear::{ExactError, Propagator};

use crate::error::Error;
use crate::model::CompiledModel;
use crate::motion::Motion;
use crate::sliding::{Observed, Sided};

/// A compiled model with values for all its parameters and the initial state that follows.
pub struct Instance<'m> {
    pub(crate) model: &'m CompiledModel,
    /// The independent parameters, SI.
    parameters: Vec<f64>,
    /// All parameters of the specification, SI.
    values: Vec<f64>,
    initial: Vec<f64>,
}

impl CompiledModel {
    /// The model at the values that its specification gives.
    ///
    /// # Errors
    /// Values or initial states that are not admissible.
    pub fn at_declared(&self) -> Result<Instance<'_>, Error> {
        self.with(&[])
    }

    /// The model with some independent parameters set, each a number in the unit that the
    /// specification declares; what depends on them is computed anew.
    ///
    /// # Errors
    /// An unknown name, a value that is not admissible, and a parameter that the specification
    /// gives by an expression: it is part of the equations, and has to be set in the model before
    /// that is derived.
    pub fn with(&self, settings: &[(&str, f64)]) -> Result<Instance<'_>, Error> {
        Instance::new(self, settings)
    }
}

impl<'m> Instance<'m> {
    /// The same where residuals of constraints decay at this rate (1/s).
    pub(crate) fn stabilised(&self, rate: f64) -> Self {
        let mut changed = Self {
            model: self.model,
            parameters: self.parameters.clone(),
            values: self.values.clone(),
            initial: self.initial.clone(),
        };
        let mut set = |place: Option<usize>, all: fn(&mut Self) -> &mut Vec<f64>| {
            if let Some(value) = place.and_then(|place| all(&mut changed).get_mut(place)) {
                *value = rate;
            }
        };
        let independent = &self.model.program().parameters;
        let place = independent
            .iter()
            .position(|p| p.quantity.name == STABILISATION_RATE);
        set(place, |instance| &mut instance.parameters);
        let place = self
            .model
            .model()
            .parameters
            .iter()
            .position(|p| p.name == STABILISATION_RATE);
        set(place, |instance| &mut instance.values);
        changed
    }

    fn new(compiled: &'m CompiledModel, settings: &[(&str, f64)]) -> Result<Self, Error> {
        let declared = compiled.model();
        let refused = |error| Error::model(declared, error);
        let model = declared.with_parameters(settings).map_err(refused)?;
        let is_expression = |name: &&str| {
            let mut parameters = declared.parameters.iter();
            let known = parameters.find(|known| known.name == *name);
            known.is_some_and(|known| matches!(known.value, ParameterValue::Expression(_)))
        };
        if let Some(name) = settings.iter().map(|(name, _)| *name).find(is_expression) {
            let message =
                format!("`{name}` is given by an expression, which is part of the equations");
            let wrong = Diagnostic::error(message);
            let wrong = wrong.help("set it in the model before the model is derived");
            return Err(Diagnostics::one(declared.source.clone(), wrong).into());
        }
        let values = model.parameter_values().map_err(refused)?;
        let mut instance = Self {
            model: compiled,
            parameters: Vec::new(),
            initial: model.initial_state(compiled.orders()).map_err(refused)?,
            values,
        };
        let independent = compiled.program().parameters.iter();
        let value = |name: &str| instance.value(name).unwrap_or(f64::NAN);
        // Every parameter of a program is one of its model.
        instance.parameters = independent.map(|p| value(&p.quantity.name)).collect();
        Ok(instance)
    }

    /// The compiled model.
    pub fn model(&self) -> &'m CompiledModel {
        self.model
    }

    /// The independent parameters, SI, in the order of
    /// [`parameter_names`](CompiledModel::parameter_names).
    pub fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    /// All parameters of the specification, SI.
    pub(crate) fn values(&self) -> &[f64] {
        &self.values
    }

    /// The value of any parameter of the specification, SI.
    pub fn value(&self, name: &str) -> Option<f64> {
        let parameters = &self.model.model().parameters;
        let place = parameters.iter().position(|known| known.name == name)?;
        self.values.get(place).copied()
    }

    /// The initial state that the specification gives, SI.
    pub fn initial(&self) -> &[f64] {
        &self.initial
    }

    /// Inputs where nobody gives them: 0, and prescribed motion in the middle of its range, if it has
    /// one.
    pub fn no_inputs(&self) -> HeldInputs {
        HeldInputs::constant(self.model.usual_inputs())
    }

    /// An evaluator at these parameters.
    ///
    /// # Errors
    /// [`Error::Request`] where the mass matrix is not positive definite.
    pub fn evaluator(&self) -> Result<Evaluator, Error> {
        positive(self.unchecked())
    }

    /// An evaluator for a few evaluations: no machine code is made for it.
    ///
    /// # Errors
    /// As [`Instance::evaluator`].
    pub fn interpreter(&self) -> Result<Evaluator, Error> {
        positive(self.model.interpreter(&self.parameters))
    }

    /// An evaluator at these parameters, whether its pivots are positive or not: what is asked of it must
    /// not rest on accelerations.
    pub(crate) fn unchecked(&self) -> Evaluator {
        self.model.evaluator(&self.parameters)
    }

    /// Computes derivatives of the constraints at these parameters; nothing without constraints.
    pub(crate) fn constraint_rows(&self) -> Option<ConstraintRows> {
        let program = self.model.constraint_program(&self.values)?;
        let mut rows = ConstraintRows::new(self.model.model(), program.clone());
        rows.prepare(&self.parameters);
        Some(rows)
    }

    /// The model with sides at these parameters; see [`CompiledModel::sided`].
    ///
    /// # Errors
    /// What cannot be derived.
    pub(crate) fn sided(&self) -> Result<Option<Sided>, Error> {
        self.model.sided(&self.parameters)
    }

    /// A propagator from switch to switch at these parameters.
    ///
    /// # Errors
    /// The term that is not linear between switches, or coefficients that are no numbers.
    pub fn propagator(&self) -> Result<Propagator, ExactError> {
        let exact = self.model.piecewise_linear().map_err(Clone::clone)?;
        let value = |name: &String| self.value(name).unwrap_or(f64::NAN);
        let values: Vec<f64> = exact.parameters().iter().map(value).collect();
        exact.at(&values)
    }

    /// The observables at every state of a motion, `energy` and `power` last: a row per sample.
    ///
    /// # Errors
    /// As [`Instance::evaluator`].
    pub fn observables(&self, motion: &Motion) -> Result<Vec<Vec<f64>>, Error> {
        let mut rows = Vec::with_capacity(motion.trajectory.times.len());
        self.observe(motion, |_, _, observables| rows.push(observables.to_vec()))?;
        Ok(rows)
    }

    /// Shows time (s), state and observables of every sample of a motion, one after the other. Where
    /// dry friction holds the motion its force is the one that does.
    ///
    /// # Errors
    /// As [`Instance::evaluator`].
    pub fn observe(
        &self,
        motion: &Motion,
        mut show: impl FnMut(f64, &[f64], &[f64]),
    ) -> Result<(), Error> {
        let evaluator = self.evaluator()?;
        let mut observables = vec![0.0; evaluator.program().observables.len()];
        let trajectory = &motion.trajectory;
        let mut observed = Observed::new(evaluator, self.sided()?, trajectory, &motion.inputs);
        for (&t, state) in trajectory.times.iter().zip(&trajectory.states) {
            let inputs = &motion.inputs.at(t);
            observed.observables(Point { t, state, inputs }, &mut observables);
            show(t, state, &observables);
        }
        Ok(())
    }
}

/// The evaluator, if the mass matrix is positive definite.
fn positive(evaluator: Evaluator) -> Result<Evaluator, Error> {
    match evaluator.pivots_are_positive() {
        true => Ok(evaluator),
        false => Err(Error::Request(NOT_POSITIVE.to_owned())),
    }
}
