//! Evaluation of one value of a program.

use super::matrices::{apply, assemble, cholesky, cholesky_solve, gram, gram_diagonal};
use super::number::Number;
use super::operands::Operands;
use super::places::Places;
use super::point::Point;
use crate::program::{Arguments, Op, PARTIAL_SUMS, Program, ValueId};

/// Computes the value `id` and stores it at its offset in `memory`.
pub(crate) fn step<N: Number>(
    memory: &mut [N],
    places: &Places,
    program: &Program,
    id: ValueId,
    point: &Point<'_>,
) {
    let value = &program.values[id.0];
    let (before, after) = memory.split_at_mut(places.offset(id));
    let out = &mut after[..value.extent.length()];
    let operands = Operands {
        memory: before,
        places,
        program,
    };
    let degrees = program.degrees_of_freedom();
    match &value.op {
        Op::Constant(number) => out[0] = N::constant(*number),
        Op::Table(place) => convert(out, &program.tables[*place].values),
        Op::Parameter(_) | Op::Argument(..) => {}
        Op::Coordinate(index) => out[0] = N::constant(point.state[*index]),
        Op::Rate(index) => out[0] = N::constant(point.state[degrees + index.index()]),
        Op::ModeCoordinates(field) => {
            let start = program.mode_offset(*field);
            convert(out, &point.state[start..]);
        }
        Op::ModeRates(field) => {
            let start = degrees + program.mode_offset(*field);
            convert(out, &point.state[start..]);
        }
        Op::State(index) => out[0] = N::constant(point.state[2 * degrees + index.index()]),
        Op::Input(index) => {
            out[0] = N::constant(point.inputs.get(index.index()).copied().unwrap_or(0.0));
        }
        Op::Time => out[0] = N::constant(point.t),
        Op::Negate(a) => unary(out, &operands, *a, |a| -a),
        Op::PivotReciprocal(a) => unary(out, &operands, *a, |a| N::constant(1.0) / a.positive()),
        Op::Add(a, b) => binary(out, &operands, *a, *b, |a, b| a + b),
        Op::Subtract(a, b) => binary(out, &operands, *a, *b, |a, b| a - b),
        Op::Multiply(a, b) => binary(out, &operands, *a, *b, |a, b| a * b),
        Op::Divide(a, b) => binary(out, &operands, *a, *b, |a, b| a / b),
        Op::Power(a, b) => binary(out, &operands, *a, *b, N::power),
        Op::Call(function, arguments) => match *arguments {
            Arguments::One([a]) => unary(out, &operands, a, |a| N::call(*function, a, a)),
            Arguments::Two([a, b]) => {
                binary(out, &operands, a, b, |a, b| N::call(*function, a, b));
            }
        },
        Op::Select {
            a,
            b,
            then,
            otherwise,
        } => {
            let (a, b) = (operands.strided(*a), operands.strided(*b));
            let (then, otherwise) = (operands.strided(*then), operands.strided(*otherwise));
            for (i, slot) in out.iter_mut().enumerate() {
                *slot = N::select_greater(
                    a.0[i * a.1],
                    b.0[i * b.1],
                    then.0[i * then.1],
                    otherwise.0[i * otherwise.1],
                );
            }
        }
        Op::Total(a) => out[0] = total(operands.slice(*a)),
        Op::Apply {
            matrix,
            transposed,
            vector,
        } => apply(
            out,
            operands.matrix(*matrix),
            *transposed,
            operands.strided(*vector),
        ),
        Op::Gram {
            left,
            weight,
            right,
        } => gram(out, &operands, [*left, *weight, *right]),
        Op::GramDiagonal {
            left,
            weight,
            right,
        } => gram_diagonal(out, &operands, [*left, *weight, *right]),
        Op::Assemble {
            diagonal,
            outer,
            matrices,
        } => assemble(
            out,
            value.extent.columns(),
            &operands,
            (*diagonal, outer, matrices),
        ),
        Op::Cholesky(matrix) => {
            let (matrix, size, _) = operands.matrix(*matrix);
            cholesky(out, matrix, size);
        }
        Op::CholeskySolve(factor, right) => {
            let columns = value.extent.columns();
            cholesky_solve(
                out,
                columns,
                operands.matrix(*factor),
                operands.strided(*right),
            );
        }
    }
}

/// Sums the elements in the order that `Op::Total` defines.
fn total<N: Number>(elements: &[N]) -> N {
    let (first, rest) = elements.split_at(elements.len().min(PARTIAL_SUMS));
    let mut partial = [N::constant(0.0); PARTIAL_SUMS];
    partial[..first.len()].copy_from_slice(first);
    for (i, x) in rest.iter().enumerate() {
        partial[i % PARTIAL_SUMS] += *x;
    }
    let mut count = first.len();
    while count > 1 {
        for k in 0..count / 2 {
            partial[k] = partial[2 * k] + partial[2 * k + 1];
        }
        if !count.is_multiple_of(2) {
            partial[count / 2] = partial[count - 1];
        }
        count = count.div_ceil(2);
    }
    partial[0]
}

/// Converts numbers to the number type of the computation; `numbers` must be at least as long as `out`.
fn convert<N: Number>(out: &mut [N], numbers: &[f64]) {
    for (slot, number) in out.iter_mut().zip(numbers) {
        *slot = N::constant(*number);
    }
}

fn unary<N: Number>(
    out: &mut [N],
    operands: &Operands<'_, N>,
    a: ValueId,
    function: impl Fn(N) -> N,
) {
    let (a, stride) = operands.strided(a);
    for (i, slot) in out.iter_mut().enumerate() {
        *slot = function(a[i * stride]);
    }
}

fn binary<N: Number>(
    out: &mut [N],
    operands: &Operands<'_, N>,
    a: ValueId,
    b: ValueId,
    function: impl Fn(N, N) -> N,
) {
    let (a, b) = (operands.strided(a), operands.strided(b));
    for (i, slot) in out.iter_mut().enumerate() {
        *slot = function(a.0[i * a.1], b.0[i * b.1]);
    }
}
