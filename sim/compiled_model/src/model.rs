//! A model with all that is made of it once: its equations, program, machine code and
//! piecewise-linear form.

use std::path::Path;
use std::sync::{Arc, OnceLock};

use eomgen_codegen::independence::rows::constraint_program;
use eomgen_codegen::mechanics::equations::Equations;
use eomgen_codegen::mechanics::sliding::may_hold;
use eomgen_codegen::program::Program;
use eomgen_codegen::program::evaluator::{Evaluator, MachineCode};
use eomgen_codegen::variant::{Variant, derive_sliding};
use eomgen_model_spec::Checked;
use eomgen_model_spec::diagnostic::Diagnostics;
use eomgen_model_spec::model::Model;
use eomgen_model_spec::source::Source;
use eomgen_sim::piecewise_linear::{ExactError, PiecewiseLinear};

use crate::differentiated::Differentiated;
use crate::error::Error;
use crate::sliding::Sided;
use crate::typical_sizes::typical_sizes;

/// The modal truncation orders that a model is derived at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Orders<'o> {
    /// Those that the specification declares.
    Declared,
    /// This one for every field.
    All(usize),
    /// One for each field, in the order of the specification.
    Each(&'o [usize]),
}

impl Orders<'_> {
    /// The order of each field of a model.
    ///
    /// # Errors
    /// An order above the limit, orders where there is no field, or as many as there are not.
    pub fn of(self, model: &Model) -> Result<Vec<usize>, Error> {
        let one = match self {
            Self::Declared => None,
            Self::All(order) => Some(order),
            Self::Each(orders) if orders.len() == model.fields.len() => {
                for order in orders {
                    let checked = model.orders(Some(*order));
                    checked.map_err(|error| Error::model(model, error))?;
                }
                return Ok(orders.to_vec());
            }
            Self::Each(orders) => {
                return Err(Error::Request(format!(
                    "{} orders are given for {} fields of the model `{}`",
                    orders.len(),
                    model.fields.len(),
                    model.name
                )));
            }
        };
        let orders = model.orders(one);
        orders.map_err(|error| Error::model(model, error))
    }
}

/// The program whose rates take sides of surfaces as inputs, and its machine code.
type SidedProgram = (Program, Option<Arc<dyn MachineCode>>);

/// A derived model that can be run at any values of its independent parameters. Machine code
/// and the piecewise-linear form are made when they are first asked for, once; the model may
/// be shared between threads.
pub struct CompiledModel {
    model: Model,
    orders: Vec<usize>,
    equations: Equations,
    program: Program,
    code: OnceLock<Option<Arc<dyn MachineCode>>>,
    piecewise_linear: OnceLock<Result<PiecewiseLinear, ExactError>>,
    differentiated: OnceLock<Result<Differentiated, Diagnostics>>,
    sided: OnceLock<Result<Option<SidedProgram>, Diagnostics>>,
    constraints: OnceLock<Option<Program>>,
    typical_sizes: OnceLock<Vec<f64>>,
}

impl CompiledModel {
    /// Reads, checks and derives a specification. Its warnings are dropped: who shows them reads
    /// it with [`eomgen_model_spec::load`] and goes on with [`CompiledModel::derive`].
    ///
    /// # Errors
    /// [`Error::Specification`] with what is wrong, each at its place.
    pub fn load(path: impl AsRef<Path>, orders: Orders<'_>) -> Result<Self, Error> {
        let Checked { model, .. } = eomgen_model_spec::load(path.as_ref())?;
        Self::derive(model, orders)
    }

    /// The same from a text; `name` stands for its file in messages.
    ///
    /// # Errors
    /// As [`CompiledModel::load`].
    pub fn of_text(name: &str, text: &str, orders: Orders<'_>) -> Result<Self, Error> {
        let Checked { model, .. } = eomgen_model_spec::check(Source::new(name, text))?;
        Self::derive(model, orders)
    }

    /// Derives a checked model.
    ///
    /// # Errors
    /// [`Error::Specification`]: orders, parameter values that are not admissible, what cannot
    /// be derived, and coordinates without inertia at the initial state.
    pub fn derive(model: Model, orders: Orders<'_>) -> Result<Self, Error> {
        let orders = orders.of(&model)?;
        let derived = Variant::derive(&model, &orders)?;
        Ok(Self::new(model, orders, derived))
    }

    /// The same for readers, and for who judges other parameters: also a model in which
    /// something has no inertia at its own parameters and initial state.
    ///
    /// # Errors
    /// As [`CompiledModel::derive`], but those about inertia.
    pub fn derive_unjudged(model: Model, orders: Orders<'_>) -> Result<Self, Error> {
        let orders = orders.of(&model)?;
        let derived = Variant::derive_to_read(&model, &orders, &[])?;
        Ok(Self::new(model, orders, derived))
    }

    fn new(model: Model, orders: Vec<usize>, derived: Variant) -> Self {
        Self {
            model,
            orders,
            equations: derived.equations,
            program: derived.program,
            code: OnceLock::new(),
            piecewise_linear: OnceLock::new(),
            differentiated: OnceLock::new(),
            sided: OnceLock::new(),
            constraints: OnceLock::new(),
            typical_sizes: OnceLock::new(),
        }
    }

    /// The checked model.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The order of each field.
    pub fn orders(&self) -> &[usize] {
        &self.orders
    }

    /// The equations of motion.
    pub fn equations(&self) -> &Equations {
        &self.equations
    }

    /// The program of the equations.
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// The names of the states: coordinates and modes, then their rates, then states of first order.
    pub fn state_names(&self) -> Vec<String> {
        self.program.state_names()
    }

    /// The SI units of the states: those of coordinates and modes, then the same per second, then
    /// those of states of first order.
    pub fn state_units(&self) -> Vec<String> {
        let coordinates = self.model.coordinates.iter();
        let mut units: Vec<String> = coordinates.map(|known| known.unit.to_string()).collect();
        for (field, order) in self.model.fields.iter().zip(&self.orders) {
            units.extend(std::iter::repeat_n(field.unit.to_string(), *order));
        }
        let rates: Vec<String> = units.iter().map(|unit| format!("{unit}/s")).collect();
        units.extend(rates);
        let first_order = self.model.states.iter();
        units.extend(first_order.map(|state| state.unit.to_string()));
        units
    }

    /// Inputs where nobody gives them, SI: 0, and prescribed motion in the middle of its range, if it
    /// has one.
    pub fn usual_inputs(&self) -> Vec<f64> {
        let none = || vec![0.0; self.model.inputs.len()];
        self.model.typical_inputs(0.0).unwrap_or_else(|_| none())
    }

    /// Typical sizes of the states in SI, by their units: powers of two to which the model's parameters, initial
    /// values and ranges lead.
    pub fn typical_sizes(&self) -> &[f64] {
        let sizes = || typical_sizes(&self.model, &self.orders);
        self.typical_sizes.get_or_init(sizes)
    }

    /// The names of the observables, `energy` and `power` last.
    pub fn observable_names(&self) -> Vec<String> {
        let observables = self.program.observables.iter();
        observables.map(|known| known.name.clone()).collect()
    }

    /// The names of the independent parameters, those given by a number, in the order of their
    /// values.
    pub fn parameter_names(&self) -> Vec<String> {
        let parameters = self.program.parameters.iter();
        parameters
            .map(|known| known.quantity.name.clone())
            .collect()
    }

    /// An evaluator of the program at these values of the independent parameters, SI: machine
    /// code where this kind of machine is known, interpreted elsewhere, with the same numbers.
    pub fn evaluator(&self, parameters: &[f64]) -> Evaluator {
        let code = self.code.get_or_init(|| eomgen_jit::code(&self.program));
        evaluator(&self.program, code.as_ref(), parameters)
    }

    /// An evaluator that interprets the program: the same numbers as machine code, which takes longer to
    /// make than a few evaluations.
    pub(crate) fn interpreter(&self, parameters: &[f64]) -> Evaluator {
        evaluator(&self.program, None, parameters)
    }

    /// Derives the Jacobians, once, which are derived when they are first asked for.
    ///
    /// # Errors
    /// What cannot be differentiated.
    pub fn differentiate(&self) -> Result<(), Error> {
        self.differentiated().map(|_| ())
    }

    /// The program with the derivatives of the constraints, if there are any; lowered once, at these values of
    /// all parameters, SI.
    pub(crate) fn constraint_program(&self, values: &[f64]) -> Option<&Program> {
        let made = self
            .constraints
            .get_or_init(|| constraint_program(&self.model, &self.equations, values));
        made.as_ref()
    }

    /// The program with Jacobians.
    pub(crate) fn differentiated(&self) -> Result<&Differentiated, Error> {
        let made = self
            .differentiated
            .get_or_init(|| Differentiated::of(self.model(), self.orders()));
        made.as_ref().map_err(|found| found.clone().into())
    }

    /// The model with the sides of surfaces that may hold a motion as inputs, at these values of the
    /// independent parameters, SI; nothing where no surface may, or where contacts would have to be held with
    /// them.
    ///
    /// # Errors
    /// What cannot be derived.
    pub fn sided(&self, parameters: &[f64]) -> Result<Option<Sided>, Error> {
        let made = self.sided.get_or_init(|| {
            if !may_hold(&self.equations) || !self.model.impacts.is_empty() {
                return Ok(None);
            }
            let program = derive_sliding(&self.model, &self.orders)?;
            Ok(program.map(|program| {
                let code = eomgen_jit::code(&program);
                (program, code)
            }))
        });
        let made = made.as_ref().map_err(|found| Error::from(found.clone()))?;
        let sided = made
            .as_ref()
            .map(|(program, code)| Sided::new(evaluator(program, code.as_ref(), parameters)));
        Ok(sided)
    }

    /// The model's form that is linear between its switches.
    ///
    /// # Errors
    /// The term that is not linear there.
    pub fn piecewise_linear(&self) -> Result<&PiecewiseLinear, &ExactError> {
        let made = self
            .piecewise_linear
            .get_or_init(|| PiecewiseLinear::of(&self.model, &self.orders));
        made.as_ref()
    }
}

/// An evaluator of a program, by its machine code if there is some, prepared at these values of
/// the independent parameters, SI.
pub(crate) fn evaluator(
    program: &Program,
    code: Option<&Arc<dyn MachineCode>>,
    parameters: &[f64],
) -> Evaluator {
    let program = program.clone();
    let mut evaluator = match code {
        Some(code) => Evaluator::with_code(program, code.clone()),
        None => Evaluator::new(program),
    };
    evaluator.prepare(parameters);
    evaluator
}
