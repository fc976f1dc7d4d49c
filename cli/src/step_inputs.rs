//! Inputs of `--input` that are constant between steps, such as `0.2*above(t - 0.1)`. The exact solver
//! holds them between these times.

use eomgen_model_spec::ast::BinaryOperator;
use eomgen_model_spec::evaluate::evaluate;
use eomgen_model_spec::model::{Expr, ExprKind, Function, Model};
use eomgen_sim::inputs::HeldInputs;

use crate::error::Result;
use crate::settings::{with_inputs, with_settings};

/// Input that is constant between the times of its steps.
pub struct StepInput {
    /// Index among the inputs of the model.
    place: usize,
    /// Function of time.
    value: Expr,
    /// Values of the parameters of `value`, SI.
    parameters: Vec<f64>,
    /// Times of the steps, s.
    times: Vec<f64>,
}

/// Returns the inputs that `prescribed` drives, if it drives all inputs of the model and each is constant
/// between steps, one of them with a step.
///
/// # Errors
/// Same as [`with_inputs`] and [`with_settings`].
pub fn step_inputs(
    model: &Model,
    prescribed: &[String],
    settings: &[String],
) -> Result<Option<Vec<StepInput>>> {
    let mut found = Vec::new();
    for text in prescribed {
        let driven = with_inputs(model.clone(), std::slice::from_ref(text))?;
        let driven = with_settings(driven, settings)?;
        let name = text.split('=').next().unwrap_or_default().trim();
        let place = model.inputs.iter().position(|input| input.name == name);
        let definition = driven.definitions.iter().find(|own| own.name == name);
        let (Some(place), Some(definition)) = (place, definition) else {
            return Ok(None);
        };
        let has_rate = model.inputs[place].rate.is_some();
        let (Ok(parameters), false) = (driven.parameter_values(), has_rate) else {
            return Ok(None);
        };
        let Some(times) = step_times(&definition.value, &parameters) else {
            return Ok(None);
        };
        found.push(StepInput {
            place,
            value: definition.value.clone(),
            parameters,
            times,
        });
    }
    let drives = |place: usize| found.iter().filter(|step| step.place == place).count() == 1;
    let drives_all = (0..model.inputs.len()).all(drives) && found.len() == model.inputs.len();
    let has_step = found.iter().any(|step| !step.times.is_empty());
    Ok((drives_all && has_step).then_some(found))
}

/// Returns the inputs, held between all steps.
pub fn hold(inputs: &[StepInput]) -> Option<HeldInputs> {
    let mut times: Vec<f64> = inputs
        .iter()
        .flat_map(|input| input.times.clone())
        .collect();
    times.sort_by(f64::total_cmp);
    times.dedup();
    // A time between two steps, and one before the first.
    let first = times.first()? - 1.0;
    let next = times.iter().skip(1).copied();
    let next = next.chain([times.last()? + 2.0]);
    let between = times
        .iter()
        .zip(next)
        .map(|(time, next)| 0.5 * (time + next));
    let samples: Vec<f64> = std::iter::once(first).chain(between).collect();
    let mut values = Vec::with_capacity(samples.len() * inputs.len());
    for t in &samples {
        let mut row = vec![0.0; inputs.len()];
        for input in inputs {
            row[input.place] = value_at(&input.value, *t, &input.parameters);
        }
        values.extend(row);
    }
    times.insert(0, first);
    HeldInputs::new(times, values, inputs.len())
}

/// Returns the times at which an expression steps; `None` if it also varies between them, or depends on
/// more than parameters and time.
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
            // Without the time the argument is constant.
            Some(time.is_finite().then_some(time).into_iter().collect())
        }
        ExprKind::Call(_, arguments) => {
            let all = arguments.iter().map(|own| step_times(own, parameters));
            Some(all.collect::<Option<Vec<_>>>()?.concat())
        }
        _ => None,
    }
}

/// Returns true if an expression of parameters and time is a polynomial of degree 1 in time.
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
