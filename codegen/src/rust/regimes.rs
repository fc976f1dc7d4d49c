//! The emitted functions that know regimes: the number of the one a state is in, and the rates
//! in one that is a constant, where every branch is decided when the kernel is compiled. One
//! text serves all regimes, so that the source does not grow with their number.

use std::collections::HashMap;

use super::body::{Access, Body, looped};
use super::expression::Expression;
use super::file::{Emitted, File};
use super::functions::Needed;
use super::literals::block;
use super::stages::{ORDER, Signature};
use crate::program::{Decided, Op, Program, SURFACES_OF_A_REGIME, ValueId};
use model_spec::model::Function;

/// Values whose branch a regime decides.
pub(super) type Switches = HashMap<ValueId, Decided>;

impl File<'_> {
    /// The number of a state's regime, and the rates in a regime.
    pub(super) fn regimes(&self, needed: &mut Needed) -> Emitted<String> {
        let Some(switches) = &self.program.requested.regimes else {
            return Ok(String::new());
        };
        let switches = switches.iter().map(|switch| (switch.value, switch.decided));
        Ok(self.regime() + &self.rates_in_regime(switches.collect(), needed)?)
    }

    fn regime(&self) -> String {
        let bits = self.guard_count().min(SURFACES_OF_A_REGIME);
        let statements = if bits == 0 {
            "0\n".to_owned()
        } else {
            let set = block(
                "if T::all_greater(guards[k], T::number(0.0)) {",
                "regime = regime | 1 << k;\n",
                "}",
            );
            format!(
                "let guards = {}guards(t, state, inputs, coefficients);\nlet mut regime = 0;\n{}regime\n",
                self.inlined(),
                looped("k", bits, &set)
            )
        };
        self.stage(
            "/// The regime that a state is in: bit k is set where number k of [`guards`] is positive,\n\
             /// for up to 32 of them. Crossing one flips its bit. Of lanes, which have to be in\n\
             /// one regime, a bit is set where it is in all.\n\
             #[allow(unused_variables)]\n",
            "regime",
            "u32",
            &statements,
        )
    }

    fn rates_in_regime(&self, switches: Switches, needed: &mut Needed) -> Emitted<String> {
        let rows = &self.program.accelerations;
        let access = Access::Coefficients(&self.field_names);
        let body = Body::in_regime(self.program, access, &rows.all(), needed, switches)?;
        let statements = self.rates_statements(body)?;
        Ok(self.stage_with(
            &format!(
                "/// Rates of the state within a regime, written to `rates`: those of [`rates_into`] where\n\
                 /// [`regime`] is `REGIME`, for half-widths that are not negative. Beyond the regime they go\n\
                 /// on as they are within, and on its surfaces they are those of its side.\n///\n/// {ORDER}\n{}\
                 #[allow(unused_variables)]\n",
                self.where_not_definite()
            ),
            &Signature {
                constant: "const REGIME: u32, ",
                arguments: "rates: &mut [T; STATES],\n",
                ..Signature::of("rates_in_regime_into", "")
            },
            &statements,
        ))
    }
}

/// A value whose branch a regime decides, of these operands.
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
    let one = || Expression::number(1.0);
    Some(match (op, operands, decided) {
        (Op::Call(Function::Deadzone, _), [p, b], Decided::Between { above, beyond }) => {
            needed.deadzone_on_side = true;
            let sides = [positive(above), positive(beyond), p.clone(), b.clone()];
            Expression::call("deadzone_on_side", &sides)
        }
        (Op::Call(Function::Contact, _), _, _) => {
            let touching = touching(decided, needed)?;
            chosen(touching, &one(), &Expression::number(0.0), needed)
        }
        (Op::Call(Function::Sign, _), _, Decided::Outside { above, below }) => {
            let (zero, minus_one) = (Expression::number(0.0), Expression::number(-1.0));
            let otherwise = chosen(positive(below), &minus_one, &zero, needed);
            chosen(positive(above), &one(), &otherwise, needed)
        }
        (Op::Call(Function::Sign, _), _, Decided::By(place)) => {
            chosen(positive(place), &one(), &Expression::number(-1.0), needed)
        }
        (Op::Call(Function::Above, _), _, Decided::By(place)) => {
            chosen(positive(place), &one(), &Expression::number(0.0), needed)
        }
        (Op::Call(Function::Above, _), _, Decided::Turned(place)) => {
            chosen(positive(place), &Expression::number(0.0), &one(), needed)
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
    let arguments = [
        Expression::atom("REGIME"),
        Expression::atom(place.to_string()),
    ];
    Expression::call("positive", &arguments)
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
    Some(Expression::call(name, &sides.map(positive)))
}

fn chosen(
    first: Expression,
    then: &Expression,
    otherwise: &Expression,
    needed: &mut Needed,
) -> Expression {
    needed.chosen = true;
    Expression::call("chosen", &[first, then.clone(), otherwise.clone()])
}
