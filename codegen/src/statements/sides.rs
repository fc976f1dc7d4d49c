//! Values whose branch is decided by the number of a regime.

use std::collections::HashMap;

use eomgen_model_spec::model::Function;

use super::expression::Expression;
use super::needed::Needed;
use crate::program::{Decided, Op, Program, ValueId};

/// Values whose branch a regime decides.
pub(super) type Switches = HashMap<ValueId, Decided>;

/// Returns the expression of a value whose branch a regime decides; None for other values.
pub(super) fn of_side(
    program: &Program,
    switches: &Switches,
    id: ValueId,
    operands: &[Expression],
    needed: &mut Needed,
) -> Option<Expression> {
    let op = &program.value(id).op;
    if let (Op::Select { a, b, .. }, [_, _, then, otherwise]) = (op, operands)
        && let (Op::Call(Function::Contact, _), Op::Constant(0.0)) =
            (&program.value(*a).op, &program.value(*b).op)
    {
        let touching = touching(*switches.get(a)?, needed)?;
        return Some(chosen(touching, then, otherwise, needed));
    }
    let decided = *switches.get(&id)?;
    let one = || Expression::Number(1.0);
    Some(match (op, operands, decided) {
        (Op::Call(Function::Deadzone, _), [p, b], Decided::Between { above, beyond }) => {
            needed.deadzone_on_side = true;
            let sides = [positive(above), positive(beyond), p.clone(), b.clone()];
            Expression::Call("deadzone_on_side", sides.to_vec())
        }
        (Op::Call(Function::Contact, _), _, _) => {
            let touching = touching(decided, needed)?;
            chosen(touching, &one(), &Expression::Number(0.0), needed)
        }
        (Op::Call(Function::Sign, _), _, Decided::Outside { above, below }) => {
            let (zero, minus_one) = (Expression::Number(0.0), Expression::Number(-1.0));
            let otherwise = chosen(positive(below), &minus_one, &zero, needed);
            chosen(positive(above), &one(), &otherwise, needed)
        }
        (Op::Call(Function::Sign, _), _, Decided::By(place)) => {
            chosen(positive(place), &one(), &Expression::Number(-1.0), needed)
        }
        (Op::Call(Function::Above, _), _, Decided::By(place)) => {
            chosen(positive(place), &one(), &Expression::Number(0.0), needed)
        }
        (Op::Call(Function::Above, _), _, Decided::Turned(place)) => {
            chosen(positive(place), &Expression::Number(0.0), &one(), needed)
        }
        (Op::Call(Function::Abs, _), [a], Decided::By(place)) => {
            chosen(positive(place), a, &Expression::negate(a), needed)
        }
        (Op::Call(Function::Max, _), [a, b], Decided::By(place)) => {
            chosen(positive(place), a, b, needed)
        }
        (Op::Call(Function::Min, _), [a, b], Decided::By(place)) => {
            chosen(positive(place), b, a, needed)
        }
        (Op::Select { .. }, [_, _, then, otherwise], Decided::By(place)) => {
            chosen(positive(place), then, otherwise, needed)
        }
        (Op::Select { .. }, [_, _, then, otherwise], Decided::Turned(place)) => {
            chosen(positive(place), otherwise, then, needed)
        }
        _ => return None,
    })
}

fn positive(place: usize) -> Expression {
    Expression::Positive(place)
}

fn touching(decided: Decided, needed: &mut Needed) -> Option<Expression> {
    let (name, sides) = match decided {
        Decided::Between { above, beyond } => {
            needed.touching = true;
            ("touching", [above, beyond])
        }
        Decided::Outside { above, below } => {
            needed.either = true;
            ("either", [above, below])
        }
        Decided::By(_) | Decided::Turned(_) => return None,
    };
    Some(Expression::Call(name, sides.map(positive).to_vec()))
}

fn chosen(
    first: Expression,
    then: &Expression,
    otherwise: &Expression,
    needed: &mut Needed,
) -> Expression {
    needed.chosen = true;
    Expression::Call("chosen", vec![first, then.clone(), otherwise.clone()])
}
