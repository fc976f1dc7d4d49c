//! Programs with values in a wrong position are rejected. Such a value must not be emitted as NaN or as a matrix of
//! zeros.

use eomgen_codegen::program::{Extent, Op, Program, ValueId};
use eomgen_codegen::rust::{EmitError, Packaging, emit};

use crate::support::{program, shipped};

/// Returns the program of the beam after the operation of the first `wanted` value was replaced.
fn replace_operation(wanted: impl Fn(&Op, Extent) -> bool, op: impl Fn(ValueId) -> Op) -> Program {
    let mut program = program(&shipped("hub_beam_tip_mass"), 2);
    let found = program.ids().find(|id| {
        let value = program.value(*id);
        wanted(&value.op, value.extent)
    });
    let id = found.expect("a value of this kind");
    let operand = program.value(id).op.operands()[0];
    program.values[id.index()].op = op(operand);
    program
}

fn expect_rejection(program: &Program) -> String {
    match emit(program, Packaging::Crate) {
        Err(EmitError::Value(message)) => message,
        Err(other) => panic!("{other}"),
        Ok(_) => panic!("emitted"),
    }
}

#[test]
fn matrix_operation_as_number_is_rejected() {
    let number = |op: &Op, extent| matches!(op, Op::Multiply(..)) && extent == Extent::Scalar;
    let message = expect_rejection(&replace_operation(number, Op::Cholesky));
    assert!(
        message.contains("not an elementwise operation"),
        "{message}"
    );
}

#[test]
fn factor_as_vector_is_rejected() {
    let vector =
        |op: &Op, extent| matches!(op, Op::Multiply(..)) && matches!(extent, Extent::Vector(_));
    let message = expect_rejection(&replace_operation(vector, Op::Cholesky));
    assert!(message.contains("not a sum of products"), "{message}");
}

#[test]
fn elementwise_operation_as_matrix_is_rejected() {
    let block = |op: &Op, _| matches!(op, Op::Assemble { .. });
    let message = expect_rejection(&replace_operation(block, Op::Negate));
    assert!(message.contains("not a block of a matrix"), "{message}");
}
