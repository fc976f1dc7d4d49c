//! Recording of a generic function: it is called with handles instead of numbers.
//!
//! Repeated operations and constants (same operation, same operands, same bits) are merged during the
//! recording; unused ones are removed at the end. Nothing else is changed.

use crate::kernel::{Kernel, Operation};
use crate::precision::Precision;
use crate::real::Real;
use std::cell::RefCell;
use std::collections::HashMap;
use std::marker::PhantomData;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Handle of a recorded value: the index of its operation in the current recording on this thread, in the number
/// format `P`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Traced<P>(usize, PhantomData<P>);

/// Records the operations of `body` for `inputs` arguments.
pub(crate) fn record<P: Precision>(
    inputs: usize,
    body: impl FnOnce(&[Traced<P>]) -> Vec<Traced<P>>,
) -> Kernel {
    let outer = RECORDER.take();
    let arguments: Vec<Traced<P>> = (0..inputs).map(|i| emit(Operation::Input(i))).collect();
    let outputs: Vec<usize> = body(&arguments).into_iter().map(|t| t.0).collect();
    let recorder = RECORDER.replace(outer);
    remove_dead_operations(inputs, &recorder.operations, &outputs)
}

thread_local! {
    static RECORDER: RefCell<Recorder> = RefCell::default();
}

#[derive(Default)]
struct Recorder {
    operations: Vec<Operation>,
    known: HashMap<Key, usize>,
}

/// Key of an operation; constants are compared by their bits.
#[derive(PartialEq, Eq, Hash)]
struct Key {
    kind: std::mem::Discriminant<Operation>,
    payload: u64,
    operands: Vec<usize>,
}

impl Key {
    fn new(operation: Operation) -> Key {
        let mut operands = Vec::new();
        operation.map_operands(|i| {
            operands.push(i);
            i
        });
        let payload = match operation {
            Operation::Constant(value) => value.to_bits(),
            Operation::Input(i) => i as u64,
            _ => 0,
        };
        Key {
            kind: std::mem::discriminant(&operation),
            payload,
            operands,
        }
    }
}

/// Records `operation` if it is new, and returns its handle.
fn emit<P>(operation: Operation) -> Traced<P> {
    RECORDER.with_borrow_mut(|recorder| {
        let Recorder { operations, known } = recorder;
        let index = *known.entry(Key::new(operation)).or_insert_with(|| {
            operations.push(operation);
            operations.len() - 1
        });
        Traced(index, PhantomData)
    })
}

/// Removes unused operations and renumbers the others in the same order.
fn remove_dead_operations(inputs: usize, all: &[Operation], outputs: &[usize]) -> Kernel {
    let mut needed = vec![false; all.len()];
    for &output in outputs {
        needed[output] = true;
    }
    for (index, operation) in all.iter().enumerate().rev() {
        if needed[index] {
            operation.map_operands(|operand| {
                needed[operand] = true;
                operand
            });
        }
    }
    let mut renumbered = vec![0; all.len()];
    let mut operations = Vec::new();
    for (index, operation) in all.iter().enumerate().filter(|(i, _)| needed[*i]) {
        renumbered[index] = operations.len();
        operations.push(operation.map_operands(|operand| renumbered[operand]));
    }
    Kernel {
        inputs,
        operations,
        outputs: outputs.iter().map(|&output| renumbered[output]).collect(),
    }
}

macro_rules! record_operator {
    ($($operator:ident $method:ident),*) => {$(
        impl<P: Precision> $operator for Traced<P> {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                emit(Operation::$operator(self.0, other.0))
            }
        }
    )*};
}

record_operator!(Add add, Sub sub, Mul mul, Div div);

impl<P: Precision> Neg for Traced<P> {
    type Output = Self;
    fn neg(self) -> Self {
        emit(Operation::Neg(self.0))
    }
}

impl<P: Precision> Real for Traced<P> {
    type Precision = P;

    fn constant(value: f64) -> Self {
        emit(Operation::Constant(P::round(value)))
    }

    fn abs(self) -> Self {
        emit(Operation::Abs(self.0))
    }

    fn copysign(self, sign: Self) -> Self {
        emit(Operation::CopySign {
            magnitude: self.0,
            sign: sign.0,
        })
    }

    fn select_less(left: Self, right: Self, then: Self, otherwise: Self) -> Self {
        emit(Operation::SelectLess {
            left: left.0,
            right: right.0,
            then: then.0,
            otherwise: otherwise.0,
        })
    }

    fn select_equal(left: Self, right: Self, then: Self, otherwise: Self) -> Self {
        emit(Operation::SelectEqual {
            left: left.0,
            right: right.0,
            then: then.0,
            otherwise: otherwise.0,
        })
    }

    fn power_of_two(self) -> Self {
        emit(Operation::PowerOfTwo(self.0))
    }

    fn exponent(self) -> Self {
        emit(Operation::Exponent(self.0))
    }

    fn significand(self) -> Self {
        emit(Operation::Significand(self.0))
    }
}
