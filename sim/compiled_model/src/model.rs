//! Compiled models: equations, program, machine code and piecewise-linear form of a specification.

use std::cell::RefCell;
use std::path::Path;
use std::sync::{Arc, OnceLock};

use eomgen_codegen::independence::constraint_program::{constraint_program, find_residual_indices};
use eomgen_codegen::independence::rows::ConstraintRows;
use eomgen_codegen::mechanics::equations::Equations;
use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::program::Program;
use eomgen_codegen::program::evaluator::{Evaluator, MachineCode};
use eomgen_codegen::variant::{
    Variant, lower_corners, lower_for_gradients, lower_with_derivatives, lower_with_sides,
};
use eomgen_model_spec::Checked;
use eomgen_model_spec::diagnostic::Diagnostics;
use eomgen_model_spec::dimension::Dimension;
use eomgen_model_spec::model::{Model, STABILISATION_RATE};
use eomgen_model_spec::source::Source;
use eomgen_model_spec::unit::Unit;
use eomgen_sim::piecewise_linear::{ExactError, PiecewiseLinear};

use crate::corners::Corners;
use crate::error::Error;
use crate::evaluation::prepare_evaluator;
use crate::jacobian_program::{ALONG_DIRECTION, ENTRY_BY_ENTRY, JacobianProgram};
use crate::labels::{ConstraintLabel, ImpactLabel, Labels};
use crate::projection::{LARGE_RATE_PER_S, Projection, find_unmoved_sizes};
use crate::statistics::Quantity;
use crate::sticking::SidedModel;
use crate::typical_sizes::{TypicalSizes, compute_typical_sizes};

/// Modal truncation orders at which a model is derived.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Orders<'o> {
    /// The orders that the specification declares.
    Declared,
    /// The same order for every field.
    Uniform(usize),
    /// One order per field, in the order of the specification.
    PerField(&'o [usize]),
}

impl Orders<'_> {
    /// Returns the order of each field of a model.
    ///
    /// # Errors
    /// An order above the limit, an order for a model without fields, or the wrong number of
    /// orders.
    pub fn resolve(self, model: &Model) -> Result<Vec<usize>, Error> {
        let one = match self {
            Self::Declared => None,
            Self::Uniform(order) => Some(order),
            Self::PerField(orders) if orders.len() == model.fields.len() => {
                for order in orders {
                    let checked = model.orders(Some(*order));
                    checked.map_err(|error| Error::from_model_error(model, error))?;
                }
                return Ok(orders.to_vec());
            }
            Self::PerField(orders) => {
                return Err(Error::Request(format!(
                    "{} orders are given for {} fields of the model `{}`",
                    orders.len(),
                    model.fields.len(),
                    model.name
                )));
            }
        };
        let orders = model.orders(one);
        orders.map_err(|error| Error::from_model_error(model, error))
    }
}

/// Derived model, independent of parameter values. Machine code, Jacobians and the piecewise-linear form are created at
/// first use and kept. Threads may share the model.
pub struct CompiledModel {
    model: Model,
    orders: Vec<usize>,
    equations: Equations,
    program: Program,
    code: OnceLock<Option<Arc<dyn MachineCode>>>,
    piecewise_linear: OnceLock<Result<PiecewiseLinear, ExactError>>,
    differentiated: OnceLock<Result<JacobianProgram, Diagnostics>>,
    tangents: OnceLock<Result<JacobianProgram, Diagnostics>>,
    /// Program for the gradients of trajectories.
    gradients: OnceLock<Result<JacobianProgram, Diagnostics>>,
    /// Program whose rates take the sides of surfaces as inputs, and its machine code.
    sided: OnceLock<Result<Option<Program>, Diagnostics>>,
    sided_code: OnceLock<Option<Arc<dyn MachineCode>>>,
    /// Program with the output `step`, and its machine code.
    stepped: OnceLock<Result<Program, Diagnostics>>,
    stepped_code: OnceLock<Option<Arc<dyn MachineCode>>>,
    corners: OnceLock<Result<Option<Program>, Diagnostics>>,
    constraints: OnceLock<Option<Program>>,
    typical_sizes: OnceLock<Vec<f64>>,
    labels: OnceLock<Labels>,
}

impl CompiledModel {
    /// Reads, checks and derives a specification. Warnings are dropped; to show them, read with
    /// [`eomgen_model_spec::load`] and call [`CompiledModel::derive`].
    ///
    /// # Errors
    /// [`Error::Specification`] with every error and its location.
    pub fn load(path: impl AsRef<Path>, orders: Orders<'_>) -> Result<Self, Error> {
        let Checked { model, .. } = eomgen_model_spec::load(path.as_ref())?;
        Self::derive(model, orders)
    }

    /// Checks and derives the specification in `text`. Messages use `name` as its file name.
    ///
    /// # Errors
    /// See [`CompiledModel::load`].
    pub fn from_text(name: &str, text: &str, orders: Orders<'_>) -> Result<Self, Error> {
        let Checked { model, .. } = eomgen_model_spec::check(Source::new(name, text))?;
        Self::derive(model, orders)
    }

    /// Derives a checked model.
    ///
    /// # Errors
    /// [`Error::Specification`]: invalid orders or parameter values, terms that cannot be derived,
    /// and coordinates without inertia at the initial state.
    pub fn derive(model: Model, orders: Orders<'_>) -> Result<Self, Error> {
        let orders = orders.resolve(&model)?;
        let derived = Variant::derive(&model, &orders)?;
        Ok(Self::new(model, orders, derived))
    }

    /// Derives a checked model without checking inertia at its own parameters and initial state, for example to read
    /// its equations or to run it at other parameters.
    ///
    /// # Errors
    /// The errors of [`CompiledModel::derive`], except those about inertia.
    pub fn derive_without_inertia_check(model: Model, orders: Orders<'_>) -> Result<Self, Error> {
        let orders = orders.resolve(&model)?;
        let derived = Variant::derive_for_report(&model, &orders, &[])?;
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
            tangents: OnceLock::new(),
            gradients: OnceLock::new(),
            corners: OnceLock::new(),
            sided: OnceLock::new(),
            sided_code: OnceLock::new(),
            stepped: OnceLock::new(),
            stepped_code: OnceLock::new(),
            constraints: OnceLock::new(),
            typical_sizes: OnceLock::new(),
            labels: OnceLock::new(),
        }
    }

    /// Returns the checked model.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Returns the order of each field.
    pub fn orders(&self) -> &[usize] {
        &self.orders
    }

    /// Returns the equations of motion.
    pub fn equations(&self) -> &Equations {
        &self.equations
    }

    /// Returns a note for each group of linearly dependent constraints.
    pub fn redundancy_notes(&self) -> Vec<String> {
        self.equations.redundancy.describe(&self.model)
    }

    /// Returns the program of the equations.
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// Returns the names of the states: coordinates and modes, their rates, then first-order
    /// states.
    pub fn state_names(&self) -> Vec<String> {
        self.program.state_names()
    }

    /// Returns the SI units of the states, in the order of [`CompiledModel::state_names`].
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

    /// Returns the default inputs, SI: 0, or the middle of the range for prescribed motion with a range.
    pub fn default_inputs(&self) -> Vec<f64> {
        let none = || vec![0.0; self.model.inputs.len()];
        self.model.typical_inputs(0.0).unwrap_or_else(|_| none())
    }

    /// Returns the typical sizes of the states, SI: powers of two that follow from the units and
    /// from the parameters, initial values and ranges of the model. See
    /// [`TypicalSizes`](crate::TypicalSizes).
    pub fn typical_sizes(&self) -> &[f64] {
        let sizes = || compute_typical_sizes(&self.model, &self.orders);
        self.typical_sizes.get_or_init(sizes)
    }

    /// Returns the names, units and sizes that motions need.
    pub(crate) fn labels(&self) -> &Labels {
        self.labels.get_or_init(|| {
            let coordinates = self.model.coordinates.iter();
            let dimensions: Vec<_> = coordinates.map(|own| own.unit.dimension).collect();
            let impacts = self.model.impacts.iter().map(|impact| ImpactLabel {
                name: impact.name.clone(),
                unit: impact.unit.to_string(),
                coordinates: (0..dimensions.len())
                    .filter(|own| dimensions[*own] == impact.unit.dimension)
                    .collect(),
            });
            let constraints = self.model.constraints.iter();
            let constraints = constraints.map(|constraint| ConstraintLabel {
                name: constraint.name.clone(),
                unit: constraint.unit.to_string(),
                is_nonholonomic: constraint.is_nonholonomic,
            });
            Labels {
                state_names: self.state_names(),
                state_units: self.state_units(),
                typical_sizes: self.typical_sizes().to_vec(),
                impacts: impacts.collect(),
                constraints: constraints.collect(),
                constraint_excess: self.equations.redundancy.excess(),
            }
        })
    }

    /// Returns the names of the observables; `energy` and `power` are the last two.
    pub fn observable_names(&self) -> Vec<String> {
        let observables = self.program.observables.iter();
        observables.map(|known| known.name.clone()).collect()
    }

    /// Returns the typical size of a quantity, SI; see [`TypicalSizes`].
    pub fn typical_size(&self, quantity: Quantity) -> f64 {
        match quantity {
            Quantity::State(place) => self.typical_sizes()[place],
            Quantity::Observable(place) => {
                let unit = Unit::parse(&self.program.observables[place].unit);
                let dimension = unit.map_or(Dimension::DIMENSIONLESS, |unit| unit.dimension);
                TypicalSizes::new(self.model(), self.orders()).typical_size(dimension)
            }
        }
    }

    /// Returns the names of the independent parameters (those given by a number), in the order of
    /// their values.
    pub fn parameter_names(&self) -> Vec<String> {
        let parameters = self.program.parameters.iter();
        parameters
            .map(|known| known.quantity.name.clone())
            .collect()
    }

    /// Returns an evaluator of the program at the given values of the independent parameters, SI. It runs machine code
    /// if the processor is supported, and interprets the program otherwise; both give the same numbers.
    pub fn evaluator(&self, parameters: &[f64]) -> Evaluator {
        let code = self.code.get_or_init(|| eomgen_jit::code(&self.program));
        prepare_evaluator(&self.program, code.as_ref(), parameters)
    }

    /// Returns an evaluator that interprets the program. Machine code gives the same numbers, but its generation takes
    /// longer than a few evaluations.
    pub(crate) fn interpreter(&self, parameters: &[f64]) -> Evaluator {
        prepare_evaluator(&self.program, None, parameters)
    }

    /// Derives the Jacobians now. Otherwise they are derived at their first use.
    ///
    /// # Errors
    /// Terms that cannot be differentiated.
    pub fn differentiate(&self) -> Result<(), Error> {
        self.jacobian_program().map(|_| ())
    }

    /// Returns the program of the constraint derivatives; `None` without constraints. It is lowered once, at the given
    /// values of all parameters, SI.
    pub(crate) fn constraint_program(&self, values: &[f64]) -> Option<&Program> {
        let made = self
            .constraints
            .get_or_init(|| constraint_program(&self.model, &self.equations, values));
        made.as_ref()
    }

    pub(crate) fn jacobian_program(&self) -> Result<&JacobianProgram, Error> {
        let made = self
            .differentiated
            .get_or_init(|| JacobianProgram::lower(&self.model, &self.equations, &ENTRY_BY_ENTRY));
        made.as_ref().map_err(|found| found.clone().into())
    }

    /// Returns the program of the derivatives along a direction and with respect to time.
    pub(crate) fn tangent_program(&self) -> Result<&Program, Error> {
        let made = self
            .tangents
            .get_or_init(|| JacobianProgram::lower(&self.model, &self.equations, &ALONG_DIRECTION));
        let made = made.as_ref().map(|made| &made.program);
        made.map_err(|found| found.clone().into())
    }

    /// Returns the program for the gradients of trajectories.
    pub(crate) fn gradient_program(&self) -> Result<&JacobianProgram, Error> {
        let made = self.gradients.get_or_init(|| {
            lower_for_gradients(&self.model, &self.equations).map(JacobianProgram::new)
        });
        made.as_ref().map_err(|found| found.clone().into())
    }

    /// Returns residuals and derivatives of the constraints at the given values of the independent parameters, SI;
    /// `None` without constraints.
    pub fn constraint_rows(&self, parameters: &[f64]) -> Option<ConstraintRows> {
        let values = self.model.parameter_values().ok()?;
        let program = self.constraint_program(&values)?;
        let residuals = find_residual_indices(&self.model, program);
        let mut rows = ConstraintRows::new(program.clone(), residuals);
        rows.prepare(parameters);
        Some(rows)
    }

    /// Returns the projection onto the constraints at the given values of the independent parameters, SI; `None`
    /// without constraints. It does not stop motions at singular positions.
    pub fn projection(&self, parameters: &[f64]) -> Option<Projection> {
        if self.model.constraints.is_empty() {
            return None;
        }
        let known = self.program.parameters.iter();
        let place = (known.map(|own| &own.quantity.name)).position(|n| n == STABILISATION_RATE)?;
        let at = |rate: f64| {
            let mut values = parameters.to_vec();
            values[place] = rate;
            RefCell::new(self.evaluator(&values))
        };
        Some(Projection {
            positive_rate_model: at(LARGE_RATE_PER_S),
            negative_rate_model: at(-LARGE_RATE_PER_S),
            stabilisation_rate: parameters[place],
            unmoved_sizes: find_unmoved_sizes(
                self.typical_sizes(),
                self.program.degrees_of_freedom(),
            ),
            singularity_watch: None,
        })
    }

    /// Returns the model in which the sides of switching surfaces are inputs, at the given values of the independent
    /// parameters, SI. `None` without surfaces.
    ///
    /// # Errors
    /// Inadmissible parameter values.
    pub fn sided_model(&self, parameters: &[f64]) -> Result<Option<SidedModel>, Error> {
        let sided = self.sided_program()?.map(|program| {
            let code = self.sided_code.get_or_init(|| eomgen_jit::code(program));
            SidedModel::new(prepare_evaluator(program, code.as_ref(), parameters))
        });
        Ok(sided)
    }

    /// Returns [`CompiledModel::sided_model`] if its surfaces can hold the motion. Otherwise compiles nothing and
    /// returns `None`.
    pub(crate) fn holding_model(&self, parameters: &[f64]) -> Result<Option<SidedModel>, Error> {
        match self.sided_program()? {
            Some(program) if !program.outputs.sliding.is_empty() => self.sided_model(parameters),
            _ => Ok(None),
        }
    }

    pub(crate) fn sided_program(&self) -> Result<Option<&Program>, Error> {
        let made = self
            .sided
            .get_or_init(|| lower_with_sides(&self.model, &self.equations));
        let made = made.as_ref().map_err(|found| Error::from(found.clone()))?;
        Ok(made.as_ref())
    }

    /// Returns an evaluator for steps of fixed length, at the given values of the independent parameters, SI.
    ///
    /// # Errors
    /// A model that fixed steps do not support.
    pub(crate) fn stepper(&self, parameters: &[f64]) -> Result<Evaluator, Error> {
        let made = self
            .stepped
            .get_or_init(|| lower_with_derivatives(&self.model, &self.equations, &[Output::Step]));
        let program = made.as_ref().map_err(|found| Error::from(found.clone()))?;
        let code = self.stepped_code.get_or_init(|| eomgen_jit::code(program));
        Ok(prepare_evaluator(program, code.as_ref(), parameters))
    }

    /// Returns the corners of a motion at the given values of the independent parameters, SI. `None` if no momentum can
    /// jump.
    ///
    /// # Errors
    /// Terms that cannot be derived.
    pub(crate) fn corners(&self, parameters: &[f64]) -> Result<Option<Corners>, Error> {
        let program = self.corner_program()?;
        let evaluator = |program| prepare_evaluator(program, None, parameters);
        Ok(program.map(|program| Corners::new(evaluator(program))))
    }

    pub(crate) fn corner_program(&self) -> Result<Option<&Program>, Error> {
        let made = self
            .corners
            .get_or_init(|| lower_corners(&self.model, &self.orders, &self.equations));
        let made = made.as_ref().map_err(|found| Error::from(found.clone()))?;
        Ok(made.as_ref())
    }

    /// Returns the function of the first surface at which the energies jump, so that rates jump; `None` without such a
    /// surface.
    pub fn first_corner(&self) -> Option<&str> {
        let mut guards = self.program.guards.iter();
        let corner = guards.find(|guard| guard.is_corner)?;
        Some(&corner.formula)
    }

    /// Returns the piecewise-linear form of the model.
    ///
    /// # Errors
    /// The term that is not piecewise linear.
    pub fn piecewise_linear(&self) -> Result<&PiecewiseLinear, &ExactError> {
        let made = self
            .piecewise_linear
            .get_or_init(|| PiecewiseLinear::from_equations(&self.model, &self.equations));
        made.as_ref()
    }
}
