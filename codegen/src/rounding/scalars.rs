//! Program as a list of operations on scalars. The list is recorded by an evaluation with handles in place of
//! numbers; equal operations are merged.

use std::cell::RefCell;
use std::collections::HashMap;
use std::mem::{Discriminant, discriminant};
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

use eomgen_model_spec::function::Function;

use super::format::Format;
use crate::program::evaluator::{NO_POINT, Number, Places, step};
use crate::program::{Extent, Op, Program, ValueId, Variable};
use crate::statements::collect_coefficients;

/// Operation on numbers; operands are indices in [`Scalars::list`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ScalarOp {
    /// Number.
    Constant(f64),
    /// Component of a [point](Program::point_place): time, state, input or independent parameter.
    Variable(usize),
    /// Conversion from double precision.
    Convert(usize),
    /// -a
    Negate(usize),
    /// a + b
    Add(usize, usize),
    /// a - b
    Subtract(usize, usize),
    /// a b
    Multiply(usize, usize),
    /// a / b
    Divide(usize, usize),
    /// a^b
    Power(usize, usize),
    /// Function of two arguments; if it has one argument, both operands are equal.
    Call(Function, usize, usize),
    /// `if a > b { then } else { otherwise }`: a, b, then, otherwise.
    Select([usize; 4]),
    /// a if a > 0, else NaN.
    Positive(usize),
}

/// Kind, constant or function, and operands of an operation.
type Key = (Discriminant<ScalarOp>, u64, [usize; 4]);

impl ScalarOp {
    /// Returns the operands; an operand may be repeated.
    pub(super) fn operands(&self) -> impl Iterator<Item = usize> + use<> {
        let operands = match *self {
            Self::Constant(_) | Self::Variable(_) => [None; 4],
            Self::Convert(a) | Self::Negate(a) | Self::Positive(a) => [Some(a), None, None, None],
            Self::Add(a, b)
            | Self::Subtract(a, b)
            | Self::Multiply(a, b)
            | Self::Divide(a, b)
            | Self::Power(a, b)
            | Self::Call(_, a, b) => [Some(a), Some(b), None, None],
            Self::Select(all) => all.map(Some),
        };
        operands.into_iter().flatten()
    }

    /// Returns a key that is equal only for equal operations.
    fn key(&self) -> Key {
        let mut operands = [0; 4];
        for (slot, operand) in operands.iter_mut().zip(self.operands()) {
            *slot = operand;
        }
        let payload = match *self {
            Self::Constant(number) => number.to_bits(),
            Self::Variable(place) => place as u64,
            Self::Call(function, ..) => function as u64,
            _ => 0,
        };
        (discriminant(self), payload, operands)
    }
}

/// Number in the list.
#[derive(Clone, Copy, Debug)]
pub struct Scalar {
    /// Operation.
    pub op: ScalarOp,
    /// Format of the result.
    pub format: Format,
    /// Value of the program that contains the number.
    pub value: ValueId,
}

/// Program as a list of operations on single numbers.
pub struct Scalars {
    /// Numbers, operands first.
    pub list: Vec<Scalar>,
    places: Places,
    /// Index of each element of the program's values.
    elements: Vec<Recorded>,
}

impl Scalars {
    /// Records the values that `roots` depend on, computed in `format`. In single precision coefficients are prepared in
    /// double precision and converted, as in the emitted code.
    pub fn record(program: &Program, roots: &[ValueId], format: Format) -> Self {
        let places = Places::new(program);
        let reachable = program.reachable(roots);
        let is_prepared = |id: &&ValueId| program.value(**id).parameter_only;
        let outer = RECORDER.replace(Recorder::new());
        let mut elements = vec![Recorded::constant(f64::NAN); places.size()];
        for id in reachable.iter().filter(is_prepared) {
            record_value(program, &places, *id, &mut elements);
        }
        if format == Format::Single {
            let coefficients = collect_coefficients(program);
            for id in reachable.iter().filter(is_prepared) {
                convert(program, &places, *id, &mut elements);
            }
            RECORDER.with_borrow_mut(|recorder| recorder.format = Format::Single);
            let computed = |id: &&ValueId| is_prepared(id) && !coefficients.contains(id);
            for id in reachable.iter().filter(computed) {
                record_computed(program, &places, *id, &mut elements);
            }
        }
        for id in reachable.iter().filter(|id| !is_prepared(id)) {
            record_value(program, &places, *id, &mut elements);
        }
        Self {
            list: RECORDER.replace(outer).list,
            places,
            elements,
        }
    }

    /// Returns the index of an element of a value; scalars are repeated.
    pub fn element(&self, program: &Program, id: ValueId, index: usize) -> usize {
        let index = match program.value(id).extent {
            Extent::Scalar => 0,
            _ => index,
        };
        self.elements[self.places.offset(id) + index].0
    }

    /// Returns all numbers that the number `root` depends on, operands first.
    pub fn reachable(&self, root: usize) -> Vec<usize> {
        let mut needed = vec![false; root + 1];
        needed[root] = true;
        for index in (0..=root).rev() {
            if needed[index] {
                for operand in self.list[index].op.operands() {
                    needed[operand] = true;
                }
            }
        }
        (0..=root).filter(|index| needed[*index]).collect()
    }

    /// Computes all numbers at a [point](Program::point_place). Conversions are exact.
    pub fn evaluate<N: Number>(&self, point: &[f64]) -> Vec<N> {
        let mut known: Vec<N> = Vec::with_capacity(self.list.len());
        for scalar in &self.list {
            let number = compute(&scalar.op, point, |operand| known[operand]);
            known.push(number);
        }
        known
    }

    /// Computes all numbers at a [point](Program::point_place), each in its format. States and inputs must be
    /// representable in the format.
    pub fn evaluate_rounded(&self, point: &[f64]) -> Vec<f64> {
        let mut known: Vec<f64> = Vec::with_capacity(self.list.len());
        for scalar in &self.list {
            known.push(match scalar.format {
                Format::Double => compute(&scalar.op, point, |operand| known[operand]),
                Format::Single => {
                    f64::from(compute(&scalar.op, point, |operand| known[operand] as f32))
                }
            });
        }
        known
    }
}

/// Computes an operation from its operands.
fn compute<N: Number>(op: &ScalarOp, point: &[f64], known: impl Fn(usize) -> N) -> N {
    match *op {
        ScalarOp::Constant(number) => N::constant(number),
        ScalarOp::Variable(place) => N::constant(point[place]),
        ScalarOp::Convert(a) => known(a),
        ScalarOp::Negate(a) => -known(a),
        ScalarOp::Add(a, b) => known(a) + known(b),
        ScalarOp::Subtract(a, b) => known(a) - known(b),
        ScalarOp::Multiply(a, b) => known(a) * known(b),
        ScalarOp::Divide(a, b) => known(a) / known(b),
        ScalarOp::Power(a, b) => known(a).power(known(b)),
        ScalarOp::Call(function, a, b) => N::call(function, known(a), known(b)),
        ScalarOp::Select([a, b, then, otherwise]) => {
            N::select_greater(known(a), known(b), known(then), known(otherwise))
        }
        ScalarOp::Positive(a) => known(a).positive(),
    }
}

fn record_value(program: &Program, places: &Places, id: ValueId, elements: &mut [Recorded]) {
    let value = program.value(id);
    let Some(first) = variable_place(program, &value.op) else {
        return record_computed(program, places, id, elements);
    };
    let offset = places.offset(id);
    RECORDER.with_borrow_mut(|recorder| recorder.value = id);
    for index in 0..value.extent.length() {
        elements[offset + index] = emit(ScalarOp::Variable(first + index));
    }
}

fn record_computed(program: &Program, places: &Places, id: ValueId, elements: &mut [Recorded]) {
    RECORDER.with_borrow_mut(|recorder| recorder.value = id);
    step(elements, places, program, id, &NO_POINT);
}

fn convert(program: &Program, places: &Places, id: ValueId, elements: &mut [Recorded]) {
    RECORDER.with_borrow_mut(|recorder| {
        recorder.value = id;
        recorder.format = Format::Single;
    });
    let offset = places.offset(id);
    for element in &mut elements[offset..offset + program.value(id).extent.length()] {
        *element = emit(ScalarOp::Convert(element.0));
    }
}

/// Returns the index in a [point](Program::point_place) of the variable that an operation reads, if it reads one.
fn variable_place(program: &Program, op: &Op) -> Option<usize> {
    let place = |variable| Some(program.point_place(variable));
    match *op {
        Op::Parameter(parameter) => Some(1 + program.states() + program.inputs.len() + parameter),
        Op::Coordinate(id) => place(Variable::Coordinate(id)),
        Op::Rate(id) => place(Variable::Rate(id)),
        Op::ModeCoordinates(field) => place(Variable::ModeCoordinates(field)),
        Op::ModeRates(field) => place(Variable::ModeRates(field)),
        Op::State(id) => place(Variable::State(id)),
        Op::Input(id) => place(Variable::Input(id)),
        Op::Time => place(Variable::Time),
        _ => None,
    }
}

/// Index of a number in the list that this thread records.
#[derive(Clone, Copy, Debug)]
struct Recorded(usize);

struct Recorder {
    list: Vec<Scalar>,
    known: HashMap<(Format, Key), usize>,
    format: Format,
    value: ValueId,
}

impl Recorder {
    fn new() -> Self {
        Self {
            list: Vec::new(),
            known: HashMap::new(),
            format: Format::Double,
            value: ValueId(0),
        }
    }
}

thread_local! {
    static RECORDER: RefCell<Recorder> = RefCell::new(Recorder::new());
}

/// Records an operation if it is new, and returns the index of its result.
fn emit(op: ScalarOp) -> Recorded {
    RECORDER.with_borrow_mut(|recorder| {
        let key = (recorder.format, op.key());
        let scalar = Scalar {
            op,
            format: recorder.format,
            value: recorder.value,
        };
        let list = &mut recorder.list;
        Recorded(*recorder.known.entry(key).or_insert_with(|| {
            list.push(scalar);
            list.len() - 1
        }))
    })
}

macro_rules! record_operator {
    ($($operator:ident $method:ident $op:ident),*) => {$(
        impl $operator for Recorded {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                emit(ScalarOp::$op(self.0, other.0))
            }
        }
    )*};
}

record_operator!(Add add Add, Sub sub Subtract, Mul mul Multiply, Div div Divide);

impl Neg for Recorded {
    type Output = Self;
    fn neg(self) -> Self {
        emit(ScalarOp::Negate(self.0))
    }
}

impl AddAssign for Recorded {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Number for Recorded {
    fn constant(value: f64) -> Self {
        emit(ScalarOp::Constant(value))
    }

    fn call(function: Function, a: Self, b: Self) -> Self {
        emit(ScalarOp::Call(function, a.0, b.0))
    }

    fn power(self, exponent: Self) -> Self {
        emit(ScalarOp::Power(self.0, exponent.0))
    }

    fn select_greater(a: Self, b: Self, then: Self, otherwise: Self) -> Self {
        emit(ScalarOp::Select([a.0, b.0, then.0, otherwise.0]))
    }

    fn positive(self) -> Self {
        emit(ScalarOp::Positive(self.0))
    }
}
