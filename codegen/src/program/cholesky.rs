//! Cholesky factorisation and solution with the factor, written once. The evaluator executes them; machine code and
//! statements are written from them. All keep the order of operations. The functions are inlined, so that the evaluator
//! keeps the places of the matrices in registers: it executes half as many instructions (callgrind, 6 and 16 rows).

/// Indices of a loop.
#[derive(Clone, Debug)]
pub enum Range<I> {
    /// 0 to n - 1.
    First(I),
    /// n - 1 to 0.
    Reversed(I),
    /// i + 1 to n - 1, for `After(i, n)`.
    After(I, I),
}

/// Executor or writer of loops over the elements of matrices. A body is executed for every index, or written once.
pub trait MatrixLoops {
    /// Index of a row or column.
    type Index: Clone;
    /// Number.
    type Number;
    /// Matrix.
    type Matrix;

    /// Loops over indices, with a name for written code.
    fn each(
        &mut self,
        name: &'static str,
        range: Range<Self::Index>,
        body: impl FnMut(&mut Self, &Self::Index),
    );

    /// Returns first - a b - ..., in the order of the indices k, for the factors a and b of each.
    fn subtract_products(
        &mut self,
        first: Self::Number,
        range: Range<Self::Index>,
        factors: impl FnMut(&mut Self, &Self::Index) -> [Self::Number; 2],
    ) -> Self::Number;

    /// Returns the element at a row and a column.
    fn get_element(&mut self, matrix: &Self::Matrix, place: [&Self::Index; 2]) -> Self::Number;

    /// Sets the element at a row and a column.
    fn set_element(&mut self, matrix: &Self::Matrix, place: [&Self::Index; 2], value: Self::Number);

    /// Returns a / b.
    fn divide(&mut self, a: Self::Number, b: Self::Number) -> Self::Number;

    /// Returns the square root if a > 0, else NaN.
    fn root_or_nan(&mut self, a: Self::Number) -> Self::Number;
}

/// Computes the lower factor L of a symmetric matrix L L^T of n rows, row by row; NaN if it is not positive definite. The
/// upper part of `factor` is not written.
#[inline(always)]
pub fn factorise<L: MatrixLoops>(
    loops: &mut L,
    n: &L::Index,
    matrix: &L::Matrix,
    factor: &L::Matrix,
) {
    let remainder = |loops: &mut L, [i, j]: [&L::Index; 2]| {
        let entry = loops.get_element(matrix, [i, j]);
        loops.subtract_products(entry, Range::First(j.clone()), |loops, k| {
            [
                loops.get_element(factor, [i, k]),
                loops.get_element(factor, [j, k]),
            ]
        })
    };
    loops.each("i", Range::First(n.clone()), |loops, i| {
        loops.each("j", Range::First(i.clone()), |loops, j| {
            let rest = remainder(loops, [i, j]);
            let pivot = loops.get_element(factor, [j, j]);
            let entry = loops.divide(rest, pivot);
            loops.set_element(factor, [i, j], entry);
        });
        let rest = remainder(loops, [i, i]);
        let root = loops.root_or_nan(rest);
        loops.set_element(factor, [i, i], root);
    });
}

/// Solves L L^T x = right in column j, by forward and backward substitution. `right` can be `x` itself.
#[inline(always)]
pub fn solve_column<L: MatrixLoops>(
    loops: &mut L,
    (n, j): (&L::Index, &L::Index),
    factor: &L::Matrix,
    [right, x]: [&L::Matrix; 2],
) {
    let divide = |loops: &mut L, rest: L::Number, i: &L::Index| {
        let pivot = loops.get_element(factor, [i, i]);
        let solved = loops.divide(rest, pivot);
        loops.set_element(x, [i, j], solved);
    };
    loops.each("i", Range::First(n.clone()), |loops, i| {
        let given = loops.get_element(right, [i, j]);
        let rest = loops.subtract_products(given, Range::First(i.clone()), |loops, k| {
            [
                loops.get_element(factor, [i, k]),
                loops.get_element(x, [k, j]),
            ]
        });
        divide(loops, rest, i);
    });
    loops.each("i", Range::Reversed(n.clone()), |loops, i| {
        let given = loops.get_element(x, [i, j]);
        let after = Range::After(i.clone(), n.clone());
        let rest = loops.subtract_products(given, after, |loops, k| {
            [
                loops.get_element(factor, [k, i]),
                loops.get_element(x, [k, j]),
            ]
        });
        divide(loops, rest, i);
    });
}

/// Solves L L^T X = right for each of m columns.
#[inline(always)]
pub fn solve<L: MatrixLoops>(
    loops: &mut L,
    [n, m]: [&L::Index; 2],
    factor: &L::Matrix,
    both: [&L::Matrix; 2],
) {
    loops.each("j", Range::First(m.clone()), |loops, j| {
        solve_column(loops, (n, j), factor, both);
    });
}
