//! Encoding of programs as bytes, for hosts that run a derived model without deriving it.
//!
//! Integers are written in groups of seven bits, `f64` numbers as eight bytes. Texts that appear only in reports and
//! emitted code are left out: titles, descriptions and the origin of parameters.

use eomgen_elementary::Function as Elementary;
use eomgen_model_spec::function::Function;
use eomgen_model_spec::ids::{CoordinateId, FieldId, InputId, ParameterId, StateId};

use crate::mechanics::impact::{Friction, Impact};
use crate::mechanics::outputs::{
    Corners, Jacobian, JacobianBlock, Outputs, RateRow, Side, SlidingSurface,
};
use crate::program::{
    Argument, Arguments, ControlOp, Extent, MassBlocks, MeasuredSource, Op, Program,
    ProgramController, ProgramField, ProgramGuard, ProgramParameter, ProgramTable, Quantity,
    RowValues, ScaledValue, Value, ValueId, Variable,
};

/// Value that can be written as bytes and read back.
pub trait Encoded: Sized {
    /// Appends the bytes of the value.
    fn encode(&self, bytes: &mut Vec<u8>);

    /// Reads a value from the start of `bytes` and removes its bytes from the slice; `None` if the bytes are damaged.
    fn decode(bytes: &mut &[u8]) -> Option<Self>;
}

/// Implements [`Encoded`] for structures, field by field. Fields after the semicolon are not written; they get their
/// defaults when read.
#[macro_export]
macro_rules! encode_structures {
    ($($of:ty { $($field:ident),* $(; $($default:ident),*)? })*) => {$(
        impl $crate::program::encoding::Encoded for $of {
            fn encode(&self, bytes: &mut Vec<u8>) {
                $(self.$field.encode(bytes);)*
            }

            fn decode(bytes: &mut &[u8]) -> Option<Self> {
                $(let $field = $crate::program::encoding::Encoded::decode(bytes)?;)*
                Some(Self { $($field,)* $($($default: Default::default(),)*)? })
            }
        }
    )*};
}

/// Implements [`Encoded`] for enumerations: the number of the variant, then its fields.
macro_rules! encode_enumerations {
    ($($of:ty {
        $($number:literal => $variant:ident $(($($place:ident),*))? $({$($field:ident),*})?,)*
    })*) => {$(
        impl Encoded for $of {
            fn encode(&self, bytes: &mut Vec<u8>) {
                match self {
                    $(Self::$variant $(($($place),*))? $({$($field),*})? => {
                        bytes.push($number);
                        $($($place.encode(bytes);)*)?
                        $($($field.encode(bytes);)*)?
                    })*
                }
            }

            fn decode(bytes: &mut &[u8]) -> Option<Self> {
                Some(match u8::decode(bytes)? {
                    $($number => {
                        $($(let $place = Encoded::decode(bytes)?;)*)?
                        $($(let $field = Encoded::decode(bytes)?;)*)?
                        Self::$variant $(($($place),*))? $({$($field),*})?
                    })*
                    _ => return None,
                })
            }
        }
    )*};
}

/// Implements [`Encoded`] for index types as integers.
macro_rules! encode_ids {
    ($($id:ty),*) => {$(
        impl Encoded for $id {
            fn encode(&self, bytes: &mut Vec<u8>) {
                self.index().encode(bytes);
            }

            fn decode(bytes: &mut &[u8]) -> Option<Self> {
                usize::decode(bytes).map(Self::new)
            }
        }
    )*};
}

impl Encoded for u8 {
    fn encode(&self, bytes: &mut Vec<u8>) {
        bytes.push(*self);
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        let (first, rest) = bytes.split_first()?;
        *bytes = rest;
        Some(*first)
    }
}

/// A function is encoded as its index in the list of all functions; new functions must be appended to this list.
impl Encoded for Elementary {
    fn encode(&self, bytes: &mut Vec<u8>) {
        bytes.push(*self as u8);
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        Self::ALL.get(usize::from(u8::decode(bytes)?)).copied()
    }
}

impl Encoded for bool {
    fn encode(&self, bytes: &mut Vec<u8>) {
        bytes.push(u8::from(*self));
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        u8::decode(bytes).map(|byte| byte != 0)
    }
}

impl Encoded for usize {
    fn encode(&self, bytes: &mut Vec<u8>) {
        let mut rest = *self;
        while rest > 0x7f {
            bytes.push((rest & 0x7f) as u8 | 0x80);
            rest >>= 7;
        }
        bytes.push(rest as u8);
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        let mut number: Self = 0;
        let mut shift = 0;
        loop {
            let byte = u8::decode(bytes)?;
            number |= Self::from(byte & 0x7f).checked_shl(shift)?;
            if byte & 0x80 == 0 {
                return Some(number);
            }
            shift += 7;
        }
    }
}

impl Encoded for f64 {
    fn encode(&self, bytes: &mut Vec<u8>) {
        bytes.extend(self.to_le_bytes());
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        let (first, rest) = bytes.split_first_chunk()?;
        *bytes = rest;
        Some(Self::from_le_bytes(*first))
    }
}

impl Encoded for String {
    fn encode(&self, bytes: &mut Vec<u8>) {
        self.len().encode(bytes);
        bytes.extend(self.as_bytes());
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        let length = usize::decode(bytes)?;
        let (text, rest) = bytes.split_at_checked(length)?;
        *bytes = rest;
        Self::from_utf8(text.to_vec()).ok()
    }
}

impl<T: Encoded> Encoded for Vec<T> {
    fn encode(&self, bytes: &mut Vec<u8>) {
        self.len().encode(bytes);
        self.iter().for_each(|element| element.encode(bytes));
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        let length = usize::decode(bytes)?;
        (0..length).map(|_| T::decode(bytes)).collect()
    }
}

impl<T: Encoded> Encoded for Option<T> {
    fn encode(&self, bytes: &mut Vec<u8>) {
        self.is_some().encode(bytes);
        if let Some(value) = self {
            value.encode(bytes);
        }
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        match bool::decode(bytes)? {
            true => T::decode(bytes).map(Some),
            false => Some(None),
        }
    }
}

impl<T: Encoded, const N: usize> Encoded for [T; N] {
    fn encode(&self, bytes: &mut Vec<u8>) {
        self.iter().for_each(|element| element.encode(bytes));
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        let elements = (0..N).map(|_| T::decode(bytes));
        elements.collect::<Option<Vec<T>>>()?.try_into().ok()
    }
}

impl<A: Encoded, B: Encoded> Encoded for (A, B) {
    fn encode(&self, bytes: &mut Vec<u8>) {
        self.0.encode(bytes);
        self.1.encode(bytes);
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        Some((A::decode(bytes)?, B::decode(bytes)?))
    }
}

impl Encoded for ValueId {
    fn encode(&self, bytes: &mut Vec<u8>) {
        self.0.encode(bytes);
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        usize::decode(bytes).map(Self)
    }
}

impl Encoded for Arguments<ValueId> {
    fn encode(&self, bytes: &mut Vec<u8>) {
        self.to_vec().encode(bytes);
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        Self::from_operands(Vec::decode(bytes)?)
    }
}

impl Encoded for Jacobian<ValueId> {
    fn encode(&self, bytes: &mut Vec<u8>) {
        (self.rows, self.columns).encode(bytes);
        self.entries.encode(bytes);
    }

    fn decode(bytes: &mut &[u8]) -> Option<Self> {
        let (rows, columns) = Encoded::decode(bytes)?;
        Some(Self {
            name: "",
            rows,
            columns,
            entries: Encoded::decode(bytes)?,
        })
    }
}

encode_ids!(CoordinateId, FieldId, InputId, ParameterId, StateId);

encode_structures! {
    Quantity { name; unit, doc }
    ProgramParameter { quantity, value; origin }
    ProgramField { coordinates, order; unit }
    ProgramGuard { formula, value, is_corner }
    ProgramTable { name, extent, values; doc }
    MassBlocks { scalars, coupling, modal }
    RowValues { scalars, modal }
    ScaledValue { row, matrix, transposed, column }
    Value { op, extent, parameter_only; name }
    Impact<ValueId, RowValues> {
        distance, rate, workless_rate, acceleration, restitution, row, column, delassus, friction
    }
    Friction<ValueId, RowValues> {
        coefficient, slip, workless_slip, acceleration, column, delassus
    }
    Side { guard, is_odd }
    SlidingSurface<ValueId, RowValues> {
        guard, disc, is_odd, is_linear, rate, by_sides, column, first_order
    }
    RateRow<ValueId, RowValues> { place, rate, row }
    Corners<ValueId, RowValues> { momenta, hamiltonian, energy, surfaces, constraints }
    JacobianBlock<ValueId> { row, rows, column, columns, diagonal, value }
    Outputs<ValueId, RowValues> {
        sliding, sides, corners, jacobians;
        kinds, bias_forces, inverse_dynamics, guard_rates, products, gradient_derivative, reactions,
        regimes
    }
    Program {
        parameters, coordinates, fields, first_order, inputs, observables, tables, values,
        accelerations, first_order_rates, mass, velocity_terms, forces, observable_values, guards,
        impacts, pivots, outputs, controllers;
        name, specification, title, spec_hash, coefficient_values, domain, trace
    }
    ProgramController {
        name, measured, sources, states, outputs, driven, values, times, initial, next,
        output_values;
        doc
    }
}

encode_enumerations! {
    Extent {
        0 => Scalar,
        1 => Vector(length),
        2 => Matrix(rows, columns),
    }
    Argument {
        0 => Accelerations,
        1 => Direction,
        2 => PointDirection,
        3 => Weights,
        4 => Sides,
    }
    Variable {
        0 => Coordinate(id),
        1 => ModeCoordinates(id),
        2 => Rate(id),
        3 => ModeRates(id),
        4 => State(id),
        5 => Input(id),
        6 => Parameter(id),
        7 => Time,
    }
    Function {
        0 => Sin,
        1 => Cos,
        2 => Tan,
        3 => Asin,
        4 => Acos,
        5 => Atan,
        6 => Atan2,
        7 => Sinh,
        8 => Cosh,
        9 => Tanh,
        10 => Exp,
        11 => Ln,
        12 => Sqrt,
        13 => Abs,
        14 => Sign,
        15 => Min,
        16 => Max,
        17 => Deadzone,
        18 => Contact,
        19 => Above,
    }
    MeasuredSource {
        0 => Time,
        1 => State(place),
        2 => Input(place),
        3 => Observable(place),
    }
    ControlOp {
        0 => Constant(value),
        1 => Parameter(place),
        2 => Period,
        3 => Measured(place),
        4 => State(place),
        5 => Negate(a),
        6 => Add(a, b),
        7 => Subtract(a, b),
        8 => Multiply(a, b),
        9 => Divide(a, b),
        10 => Call(function, arguments),
        11 => Elementary(function, arguments),
        12 => Select(parts),
    }
    Op {
        0 => Constant(value),
        1 => Table(place),
        2 => Parameter(place),
        3 => Coordinate(id),
        4 => Rate(id),
        5 => ModeCoordinates(id),
        6 => ModeRates(id),
        7 => State(id),
        8 => Input(id),
        9 => Time,
        10 => Argument(argument, variable),
        11 => Negate(a),
        12 => Add(a, b),
        13 => Subtract(a, b),
        14 => Multiply(a, b),
        15 => Divide(a, b),
        16 => Power(a, b),
        17 => Call(function, arguments),
        18 => Select { a, b, then, otherwise },
        19 => PivotReciprocal(a),
        20 => Total(a),
        21 => Apply { matrix, transposed, vector },
        22 => Gram { left, weight, right },
        23 => GramDiagonal { left, weight, right },
        24 => Assemble { diagonal, outer, matrices },
        25 => Cholesky(a),
        26 => CholeskySolve(a, b),
    }
}
