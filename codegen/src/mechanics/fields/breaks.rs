//! Positions at which a coefficient along a field switches, if they are fixed fractions of the field's length.

use eomgen_model_spec::evaluate::{evaluate, evaluate_with};
use eomgen_model_spec::ids::FieldId;
use eomgen_model_spec::model::{Expr, ExprKind, Function, Model, ParameterValue};

use super::contents::contents;

/// Largest rounding error of a relative position, which takes a dozen operations.
const POSITION_ROUNDING: f64 = 1e-14;

/// Number of other parameter sets for which a position must be at the same fraction of the length.
const OTHER_PARAMETER_SETS: usize = 2;

/// Function of the position that changes its sign at a break: a sum of expressions with factors.
type Argument<'m> = Vec<(f64, &'m Expr)>;

/// Returns the relative positions inside the domain, ascending. Switches whose relative position depends on the
/// parameters are left out.
pub(super) fn find_fixed_breaks(model: &Model, field: FieldId) -> Vec<f64> {
    let arguments = find_switching_arguments(model, field);
    if arguments.is_empty() {
        return Vec::new();
    }
    let Ok(declared) = model.parameter_values() else {
        return Vec::new();
    };
    let others: Vec<Vec<f64>> = (1..=OTHER_PARAMETER_SETS)
        .filter_map(|draw| vary_parameters(model, draw))
        .collect();
    if others.len() < OTHER_PARAMETER_SETS {
        return Vec::new();
    }
    let roots = arguments.iter().filter_map(|argument| {
        let root =
            |parameters: &Vec<f64>| solve_for_relative_position(model, field, argument, parameters);
        let found = root(&declared)?;
        let is_same = |other| (root(other).unwrap_or(f64::NAN) - found).abs() <= POSITION_ROUNDING;
        let is_inside = POSITION_ROUNDING < found && found < 1.0 - POSITION_ROUNDING;
        (is_inside && others.iter().all(is_same)).then_some(found)
    });
    let mut breaks: Vec<f64> = roots.collect();
    breaks.sort_by(f64::total_cmp);
    breaks.dedup_by(|later, earlier| *later - *earlier <= POSITION_ROUNDING);
    breaks
}

fn find_switching_arguments(model: &Model, of: FieldId) -> Vec<Argument<'_>> {
    let mut found: Vec<Argument<'_>> = Vec::new();
    model.for_each_expression(&mut |expr| {
        expr.visit(&mut |part| {
            let ExprKind::Integral { field, integrand } = &part.kind else {
                return;
            };
            if *field != of {
                return;
            }
            integrand.visit(&mut |part| {
                if let ExprKind::Call(function, arguments) = &part.kind
                    && contents(model, part).is_coefficient()
                {
                    found.extend(find_call_arguments(*function, arguments));
                }
            });
        });
    });
    found
}

fn find_call_arguments(function: Function, arguments: &[Expr]) -> Vec<Argument<'_>> {
    match (function, arguments) {
        (Function::Above | Function::Sign | Function::Abs, [x]) => vec![vec![(1.0, x)]],
        (Function::Min | Function::Max, [x, y]) => vec![vec![(1.0, x), (-1.0, y)]],
        (Function::Deadzone | Function::Contact, [x, width]) => {
            vec![vec![(1.0, x), (-1.0, width)], vec![(1.0, x), (1.0, width)]]
        }
        _ => Vec::new(),
    }
}

/// Returns the relative position at which an argument is 0; `None` if it is not linear in the position.
fn solve_for_relative_position(
    model: &Model,
    field: FieldId,
    argument: &Argument<'_>,
    parameters: &[f64],
) -> Option<f64> {
    let field = &model.fields[field];
    let [from, to] = [&field.from, &field.to].map(|end| evaluate(end, parameters));
    let value = |x: f64| -> f64 {
        let addends = argument.iter().map(|(factor, expr)| {
            factor
                * evaluate_with(expr, &|leaf| match leaf {
                    ExprKind::Position(_) => x,
                    ExprKind::Definition(index) => {
                        evaluate(&model.definitions[*index].value, parameters)
                    }
                    ExprKind::Parameter(index) => parameters[index.index()],
                    _ => f64::NAN,
                })
        });
        addends.sum()
    };
    let [start, middle, end] = [from, 0.5 * (from + to), to].map(value);
    let is_linear =
        (start + end - 2.0 * middle).abs() <= POSITION_ROUNDING * (start.abs() + end.abs());
    let root = start / (start - end);
    (is_linear && root.is_finite()).then_some(root)
}

/// Returns the parameters, with each independent parameter multiplied by a different factor; declared bounds are
/// ignored.
fn vary_parameters(model: &Model, draw: usize) -> Option<Vec<f64>> {
    let mut changed = model.clone();
    for (place, parameter) in changed.parameters.iter_mut().enumerate() {
        (parameter.min, parameter.max) = (None, None);
        if let ParameterValue::Number(value) = &mut parameter.value {
            let turns = 0.618_034 * (draw * (place + 1)) as f64;
            *value *= 0.75 + 0.5 * turns.fract();
        }
    }
    changed.parameter_values().ok()
}
