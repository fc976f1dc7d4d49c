//! Matrix operations of the evaluator: products, Gram matrices, assembled matrices and Cholesky factors, with the
//! order of summation that [`Op`](crate::program::Op) defines.

use eomgen_model_spec::function::Function;

use super::number::Number;
use super::operands::Operands;
use crate::program::cholesky::{self, MatrixLoops, Range};
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
        for (index, slot) in out.iter_mut().enumerate() {
            *slot += u.0[index / columns * u.1] * v.0[index % columns * v.1];
        }
    }
    for scaled in matrices {
        let (matrix, _, width) = operands.matrix(scaled.matrix);
        let (row, column) = (
            operands.strided(scaled.row),
            operands.strided(scaled.column),
        );
        for (index, slot) in out.iter_mut().enumerate() {
            let (r, c) = (index / columns, index % columns);
            let entry = if scaled.transposed {
                matrix[c * width + r]
            } else {
                matrix[r * width + c]
            };
            *slot += row.0[r * row.1] * entry * column.0[c * column.1];
        }
    }
}

/// Computes the lower Cholesky factor L with L L^T = matrix; the upper part of `out` is set to 0.
pub(super) fn cholesky<N: Number>(out: &mut [N], matrix: &[N], size: usize) {
    out.fill(N::constant(0.0));
    let mut execution = Execution {
        left: (matrix, size),
        right: (matrix, size),
        out: (out, size),
    };
    cholesky::factorise(&mut execution, &size, &Operand::Left, &Operand::Out);
}

/// Solves a system for `columns` right-hand sides. With stride 0, all rows of the right-hand side have the same
/// number.
pub(super) fn cholesky_solve<N: Number>(
    out: &mut [N],
    columns: usize,
    (factor, size, _): (&[N], usize, usize),
    (right, stride): (&[N], usize),
) {
    let mut execution = Execution {
        left: (factor, size),
        right: (right, stride * columns),
        out: (out, columns),
    };
    let both = [&Operand::Right, &Operand::Out];
    cholesky::solve(&mut execution, [&size, &columns], &Operand::Left, both);
}

/// Matrices of an operation, each with its row stride.
struct Execution<'a, N> {
    left: (&'a [N], usize),
    right: (&'a [N], usize),
    out: (&'a mut [N], usize),
}

enum Operand {
    Left,
    Right,
    Out,
}

impl<N: Number> MatrixLoops for Execution<'_, N> {
    type Index = usize;
    type Number = N;
    type Matrix = Operand;

    #[inline(always)]
    fn each(&mut self, _: &str, range: Range<usize>, mut body: impl FnMut(&mut Self, &usize)) {
        match range {
            Range::First(n) => (0..n).for_each(|i| body(self, &i)),
            Range::Reversed(n) => (0..n).rev().for_each(|i| body(self, &i)),
            Range::After(i, n) => (i + 1..n).for_each(|i| body(self, &i)),
        }
    }

    #[inline(always)]
    fn subtract_products(
        &mut self,
        first: N,
        range: Range<usize>,
        mut factors: impl FnMut(&mut Self, &usize) -> [N; 2],
    ) -> N {
        let mut rest = first;
        self.each("k", range, |execution, k| {
            let [a, b] = factors(execution, k);
            rest = rest - a * b;
        });
        rest
    }

    #[inline(always)]
    fn get_element(&mut self, matrix: &Operand, [row, column]: [&usize; 2]) -> N {
        match matrix {
            Operand::Left => self.left.0[row * self.left.1 + column],
            Operand::Right => self.right.0[row * self.right.1 + column],
            Operand::Out => self.out.0[row * self.out.1 + column],
        }
    }

    #[inline(always)]
    fn set_element(&mut self, _: &Operand, [row, column]: [&usize; 2], value: N) {
        self.out.0[row * self.out.1 + column] = value;
    }

    #[inline(always)]
    fn divide(&mut self, a: N, b: N) -> N {
        a / b
    }

    #[inline(always)]
    fn root_or_nan(&mut self, a: N) -> N {
        let pivot = a.positive();
        N::call(Function::Sqrt, pivot, pivot)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Product L L^T of the integer factor L with the rows (2), (1, 3) and (-4, 5, 1).
    const MATRIX: [f64; 9] = [4.0, 2.0, -8.0, 2.0, 10.0, 11.0, -8.0, 11.0, 42.0];

    #[test]
    fn factor_and_solutions_of_integers_are_exact() {
        let mut factor = [f64::NAN; 9];
        cholesky(&mut factor, &MATRIX, 3);
        assert_eq!(factor, [2.0, 0.0, 0.0, 1.0, 3.0, 0.0, -4.0, 5.0, 1.0]);
        // The columns are the products of the matrix with (1, 2, 3) and (0, -1, 1).
        let right = [-16.0, -10.0, 55.0, 1.0, 140.0, 31.0];
        let mut x = [f64::NAN; 6];
        cholesky_solve(&mut x, 2, (&factor, 3, 3), (&right, 1));
        assert_eq!(x, [1.0, 0.0, 2.0, -1.0, 3.0, 1.0]);
    }

    #[test]
    fn scalar_is_repeated_on_the_right_hand_side() {
        let mut x = [f64::NAN; 2];
        cholesky_solve(&mut x, 1, (&[1.0, 0.0, 1.0, 1.0], 2, 2), (&[3.0], 0));
        assert_eq!(x, [3.0, 0.0]);
    }

    #[test]
    fn pivot_that_is_not_positive_gives_nan() {
        let mut factor = [0.0_f64; 4];
        cholesky(&mut factor, &[1.0, 2.0, 2.0, 4.0], 2);
        assert_eq!(factor[..3], [1.0, 0.0, 2.0]);
        assert!(factor[3].is_nan());
    }
}
