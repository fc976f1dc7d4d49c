//! Refines a decomposition A X = X D, Y X = 1 to double precision.
//!
//! After the QR iteration, the error of every eigenvalue is a rounding of the largest one. The phase of a slow
//! mode then drifts by 1e-10 of its amplitude within some thousand periods. First-order corrections are
//! computed from residuals in twice the precision. After two rounds the error of each eigenvalue is its own
//! rounding. The size of the last correction decides whether the decomposition is reliable.

use std::ops::Range;

use nalgebra::{Complex, DMatrix};

use super::error_free::{two_product, two_sum};

/// Maximum number of corrections; each squares the relative error.
const MAX_ROUNDS: usize = 5;

/// Errors below this fraction of the eigenvalues are rounding and are not corrected. The vectors of nearly
/// equal eigenvalues cannot be separated, and need not be.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Largest rotation of a subspace by an error, as a multiple of the relative error, for which the subspaces
/// count as separate. Errors below rounding are then corrected as well.
const MAX_ROTATION_PER_ERROR: f64 = 1e3;

/// Larger rotations of a vector are not applied, because the corrections are accurate to first order only.
const MAX_ROTATION: f64 = 0.1;

/// Remaining error above which a decomposition is unreliable, as a fraction of the eigenvalues.
const MAX_REMAINING_ERROR: f64 = 1e-9;

/// Invariant subspaces of a matrix; D is block diagonal.
pub(super) struct Subspaces {
    /// X: basis vectors of all subspaces.
    pub columns: DMatrix<Complex<f64>>,
    /// Y, the inverse of X.
    pub rows: DMatrix<Complex<f64>>,
    /// D, 1/s; entries outside its blocks are not read.
    pub matrix: DMatrix<Complex<f64>>,
    /// Index range of each subspace.
    pub blocks: Vec<Range<usize>>,
}

/// Result of a refinement.
pub(super) struct Refinement {
    /// True if the subspaces are reliable.
    pub converged: bool,
    /// Pairs of blocks that rounding does not separate, if `converged` is false.
    pub inseparable: Vec<(usize, usize)>,
}

impl Subspaces {
    /// Refines the subspaces of a matrix.
    pub fn refine(&mut self, of: &DMatrix<f64>) -> Refinement {
        let mut inseparable = Vec::new();
        let mut wrong = f64::INFINITY;
        for _ in 0..MAX_ROUNDS {
            self.refine_rows();
            inseparable.clear();
            let before = std::mem::replace(&mut wrong, self.refine_columns(of, &mut inseparable));
            if !(wrong > ROUNDING && wrong < before) {
                break;
            }
        }
        self.refine_rows();
        Refinement {
            converged: wrong <= MAX_REMAINING_ERROR,
            inseparable,
        }
    }

    /// Corrects X and D to first order. With E = Y (A X - X D), the diagonal blocks of D change by those of E,
    /// and X changes by X F with D_i F_ij - F_ij D_j = -E_ij. Returns the magnitude of E relative to the
    /// eigenvalues, and adds the pairs of blocks that E rotates into each other.
    fn refine_columns(&mut self, of: &DMatrix<f64>, inseparable: &mut Vec<(usize, usize)>) -> f64 {
        let error = &self.rows * self.residual(of);
        let size = error.nrows();
        let mut turn = DMatrix::zeros(size, size);
        let magnitude = |range: &Range<usize>| -> f64 {
            range
                .clone()
                .map(|index| self.matrix[(index, index)].norm())
                .fold(0.0, f64::max)
        };
        let magnitudes: Vec<f64> = self.blocks.iter().map(magnitude).collect();
        let largest = magnitudes.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        let mut wrong = 0.0_f64;
        for (i, rows) in self.blocks.iter().enumerate() {
            for (j, columns) in self.blocks.iter().enumerate() {
                let index = (rows.start, columns.start);
                let shape = (rows.len(), columns.len());
                let found = error.view(index, shape).into_owned();
                if i == j {
                    let mut block = self.matrix.view_mut(index, shape);
                    block += found;
                    continue;
                }
                let relative =
                    found.norm() / (magnitudes[i] + magnitudes[j]).max(f64::EPSILON * largest);
                // NaN must not count as a small error.
                wrong = if relative.is_nan() {
                    f64::INFINITY
                } else {
                    wrong.max(relative)
                };
                let solved = solve_sylvester(&self.block(rows), &self.block(columns), &found);
                let is_apart = solved.norm() <= MAX_ROTATION_PER_ERROR * relative;
                if is_apart || (relative > ROUNDING && solved.norm() <= MAX_ROTATION) {
                    turn.view_mut(index, shape).copy_from(&solved);
                } else if relative > MAX_REMAINING_ERROR {
                    inseparable.push((i, j));
                }
            }
        }
        let correction = &self.columns * &turn;
        for (entry, correction) in self.columns.iter_mut().zip(correction.iter()) {
            // Exact zeros of a basis vector remain exact.
            if entry.norm() > 0.0 || correction.norm() > ROUNDING {
                *entry += correction;
            }
        }
        wrong
    }

    fn block(&self, range: &Range<usize>) -> DMatrix<Complex<f64>> {
        let shape = (range.len(), range.len());
        self.matrix
            .view((range.start, range.start), shape)
            .into_owned()
    }

    /// Returns A X - X D.
    fn residual(&self, of: &DMatrix<f64>) -> DMatrix<Complex<f64>> {
        let size = of.nrows();
        let felt: Vec<Vec<(usize, f64)>> = (0..size)
            .map(|row| {
                let entries = of.row(row).iter().copied().enumerate().collect::<Vec<_>>();
                entries
                    .into_iter()
                    .filter(|(_, entry)| *entry != 0.0)
                    .collect()
            })
            .collect();
        let mut residual = DMatrix::zeros(size, size);
        for block in &self.blocks {
            for column in block.clone() {
                for (row, entries) in felt.iter().enumerate() {
                    let mut sum = Accumulator::default();
                    for (between, entry) in entries {
                        let x = self.columns[(*between, column)];
                        sum.add_product(Complex::new(*entry, 0.0), x);
                    }
                    for between in block.clone() {
                        let x = self.columns[(row, between)];
                        sum.add_product(-x, self.matrix[(between, column)]);
                    }
                    residual[(row, column)] = sum.value();
                }
            }
        }
        residual
    }

    /// Replaces Y by Y + (1 - Y X) Y.
    fn refine_rows(&mut self) {
        let size = self.rows.nrows();
        let rest = DMatrix::from_fn(size, size, |i, j| {
            let mut sum = Accumulator::default();
            if i == j {
                sum.add_product(Complex::new(1.0, 0.0), Complex::new(1.0, 0.0));
            }
            for k in 0..size {
                sum.add_product(-self.rows[(i, k)], self.columns[(k, j)]);
            }
            sum.value()
        });
        self.rows += rest * &self.rows;
    }
}

/// Returns X of A X - X B = -C.
fn solve_sylvester(
    a: &DMatrix<Complex<f64>>,
    b: &DMatrix<Complex<f64>>,
    c: &DMatrix<Complex<f64>>,
) -> DMatrix<Complex<f64>> {
    let (rows, columns) = c.shape();
    if rows == 1 && columns == 1 {
        return c / (b[(0, 0)] - a[(0, 0)]);
    }
    let mut system = DMatrix::zeros(rows * columns, rows * columns);
    for column in 0..columns {
        for row in 0..rows {
            let equation = column * rows + row;
            for other in 0..rows {
                system[(equation, column * rows + other)] += a[(row, other)];
            }
            for other in 0..columns {
                system[(equation, other * rows + row)] -= b[(other, column)];
            }
        }
    }
    let right = DMatrix::from_iterator(rows * columns, 1, c.iter().map(|entry| -entry));
    let solved = system.lu().solve(&right);
    solved.map_or_else(
        || DMatrix::from_element(rows, columns, Complex::new(f64::INFINITY, 0.0)),
        |solved| DMatrix::from_iterator(rows, columns, solved.iter().copied()),
    )
}

/// Sum of products in twice the precision (Ogita, Rump and Oishi, Accurate Sum and Dot Product, SIAM J. Sci.
/// Comput. 26, 2005, algorithm 5.3).
#[derive(Clone, Copy, Default)]
struct Accumulator {
    re: [f64; 2],
    im: [f64; 2],
}

impl Accumulator {
    fn add_product(&mut self, a: Complex<f64>, b: Complex<f64>) {
        add(&mut self.re, a.re, b.re);
        add(&mut self.re, -a.im, b.im);
        add(&mut self.im, a.re, b.im);
        add(&mut self.im, a.im, b.re);
    }

    fn value(self) -> Complex<f64> {
        Complex::new(self.re[0] + self.re[1], self.im[0] + self.im[1])
    }
}

/// Adds a product with the rounding errors of both operations.
fn add(sum: &mut [f64; 2], a: f64, b: f64) {
    if a == 0.0 || b == 0.0 {
        return;
    }
    let (product, rounding) = two_product(a, b);
    let (total, error) = two_sum(sum[0], product);
    sum[0] = total;
    sum[1] += error + rounding;
}
