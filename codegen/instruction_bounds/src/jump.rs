//! Continuation after an instruction.

use crate::listing::Place;
use crate::state::{LR, State};
use crate::value::{Base, UNKNOWN, Value};

/// Number of the program counter.
pub const PC: u8 = 15;

/// Continuation after an instruction.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Step {
    /// The next instruction.
    Next,
    /// A jump.
    Jump(Place),
    /// A jump that is taken if the value is true; `None` if it is not known.
    Branch(Place, Option<bool>),
    /// A call of a function.
    Call(Place),
    /// The end of the function.
    Return,
    /// No bound, for a reason.
    Unbounded(String),
}

/// Jumps to a value. An unknown one from the link register or the stack is the address of the caller if the stack
/// pointer has its first value again: compiled functions do not overwrite it.
pub fn goto(value: Value, is_saved: bool, state: &State) -> Step {
    let at_end = state.stack_offset() == Some(0);
    match value {
        Value::Address(Base::Code(section), offset) => {
            Step::Jump(u64::from(section) << 32 | u64::from(offset))
        }
        Value::Address(Base::Entry(LR), 0) if at_end => Step::Return,
        UNKNOWN if is_saved && at_end => Step::Return,
        _ => Step::Unbounded("an indirect jump".to_owned()),
    }
}

/// Sets a register that may be the program counter.
pub fn assign(state: &mut State, number: u8, value: Value) -> Step {
    match number {
        PC => goto(value, false, state),
        _ => {
            state.set(number, value);
            Step::Next
        }
    }
}
