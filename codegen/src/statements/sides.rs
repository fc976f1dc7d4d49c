//! Values of piecewise functions whose branch the regime number decides.

use std::collections::HashMap;

use eomgen_model_spec::model::Function;

use super::expression::Expression;
use super::needed::{Helper, RequiredFunctions};
use crate::program::{Decision, Op, Program, ValueId};

/// Values whose branch a regime decides.
pub(super) type Switches = HashMap<ValueId, Decision>;

/// Returns the expression of a value whose branch a regime decides; None for other values.
pub(super) fn decide_by_regime(
    program: &Program,
    switches: &Switches,
    id: ValueId,
    operands: &[Expression],
    needed: &mut RequiredFunctions,
) -> Option<Expression> {
    let op = &program.value(id).op;
    if let (Op::Select { a, b, .. }, [_, _, then, otherwise]) = (op, operands)
        && let (Op::Call(Function::Contact, _), Op::Constant(0.0)) =
            (&program.value(*a).op, &program.value(*b).op)
    {
        let touching = touching(*switches.get(a)?, needed)?;
        return Some(choose_expression(touching, then, otherwise, needed));
    }
    let decided = *switches.get(&id)?;
    let one = || Expression::Number(1.0);
    Some(match (op, operands, decided) {
        (Op::Call(Function::Deadzone, _), [p, b], Decision::Between { above, beyond }) => {
            needed.add(Helper::DeadzoneOnSide);
            let sides = [positive(above), positive(beyond), p.clone(), b.clone()];
            Expression::Call("deadzone_on_side", sides.to_vec())
        }
        (Op::Call(Function::Contact, _), _, _) => {
            let touching = touching(decided, needed)?;
            choose_expression(touching, &one(), &Expression::Number(0.0), needed)
        }
        (Op::Call(Function::Sign, _), _, Decision::Outside { above, below }) => {
            let (zero, minus_one) = (Expression::Number(0.0), Expression::Number(-1.0));
            let otherwise = choose_expression(positive(below), &minus_one, &zero, needed);
            choose_expression(positive(above), &one(), &otherwise, needed)
        }
        (Op::Call(Function::Sign, _), _, Decision::Surface(place)) => {
            choose_expression(positive(place), &one(), &Expression::Number(-1.0), needed)
        }
        (Op::Call(Function::Above, _), _, Decision::Surface(place)) => {
            choose_expression(positive(place), &one(), &Expression::Number(0.0), needed)
        }
        (Op::Call(Function::Above, _), _, Decision::NegatedSurface(place)) => {
            choose_expression(positive(place), &Expression::Number(0.0), &one(), needed)
        }
        (Op::Call(Function::Abs, _), [a], Decision::Surface(place)) => {
            choose_expression(positive(place), a, &Expression::negate(a), needed)
        }
        (Op::Call(Function::Max, _), [a, b], Decision::Surface(place)) => {
            choose_expression(positive(place), a, b, needed)
        }
        (Op::Call(Function::Min, _), [a, b], Decision::Surface(place)) => {
            choose_expression(positive(place), b, a, needed)
        }
        (Op::Select { .. }, [_, _, then, otherwise], Decision::Surface(place)) => {
            choose_expression(positive(place), then, otherwise, needed)
        }
        (Op::Select { .. }, [_, _, then, otherwise], Decision::NegatedSurface(place)) => {
            choose_expression(positive(place), otherwise, then, needed)
        }
        _ => return None,
    })
}

fn positive(place: usize) -> Expression {
    Expression::Positive(place)
}

fn touching(decided: Decision, needed: &mut RequiredFunctions) -> Option<Expression> {
    let (name, sides) = match decided {
        Decision::Between { above, beyond } => {
            needed.add(Helper::Touching);
            ("touching", [above, beyond])
        }
        Decision::Outside { above, below } => {
            needed.add(Helper::Either);
            ("either", [above, below])
        }
        Decision::Surface(_) | Decision::NegatedSurface(_) => return None,
    };
    Some(Expression::Call(name, sides.map(positive).to_vec()))
}

fn choose_expression(
    first: Expression,
    then: &Expression,
    otherwise: &Expression,
    needed: &mut RequiredFunctions,
) -> Expression {
    needed.add(Helper::Chosen);
    Expression::Call("chosen", vec![first, then.clone(), otherwise.clone()])
}
