//! Registers, flags and stack at an instruction, as far as they are known.

use std::collections::BTreeMap;

use crate::value::{Base, Flags, SP, UNKNOWN, Value, add, opaque};

/// Register number of the link register.
pub const LR: u8 = 14;

/// Known part of the processor state.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct State {
    registers: [Value; 15],
    /// Condition flags.
    pub flags: Flags,
    /// Known words of the function's stack, by their offset from the stack pointer at entry.
    words: BTreeMap<i32, Value>,
    /// True if other memory may contain an address of the function's stack.
    has_escaped: bool,
}

/// Memory outside its own stack that a function may write.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Writes {
    /// True if the address of a write is unknown.
    pub anywhere: bool,
    /// By register: first and last byte offset of the writes, relative to the value of the register at entry.
    pub relative: BTreeMap<u8, (i32, i32)>,
}

/// Effect of a call on its caller.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Effect {
    /// Memory that the function may write.
    pub writes: Writes,
    /// Core registers at the return, expressed by the registers at entry. The procedure call standard is not
    /// sufficient: a compiler also keeps values in other registers if it knows that the function does not change
    /// them.
    pub registers: [Value; 15],
}

impl Writes {
    fn include(&mut self, register: u8, [first, last]: [i32; 2]) {
        let range = self.relative.entry(register).or_insert((first, last));
        *range = (range.0.min(first), range.1.max(last));
    }
}

impl State {
    /// Returns the state at the first instruction; `numbers` are known arguments.
    pub fn at_entry(numbers: [Option<u32>; 4]) -> Self {
        let mut registers = [UNKNOWN; 15];
        for (number, register) in (0..).zip(&mut registers) {
            *register = Value::Address(Base::Entry(number), 0);
        }
        for (number, register) in numbers.into_iter().zip(&mut registers) {
            if let Some(number) = number {
                *register = Value::number(number);
            }
        }
        Self {
            registers,
            flags: Flags::default(),
            words: BTreeMap::new(),
            has_escaped: false,
        }
    }

    /// Returns the content of a register; the program counter is unknown.
    pub fn register(&self, number: u8) -> Value {
        let value = self.registers.get(usize::from(number));
        value.copied().unwrap_or(UNKNOWN)
    }

    /// Sets a register. Words below a new stack pointer become unknown.
    pub fn set(&mut self, number: u8, value: Value) {
        if let Some(register) = self.registers.get_mut(usize::from(number)) {
            *register = value;
        }
        if number == SP {
            match value.as_stack_offset() {
                Some(offset) => self.words = self.words.split_off(&offset),
                None => self.words.clear(),
            }
        }
    }

    /// Returns the offset of the stack pointer from its value at entry.
    pub fn stack_offset(&self) -> Option<i32> {
        self.register(SP).as_stack_offset()
    }

    /// Returns the word at an address.
    pub fn load(&self, address: Value) -> Value {
        if address == Value::Frame {
            return opaque(&self.words.values().copied().collect::<Vec<_>>());
        }
        let word = address
            .as_stack_offset()
            .and_then(|offset| self.words.get(&offset));
        word.copied().unwrap_or(UNKNOWN)
    }

    /// Stores a word.
    pub fn store(&mut self, address: Value, value: Value, writes: &mut Writes) {
        self.overwrite(address, [0, 3], writes);
        match address.as_stack_offset() {
            Some(offset) if offset < 0 => {
                if value != UNKNOWN {
                    self.words.insert(offset, value);
                }
            }
            _ => self.has_escaped |= value.is_stack_address(),
        }
    }

    /// Records that an address of the function's stack may be stored in memory that is not tracked.
    pub fn note_escape(&mut self, value: Value) {
        self.has_escaped |= value.is_stack_address();
    }

    /// Marks the words as unknown that a write of an unknown number changes. The write is between these offsets from
    /// an address.
    pub fn overwrite(&mut self, address: Value, [first, last]: [i32; 2], writes: &mut Writes) {
        match address {
            Value::Address(Base::Entry(SP), offset) => {
                let offset = offset as i32;
                let (first, last) = (offset.saturating_add(first), offset.saturating_add(last));
                let begin = first.saturating_sub(3);
                let stale: Vec<i32> = self.words.range(begin..=last).map(|(at, _)| *at).collect();
                for at in stale {
                    self.forget(at);
                }
                if last >= 0 {
                    writes.include(SP, [first, last]);
                }
            }
            Value::Address(Base::Entry(register @ 0..=3), offset) => {
                let offset = offset as i32;
                let range = [offset.saturating_add(first), offset.saturating_add(last)];
                writes.include(register, range);
            }
            // Constants of the program are in its data.
            Value::Address(Base::Symbol(_), _) => {}
            Value::Frame => self.forget_all(),
            Value::Address(..) | Value::Bits { .. } => {
                writes.anywhere = true;
                if self.has_escaped {
                    self.forget_all();
                }
            }
        }
    }

    fn forget(&mut self, at: i32) {
        let value = self.words.remove(&at);
        self.has_escaped |= value.is_some_and(Value::is_stack_address);
    }

    fn forget_all(&mut self) {
        let words = std::mem::take(&mut self.words);
        self.has_escaped |= words.into_values().any(Value::is_stack_address);
    }

    /// Applies the effect of a call.
    pub fn call(&mut self, called: &Effect, writes: &mut Writes) {
        let arguments = [0, 1, 2, 3].map(|number| self.register(number));
        let passes_frame = arguments.into_iter().any(Value::is_stack_address)
            || self.words.values().any(|value| value.is_stack_address());
        let before = self.clone();
        if called.writes.anywhere {
            writes.anywhere = true;
            if passes_frame || self.has_escaped {
                self.forget_all();
            }
        }
        for (&register, &(first, last)) in &called.writes.relative {
            self.overwrite(before.register(register), [first, last], writes);
        }
        // The called function may store or return the addresses that it receives.
        let is_writing = called.writes.anywhere || !called.writes.relative.is_empty();
        self.has_escaped |= is_writing && passes_frame;
        for (number, value) in (0..).zip(called.registers) {
            match (number, before.translate(value)) {
                (SP, _) => {}
                // The procedure call standard preserves these registers, even if the saved words on the stack are
                // unknown.
                (4..=11, UNKNOWN) => {}
                (_, UNKNOWN) => self.set(number, opaque(&arguments)),
                (_, value) => self.set(number, value),
            }
        }
        self.flags = Flags::default();
    }

    /// Converts a value of the called function, which refers to its registers at entry, to a value of the caller.
    fn translate(&self, value: Value) -> Value {
        match value {
            Value::Address(Base::Entry(register), offset) => {
                add(self.register(register), Value::number(offset), Some(false)).0
            }
            value => value,
        }
    }

    /// Returns the core registers.
    pub fn registers(&self) -> [Value; 15] {
        self.registers
    }

    /// Returns the state with the values that are known and equal in both states.
    pub fn join(&self, other: &Self) -> Self {
        let mut joined = self.clone();
        for (register, value) in joined.registers.iter_mut().zip(other.registers) {
            *register = register.join(value);
        }
        let flag = |left: Option<bool>, right: Option<bool>| left.filter(|_| left == right);
        let (left, right) = (self.flags, other.flags);
        joined.flags = Flags {
            n: flag(left.n, right.n),
            z: flag(left.z, right.z),
            c: flag(left.c, right.c),
            v: flag(left.v, right.v),
        };
        joined.has_escaped |= other.has_escaped;
        for (at, value) in &self.words {
            let value = match other.words.get(at) {
                Some(there) => value.join(*there),
                None => opaque(&[*value]),
            };
            joined.words.insert(*at, value);
        }
        let missing = other
            .words
            .iter()
            .filter(|(at, _)| !self.words.contains_key(at));
        let missing: Vec<(i32, Value)> = missing
            .map(|(at, value)| (*at, opaque(&[*value])))
            .collect();
        joined.words.extend(missing);
        joined.words.retain(|_, value| *value != UNKNOWN);
        joined
    }

    /// Returns the known numbers among the arguments.
    pub fn arguments(&self) -> [Option<u32>; 4] {
        [0, 1, 2, 3].map(|number| self.register(number).as_number())
    }
}
