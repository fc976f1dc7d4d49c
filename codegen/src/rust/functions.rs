//! Helper functions of an emitted file: their selection, and the text of the small ones. `kernels` writes
//! those with kernels.

use super::expression::{Conversions, Writer, zeros};
use super::kernels::function;
use super::piecewise::{CHOSEN, DEADZONE_ON_SIDE, EITHER, POSITIVE, TOUCHING};
use super::slopes;
use crate::statements::layout::block;
use crate::statements::{
    Elements, Helper, Index, MatrixOperand, Recorder, RequiredFunctions, Statement,
};

/// Writes the required functions.
pub fn write_functions(needed: &RequiredFunctions, conversions: Conversions) -> String {
    let sides = [
        Helper::DeadzoneOnSide,
        Helper::Touching,
        Helper::Either,
        Helper::Chosen,
    ];
    let has = |helper: Helper| needed.has_any(&[helper]);
    let mut text = String::new();
    for (needed, item) in [
        (has(Helper::DeadzoneOnSide), DEADZONE_ON_SIDE),
        (has(Helper::Touching), TOUCHING),
        (has(Helper::Either), EITHER),
        (has(Helper::Chosen), CHOSEN),
        (needed.has_any(&sides), POSITIVE),
        (
            has(Helper::Cholesky),
            &*(write_cholesky() + &write_cholesky_solve()),
        ),
        (
            has(Helper::CholeskyOfMatrix),
            &*write_cholesky_solve_matrix(),
        ),
        (
            conversions.converted || conversions.converted_matrix,
            CONVERTED,
        ),
        (conversions.converted_matrix, CONVERTED_MATRIX),
        (
            conversions.read_array || conversions.read_matrix,
            READ_ARRAY,
        ),
        (conversions.read_matrix, READ_MATRIX),
        (
            needed.has_any(&[Helper::Sum, Helper::SumOfFew]),
            PAIRWISE_SUM,
        ),
        (has(Helper::SumOfFew), SUM_OF_FEW),
        (has(Helper::Sum), SUM),
    ] {
        if needed {
            text.push_str(item);
        }
    }
    text + &slopes::with_slopes(&needed.kernels)
        .into_iter()
        .map(function)
        .collect::<String>()
}

const CHOLESKY_HEAD: &str = "\
/// Computes the lower factor L of a symmetric matrix L L^T; NaN if it is not positive definite.
fn cholesky<T: Scalar, const N: usize>(matrix: &[[T; N]; N]) -> [[T; N]; N] {";

/// Head of the solution for a vector. Rates for SIMD lanes also use this function.
const CHOLESKY_SOLVE_HEAD: &str = "\
/// Solves L L^T x = right.
#[inline(always)]
fn cholesky_solve<T: Scalar, const N: usize>(
    factor: &[[T; N]; N],
    right: &[T; N],
) -> [T; N] {";

const CHOLESKY_SOLVE_MATRIX_HEAD: &str = "\
/// Solves L L^T X = right, column by column.
fn cholesky_solve_matrix<T: Scalar, const N: usize, const M: usize>(
    factor: &[[T; N]; N],
    right: &[[T; M]; N],
) -> [[T; M]; N] {";

/// Writes the Cholesky factorisation.
fn write_cholesky() -> String {
    let lines = recorder().factorise(
        "N",
        &MatrixOperand::local("matrix", Elements::InRows),
        &MatrixOperand::local("factor", Elements::InRows),
    );
    write_array_function(CHOLESKY_HEAD, ("factor", &["N", "N"]), &lines)
}

/// Writes the solution with a Cholesky factor for a vector.
fn write_cholesky_solve() -> String {
    let lines = build_solution(Elements::InColumn, None);
    write_array_function(CHOLESKY_SOLVE_HEAD, ("x", &["N"]), &lines)
}

/// Writes the solution with a Cholesky factor for a matrix.
fn write_cholesky_solve_matrix() -> String {
    let lines = build_solution(Elements::InRows, Some("M".into()));
    write_array_function(CHOLESKY_SOLVE_MATRIX_HEAD, ("x", &["N", "M"]), &lines)
}

fn build_solution(elements: Elements, columns: Option<Index>) -> Vec<Statement> {
    let both = ["right", "x"].map(|name| MatrixOperand::local(name, elements.clone()));
    let factor = MatrixOperand::local("factor", Elements::InRows);
    recorder().solve(("N", columns), &factor, both.each_ref())
}

fn recorder() -> Recorder {
    Recorder::new("rest")
}

/// Writes a function that returns an array with these lengths. The array is filled with zeros before the statements
/// of `lines`.
fn write_array_function(
    head: &str,
    (result, lengths): (&str, &[&str]),
    lines: &[Statement],
) -> String {
    let lengths: Vec<String> = lengths.iter().map(|length| (*length).to_owned()).collect();
    let lines = zeros(result, &lengths) + &Writer::default().statements(lines);
    block(head, &format!("{lines}{result}\n"), "}")
}

const CONVERTED: &str = "\
/// Converts numbers to another type.
#[inline(always)]
fn converted<T: Scalar, const N: usize>(numbers: &[f64; N]) -> [T; N] {
    let mut converted = [T::number(0.0); N];
    for i in 0..N {
        converted[i] = T::number(numbers[i]);
    }
    converted
}
";

const CONVERTED_MATRIX: &str = "\
/// Converts a matrix to another type.
#[inline(always)]
fn converted_matrix<T: Scalar, const N: usize, const M: usize>(
    numbers: &[[f64; N]; M],
) -> [[T; N]; M] {
    let mut matrix = [[T::number(0.0); N]; M];
    for i in 0..M {
        matrix[i] = converted(&numbers[i]);
    }
    matrix
}
";

/// Pairwise sum of the partial sums.
const PAIRWISE_SUM: &str = "\
/// Returns the pairwise sum of the first `N` of eight numbers.
#[inline(always)]
fn pairwise_sum<const N: usize, T: Scalar>(s: &[T; 8]) -> T {
    let a = if N > 1 { s[0] + s[1] } else { s[0] };
    let b = if N > 3 { s[2] + s[3] } else { s[2] };
    let c = if N > 5 { s[4] + s[5] } else { s[4] };
    let d = if N > 7 { s[6] + s[7] } else { s[6] };
    let left = if N > 2 { a + b } else { a };
    let right = if N > 6 { c + d } else { c };
    if N > 4 { left + right } else { left }
}
";

/// Conversion of whole vectors of coefficients.
const READ_ARRAY: &str = "\
/// Reads coefficients as numbers of the computation.
#[inline(always)]
fn read_array<T: Scalar, C: Coefficient<T>, const N: usize>(numbers: &[C; N]) -> [T; N] {
    let mut read = [T::number(0.0); N];
    for i in 0..N {
        read[i] = C::read(numbers[i]);
    }
    read
}
";

/// Conversion of whole matrices of coefficients.
const READ_MATRIX: &str = "\
/// Reads a matrix of coefficients as numbers of the computation.
#[inline(always)]
fn read_matrix<T: Scalar, C: Coefficient<T>, const N: usize, const M: usize>(
    matrix: &[[C; N]; M],
) -> [[T; N]; M] {
    let mut read = [[T::number(0.0); N]; M];
    for i in 0..M {
        read[i] = read_array(&matrix[i]);
    }
    read
}
";

/// Sum of at most eight elements.
const SUM_OF_FEW: &str = "\
/// Adds up to eight elements.
#[inline(always)]
fn sum_of_few<const N: usize, T: Scalar, F: Fn(usize) -> T>(
    _: [(); N],
    element: F,
) -> T {
    let mut s = [T::number(0.0); 8];
    for k in 0..N {
        s[k] = element(k);
    }
    pairwise_sum::<N, T>(&s)
}
";

/// Sum of more than eight elements. For scalars the function is not inlined: the compiler would vectorise across
/// unrolled outer loops and spill registers. For SIMD lanes an attribute enforces inlining, because the compiler
/// would inline only some of the calls. The length is a constant of the type, which removes bounds checks.
const SUM: &str = "\
/// Adds elements in eight partial sums; sum k has the elements k, k + 8, k + 16, ...
#[inline(always)]
fn sum<const N: usize, T: Scalar, F: Fn(usize) -> T>(_: [(); N], element: F) -> T {
    T::long_loop(
        #[inline(always)]
        move || {
            let mut s = [T::number(0.0); 8];
            for k in 0..8 {
                s[k] = element(k);
            }
            for block in 1..N / 8 {
                for k in 0..8 {
                    s[k] = s[k] + element(8 * block + k);
                }
            }
            for i in N / 8 * 8..N {
                s[i % 8] = s[i % 8] + element(i);
            }
            pairwise_sum::<N, T>(&s)
        },
    )
}
";
