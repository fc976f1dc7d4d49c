//! Code of elementary functions, written from their kernels, and of selections, without branches.
//!
//! All functions process two lanes and represent comparisons as bit masks; a single number is stored in both lanes. A
//! division by 0 or a NaN in one lane has no effect on the other lane.

use std::rc::Rc;

use cranelift_codegen::ir::condcodes::FloatCC;
use cranelift_codegen::ir::{InstBuilder, MemFlagsData, Value, types};
use eomgen_codegen::program::Arguments;
use eomgen_codegen::program::evaluator::elementary;
use eomgen_elementary::{Function as Elementary, Kernel, Operation};
use eomgen_model_spec::model::Function;

use crate::branches::Branches;
use crate::lanes::Lanes;
use crate::stage::Writer;

const SIGN: u64 = 1 << 63;
const MANTISSA: u64 = (1 << 52) - 1;
/// Mask of the exponent field after a shift to the right.
const EXPONENT: u64 = 0x7ff;
/// 2^52. If an integer k < 2^52 is written to the mantissa bits, the number is 2^52 + k.
const ALIGNER: f64 = (1_u64 << 52) as f64;

impl Writer<'_, '_, '_> {
    /// Computes a function of the expression language.
    pub fn call(&mut self, function: Function, arguments: Arguments<Value>, lanes: Lanes) -> Value {
        let function = elementary(function);
        match arguments {
            Arguments::One(one) => self.function(function, one, lanes),
            Arguments::Two(two) => self.function(function, two, lanes),
        }
    }

    /// Computes an elementary function from its kernel.
    pub fn function<const N: usize>(
        &mut self,
        function: Elementary,
        arguments: [Value; N],
        lanes: Lanes,
    ) -> Value {
        self.combine_lanes(arguments, lanes, |writer, arguments| {
            writer.operations(function, &arguments, lanes)
        })
    }

    /// Computes the square root of one number if a > 0, else NaN.
    pub fn positive_root(&mut self, a: Value) -> Value {
        self.combine_lanes([a], Lanes::One, |writer, [a]| {
            let root = writer.operations(Elementary::Sqrt, &[a], Lanes::One);
            writer.select_if_positive(a, root)
        })
    }

    /// Computes `if a > b { then } else { otherwise }`.
    pub fn select(&mut self, operands: [Value; 4], lanes: Lanes) -> Value {
        self.combine_lanes(operands, lanes, |writer, [a, b, then, otherwise]| {
            let mask = writer.compare(FloatCC::GreaterThan, a, b);
            writer.instructions().bitselect(mask, then, otherwise)
        })
    }

    fn select_if_positive(&mut self, a: Value, value: Value) -> Value {
        let zero = self.literal(0.0, Lanes::Two);
        let nan = self.literal(f64::NAN, Lanes::Two);
        let mask = self.compare(FloatCC::GreaterThan, a, zero);
        self.instructions().bitselect(mask, value, nan)
    }

    /// Runs `body` on two lanes; a single number is stored in both.
    fn combine_lanes<const N: usize>(
        &mut self,
        arguments: [Value; N],
        lanes: Lanes,
        body: impl FnOnce(&mut Self, [Value; N]) -> Value,
    ) -> Value {
        if lanes == Lanes::Two {
            return body(self, arguments);
        }
        let both = arguments.map(|argument| self.instructions().splat(types::F64X2, argument));
        let value = body(self, both);
        self.instructions().extractlane(value, 0)
    }

    /// Sets all bits of a lane if the comparison is true.
    fn compare(&mut self, condition: FloatCC, a: Value, b: Value) -> Value {
        let mask = self.instructions().fcmp(condition, a, b);
        self.as_numbers(mask)
    }

    fn as_numbers(&mut self, bits: Value) -> Value {
        let flags = MemFlagsData::new();
        self.instructions().bitcast(types::F64X2, flags, bits)
    }

    fn as_bits(&mut self, numbers: Value) -> Value {
        let flags = MemFlagsData::new();
        self.instructions().bitcast(types::I64X2, flags, numbers)
    }

    fn bits(&mut self, bits: u64) -> Value {
        self.literal(f64::from_bits(bits), Lanes::Two)
    }

    /// Computes a function operation by operation. `lanes` states whether the two lanes contain different numbers.
    fn operations(&mut self, function: Elementary, arguments: &[Value], lanes: Lanes) -> Value {
        let kernels = &mut self.shared.kernels;
        let entry = kernels.entry(function).or_insert_with(|| {
            let kernel = function.kernel();
            let branches = Branches::of(&kernel);
            Rc::new((kernel, branches))
        });
        let entry = Rc::clone(entry);
        let (kernel, branches) = &*entry;
        match lanes {
            Lanes::One => self.write_branching_kernel(kernel, branches, arguments),
            Lanes::Two => self.kernel(kernel, arguments),
        }
    }

    fn kernel(&mut self, kernel: &Kernel, arguments: &[Value]) -> Value {
        let mut values = Vec::with_capacity(kernel.operations.len());
        for operation in &kernel.operations {
            let value = self.primitive(kernel, *operation, |place| values[place], arguments);
            values.push(value);
        }
        values[kernel.outputs[0]]
    }

    /// Writes one operation of a kernel. `value` returns the results of earlier operations.
    pub fn primitive(
        &mut self,
        kernel: &Kernel,
        operation: Operation,
        value: impl Fn(usize) -> Value,
        inputs: &[Value],
    ) -> Value {
        use Operation as O;
        match operation {
            O::Input(place) => inputs[place],
            O::Constant(value) => self.literal(value, Lanes::Two),
            O::Add(a, b) => self.add(value(a), value(b)),
            O::Sub(a, b) => self.instructions().fsub(value(a), value(b)),
            O::Mul(a, b) => self.multiply(value(a), value(b)),
            O::Div(a, b) => self.instructions().fdiv(value(a), value(b)),
            O::Neg(a) => self.negate(value(a), Lanes::Two),
            O::Abs(a) => self.magnitude(value(a)),
            O::CopySign { magnitude, sign } => {
                let magnitude = self.magnitude(value(magnitude));
                let mask = self.bits(SIGN);
                let sign = self.instructions().band(value(sign), mask);
                self.instructions().bor(magnitude, sign)
            }
            O::SelectLess {
                left,
                right,
                then,
                otherwise,
            } => {
                let mask = self.compare(FloatCC::LessThan, value(left), value(right));
                // All bits of zero are 0.
                match kernel.operations[otherwise] {
                    O::Constant(zero) if zero.to_bits() == 0 => {
                        self.instructions().band(mask, value(then))
                    }
                    _ => self
                        .instructions()
                        .bitselect(mask, value(then), value(otherwise)),
                }
            }
            O::SelectEqual {
                left,
                right,
                then,
                otherwise,
            } => {
                let mask = self.compare(FloatCC::Equal, value(left), value(right));
                self.instructions()
                    .bitselect(mask, value(then), value(otherwise))
            }
            O::PowerOfTwo(a) => {
                let aligner = self.literal(ALIGNER + 1023.0, Lanes::Two);
                let sum = self.instructions().fadd(value(a), aligner);
                let bits = self.as_bits(sum);
                let bits = self.instructions().ishl_imm_u(bits, 52);
                self.as_numbers(bits)
            }
            O::Exponent(a) => self.exponent(value(a)),
            O::Significand(a) => {
                let mantissa = self.bits(MANTISSA);
                let one = self.literal(1.0, Lanes::Two);
                let field = self.instructions().band(value(a), mantissa);
                self.instructions().bor(field, one)
            }
        }
    }

    fn magnitude(&mut self, a: Value) -> Value {
        let mask = self.bits(!SIGN);
        self.instructions().band(a, mask)
    }

    /// Converts the exponent field exactly to a number: adds it to the mantissa bits of 2^52 and subtracts 2^52.
    fn exponent(&mut self, a: Value) -> Value {
        let bits = self.as_bits(a);
        let field = self.instructions().ushr_imm_u(bits, 52);
        let field = self.as_numbers(field);
        let mask = self.bits(EXPONENT);
        let field = self.instructions().band(field, mask);
        let aligner = self.literal(ALIGNER, Lanes::Two);
        let shifted = self.instructions().bor(field, aligner);
        let number = self.instructions().fsub(shifted, aligner);
        let bias = self.literal(1023.0, Lanes::Two);
        self.instructions().fsub(number, bias)
    }
}
