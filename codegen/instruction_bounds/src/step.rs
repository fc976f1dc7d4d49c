//! Effect of an instruction on the known part of the state.

use crate::compute::compute;
use crate::instruction::Instruction;
use crate::jump::{PC, Step, assign, jump_to};
use crate::listing::{CodeAddress, Listing};
use crate::operand::{Memory, Operand};
use crate::state::{LR, State, Writes};
use crate::value::{Base, Flags, SP, Shift, UNKNOWN, Value, add, opaque, shift, subtract};

/// Executor of the instructions of a listing.
pub struct Machine<'a> {
    /// Listing with data and symbols.
    pub listing: &'a Listing,
    /// Memory that the instructions write.
    pub writes: Writes,
}

/// Floating-point instructions without effect on core registers, flags or memory.
const FLOATS: [&str; 30] = [
    "vadd", "vsub", "vmul", "vdiv", "vmla", "vmls", "vnmla", "vnmls", "vnmul", "vneg", "vabs",
    "vsqrt", "vcvt", "vcvtr", "vfma", "vfms", "vfnma", "vfnms", "vmaxnm", "vminnm", "vseleq",
    "vselge", "vselgt", "vselvs", "vcmp", "vcmpe", "vldr", "vrintz", "vrinta", "vmsr",
];

/// Instructions without effect.
const IDLE: [&str; 4] = ["nop", "dmb", "dsb", "isb"];

impl Machine<'_> {
    /// Executes an instruction whose condition holds.
    pub fn execute(
        &mut self,
        code_address: CodeAddress,
        of: &Instruction,
        state: &mut State,
    ) -> Step {
        let name = of.name.as_str();
        let step = match name {
            _ if name.starts_with("it") || IDLE.contains(&name) || FLOATS.contains(&name) => {
                Some(Step::Next)
            }
            "b" | "bl" => self
                .target(code_address, of)
                .map(|target| self.branch(code_address, of, target, state)),
            "bx" => of
                .register(0)
                .map(|number| jump_to(state.register(number), number == LR, state)),
            "blx" => Some(Step::Unbounded("an indirect call".to_owned())),
            "tbb" | "tbh" => Some(Step::Unbounded("an indirect jump".to_owned())),
            "cbz" | "cbnz" => self.compare_and_branch(code_address, of, state),
            "push" | "pop" | "stmdb" | "stmia" | "ldmia" | "ldmdb" | "vpush" | "vpop"
            | "vldmia" | "vldmdb" | "vstmia" | "vstmdb" => self.move_many(of, state),
            "ldr" | "ldrd" | "ldrb" | "ldrh" | "ldrsb" | "ldrsh" | "str" | "strd" | "strb"
            | "strh" | "vstr" => self.access(code_address, of, state),
            "vmov" => Some(move_float(of, state)),
            "vmrs" => {
                match of.register(0) {
                    Some(number) => state.set(number, UNKNOWN),
                    None => state.flags = Flags::default(),
                }
                Some(Step::Next)
            }
            _ => compute(of, state),
        };
        step.unwrap_or_else(|| Step::Unbounded(format!("the unknown instruction `{name}`")))
    }

    /// Returns the target of a jump or the reason why it is not known.
    fn target(
        &self,
        code_address: CodeAddress,
        of: &Instruction,
    ) -> Option<Result<CodeAddress, String>> {
        if let Some(symbol) = &of.symbol {
            let function = self.listing.functions.get(symbol);
            let missing =
                || format!("a call of `{symbol}`, which neither the object nor libgcc contains");
            return Some(
                function
                    .map(|function| function.code_address)
                    .ok_or_else(missing),
            );
        }
        of.operands.iter().find_map(|operand| match operand {
            Operand::Target(target) => Some(Ok(code_address >> 32 << 32 | target)),
            _ => None,
        })
    }

    fn branch(
        &self,
        code_address: CodeAddress,
        of: &Instruction,
        target: Result<CodeAddress, String>,
        state: &mut State,
    ) -> Step {
        match target {
            Err(reason) => Step::Unbounded(reason),
            Ok(target) if of.name == "b" => Step::Jump(target),
            Ok(target) if self.listing.is_function(target) => Step::Call(target),
            // The target is a part of a libgcc function that other functions share.
            Ok(target) => {
                state.set(LR, code(code_address + of.size));
                Step::Jump(target)
            }
        }
    }

    fn compare_and_branch(
        &self,
        code_address: CodeAddress,
        of: &Instruction,
        state: &State,
    ) -> Option<Step> {
        let (_, is_zero) = state.register(of.register(0)?).sign_and_zero();
        let is_taken = is_zero.map(|is_zero| is_zero == (of.name == "cbz"));
        match self.target(code_address, of)? {
            Ok(target) => Some(Step::Branch(target, is_taken)),
            Err(reason) => Some(Step::Unbounded(reason)),
        }
    }

    /// Executes a load or store of several registers.
    fn move_many(&mut self, of: &Instruction, state: &mut State) -> Option<Step> {
        let (base, is_updated, list) = match (&of.operands[..], &*of.name) {
            ([list], _) => (SP, true, list),
            ([Operand::Updated(base), list], _) => (*base, true, list),
            ([Operand::Register(base), list], _) => (*base, false, list),
            _ => return None,
        };
        let words = match list {
            Operand::Registers(list) => list.len() as u32,
            Operand::Floats(words) => *words,
            _ => return None,
        };
        let is_store = of.name.contains("st") || of.name.contains("push");
        let is_down = of.name.ends_with("db") || of.name.contains("push");
        let before = state.register(base);
        let moved = match is_down {
            true => subtract(before, Value::number(4 * words), Some(true)).0,
            false => add(before, Value::number(4 * words), Some(false)).0,
        };
        let first = if is_down { moved } else { before };
        // Words are accessed before the stack pointer moves up, and after it moves down: words below it become
        // unknown.
        if is_updated && is_down {
            state.set(base, moved);
        }
        let at = |word: u32| add(first, Value::number(4 * word), Some(false)).0;
        let mut target = None;
        match list {
            Operand::Registers(list) if is_store => {
                for (word, number) in (0..).zip(list) {
                    let value = state.register(*number);
                    state.store(at(word), value, &mut self.writes);
                }
            }
            Operand::Registers(list) => {
                let values: Vec<Value> = (0..words).map(|word| state.load(at(word))).collect();
                for (number, value) in list.iter().zip(values) {
                    match *number {
                        PC => target = Some(value),
                        number => state.set(number, value),
                    }
                }
            }
            _ if is_store => {
                let last = 4 * i32::try_from(words).ok()? - 1;
                state.overwrite(first, [0, last], &mut self.writes);
            }
            _ => {}
        }
        if is_updated && !is_down {
            state.set(base, moved);
        }
        Some(match target {
            Some(target) => jump_to(target, true, state),
            None => Step::Next,
        })
    }

    /// Executes a load or store of one or two words, or of a part of a word.
    fn access(
        &mut self,
        code_address: CodeAddress,
        of: &Instruction,
        state: &mut State,
    ) -> Option<Step> {
        let memory = of
            .operands
            .iter()
            .position(|operand| matches!(operand, Operand::Memory(_)))?;
        let Operand::Memory(address) = &of.operands[memory] else {
            return None;
        };
        if address.base == PC {
            let number = of.register(0)?;
            let at = ((code_address + 4) & !3).checked_add_signed(i64::from(address.offset))?;
            let value = match of.name.as_str() {
                "ldr" if address.index.is_none() => self.constant(at),
                _ => UNKNOWN,
            };
            return Some(assign(state, number, value));
        }
        let base = state.register(address.base);
        let moved = displaced(base, address, state);
        // With `[r0], #4` the number is added to the register after the access.
        let after = match of.operands.get(memory + 1) {
            None => None,
            Some(Operand::Number(number)) => Some(add(base, Value::number(*number), Some(false)).0),
            Some(_) => Some(opaque(&[base])),
        };
        let write_back = after.or(address.is_updated.then_some(moved));
        if let Some(value) = write_back {
            // The stack pointer moves up only after a load; `move_many` states the order.
            let is_up = value.as_stack_offset() > base.as_stack_offset();
            if !is_up {
                state.set(address.base, value);
            }
        }
        let registers = of.operands[..memory].iter().map(|operand| match operand {
            Operand::Register(number) => Some(*number),
            _ => None,
        });
        let registers: Option<Vec<u8>> = registers.collect();
        let mut target = None;
        match of.name.as_str() {
            "vstr" => {
                let Some(Operand::Floats(words)) = of.operands.first() else {
                    return None;
                };
                let last = 4 * i32::try_from(*words).ok()? - 1;
                state.overwrite(moved, [0, last], &mut self.writes);
            }
            "strb" => {
                state.note_escape(state.register(*registers?.first()?));
                state.overwrite(moved, [0, 0], &mut self.writes);
            }
            "strh" => {
                state.note_escape(state.register(*registers?.first()?));
                state.overwrite(moved, [0, 1], &mut self.writes);
            }
            name => {
                for (word, number) in (0..).zip(registers?) {
                    let at = add(moved, Value::number(4 * word), Some(false)).0;
                    if name.starts_with("str") {
                        let value = state.register(number);
                        state.store(at, value, &mut self.writes);
                        continue;
                    }
                    let value = match name {
                        "ldr" | "ldrd" => state.load(at),
                        _ => opaque(&[state.load(at)]),
                    };
                    match number {
                        PC => target = Some(value),
                        number => state.set(number, value),
                    }
                }
            }
        }
        if let Some(value) = write_back {
            state.set(address.base, value);
        }
        Some(match target {
            Some(target) => jump_to(target, true, state),
            None => Step::Next,
        })
    }

    /// Returns a word of data that is stored between the instructions.
    fn constant(&self, at: CodeAddress) -> Value {
        let Some(line) = self.listing.lines.get(&at) else {
            return UNKNOWN;
        };
        let digits = line.operands.strip_prefix("0x");
        let number = digits.and_then(|digits| u32::from_str_radix(digits, 16).ok());
        match (number, &line.symbol) {
            _ if line.mnemonic != ".word" => UNKNOWN,
            (Some(number), None) => Value::number(number),
            (Some(number), Some(symbol)) => {
                let symbol = self.listing.symbols.get(symbol);
                symbol.map_or(UNKNOWN, |symbol| {
                    Value::Address(Base::Symbol(*symbol), number)
                })
            }
            (None, _) => UNKNOWN,
        }
    }
}

/// Returns the address of an instruction as a value.
fn code(code_address: CodeAddress) -> Value {
    Value::Address(Base::Code((code_address >> 32) as u32), code_address as u32)
}

fn displaced(base: Value, address: &Memory, state: &State) -> Value {
    let moved = add(base, Value::number(address.offset as u32), Some(false)).0;
    match address.index {
        None => moved,
        Some((number, code_addresses)) => {
            let index = shift(state.register(number), Shift::Left, code_addresses, None).0;
            add(moved, index, Some(false)).0
        }
    }
}

/// Executes a move between core and floating-point registers.
fn move_float(of: &Instruction, state: &mut State) -> Step {
    let is_to_core = matches!(of.operands.first(), Some(Operand::Register(_)));
    for operand in &of.operands {
        if let Operand::Register(number) = operand {
            match is_to_core {
                true => state.set(*number, UNKNOWN),
                false => state.note_escape(state.register(*number)),
            }
        }
    }
    Step::Next
}
