//! Inputs given by expressions of time and parameters. Some are constant between their steps, such as `0.2*above(t -
//! 0.1)`. Every solver holds these inputs between the times of their steps.

use std::collections::HashMap;
use std::sync::Arc;

use eomgen_model_spec::assignment::Assignment;
use eomgen_model_spec::ast::BinaryOperator;
use eomgen_model_spec::evaluate::evaluate;
use eomgen_model_spec::model::{Expr, ExprKind, Function, Model};
use eomgen_sim::inputs::{HeldInputs, InputFunction};

use crate::error::Error;
use crate::fixed_steps::describe_prescribed_motion;
use crate::model::CompiledModel;
use crate::prescribed_inputs::{with_one_prescribed_input, with_prescribed_inputs};

/// Piecewise constant inputs, at any parameter values.
pub struct StepInputs {
    /// One entry per input of the model, in its order; `None` if no expression with steps drives it.
    inputs: Vec<Option<ExpressionInput>>,
}

struct ExpressionInput {
    /// Model in which the input is a definition.
    driven: Model,
    /// Function of time.
    value: Expr,
}

impl ExpressionInput {
    /// Returns an input with its index among the inputs of the model; `None` if its name is no longer a definition.
    fn new(model: &Model, given: &Assignment) -> Result<Option<(usize, Self)>, Error> {
        let driven = with_one_prescribed_input(model, given)?;
        let name = given.name();
        let place = model.inputs.iter().position(|input| input.name == name);
        let definition = driven.definitions.iter().find(|own| own.name == name);
        let (Some(place), Some(definition)) = (place, definition) else {
            return Ok(None);
        };
        let value = definition.value.clone();
        Ok(Some((place, Self { driven, value })))
    }

    /// Returns the parameter values of the function, SI.
    fn parameters(&self, settings: &[(&str, f64)]) -> Result<Vec<f64>, Error> {
        let refused = |error| Error::from_model_error(&self.driven, error);
        let valued = self.driven.with_parameters(settings).map_err(refused)?;
        valued.parameter_values().map_err(refused)
    }
}

impl StepInputs {
    /// Returns the model and the inputs that `given` holds between steps. Other inputs of `given` become definitions of
    /// the model. Returns `None` if no input is piecewise constant at these parameter values.
    ///
    /// # Errors
    /// See [`with_prescribed_inputs`](crate::with_prescribed_inputs).
    pub fn find(
        model: &Model,
        given: &[Assignment],
        settings: &[(&str, f64)],
    ) -> Result<Option<(Model, Self)>, Error> {
        let mut found: Vec<Option<ExpressionInput>> = model.inputs.iter().map(|_| None).collect();
        let (mut has_step, mut others) = (false, Vec::new());
        for given in given {
            let input = ExpressionInput::new(model, given)?;
            let steps = input.and_then(|(place, input)| {
                let has_rate = model.inputs[place].rate.is_some();
                let parameters = input.parameters(settings).ok().filter(|_| !has_rate)?;
                Some((place, step_times(&input.value, &parameters)?, input))
            });
            let Some((place, times, input)) = steps else {
                others.push(given.clone());
                continue;
            };
            if found[place].is_some() {
                return Ok(None);
            }
            has_step |= !times.is_empty();
            found[place] = Some(input);
        }
        // Controllers measure inputs, so constant inputs remain inputs too.
        let is_held = has_step || (!model.controllers.is_empty() && others.is_empty());
        if !is_held {
            return Ok(None);
        }
        let driven = with_prescribed_inputs(model.clone(), &others)?;
        let mut named: HashMap<&str, ExpressionInput> = (model.inputs.iter().zip(found))
            .filter_map(|(input, found)| Some((input.name.as_str(), found?)))
            .collect();
        let inputs = driven.inputs.iter();
        let inputs = inputs
            .map(|input| named.remove(input.name.as_str()))
            .collect();
        Ok(Some((driven, Self { inputs })))
    }

    /// Returns true if an expression with steps drives every input of the `declared` model that no controller drives.
    fn drives_all(&self, declared: &Model, model: &Model) -> bool {
        let mut places = self.inputs.iter().enumerate();
        model.inputs.len() == declared.inputs.len()
            && places.all(|(place, input)| input.is_some() || model.is_controlled(place))
    }

    /// Returns the inputs at parameter values in declared units, held between all steps. `others` has the inputs that
    /// no expression gives; they are constant.
    ///
    /// # Errors
    /// Inadmissible parameter values.
    pub fn held(&self, settings: &[(&str, f64)], others: &HeldInputs) -> Result<HeldInputs, Error> {
        let constant = others.last_sample(0.0);
        let parameters = self.inputs.iter().map(|input| match input {
            Some(input) => input.parameters(settings),
            None => Ok(Vec::new()),
        });
        let parameters = parameters.collect::<Result<Vec<_>, _>>()?;
        let each = || self.inputs.iter().zip(&parameters);
        let steps = each().filter_map(|(input, own)| step_times(&input.as_ref()?.value, own));
        let mut times: Vec<f64> = steps.flatten().collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        let values = |t: f64| {
            each().zip(constant).map(move |((input, own), other)| {
                let input = input.as_ref();
                input.map_or(*other, |input| value_at(&input.value, t, own))
            })
        };
        let (Some(first), Some(last)) = (times.first().copied(), times.last().copied()) else {
            return Ok(HeldInputs::constant(values(0.0).collect()));
        };
        // Evaluation times: one between two steps, and one before the first step.
        let next = times.iter().skip(1).copied().chain([last + 2.0]);
        let between = times.iter().zip(next);
        let between = between.map(|(time, next)| 0.5 * (time + next));
        let samples = std::iter::once(first - 1.0).chain(between);
        let rows: Vec<f64> = samples.flat_map(values).collect();
        times.insert(0, first - 1.0);
        let constant = || HeldInputs::constant(values(first).collect());
        Ok(HeldInputs::new(times, rows, self.inputs.len()).unwrap_or_else(constant))
    }
}

/// Input given by an expression of time, at fixed parameter values.
#[derive(Debug)]
struct InputAtParameters {
    value: Expr,
    /// Parameter values of `value`, SI.
    parameters: Vec<f64>,
}

impl InputFunction for InputAtParameters {
    fn write(&self, t: f64, out: &mut [f64]) {
        out.fill(value_at(&self.value, t, &self.parameters));
    }
}

/// Inputs that remain inputs of the model and are functions of time, at any parameter values.
pub struct FunctionInputs {
    /// Index of each input among the inputs of the model, and its expression.
    inputs: Vec<(usize, ExpressionInput)>,
}

impl FunctionInputs {
    /// Returns the inputs of a model that `given` prescribes.
    ///
    /// # Errors
    /// Prescribed motion, because the expression does not give its rates here; see also
    /// [`with_prescribed_inputs`](crate::with_prescribed_inputs).
    pub fn new(model: &Model, given: &[Assignment], role: InputRole) -> Result<Self, Error> {
        let mut inputs = Vec::with_capacity(given.len());
        for given in given {
            let Some((place, input)) = ExpressionInput::new(model, given)? else {
                continue;
            };
            if model.inputs[place].rate.is_some() {
                let reason = match role {
                    InputRole::Measured => {
                        "prescribed motion by an expression is not supported in a model with controllers".to_owned()
                    }
                    InputRole::Held => describe_prescribed_motion(given.name()),
                };
                return Err(given.name_error(reason, None).into());
            }
            inputs.push((place, input));
        }
        Ok(Self { inputs })
    }

    /// Adds the inputs to others, at parameter values in declared units.
    ///
    /// # Errors
    /// Inadmissible parameter values.
    pub fn add_to(
        &self,
        mut others: HeldInputs,
        settings: &[(&str, f64)],
    ) -> Result<HeldInputs, Error> {
        for (place, input) in &self.inputs {
            let function = InputAtParameters {
                parameters: input.parameters(settings)?,
                value: input.value.clone(),
            };
            others = others.with_function(*place, 1, Arc::new(function));
        }
        Ok(others)
    }
}

/// Role of inputs that are given by expressions and remain inputs of the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InputRole {
    /// Inputs that controllers measure.
    Measured,
    /// Inputs that fixed steps hold constant.
    Held,
}

/// Treatment of inputs that are given by expressions. Inputs without a role become definitions of the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InputTreatment {
    /// Role for which the inputs remain inputs of the model.
    pub role: Option<InputRole>,
    /// True if inputs may be held between their steps, because no record gives other inputs.
    pub may_hold: bool,
}

/// Inputs given by expressions of time and parameters, at any parameter values.
pub enum ExpressionInputs {
    /// Inputs that became definitions of the model.
    Definitions,
    /// Inputs that are constant between steps.
    Steps(StepInputs),
    /// Inputs that are functions of time.
    Functions(FunctionInputs),
}

impl ExpressionInputs {
    /// Derives a model with the inputs that `given` prescribes, and returns both. `settings` are parameters in declared
    /// units.
    ///
    /// # Errors
    /// See [`with_prescribed_inputs`](crate::with_prescribed_inputs) and `derive`.
    pub fn derive<E: From<Error>>(
        declared: Model,
        given: &[Assignment],
        (treatment, settings): (InputTreatment, &[(&str, f64)]),
        derive: impl Fn(Model) -> Result<CompiledModel, E>,
    ) -> Result<(CompiledModel, Self), E> {
        let steps = match treatment.may_hold {
            true => StepInputs::find(&declared, given, settings)?,
            false => None,
        };
        if let Some((model, steps)) = steps
            && (treatment.role.is_none() || steps.drives_all(&declared, &model))
        {
            return Ok((derive(model)?, Self::Steps(steps)));
        }
        if let Some(role) = treatment.role {
            let functions = FunctionInputs::new(&declared, given, role)?;
            return Ok((derive(declared)?, Self::Functions(functions)));
        }
        let model = derive(with_prescribed_inputs(declared, given)?)?;
        Ok((model, Self::Definitions))
    }

    /// Returns true if inputs vary between steps. The exact solver does not support such inputs.
    pub fn are_time_varying(&self) -> bool {
        matches!(self, Self::Functions(functions) if !functions.inputs.is_empty())
    }

    /// Returns the inputs at parameter values in declared units. `others` returns the inputs that no expression gives.
    ///
    /// # Errors
    /// Inadmissible parameter values, and the errors of `others`.
    pub fn at<E: From<Error>>(
        &self,
        settings: &[(&str, f64)],
        others: impl FnOnce() -> Result<HeldInputs, E>,
    ) -> Result<HeldInputs, E> {
        match self {
            Self::Definitions => others(),
            Self::Steps(steps) => Ok(steps.held(settings, &others()?)?),
            Self::Functions(functions) => Ok(functions.add_to(others()?, settings)?),
        }
    }
}

/// Returns the times at which an expression steps; `None` if it also varies between steps, or depends on more than
/// parameters and time.
fn step_times(expr: &Expr, parameters: &[f64]) -> Option<Vec<f64>> {
    match &expr.kind {
        ExprKind::Number(_) | ExprKind::Pi | ExprKind::Parameter(_) => Some(Vec::new()),
        ExprKind::Negate(operand) => step_times(operand, parameters),
        ExprKind::Binary(_, left, right) => {
            let left = step_times(left, parameters)?;
            Some([left, step_times(right, parameters)?].concat())
        }
        ExprKind::Call(Function::Above, arguments) => {
            let [argument] = &arguments[..] else {
                return None;
            };
            if !is_affine(argument) {
                return None;
            }
            let [start, later] = [0.0, 1.0].map(|t| value_at(argument, t, parameters));
            let time = -start / (later - start);
            // An argument that does not depend on time is constant and never steps.
            Some(time.is_finite().then_some(time).into_iter().collect())
        }
        ExprKind::Call(_, arguments) => {
            let all = arguments.iter().map(|own| step_times(own, parameters));
            Some(all.collect::<Option<Vec<_>>>()?.concat())
        }
        _ => None,
    }
}

/// Returns true if an expression of parameters and time is at most linear in time.
fn is_affine(expr: &Expr) -> bool {
    match &expr.kind {
        ExprKind::Number(_) | ExprKind::Pi | ExprKind::Parameter(_) | ExprKind::Time => true,
        ExprKind::Negate(operand) => is_affine(operand),
        ExprKind::Binary(operator, left, right) => {
            let is_constant = |side: &Expr| is_affine(side) && !mentions_time(side);
            match operator {
                BinaryOperator::Add | BinaryOperator::Subtract => {
                    is_affine(left) && is_affine(right)
                }
                BinaryOperator::Multiply => {
                    (is_constant(left) && is_affine(right))
                        || (is_affine(left) && is_constant(right))
                }
                BinaryOperator::Divide => is_affine(left) && is_constant(right),
                BinaryOperator::Power => is_constant(left) && is_constant(right),
            }
        }
        _ => false,
    }
}

fn mentions_time(expr: &Expr) -> bool {
    match &expr.kind {
        ExprKind::Time => true,
        ExprKind::Negate(operand) => mentions_time(operand),
        ExprKind::Binary(_, left, right) => mentions_time(left) || mentions_time(right),
        ExprKind::Call(_, arguments) => arguments.iter().any(mentions_time),
        _ => false,
    }
}

/// Returns the value of an expression of parameters and time.
fn value_at(expr: &Expr, t: f64, parameters: &[f64]) -> f64 {
    let mut at_time = expr.clone();
    set_time(&mut at_time, t);
    evaluate(&at_time, parameters)
}

fn set_time(expr: &mut Expr, t: f64) {
    match &mut expr.kind {
        ExprKind::Time => expr.kind = ExprKind::Number(t),
        ExprKind::Negate(operand) => set_time(operand, t),
        ExprKind::Binary(_, left, right) => {
            set_time(left, t);
            set_time(right, t);
        }
        ExprKind::Call(_, arguments) => {
            for argument in arguments {
                set_time(argument, t);
            }
        }
        _ => {}
    }
}
