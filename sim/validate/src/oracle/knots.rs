//! Computes the positions at which piecewise coefficients of integrals switch, by bisection.

use eomgen_model_spec::evaluate::{evaluate, evaluate_with};
use eomgen_model_spec::ids::FieldId;
use eomgen_model_spec::model::{Expr, ExprKind, Function, Model};

/// Number of parts of the domain with at most one sign change of an argument.
const PARTS: usize = 64;

/// Returns the relative positions (0 to 1) inside the domain at which a function of position and parameters switches.
pub(super) fn switch_positions(
    model: &Model,
    of: FieldId,
    parameters: &[f64],
    [from, to]: [f64; 2],
) -> Vec<f64> {
    let mut found = Vec::new();
    let mut search = |function: &dyn Fn(f64) -> f64| {
        let value = |s: f64| function(from + (to - from) * s);
        for part in 0..PARTS {
            let [mut low, mut high] = [part, part + 1].map(|k| k as f64 / PARTS as f64);
            let start = value(low);
            // The product is NaN if the argument depends on the motion, so no switch is found.
            if start * value(high) < 0.0 {
                while 0.5 * (low + high) > low && 0.5 * (low + high) < high {
                    let middle = 0.5 * (low + high);
                    match value(middle) * start > 0.0 {
                        true => low = middle,
                        false => high = middle,
                    }
                }
                found.push(high);
            } else if start == 0.0 && part > 0 {
                found.push(low);
            }
        }
    };
    model.for_each_expression(&mut |expr| {
        expr.visit(&mut |part| {
            let ExprKind::Integral { field, integrand } = &part.kind else {
                return;
            };
            if *field != of {
                return;
            }
            integrand.visit(&mut |part| {
                let ExprKind::Call(function, arguments) = &part.kind else {
                    return;
                };
                let value = |expr: &Expr, x: f64| {
                    evaluate_with(expr, &|leaf| match leaf {
                        ExprKind::Position(_) => x,
                        ExprKind::Parameter(index) => {
                            parameters.get(index.index()).copied().unwrap_or(f64::NAN)
                        }
                        ExprKind::Definition(index) => {
                            evaluate(&model.definitions[*index].value, parameters)
                        }
                        _ => f64::NAN,
                    })
                };
                match (function, &arguments[..]) {
                    (Function::Above | Function::Sign | Function::Abs, [argument]) => {
                        search(&|x| value(argument, x));
                    }
                    (Function::Min | Function::Max, [one, other]) => {
                        search(&|x| value(one, x) - value(other, x));
                    }
                    (Function::Deadzone | Function::Contact, [argument, width]) => {
                        search(&|x| value(argument, x) - value(width, x));
                        search(&|x| value(argument, x) + value(width, x));
                    }
                    _ => {}
                }
            });
        });
    });
    found.sort_by(f64::total_cmp);
    found.dedup();
    found
}
