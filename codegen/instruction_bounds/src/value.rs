//! Partly known contents of registers and of the stack.

/// Content of a register or of a word of the stack.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Value {
    /// Number whose bits in the mask `known` equal those of `bits`.
    Bits {
        /// Mask of the known bits.
        known: u32,
        /// Values of the known bits; 0 at unknown bits.
        bits: u32,
    },
    /// Address at a known offset from a base address.
    Address(Base, u32),
    /// Unknown address within the stack of the function.
    Frame,
}

/// Base of an address.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Base {
    /// Value of a core register at the first instruction of the function.
    Entry(u8),
    /// Instructions of a section.
    Code(u32),
    /// Symbol with this number in the listing.
    Symbol(usize),
}

/// Register number of the stack pointer.
pub const SP: u8 = 13;

/// Unknown number.
pub const UNKNOWN: Value = Value::Bits { known: 0, bits: 0 };

/// Condition flags, if known.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Flags {
    /// Negative.
    pub n: Option<bool>,
    /// Zero.
    pub z: Option<bool>,
    /// Carry.
    pub c: Option<bool>,
    /// Overflow.
    pub v: Option<bool>,
}

impl Value {
    /// Returns a known number.
    pub fn number(bits: u32) -> Self {
        Self::Bits {
            known: u32::MAX,
            bits,
        }
    }

    /// Returns the number if all bits are known.
    pub fn as_number(self) -> Option<u32> {
        match self {
            Self::Bits {
                known: u32::MAX,
                bits,
            } => Some(bits),
            _ => None,
        }
    }

    /// Returns the offset of an address within or above the stack of the function.
    pub fn as_stack_offset(self) -> Option<i32> {
        match self {
            Self::Address(Base::Entry(SP), offset) => Some(offset as i32),
            _ => None,
        }
    }

    /// Returns true if the value may be an address of the function's stack.
    pub fn is_stack_address(self) -> bool {
        self == Self::Frame || self.as_stack_offset().is_some()
    }

    /// Returns a value with the bits that are known and equal in both values.
    pub fn join(self, other: Self) -> Self {
        match (self, other) {
            _ if self == other => self,
            (Self::Bits { known, bits }, Self::Bits { known: k, bits: b }) => {
                let known = known & k & !(bits ^ b);
                Self::Bits {
                    known,
                    bits: bits & known,
                }
            }
            _ => opaque(&[self, other]),
        }
    }

    /// Returns the mask of known bits and their values.
    fn parts(self) -> (u32, u32) {
        match self {
            Self::Bits { known, bits } => (known, bits),
            _ => (0, 0),
        }
    }

    /// Returns the flags N and Z of a result.
    pub fn sign_and_zero(self) -> (Option<bool>, Option<bool>) {
        let (known, bits) = self.parts();
        let n = (known >> 31 == 1).then_some(bits >> 31 == 1);
        let z = match (bits != 0, known == u32::MAX) {
            (true, _) => Some(false),
            (false, true) => Some(true),
            _ => None,
        };
        (n, z)
    }
}

/// Returns the result of an operation that is not modelled: an unknown stack address if an operand is a stack
/// address, else an unknown number.
pub fn opaque(operands: &[Value]) -> Value {
    match operands.iter().any(|value| value.is_stack_address()) {
        true => Value::Frame,
        false => UNKNOWN,
    }
}

/// Returns the bit-wise complement.
pub fn complement(value: Value) -> Value {
    match value {
        Value::Bits { known, bits } => Value::Bits {
            known,
            bits: !bits & known,
        },
        _ => opaque(&[value]),
    }
}

/// Returns `left & right`.
pub fn and(left: Value, right: Value) -> Value {
    let ((k, b), (m, c)) = (left.parts(), right.parts());
    if left.is_stack_address() || right.is_stack_address() {
        return Value::Frame;
    }
    let known = (k & m) | (k & !b) | (m & !c);
    Value::Bits {
        known,
        bits: b & c & known,
    }
}

/// Returns `left | right`.
pub fn or(left: Value, right: Value) -> Value {
    if left.is_stack_address() || right.is_stack_address() {
        return Value::Frame;
    }
    complement(and(complement(left), complement(right)))
}

/// Returns `left ^ right`.
pub fn xor(left: Value, right: Value) -> Value {
    if left.is_stack_address() || right.is_stack_address() {
        return Value::Frame;
    }
    let ((k, b), (m, c)) = (left.parts(), right.parts());
    let known = k & m;
    Value::Bits {
        known,
        bits: (b ^ c) & known,
    }
}

/// Returns `left + right + carry` with its flags.
pub fn add(left: Value, right: Value, carry: Option<bool>) -> (Value, Flags) {
    let moved = match (left, right) {
        (Value::Address(base, offset), other) | (other, Value::Address(base, offset)) => {
            match (other.as_number(), carry) {
                (Some(number), Some(carry)) => {
                    let offset = offset.wrapping_add(number).wrapping_add(u32::from(carry));
                    Some(Value::Address(base, offset))
                }
                _ => Some(opaque(&[left, right])),
            }
        }
        (Value::Frame, _) | (_, Value::Frame) => Some(Value::Frame),
        _ => None,
    };
    if let Some(value) = moved {
        return (value, Flags::default());
    }
    let ((k, b), (m, c)) = (left.parts(), right.parts());
    let bit = |known: u32, bits: u32, place: u32| {
        (known >> place & 1 == 1).then_some(bits >> place & 1 == 1)
    };
    let (mut known, mut bits) = (0, 0);
    let (mut into, mut before_last) = (carry, carry);
    for place in 0..32 {
        let (x, y) = (bit(k, b, place), bit(m, c, place));
        if let (Some(x), Some(y), Some(carry)) = (x, y, into) {
            known |= 1 << place;
            bits |= u32::from(x ^ y ^ carry) << place;
        }
        before_last = into;
        into = majority(x, y, into);
    }
    let value = Value::Bits { known, bits };
    let (n, z) = value.sign_and_zero();
    let v = into.zip(before_last).map(|(out, before)| out != before);
    (value, Flags { n, z, c: into, v })
}

/// Returns the majority value of three bits, if known.
fn majority(x: Option<bool>, y: Option<bool>, z: Option<bool>) -> Option<bool> {
    [(x, y), (y, z), (x, z)]
        .into_iter()
        .find_map(|(a, b)| a.filter(|_| a == b))
}

/// Returns `left - right - !carry` with its flags; `carry` is true for a plain difference.
pub fn subtract(left: Value, right: Value, carry: Option<bool>) -> (Value, Flags) {
    if let (Value::Address(base, x), Value::Address(other, y)) = (left, right)
        && base == other
        && carry == Some(true)
    {
        let value = Value::number(x.wrapping_sub(y));
        let (n, z) = value.sign_and_zero();
        // Carry and overflow depend on the base address, which is unknown.
        let flags = Flags {
            n,
            z,
            ..Flags::default()
        };
        return (value, flags);
    }
    match (left, right.as_number()) {
        (Value::Address(..), Some(number)) => add(left, Value::number(!number), carry),
        (Value::Address(..) | Value::Frame, _) => (opaque(&[left, right]), Flags::default()),
        _ => match right {
            Value::Bits { .. } => add(left, complement(right), carry),
            _ => (opaque(&[left, right]), Flags::default()),
        },
    }
}

/// Kind of a shift.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shift {
    /// To the left.
    Left,
    /// To the right, with zeros.
    Right,
    /// To the right, with copies of the sign.
    Arithmetic,
    /// Rotation to the right.
    Rotate,
    /// Rotation by one bit to the right through the carry flag.
    Extended,
}

/// Returns the shifted value and the carry flag. `places` is the number of bits, 0 to 31, or 32 for a shift to the
/// right.
pub fn shift(value: Value, kind: Shift, places: u32, carry: Option<bool>) -> (Value, Option<bool>) {
    let Value::Bits { known, bits } = value else {
        return match places {
            0 if kind != Shift::Extended => (value, carry),
            _ => (opaque(&[value]), None),
        };
    };
    let bit = |place: u32| (known >> place & 1 == 1).then_some(bits >> place & 1 == 1);
    if kind == Shift::Extended {
        let top = carry.map_or((0, 0), |carry| (1 << 31, u32::from(carry) << 31));
        let value = Value::Bits {
            known: known >> 1 | top.0,
            bits: bits >> 1 | top.1,
        };
        return (value, bit(0));
    }
    if places == 0 {
        return (value, carry);
    }
    if places > 31 {
        return (UNKNOWN, None);
    }
    let ones = |count: u32| (1_u32 << count) - 1;
    let upper = ones(places) << (32 - places);
    let (known, bits, out) = match kind {
        Shift::Left => (
            known << places | ones(places),
            bits << places,
            bit(32 - places),
        ),
        Shift::Right => (known >> places | upper, bits >> places, bit(places - 1)),
        Shift::Arithmetic => (
            (known as i32 >> places) as u32,
            (bits as i32 >> places) as u32,
            bit(places - 1),
        ),
        Shift::Rotate | Shift::Extended => (
            known.rotate_right(places),
            bits.rotate_right(places),
            bit(places - 1),
        ),
    };
    (Value::Bits { known, bits }, out)
}
