//! Execution of integer instructions.

use crate::instruction::Instruction;
use crate::jump::{Step, assign};
use crate::operand::Operand;
use crate::state::State;
use crate::value::{
    Flags, Shift, UNKNOWN, Value, add, and, complement, opaque, or, shift, subtract, xor,
};

/// Integer instructions whose result is treated as unknown.
const OPAQUE: [&str; 17] = [
    "mla", "mls", "udiv", "sdiv", "clz", "rbit", "rev", "ubfx", "sbfx", "bfi", "bfc", "uxtb",
    "uxth", "sxtb", "sxth", "uxtab", "uxtah",
];

/// Returns the value of the second operand after its shift, and the carry flag after the shift.
fn read_second_operand(
    of: &Instruction,
    place: usize,
    state: &State,
) -> Option<(Value, Option<bool>)> {
    let carry = state.flags.c;
    let value = match of.operands.get(place)? {
        Operand::Number(number) => {
            // A larger constant is encoded with a rotation, which sets the carry flag.
            let carry = if *number < 256 { carry } else { None };
            return Some((Value::number(*number), carry));
        }
        Operand::Register(number) => state.register(*number),
        _ => return None,
    };
    match of.operands.get(place + 1) {
        None => Some((value, carry)),
        Some(Operand::Shifted(kind, places)) => Some(shift(value, *kind, *places, carry)),
        Some(Operand::ShiftedBy(..)) => Some((opaque(&[value]), None)),
        Some(_) => None,
    }
}

/// Executes an instruction of the integer unit.
pub fn compute(of: &Instruction, state: &mut State) -> Option<Step> {
    let name = of.name.as_str();
    let carry = state.flags.c;
    if matches!(name, "umull" | "umlal" | "smull" | "smlal") {
        for result in 0..2 {
            state.set(of.register(result)?, UNKNOWN);
        }
        return (!of.sets_flags).then_some(Step::Next);
    }
    if OPAQUE.contains(&name) {
        let inputs = of.operands.iter().filter_map(|operand| match operand {
            Operand::Register(number) => Some(state.register(*number)),
            _ => None,
        });
        let value = opaque(&inputs.collect::<Vec<_>>());
        state.set(of.register(0)?, value);
        return (!of.sets_flags).then_some(Step::Next);
    }
    if matches!(name, "movw" | "movt") {
        let number = of.register(0)?;
        let value = match (&of.symbol, of.operands.get(1), name) {
            (Some(_), _, _) => UNKNOWN,
            (None, Some(Operand::Number(bits)), "movw") => Value::number(*bits),
            (None, Some(Operand::Number(bits)), _) => {
                let low = and(state.register(number), Value::number(0xffff));
                or(low, Value::number(bits << 16))
            }
            _ => return None,
        };
        return Some(assign(state, number, value));
    }
    let is_shift =
        |operand: &&Operand| matches!(operand, Operand::Shifted(..) | Operand::ShiftedBy(..));
    let count = of
        .operands
        .iter()
        .filter(|operand| !is_shift(operand))
        .count();
    // If there are only two operands, the first one is also the result.
    let last = count.checked_sub(1)?;
    let left = state.register(of.register(last.checked_sub(1)?)?);
    let (right, moved_carry) = read_second_operand(of, last, state)?;
    let logical = |value: Value| {
        let (n, z) = value.sign_and_zero();
        let flags = Flags {
            n,
            z,
            c: moved_carry,
            v: state.flags.v,
        };
        (value, flags)
    };
    let shifted = |kind: Shift| {
        let (value, c) = match right.as_number() {
            Some(places) => shift(left, kind, places & 0xff, carry),
            None => (opaque(&[left]), None),
        };
        let (n, z) = value.sign_and_zero();
        (
            value,
            Flags {
                n,
                z,
                c,
                v: state.flags.v,
            },
        )
    };
    let (value, flags) = match name {
        "mov" | "cpy" => logical(right),
        "mvn" => logical(complement(right)),
        "add" | "addw" | "cmn" => add(left, right, Some(false)),
        "adc" => add(left, right, carry),
        "sub" | "subw" | "cmp" => subtract(left, right, Some(true)),
        "sbc" => subtract(left, right, carry),
        "rsb" => subtract(right, left, Some(true)),
        "neg" => subtract(Value::number(0), right, Some(true)),
        "and" | "tst" => logical(and(left, right)),
        "orr" => logical(or(left, right)),
        "eor" | "teq" => logical(xor(left, right)),
        "bic" => logical(and(left, complement(right))),
        "orn" => logical(or(left, complement(right))),
        "lsl" => shifted(Shift::Left),
        "lsr" => shifted(Shift::Right),
        "asr" => shifted(Shift::Arithmetic),
        "ror" => shifted(Shift::Rotate),
        "rrx" => {
            let (value, c) = shift(right, Shift::Extended, 1, carry);
            let (n, z) = value.sign_and_zero();
            (
                value,
                Flags {
                    n,
                    z,
                    c,
                    v: state.flags.v,
                },
            )
        }
        "mul" => match (left.as_number(), right.as_number()) {
            (Some(left), Some(right)) => logical(Value::number(left.wrapping_mul(right))),
            _ => logical(opaque(&[left, right])),
        },
        _ => return None,
    };
    if of.sets_flags {
        state.flags = flags;
    }
    match name {
        "cmp" | "cmn" | "tst" | "teq" => Some(Step::Next),
        _ => Some(assign(state, of.register(0)?, value)),
    }
}
