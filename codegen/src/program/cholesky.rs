//! Cholesky factorisation and solution with the factor, defined once for all backends. The evaluator executes the
//! loops; machine code and statements are generated from them. The order of operations is the same in all backends.
//! The functions are inlined, because the evaluator then keeps the addresses of the matrices in registers and
//! executes half as many instructions (callgrind, 6 and 16 rows).

/// Index range of a loop.
#[derive(Clone, Debug)]
pub enum Range<I> {
    /// From 0 to n - 1.
    First(I),
    /// From n - 1 down to 0.
    Reversed(I),
    /// From i + 1 to n - 1, for `After(i, n)`.
    After(I, I),
}

/// Backend for loops over matrix elements. The evaluator executes the body for every index; a code generator emits it
/// once.
pub trait MatrixLoops {
    /// Index of a row or column.
    type Index: Clone;
    /// Number.
    type Number;
    /// Matrix.
    type Matrix;

    /// Loops over an index range; `name` is the loop variable in generated code.
    fn each(
        &mut self,
        name: &'static str,
        range: Range<Self::Index>,
        body: impl FnMut(&mut Self, &Self::Index),
    );

    /// Returns first - a_0 b_0 - a_1 b_1 - ..., in the order of the indices k.
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

/// Computes the lower factor L of a symmetric matrix L L^T of n rows, row by row. The factor contains NaN if the
/// matrix is not positive definite. The upper part of `factor` is not written.
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

/// Solves L L^T x = right for column j by forward and backward substitution. `right` can be the same matrix as `x`.
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
