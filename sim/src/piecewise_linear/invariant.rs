//! Invariant subspaces of a matrix for one grouping of its eigenvalues, refined and extended to the full state.

use std::ops::Range;

use nalgebra::{Complex, DMatrix};

use super::blocks::{decouple, inverse};
use super::clustering::{REAL_FRACTION, runs};
use super::decomposition::{Decomposition, Integrals, Part};
use super::refine::{Refinement, Subspaces};
use super::schur::SchurForm;

/// Subspaces for one grouping of the eigenvalues, in the balanced inner state.
pub(super) struct InvariantSubspaces {
    subspaces: Subspaces,
    /// Dimension of the subspace of the eigenvalues near zero, which is the first subspace.
    zeros: usize,
    /// Largest magnitude of the eigenvalues near zero, 1/s.
    radius: f64,
    scale: Vec<f64>,
    /// Sensitivity of each eigenvalue, in the order of the Schur form.
    pub sensitivity: Vec<f64>,
    /// Cluster number of each eigenvalue, in the order of the Schur form.
    numbers: Vec<usize>,
}

impl InvariantSubspaces {
    /// Computes the subspaces for the cluster `numbers` of the eigenvalues, 0 for those near zero, in the order
    /// of the Schur form.
    pub fn with_clusters(schur: &SchurForm, zeros: usize, numbers: Vec<usize>) -> Self {
        let mut order: Vec<usize> = (0..numbers.len()).collect();
        order.sort_by_key(|index| numbers[*index]);
        let mut cluster = numbers.clone();
        let mut form = SchurForm {
            triangle: schur.triangle.clone(),
            basis: schur.basis.clone(),
            scale: schur.scale.clone(),
        };
        form.sort_by_key(cluster.clone());
        cluster.sort_unstable();
        let blocks = runs(&cluster);
        let near_zero = (0..zeros).map(|index| form.triangle[(index, index)].norm());
        let radius = near_zero.fold(0.0, f64::max);
        let coupling = decouple(&form.triangle, &blocks);
        let columns = &form.basis * &coupling;
        let rows = inverse(&coupling) * form.basis.adjoint();
        let mut sensitivity = vec![1.0; cluster.len()];
        for (index, original) in order.into_iter().enumerate().skip(zeros) {
            sensitivity[original] = columns.column(index).norm() * rows.row(index).norm();
        }
        Self {
            subspaces: Subspaces {
                columns,
                rows,
                matrix: form.triangle,
                blocks,
            },
            zeros,
            radius,
            scale: form.scale,
            sensitivity,
            numbers,
        }
    }

    /// Computes the subspaces with these pairs of blocks merged. Returns `None` if there are no pairs, or if a
    /// pair includes the eigenvalues near zero.
    pub fn merge(self, schur: &SchurForm, pairs: &[(usize, usize)]) -> Option<Self> {
        let mut sorted = self.numbers.clone();
        sorted.sort_unstable();
        let mut numbers = self.numbers;
        for (a, b) in pairs {
            let number = |block: usize| sorted[self.subspaces.blocks[block].start];
            let (kept, gone) = (number(*a).min(number(*b)), number(*a).max(number(*b)));
            if kept == 0 {
                return None;
            }
            for slot in numbers.iter_mut().chain(&mut sorted) {
                if *slot == gone {
                    *slot = kept;
                }
            }
        }
        let found = !pairs.is_empty();
        found.then(|| Self::with_clusters(schur, self.zeros, numbers))
    }

    /// Refines the subspaces to double precision; the subspace near zero gets a real basis.
    pub fn refine(&mut self, inner: &DMatrix<f64>) -> Refinement {
        let balanced = DMatrix::from_fn(inner.nrows(), inner.ncols(), |i, j| {
            inner[(i, j)] * self.scale[j] / self.scale[i]
        });
        let (size, zeros) = (balanced.nrows(), self.zeros);
        let Subspaces {
            columns,
            rows,
            matrix,
            ..
        } = &mut self.subspaces;
        let spanned = columns.columns(0, zeros).into_owned();
        let basis = find_real_basis(&spanned);
        let slow = basis.transpose() * &balanced * &basis;
        let complex = |real: &DMatrix<f64>| real.map(|entry| Complex::new(entry, 0.0));
        let turned = complex(&basis).transpose() * &spanned * rows.rows(0, zeros);
        let real = turned.map(|entry| Complex::new(entry.re, 0.0));
        columns
            .view_mut((0, 0), (size, zeros))
            .copy_from(&complex(&basis));
        rows.view_mut((0, 0), (zeros, size)).copy_from(&real);
        matrix
            .view_mut((0, 0), (zeros, zeros))
            .copy_from(&complex(&slow));
        self.subspaces.refine(&balanced)
    }

    /// Returns the sensitivity of the most sensitive eigenvalue.
    pub fn condition(&self) -> f64 {
        self.sensitivity.iter().fold(0.0, |largest: f64, s| {
            if s.is_finite() {
                largest.max(*s)
            } else {
                f64::MAX
            }
        })
    }

    /// Returns the parts in the full state. The rates of the `pure` states are `outer` times the inner state.
    pub fn extend_to_full_state(
        self,
        outer: &DMatrix<f64>,
        pure: &[usize],
        felt: &[usize],
    ) -> Decomposition {
        let unscaled = |mut matrix: DMatrix<Complex<f64>>, power: i32| {
            for (index, scale) in self.scale.iter().enumerate() {
                let factor = Complex::new(scale.powi(power), 0.0);
                if power > 0 {
                    matrix.row_mut(index).scale_mut(factor.re);
                } else {
                    matrix.column_mut(index).scale_mut(factor.re);
                }
            }
            matrix
        };
        let columns = unscaled(self.subspaces.columns.clone(), 1);
        let rows = unscaled(self.subspaces.rows.clone(), -1);
        let outer_complex = outer.map(|entry| Complex::new(entry, 0.0));
        let states = pure.len() + felt.len();
        let mut parts = Vec::new();
        // Contribution of the other parts to the pure integrals, which is subtracted.
        let mut carried = DMatrix::<f64>::zeros(pure.len(), felt.len());
        let simple = self.weights();
        for (block, weight) in self.subspaces.blocks.iter().zip(simple) {
            if block.start < self.zeros || weight == 0.0 {
                continue;
            }
            let size = block.len();
            let own = self
                .subspaces
                .matrix
                .view((block.start, block.start), (size, size))
                .into_owned();
            let inner_columns = columns.columns(block.start, size).into_owned();
            let inner_rows = rows.rows(block.start, size).into_owned();
            let integrated = divide_from_right(&outer_complex * &inner_columns, &own);
            let product = &integrated * &inner_rows;
            carried += product.map(|entry| weight * entry.re);
            let centre = own.diagonal().sum() / size as f64;
            let matrix = own - DMatrix::from_diagonal_element(size, size, centre);
            parts.push(Part {
                centre,
                matrix,
                columns: scatter_rows(states, &[(pure, &integrated), (felt, &inner_columns)]),
                rows: scatter_rows(states, &[(felt, &inner_rows.transpose())]).transpose(),
                weight,
            });
        }
        let integrals = self.integrals(outer, pure, felt, [&columns, &rows], &carried);
        Decomposition { integrals, parts }
    }

    /// Returns the weight of each block: 2 or 1, or 0 for the conjugate of another block.
    fn weights(&self) -> Vec<f64> {
        let matrix = &self.subspaces.matrix;
        let imaginary = |block: &Range<usize>| -> (f64, f64) {
            let parts = block.clone().map(|index| matrix[(index, index)].im);
            let (low, high) = (f64::INFINITY, f64::NEG_INFINITY);
            parts.fold((low, high), |(low, high), im| (low.min(im), high.max(im)))
        };
        let bounds: Vec<(f64, f64)> = self.subspaces.blocks.iter().map(imaginary).collect();
        let largest = (0..matrix.nrows())
            .map(|index| matrix[(index, index)].norm())
            .fold(0.0, f64::max);
        let mut tolerance = REAL_FRACTION * largest;
        loop {
            let upper = bounds.iter().filter(|(low, _)| *low > tolerance).count();
            let lower = bounds.iter().filter(|(_, high)| *high < -tolerance).count();
            if upper == lower || tolerance > largest {
                break;
            }
            tolerance *= 4.0;
        }
        let weight = |(low, high): &(f64, f64)| match (*low > tolerance, *high < -tolerance) {
            (true, _) => 2.0,
            (_, true) => 0.0,
            _ => 1.0,
        };
        bounds.iter().map(weight).collect()
    }

    /// Returns the part near zero together with the pure integrals, in a real basis.
    fn integrals(
        &self,
        outer: &DMatrix<f64>,
        pure: &[usize],
        felt: &[usize],
        [inner_columns, inner_rows]: [&DMatrix<Complex<f64>>; 2],
        carried: &DMatrix<f64>,
    ) -> Integrals {
        let zeros = self.zeros;
        let real = |matrix: &DMatrix<Complex<f64>>| matrix.map(|entry| entry.re);
        let inner_columns = real(&inner_columns.columns(0, zeros).into_owned());
        let inner_rows = real(&inner_rows.rows(0, zeros).into_owned());
        let slow = real(
            &self
                .subspaces
                .matrix
                .view((0, 0), (zeros, zeros))
                .into_owned(),
        );
        let size = pure.len() + zeros;
        let mut matrix = DMatrix::zeros(size, size);
        matrix
            .view_mut((0, pure.len()), (pure.len(), zeros))
            .copy_from(&(outer * &inner_columns));
        matrix
            .view_mut((pure.len(), pure.len()), (zeros, zeros))
            .copy_from(&slow);
        let states = pure.len() + felt.len();
        let mut columns = DMatrix::zeros(states, size);
        let mut rows = DMatrix::zeros(size, states);
        for (index, state) in pure.iter().enumerate() {
            columns[(*state, index)] = 1.0;
            rows[(index, *state)] = 1.0;
            for (column, other) in felt.iter().enumerate() {
                rows[(index, *other)] = -carried[(index, column)];
            }
        }
        for (index, state) in felt.iter().enumerate() {
            for column in 0..zeros {
                columns[(*state, pure.len() + column)] = inner_columns[(index, column)];
                rows[(pure.len() + column, *state)] = inner_rows[(column, index)];
            }
        }
        Integrals {
            matrix,
            columns,
            rows,
            radius: self.radius,
            pure: pure.len(),
        }
    }
}

/// Returns X of X A = B.
fn divide_from_right(b: DMatrix<Complex<f64>>, a: &DMatrix<Complex<f64>>) -> DMatrix<Complex<f64>> {
    let (rows, columns) = b.shape();
    if columns == 1 {
        return b / a[(0, 0)];
    }
    let solved = a.transpose().lu().solve(&b.transpose());
    solved.map_or_else(
        || DMatrix::from_element(rows, columns, Complex::new(f64::NAN, 0.0)),
        |solved| solved.transpose(),
    )
}

/// Returns a matrix with `states` rows, with the rows of another matrix at the given indices.
fn scatter_rows(
    states: usize,
    pieces: &[(&[usize], &DMatrix<Complex<f64>>)],
) -> DMatrix<Complex<f64>> {
    let columns = pieces.first().map_or(0, |(_, piece)| piece.ncols());
    let mut whole = DMatrix::zeros(states, columns);
    for (indices, piece) in pieces {
        for (row, index) in indices.iter().enumerate() {
            whole.row_mut(*index).copy_from(&piece.row(row));
        }
    }
    whole
}

/// Returns an orthonormal real basis of the span of complex columns, which must equal its conjugate.
/// Gram-Schmidt with pivoting: the largest remainder is next.
fn find_real_basis(columns: &DMatrix<Complex<f64>>) -> DMatrix<f64> {
    let (rows, size) = columns.shape();
    let mut candidates = DMatrix::from_fn(rows, 2 * size, |i, j| {
        let entry = columns[(i, j / 2)];
        if j % 2 == 0 { entry.re } else { entry.im }
    });
    let mut basis = DMatrix::zeros(rows, size);
    for found in 0..size {
        let largest = (0..2 * size)
            .max_by(|a, b| {
                let norm = |j: usize| candidates.column(j).norm();
                norm(*a).total_cmp(&norm(*b))
            })
            .unwrap_or(0);
        let mut direction = candidates.column(largest).into_owned();
        // Repeats the orthogonalisation to remove rounding errors.
        for before in 0..found {
            let earlier = basis.column(before).into_owned();
            direction -= &earlier * earlier.dot(&direction);
        }
        let norm = direction.norm();
        if norm > 0.0 {
            direction /= norm;
        }
        for j in 0..2 * size {
            let along = direction.dot(&candidates.column(j));
            let reduced = candidates.column(j) - &direction * along;
            candidates.set_column(j, &reduced);
        }
        basis.set_column(found, &direction);
    }
    basis
}
