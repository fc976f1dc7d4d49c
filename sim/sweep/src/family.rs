//! A derived model as a family over its parameters: the numbers of one member at a time.
//! The equations are derived once; parameters are numbers in their prepared stage.

use std::f64::consts::TAU;
use std::sync::Arc;

use codegen::program::Program;
use codegen::program::evaluator::{Evaluator, MachineCode};
use model_spec::model::Model;
use model_spec::unit::Unit;

use super::error::SweepError;
use super::measure::{Column, Failure};
use eomgen_compiled_model::driven::Driven;
use sim::inputs::HeldInputs;
use sim::ode::SolveError;
use sim::piecewise_linear::{ExactError, PiecewiseLinear, Propagator};

/// A derived model whose parameters are varied.
pub struct Family {
    model: Model,
    program: Program,
    code: Option<Arc<dyn MachineCode>>,
    orders: Vec<usize>,
    exact: Result<PiecewiseLinear, ExactError>,
}

/// One member of a family.
pub struct Member {
    /// The values of [`Program::parameters`], in SI: what
    /// [`Evaluator::prepare`](codegen::program::evaluator::Evaluator::prepare) takes.
    pub parameters: Vec<f64>,
    /// The initial state in SI.
    pub initial: Vec<f64>,
    /// The values of all parameters of the model, in SI and in the model's order.
    values: Vec<f64>,
}

impl Family {
    /// Takes a model and the program derived from it.
    ///
    /// Varied parameters must be numbers in `model` and not expressions, so that the program
    /// has them among its independent ones: derive the model at the grid's first point.
    pub fn new(model: Model, program: Program) -> Self {
        let orders: Vec<usize> = program.fields.iter().map(|field| field.order).collect();
        Self {
            exact: PiecewiseLinear::of(&model, &orders),
            model,
            program,
            code: None,
            orders,
        }
    }

    /// The same, its members computed by machine code made from its program.
    pub fn with_code(self, code: Option<Arc<dyn MachineCode>>) -> Self {
        Self { code, ..self }
    }

    /// The model.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The program of all members.
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// The member with some parameters set, each in the unit that the specification declares.
    ///
    /// # Errors
    /// [`Failure::Parameters`] where the model does not admit them.
    pub fn member(&self, settings: &[(&str, f64)]) -> Result<Member, Failure> {
        let refused = |_| Failure::Parameters;
        let model = self.model.with_parameters(settings).map_err(refused)?;
        let values = model.parameter_values().map_err(refused)?;
        let known = model.parameters.iter().map(|parameter| &parameter.name);
        let independent = |name: &String| known.clone().position(|known| known == name);
        let parameters = self
            .program
            .parameters
            .iter()
            .map(|p| independent(&p.quantity.name).map_or(f64::NAN, |place| values[place]))
            .collect();
        Ok(Member {
            parameters,
            initial: model.initial_state(&self.orders).map_err(refused)?,
            values,
        })
    }

    /// A member for the general solver, its inputs 0.
    ///
    /// # Errors
    /// [`Failure::Parameters`] where the mass matrix is not positive definite.
    pub fn driven(&self, member: &Member) -> Result<Driven, Failure> {
        let program = self.program.clone();
        let mut evaluator = match &self.code {
            Some(code) => Evaluator::with_code(program, code.clone()),
            None => Evaluator::new(program),
        };
        evaluator.prepare(&member.parameters);
        Driven::new(evaluator, self.inputs()).map_err(|_| Failure::Parameters)
    }

    /// The equations of all members for exact propagation; the error names the term that is
    /// not linear between switches.
    ///
    /// # Errors
    /// If there is such a term.
    pub fn exact(&self) -> Result<&PiecewiseLinear, &ExactError> {
        self.exact.as_ref()
    }

    /// A member for exact propagation.
    ///
    /// # Errors
    /// [`Failure::Parameters`] where the mass matrix is not positive definite, or a
    /// coefficient no number; [`Failure::Undefined`] for a family that is not linear between
    /// switches.
    pub fn propagator(&self, member: &Member) -> Result<Propagator, Failure> {
        let exact = self.exact().map_err(|_| Failure::Undefined)?;
        let known = &self.model.parameters;
        let value = |name: &String| {
            let place = known.iter().position(|parameter| parameter.name == *name);
            place.map_or(f64::NAN, |place| member.values[place])
        };
        let values: Vec<f64> = exact.parameters().iter().map(value).collect();
        Ok(exact.at(&values)?)
    }

    /// Inputs of 0, as many as the model has.
    pub fn inputs(&self) -> HeldInputs {
        HeldInputs::zero(self.model.inputs.len())
    }

    /// The parameter that is the angular frequency of the forcing.
    ///
    /// # Errors
    /// No such parameter, or one that is no frequency.
    pub fn frequency(&self, name: &str) -> Result<Frequency, SweepError> {
        let parameters = &self.model.parameters;
        let Some(place) = parameters.iter().position(|known| known.name == name) else {
            return Err(SweepError::Request(format!(
                "the model `{}` has no parameter `{name}`: give --frequency NAME, the parameter \
                 that is the angular frequency of the forcing in rad/s",
                self.model.name
            )));
        };
        let unit = &parameters[place].unit;
        let expected = Unit::parse("rad/s").map(|unit| unit.dimension);
        if Ok(unit.dimension) != expected {
            return Err(SweepError::Request(format!(
                "--frequency {name}: its unit is {unit}, where an angular frequency is in rad/s"
            )));
        }
        Ok(Frequency { place })
    }

    /// Parameters as columns of a result, in declared units.
    ///
    /// # Errors
    /// A name that is no parameter of the model.
    pub fn columns<'a>(
        &self,
        names: impl Iterator<Item = &'a str>,
    ) -> Result<Vec<Column>, SweepError> {
        let column = |name: &str| {
            let mut known = self.model.parameters.iter();
            let parameter = known.find(|known| known.name == name).ok_or_else(|| {
                SweepError::Request(format!("the model has no parameter `{name}`"))
            })?;
            Ok(Column::new(
                name,
                parameter.unit.to_string(),
                &parameter.doc,
            ))
        };
        names.map(column).collect()
    }
}

/// Which parameter is the angular frequency of the forcing.
#[derive(Clone, Copy, Debug)]
pub struct Frequency {
    place: usize,
}

impl Member {
    /// The period of the forcing, in s.
    ///
    /// # Errors
    /// [`Failure::Undefined`] where the frequency is not positive.
    pub fn period(&self, frequency: Frequency) -> Result<f64, Failure> {
        let omega = self.values.get(frequency.place).copied();
        let period = TAU / omega.unwrap_or(f64::NAN);
        if period > 0.0 && period.is_finite() {
            return Ok(period);
        }
        Err(Failure::Undefined)
    }
}

impl From<SolveError> for Failure {
    fn from(error: SolveError) -> Self {
        match error {
            SolveError::NotFinite { .. } | SolveError::NotPositiveDefinite { .. } => {
                Self::NotFinite
            }
            SolveError::Caught { .. } | SolveError::TooManySwitches { .. } => Self::Switching,
            _ => Self::Limit,
        }
    }
}

impl From<ExactError> for Failure {
    fn from(error: ExactError) -> Self {
        match error {
            ExactError::Stopped(error) => error.into(),
            ExactError::Held { .. } => Self::Switching,
            ExactError::NotConverged => Self::Limit,
            ExactError::NotLinear { .. } => Self::Undefined,
            ExactError::Model(_)
            | ExactError::NotFinite
            | ExactError::NotPositiveDefinite
            | ExactError::NegativeHalfWidth => Self::Parameters,
        }
    }
}
