//! Continuation after an instruction.

use crate::listing::CodeAddress;
use crate::state::{LR, State};
use crate::value::{Base, UNKNOWN, Value};

/// Register number of the program counter.
pub const PC: u8 = 15;

/// Continuation after an instruction.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Step {
    /// The next instruction.
    Next,
    /// A jump.
    Jump(CodeAddress),
    /// A conditional jump. It is taken if the value is true; `None` means that this is unknown.
    Branch(CodeAddress, Option<bool>),
    /// A call of a function.
    Call(CodeAddress),
    /// The end of the function.
    Return,
    /// The function has no bound; contains the reason.
    Unbounded(String),
}

/// Jumps to a value. An unknown value from the link register or the stack is the return address if the stack pointer
/// has its value at entry again, because compiled functions do not overwrite the return address.
pub fn jump_to(value: Value, is_saved: bool, state: &State) -> Step {
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

/// Sets a register. If it is the program counter, this is a jump.
pub fn assign(state: &mut State, number: u8, value: Value) -> Step {
    match number {
        PC => jump_to(value, false, state),
        _ => {
            state.set(number, value);
            Step::Next
        }
    }
}
