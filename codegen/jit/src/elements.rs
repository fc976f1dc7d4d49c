//! Elements of values: numbers from registers and memory, and elementwise operations.

use cranelift_codegen::ir::{InstBuilder, MemFlagsData, Opcode, Value, types};
use eomgen_codegen::program::{Extent, Op, PARTIAL_SUMS, ValueId};

use crate::lanes::{Array, ElementRef, Lanes, MAX_REGISTER_VECTOR, pairs};
use crate::stage::Writer;
use eomgen_elementary::Function as Elementary;

/// Returns the flags of a memory access; every address is inside the caller's memory.
fn flags(lanes: Lanes, constant: bool) -> MemFlagsData {
    let flags = MemFlagsData::new().with_notrap();
    // A pair of lanes can be unaligned: its address need not be a multiple of its size.
    let flags = match lanes {
        Lanes::One => flags.with_aligned(),
        Lanes::Two => flags,
    };
    if constant {
        flags.with_readonly().with_can_move()
    } else {
        flags
    }
}

impl Writer<'_, '_, '_> {
    pub fn load(&mut self, array: Array, at: ElementRef) -> Value {
        let address = self.offset_address(array.base, at);
        let offset = self.bytes(array.start + at.element);
        let flags = flags(at.lanes, array.constant);
        self.instructions()
            .load(at.lanes.kind(), flags, address, offset)
    }

    pub fn store(&mut self, value: Value, array: Array, at: ElementRef) {
        let address = self.offset_address(array.base, at);
        let offset = self.bytes(array.start + at.element);
        self.instructions()
            .store(flags(at.lanes, false), value, address, offset);
    }

    fn bytes(&self, numbers: usize) -> i32 {
        // `compile` rejects programs whose memory would not fit.
        (numbers * 8) as i32
    }

    fn offset_address(&mut self, base: Value, at: ElementRef) -> Value {
        match at.moving {
            Some(moving) => self.instructions().iadd(base, moving),
            None => base,
        }
    }

    /// Returns a literal in every lane.
    pub fn literal(&mut self, value: f64, lanes: Lanes) -> Value {
        if lanes == Lanes::One && value.to_bits() == 0 {
            return self.instructions().f64const(0.0);
        }
        let array = Array {
            base: self.call.memory,
            start: self.shared.first_constant() + self.shared.constants.place(value),
            constant: true,
        };
        let at = ElementRef {
            lanes,
            ..ElementRef::single(0)
        };
        self.load(array, at)
    }

    /// Returns a bound number.
    pub fn number(&self, id: ValueId, lanes: Lanes) -> Value {
        let numbers = match lanes {
            Lanes::One => &self.numbers,
            Lanes::Two => &self.broadcast,
        };
        numbers[&id]
    }

    /// Binds a number in one lane, and its copy in both lanes.
    pub fn bind(&mut self, id: ValueId, value: Value) {
        let both = self.instructions().splat(types::F64X2, value);
        self.numbers.insert(id, value);
        self.broadcast.insert(id, both);
    }

    /// Returns an element of a value. All elements of a scalar are equal.
    pub fn element(&mut self, id: ValueId, at: ElementRef) -> Value {
        if self.program.value(id).extent == Extent::Scalar {
            return self.number(id, at.lanes);
        }
        if let Some(registers) = self.registers.get(&id) {
            return registers[at.element / 2];
        }
        match self.array(id) {
            Some(array) => self.load(array, at),
            None => self.compute_element(id, at),
        }
    }

    /// Computes an element from the elements of the operands.
    pub fn compute_element(&mut self, id: ValueId, at: ElementRef) -> Value {
        let lanes = at.lanes;
        let of = |writer: &mut Self, operand: ValueId| writer.element(operand, at);
        let both = |writer: &mut Self, operands: [ValueId; 2]| operands.map(|id| of(writer, id));
        match self.program.value(id).op.clone() {
            Op::Negate(a) => {
                let a = of(self, a);
                self.negate(a, lanes)
            }
            Op::Add(a, b) => {
                let [a, b] = both(self, [a, b]);
                self.add(a, b)
            }
            Op::Subtract(a, b) => {
                let [a, b] = both(self, [a, b]);
                self.instructions().fsub(a, b)
            }
            Op::Multiply(a, b) => {
                let [a, b] = both(self, [a, b]);
                self.multiply(a, b)
            }
            Op::Divide(a, b) => {
                let [a, b] = both(self, [a, b]);
                self.instructions().fdiv(a, b)
            }
            Op::Power(a, b) => {
                let operands = both(self, [a, b]);
                self.function(Elementary::Pow, operands, lanes)
            }
            Op::Call(function, arguments) => {
                let arguments = arguments.map(|argument| of(self, argument));
                self.call(function, arguments, lanes)
            }
            Op::Select {
                a,
                b,
                then,
                otherwise,
            } => {
                let operands = [a, b, then, otherwise].map(|operand| of(self, operand));
                self.select(operands, lanes)
            }
            Op::PivotReciprocal(a) => {
                let a = of(self, a);
                self.function(Elementary::PivotReciprocal, [a], lanes)
            }
            // `stage` must bind leaves and results of matrix operations.
            other => self.misplaced_value(id, &other, lanes),
        }
    }

    /// Records a value that cannot be computed element by element. The compilation then fails.
    fn misplaced_value(&mut self, id: ValueId, op: &Op, lanes: Lanes) -> Value {
        let place = id.index();
        self.defect = Some(format!(
            "value {place}, {op:?}, cannot be computed by elements"
        ));
        self.literal(0.0, lanes)
    }

    /// Computes a + b.
    pub fn add(&mut self, a: Value, b: Value) -> Value {
        let (a, b) = self.load_last(a, b);
        self.instructions().fadd(a, b)
    }

    /// Computes a b.
    pub fn multiply(&mut self, a: Value, b: Value) -> Value {
        let (a, b) = self.load_last(a, b);
        self.instructions().fmul(a, b)
    }

    /// Orders two operands so that an operand in memory is the second one. It is then loaded by the instruction that
    /// uses it, and needs no register while the other operand is computed.
    fn load_last(&self, a: Value, b: Value) -> (Value, Value) {
        let graph = &self.builder.func.dfg;
        let is_load = |value| {
            let definition = graph.value_def(value).inst();
            definition.is_some_and(|inst| graph.insts[inst].opcode() == Opcode::Load)
        };
        if is_load(a) { (b, a) } else { (a, b) }
    }

    /// Flips the sign bit.
    pub fn negate(&mut self, a: Value, lanes: Lanes) -> Value {
        match lanes {
            Lanes::One => self.instructions().fneg(a),
            Lanes::Two => {
                let sign = self.literal(-0.0, lanes);
                self.instructions().bxor(a, sign)
            }
        }
    }

    /// Computes a vector and stores it in memory.
    pub fn fill(&mut self, id: ValueId, array: Array, length: usize) {
        self.loop_over_elements(length, |writer, at| {
            let value = writer.compute_element(id, at);
            writer.store(value, array, at);
        });
    }

    /// Computes a vector of at most [`MAX_REGISTER_VECTOR`] elements and keeps it in registers.
    pub fn keep(&mut self, id: ValueId, length: usize) {
        debug_assert!(length <= MAX_REGISTER_VECTOR);
        let mut registers = Vec::new();
        self.loop_over_elements(length, |writer, at| {
            registers.push(writer.compute_element(id, at));
        });
        self.registers.insert(id, registers);
    }

    /// Sums the elements of a vector in the order that `Op::Total` defines. Two adjacent partial sums share a
    /// register.
    pub fn total(&mut self, vector: ValueId) -> Value {
        let length = self.program.value(vector).extent.length();
        let first = length.min(PARTIAL_SUMS);
        let mut partial: Vec<Value> = pairs(0, first).map(|at| self.element(vector, at)).collect();
        let turns = length / PARTIAL_SUMS - usize::from(length >= PARTIAL_SUMS);
        partial = self.loop_turns(turns, PARTIAL_SUMS, partial, |writer, moving, partial| {
            let pairs = (0..PARTIAL_SUMS).step_by(2).zip(partial);
            pairs
                .map(|(element, sum)| {
                    let at = ElementRef::pair(Some(moving), PARTIAL_SUMS + element);
                    let element = writer.element(vector, at);
                    writer.instructions().fadd(*sum, element)
                })
                .collect()
        });
        for at in pairs((turns + 1) * PARTIAL_SUMS, length) {
            let element = self.element(vector, at);
            let sum = &mut partial[at.element % PARTIAL_SUMS / 2];
            *sum = match at.lanes {
                Lanes::Two => self.instructions().fadd(*sum, element),
                Lanes::One => {
                    let first = self.instructions().extractlane(*sum, 0);
                    let first = self.add(first, element);
                    self.instructions().insertlane(*sum, first, 0)
                }
            };
        }
        self.sum_pairwise(&partial, first)
    }

    /// Returns the pairwise sum of the first `count` lanes.
    fn sum_pairwise(&mut self, registers: &[Value], count: usize) -> Value {
        let mut sums: Vec<Value> = Vec::new();
        for (register, at) in registers.iter().zip(pairs(0, count)) {
            sums.push(match at.lanes {
                Lanes::One => *register,
                Lanes::Two => {
                    let left = self.instructions().extractlane(*register, 0);
                    let right = self.instructions().extractlane(*register, 1);
                    self.instructions().fadd(left, right)
                }
            });
        }
        while sums.len() > 1 {
            sums = sums
                .chunks(2)
                .map(|neighbours| match *neighbours {
                    [left, right] => self.instructions().fadd(left, right),
                    _ => neighbours[0],
                })
                .collect();
        }
        match sums.first() {
            Some(sum) => *sum,
            None => self.literal(0.0, Lanes::One),
        }
    }
}
