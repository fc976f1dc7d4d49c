//! Compiled model at one set of parameter values.

use std::borrow::Borrow;
use std::cell::RefCell;
use std::ops::Deref;
use std::sync::Arc;

use eomgen_codegen::independence::constraint_program::find_residual_indices;
use eomgen_codegen::independence::rows::ConstraintRows;
use eomgen_codegen::mechanics::fields::resolution::check_coefficients;
use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics};
use eomgen_model_spec::model::{Model, ParameterValue, STABILISATION_RATE};
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::piecewise_linear::{ExactError, Propagator};

use crate::driven_model::DrivenModel;
use crate::error::Error;
use crate::evaluation::require_positive_pivots;
use crate::model::CompiledModel;
use crate::motion::Motion;
use crate::motion_model::MotionModel;
use crate::projection::InitialChange;
use crate::sticking::{ObservedMotion, SidedModel};

/// Compiled model that an instance borrows or shares.
#[derive(Clone)]
pub(crate) enum ModelHandle<'m> {
    Borrowed(&'m CompiledModel),
    Shared(Arc<CompiledModel>),
}

impl Deref for ModelHandle<'_> {
    type Target = CompiledModel;

    fn deref(&self) -> &CompiledModel {
        match self {
            Self::Borrowed(model) => model,
            Self::Shared(model) => model,
        }
    }
}

/// Compiled model at one set of parameter values, with the resulting initial state.
#[derive(Clone)]
pub struct Instance<'m> {
    pub(crate) model: ModelHandle<'m>,
    /// Changed parameters, in declared units.
    settings: Vec<(String, f64)>,
    /// Independent parameters, SI.
    parameters: Vec<f64>,
    /// All parameters of the specification, SI.
    values: Vec<f64>,
    initial: Vec<f64>,
}

impl CompiledModel {
    /// Returns the model at the declared parameter values.
    ///
    /// # Errors
    /// Invalid parameter values or initial states.
    pub fn with_declared_parameters(&self) -> Result<Instance<'_>, Error> {
        self.with_parameters(&[])
    }

    /// Sets independent parameters, each in the unit that the specification declares, and recomputes all dependent
    /// parameters.
    ///
    /// # Errors
    /// An unknown name, an invalid value, or a coefficient along a field that the quadrature does not resolve at these
    /// values. A parameter that the specification gives by an expression is rejected too. Its expression is part of the
    /// equations: change it in the model and derive again.
    pub fn with_parameters(&self, settings: &[(&str, f64)]) -> Result<Instance<'_>, Error> {
        Instance::new(ModelHandle::Borrowed(self), settings)
    }

    /// Returns an instance that shares the model; see [`CompiledModel::with_parameters`].
    ///
    /// # Errors
    /// See [`CompiledModel::with_parameters`].
    pub fn share_with_parameters(
        self: &Arc<Self>,
        settings: &[(&str, f64)],
    ) -> Result<Instance<'static>, Error> {
        Instance::new(ModelHandle::Shared(Arc::clone(self)), settings)
    }
}

impl<'m> Instance<'m> {
    /// Returns a copy in which the residuals of constraints decay at the given rate, 1/s.
    pub(crate) fn with_stabilisation_rate(&self, rate: f64) -> Self {
        let mut changed = self.clone();
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

    fn new(compiled: ModelHandle<'m>, settings: &[(&str, f64)]) -> Result<Self, Error> {
        let declared = compiled.model();
        let refused = |error| Error::from_model_error(declared, error);
        let model = declared.with_parameters(settings).map_err(refused)?;
        let is_expression = |name: &&str| {
            let mut parameters = declared.parameters.iter();
            let known = parameters.find(|known| known.name == *name);
            known.is_some_and(|known| matches!(known.value, ParameterValue::Expression(_)))
        };
        if let Some(name) = settings.iter().map(|(name, _)| *name).find(is_expression) {
            let message = format!(
                "`{name}` is defined by an expression, which is part of the derived equations"
            );
            let wrong = Diagnostic::error(message);
            let wrong =
                wrong.with_help("set it in the specification before the equations are derived");
            return Err(Diagnostics::from_one(declared.source.clone(), wrong).into());
        }
        if !settings.is_empty() {
            check_coefficients(&model, compiled.orders())
                .map_err(|wrong| Diagnostics::from_one(declared.source.clone(), wrong))?;
        }
        let values = model.parameter_values().map_err(refused)?;
        let initial = model.initial_state(compiled.orders()).map_err(refused)?;
        let owned = settings.iter();
        let owned = owned.map(|(name, value)| ((*name).to_owned(), *value));
        let mut instance = Self {
            model: compiled,
            settings: owned.collect(),
            parameters: Vec::new(),
            initial,
            values,
        };
        let independent = instance.model.program().parameters.iter();
        let value = |name: &str| instance.value(name).unwrap_or(f64::NAN);
        instance.parameters = independent.map(|p| value(&p.quantity.name)).collect();
        Ok(instance)
    }

    /// Returns the changed parameters, in declared units.
    pub(crate) fn settings(&self) -> &[(String, f64)] {
        &self.settings
    }

    /// Returns the compiled model.
    pub fn model(&self) -> &CompiledModel {
        &self.model
    }

    /// Returns the specification's model at these parameter values.
    ///
    /// # Errors
    /// Invalid parameter values.
    pub fn valued_model(&self) -> Result<Model, Error> {
        let settings = self.settings.iter();
        let settings: Vec<(&str, f64)> = settings.map(|(name, v)| (&**name, *v)).collect();
        let declared = self.model.model();
        let valued = declared.with_parameters(&settings);
        valued.map_err(|error| Error::from_model_error(declared, error))
    }

    /// Returns the independent parameters, SI, in the order of
    /// [`parameter_names`](CompiledModel::parameter_names).
    pub fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    /// Returns all parameters of the specification, SI.
    pub(crate) fn values(&self) -> &[f64] {
        &self.values
    }

    /// Returns the value of any parameter of the specification, SI.
    pub fn value(&self, name: &str) -> Option<f64> {
        let parameters = &self.model.model().parameters;
        let place = parameters.iter().position(|known| known.name == name)?;
        self.values.get(place).copied()
    }

    /// Returns the initial state of the specification, SI.
    pub fn initial_state(&self) -> &[f64] {
        &self.initial
    }

    /// Returns the default inputs: 0, or the middle of the range for prescribed motion with a range.
    pub fn default_inputs(&self) -> HeldInputs {
        HeldInputs::constant(self.model.default_inputs())
    }

    /// Returns an evaluator at these parameters.
    ///
    /// # Errors
    /// [`Error::Request`] if the mass matrix is not positive definite.
    pub fn evaluator(&self) -> Result<Evaluator, Error> {
        require_positive_pivots(self.evaluator_unchecked())
    }

    /// Returns an evaluator for steps of fixed length.
    pub(crate) fn stepper(&self) -> Result<Evaluator, Error> {
        require_positive_pivots(self.model.stepper(&self.parameters)?)
    }

    /// Returns an evaluator without machine code, for a few evaluations.
    ///
    /// # Errors
    /// Same as [`Instance::evaluator`].
    pub fn interpreter(&self) -> Result<Evaluator, Error> {
        require_positive_pivots(self.model.interpreter(&self.parameters))
    }

    /// Returns an evaluator without checking that the mass matrix is positive definite. Its
    /// accelerations may be invalid.
    pub(crate) fn evaluator_unchecked(&self) -> Evaluator {
        self.model.evaluator(&self.parameters)
    }

    /// Returns the derivatives of the constraints at these parameters; `None` without constraints.
    pub(crate) fn constraint_rows(&self) -> Option<ConstraintRows> {
        let program = self.model.constraint_program(&self.values)?;
        let residuals = find_residual_indices(self.model.model(), program);
        let mut rows = ConstraintRows::new(program.clone(), residuals);
        rows.prepare(&self.parameters);
        Some(rows)
    }

    /// Returns [`CompiledModel::sided_model`] at the parameters of this instance.
    ///
    /// # Errors
    /// See [`CompiledModel::sided_model`].
    pub fn sided_model(&self) -> Result<Option<SidedModel>, Error> {
        self.model.sided_model(&self.parameters)
    }

    /// Returns [`CompiledModel::holding_model`] at the parameters of this instance.
    ///
    /// # Errors
    /// See [`CompiledModel::sided_model`].
    pub(crate) fn holding_model(&self) -> Result<Option<SidedModel>, Error> {
        self.model.holding_model(&self.parameters)
    }

    /// Returns the system of this instance for solvers, at the relative `tolerance` of the states: with projection onto
    /// the constraints, impacts and sticking. The system keeps the state of contacts and sticking, so use it for one
    /// motion only.
    ///
    /// # Errors
    /// See [`Instance::evaluator`].
    pub fn driven_model<E: Borrow<RefCell<Evaluator>>, I: Borrow<HeldInputs>>(
        &self,
        evaluator: E,
        inputs: I,
        tolerance: f64,
    ) -> Result<DrivenModel<E, I>, Error> {
        (self as &dyn MotionModel).driven_model(evaluator, inputs, tolerance)
    }

    /// Returns the consistent state nearest to `state` in the norm of the kinetic energy, and the changed values.
    ///
    /// # Errors
    /// [`Error::Request`] if a constraint depends on others at the state, or if no state near it satisfies the
    /// constraints; the message names them.
    pub fn find_consistent_state(
        &self,
        state: &[f64],
        t: f64,
        inputs: &HeldInputs,
    ) -> Result<(Vec<f64>, Vec<InitialChange>), Error> {
        (self as &dyn MotionModel).find_consistent_start(state, (t, t), inputs)
    }

    /// Returns an exact propagator at these parameters.
    ///
    /// # Errors
    /// The term that is not piecewise linear, or coefficients that are not finite.
    pub fn propagator(&self) -> Result<Propagator, ExactError> {
        let exact = self.model.piecewise_linear().map_err(Clone::clone)?;
        let value = |name: &String| self.value(name).unwrap_or(f64::NAN);
        let values: Vec<f64> = exact.parameter_names().iter().map(value).collect();
        exact.propagator_at(&values)
    }

    /// Returns the observables at every sample of a motion, one row per sample; `energy` and `power` are the last two.
    ///
    /// # Errors
    /// See [`Instance::evaluator`].
    pub fn observables(&self, motion: &Motion) -> Result<Vec<Vec<f64>>, Error> {
        let mut rows = Vec::with_capacity(motion.trajectory.times.len());
        self.observe(motion, |_, _, observables| rows.push(observables.to_vec()))?;
        Ok(rows)
    }

    /// Calls `show` with the time (s), state and observables of every sample of a motion. During sticking, the
    /// observables use the friction force that holds the motion.
    ///
    /// # Errors
    /// See [`Instance::evaluator`].
    pub fn observe(
        &self,
        motion: &Motion,
        mut show: impl FnMut(f64, &[f64], &[f64]),
    ) -> Result<(), Error> {
        let evaluator = self.evaluator()?;
        let mut observables = vec![0.0; evaluator.program().observables.len()];
        let trajectory = &motion.trajectory;
        let mut observed =
            ObservedMotion::new(evaluator, self.holding_model()?, trajectory, &motion.inputs);
        for (&t, state) in trajectory.times.iter().zip(&trajectory.states) {
            let inputs = &motion.inputs.evaluate(t);
            observed.observables(Point { t, state, inputs }, &mut observables);
            show(t, state, &observables);
        }
        Ok(())
    }
}
