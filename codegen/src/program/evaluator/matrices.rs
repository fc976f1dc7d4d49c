//! Matrix operations of the evaluator: products, Gram matrices, assembled blocks and Cholesky factors, with
//! the order of summation that the program defines.

use eomgen_model_spec::function::Function;

use super::number::Number;
use super::operands::Operands;
use crate::program::{ScaledValue, ValueId};

/// Computes left^T diag(weight) right.
pub(super) fn gram<N: Number>(
    out: &mut [N],
    operands: &Operands<'_, N>,
    [left, weight, right]: [ValueId; 3],
) {
    let (left, nodes, rows) = operands.matrix(left);
    let (right, _, columns) = operands.matrix(right);
    let (weight, stride) = operands.strided(weight);
    for r in 0..rows {
        for c in 0..columns {
            out[r * columns + c] = (0..nodes).fold(N::constant(0.0), |total, g| {
                total + left[g * rows + r] * weight[g * stride] * right[g * columns + c]
            });
        }
    }
}

/// Computes the diagonal of left^T diag(weight) right.
pub(super) fn gram_diagonal<N: Number>(
    out: &mut [N],
    operands: &Operands<'_, N>,
    [left, weight, right]: [ValueId; 3],
) {
    let (left, nodes, modes) = operands.matrix(left);
    let (right, ..) = operands.matrix(right);
    let (weight, stride) = operands.strided(weight);
    for (r, slot) in out.iter_mut().enumerate() {
        *slot = (0..nodes).fold(N::constant(0.0), |total, g| {
            total + left[g * modes + r] * weight[g * stride] * right[g * modes + r]
        });
    }
}

/// Multiplies a matrix, or its transpose, by a vector.
pub(super) fn apply<N: Number>(
    out: &mut [N],
    (matrix, rows, columns): (&[N], usize, usize),
    transposed: bool,
    (vector, stride): (&[N], usize),
) {
    for (i, slot) in out.iter_mut().enumerate() {
        *slot = if transposed {
            (0..rows).fold(N::constant(0.0), |total, g| {
                total + matrix[g * columns + i] * vector[g * stride]
            })
        } else {
            (0..columns).fold(N::constant(0.0), |total, c| {
                total + matrix[i * columns + c] * vector[c * stride]
            })
        };
    }
}

/// Computes a matrix of `columns` columns from its diagonal, outer products and scaled matrices.
pub(super) fn assemble<N: Number>(
    out: &mut [N],
    columns: usize,
    operands: &Operands<'_, N>,
    (diagonal, outer, matrices): (Option<ValueId>, &[(ValueId, ValueId)], &[ScaledValue]),
) {
    out.fill(N::constant(0.0));
    if let Some(diagonal) = diagonal {
        let (diagonal, stride) = operands.strided(diagonal);
        for r in 0..columns {
            out[r * columns + r] += diagonal[r * stride];
        }
    }
    for (u, v) in outer {
        let (u, v) = (operands.strided(*u), operands.strided(*v));
        for (place, slot) in out.iter_mut().enumerate() {
            *slot += u.0[place / columns * u.1] * v.0[place % columns * v.1];
        }
    }
    for scaled in matrices {
        let (matrix, _, width) = operands.matrix(scaled.matrix);
        let (row, column) = (
            operands.strided(scaled.row),
            operands.strided(scaled.column),
        );
        for (place, slot) in out.iter_mut().enumerate() {
            let (r, c) = (place / columns, place % columns);
            let entry = if scaled.transposed {
                matrix[c * width + r]
            } else {
                matrix[r * width + c]
            };
            *slot += row.0[r * row.1] * entry * column.0[c * column.1];
        }
    }
}

/// Computes the factor L of L L^T = matrix, row by row; the upper part of `out` becomes 0.
pub(super) fn cholesky<N: Number>(out: &mut [N], matrix: &[N], size: usize) {
    out.fill(N::constant(0.0));
    for r in 0..size {
        for c in 0..=r {
            let rest = (0..c).fold(matrix[r * size + c], |rest, k| {
                rest - out[r * size + k] * out[c * size + k]
            });
            out[r * size + c] = if r == c {
                let pivot = rest.positive();
                N::call(Function::Sqrt, pivot, pivot)
            } else {
                rest / out[c * size + c]
            };
        }
    }
}

/// Solves for `columns` right-hand sides; with stride 0 all rows share one number.
pub(super) fn cholesky_solve<N: Number>(
    out: &mut [N],
    columns: usize,
    (factor, size, _): (&[N], usize, usize),
    (right, stride): (&[N], usize),
) {
    for column in 0..columns {
        let right = (right, stride * columns);
        solve_column(out, (column, columns), factor, size, right);
    }
}

/// Solves for one column of the right-hand side. Both arrays hold `columns` numbers in a row; with stride 0
/// all rows of the right-hand side share one number.
fn solve_column<N: Number>(
    out: &mut [N],
    (column, columns): (usize, usize),
    factor: &[N],
    size: usize,
    (right, stride): (&[N], usize),
) {
    let at = |r: usize| r * columns + column;
    for r in 0..size {
        let rest = (0..r).fold(right[r * stride + column], |rest, k| {
            rest - factor[r * size + k] * out[at(k)]
        });
        out[at(r)] = rest / factor[r * size + r];
    }
    for r in (0..size).rev() {
        let rest = (r + 1..size).fold(out[at(r)], |rest, k| {
            rest - factor[k * size + r] * out[at(k)]
        });
        out[at(r)] = rest / factor[r * size + r];
    }
}
