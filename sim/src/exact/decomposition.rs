//! A real matrix as a sum of parts that move by themselves: A = sum of columns matrix rows.
//!
//! What integrates (states that no other state feels, and everything with an eigenvalue
//! near zero) is one part with a real basis and a matrix that is nearly nilpotent: its
//! exponential is a polynomial. Plain eigenvectors of such a cluster have condition 1e12
//! and worse. Every other eigenvalue is a part of its own, and those so close together that
//! their eigenvectors nearly agree share one.

use std::ops::Range;

use nalgebra::{Complex, DMatrix};

use super::blocks::{decouple, inverse};
use super::refine::{Refinement, Subspaces};
use super::schur::SchurForm;

/// Eigenvalues below this part of the fastest rate, or of 1 1/s, count as near zero: as modes
/// of their own they would answer a constant force with a large and useless amplitude.
const NEAR_ZERO: f64 = 1e-5;

/// Eigenvectors are well-conditioned if no eigenvalue is more sensitive than this. Amplitudes
/// and eigenvalues are both wrong by it: four digits of sixteen at most.
const WELL_CONDITIONED: f64 = 100.0;

/// Two eigenvalues that nearly share an eigenvector are as sensitive as one over their
/// relative distance, up to about this factor; what is more sensitive has other reasons.
const SHARED: f64 = 3.0;

/// Eigenvalues closer than this, relative, always share a part.
const EQUAL: f64 = 1e-9;

/// Sensitive beyond all use: then distances up to the second number count as near.
const HOPELESS: (f64, f64) = (1e6, 1e-2);

/// Imaginary parts below this part of the largest eigenvalue count as zero.
const REAL: f64 = 1e-11;

/// A part of a matrix: A columns = columns (centre + matrix).
#[derive(Clone, Debug)]
pub(super) struct Part {
    /// What the eigenvalues are near to, 1/s.
    pub centre: Complex<f64>,
    /// The rest: upper triangular with small diagonal, 1/s.
    pub matrix: DMatrix<Complex<f64>>,
    /// states x size.
    pub columns: DMatrix<Complex<f64>>,
    /// size x states; rows columns = 1.
    pub rows: DMatrix<Complex<f64>>,
    /// 2 for a part that stands for itself and its conjugate, 1 for one that is real.
    pub weight: f64,
}

/// The part with eigenvalues near zero.
#[derive(Clone, Debug)]
pub(super) struct Integrals {
    /// The matrix in its basis, 1/s.
    pub matrix: DMatrix<f64>,
    /// states x size.
    pub columns: DMatrix<f64>,
    /// size x states.
    pub rows: DMatrix<f64>,
    /// The largest magnitude of its eigenvalues, 1/s.
    pub radius: f64,
    /// So many of its coordinates, the first ones, are felt by no other.
    pub pure: usize,
}

/// A matrix by parts: its exponential is the sum of theirs, twice the real part for a
/// weight of 2.
#[derive(Clone, Debug)]
pub(super) struct Decomposition {
    pub integrals: Integrals,
    pub parts: Vec<Part>,
}

/// Why a matrix could not be decomposed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Failure {
    /// It holds infinite numbers or none.
    NotFinite,
    /// The eigenvalue iteration did not converge.
    NotConverged,
}

impl Decomposition {
    /// The parts of a square matrix, on which forces act as fast as `forcing`, 1/s. Real
    /// eigenvalues up to `slow` in magnitude, 1/s, go to the integrals.
    pub fn of(matrix: &DMatrix<f64>, forcing: f64, slow: f64) -> Result<Self, Failure> {
        if matrix.iter().any(|entry| !entry.is_finite()) {
            return Err(Failure::NotFinite);
        }
        let unfelt = |state: &usize| matrix.column(*state).iter().all(|entry| *entry == 0.0);
        let (pure, felt): (Vec<usize>, Vec<usize>) = (0..matrix.ncols()).partition(unfelt);
        let inner = matrix.select_columns(&felt).select_rows(&felt);
        let outer = matrix.select_columns(&felt).select_rows(&pure);
        let mut schur =
            SchurForm::of(&inner, time_scale(matrix, &felt)).ok_or(Failure::NotConverged)?;
        let near_zero = near_zero(&schur.eigenvalues(), forcing, slow);
        schur.sort_by_key(near_zero.iter().map(|near| usize::from(!near)).collect());
        let zeros = near_zero.iter().filter(|near| **near).count();
        let mut found = best_parts(&schur, zeros);
        for _ in 0..=zeros.max(inner.nrows()) {
            let refinement = found.refine(&inner);
            if refinement.converged {
                return Ok(found.in_full_state(&outer, &pure, &felt));
            }
            found = found
                .merged(&schur, &refinement.inseparable)
                .ok_or(Failure::NotConverged)?;
        }
        Err(Failure::NotConverged)
    }
}

/// A unit of time in which positions and rates are of like size: 1 for the first half of the
/// state, the positions, and a power of two near the fastest rate for the second.
fn time_scale(matrix: &DMatrix<f64>, felt: &[usize]) -> Vec<f64> {
    let half = matrix.nrows() / 2;
    let rates = matrix.rows(half, matrix.nrows() - half);
    let stiffest = rates.columns(0, half).amax().sqrt();
    let drag = rates.columns(half, matrix.nrows() - half).amax();
    let fastest = stiffest.max(drag);
    let unit = if fastest > 0.0 {
        fastest.log2().round().exp2()
    } else {
        1.0
    };
    let of = |state: &usize| if *state < half { 1.0 } else { unit };
    felt.iter().map(of).collect()
}

/// Which eigenvalues are near zero.
fn near_zero(eigenvalues: &[Complex<f64>], forcing: f64, slow: f64) -> Vec<bool> {
    let fastest = forcing.abs().max(1.0);
    let largest = eigenvalues.iter().map(|e| e.norm()).fold(fastest, f64::max);
    // A conjugate pair differs by rounding only and must not be torn apart.
    let mut bound = NEAR_ZERO * largest;
    for value in eigenvalues {
        if (value.norm() - bound).abs() < 1e-3 * bound {
            bound *= 1.01;
        }
    }
    let is_slow = |e: &Complex<f64>| e.im.abs() <= REAL * largest && e.re.abs() <= slow;
    eigenvalues
        .iter()
        .map(|e| e.norm() <= bound || is_slow(e))
        .collect()
}

/// The parts, with those eigenvalues together that are sensitive because of each other.
fn best_parts(schur: &SchurForm, zeros: usize) -> Found {
    let eigenvalues = schur.eigenvalues();
    let first = Found::with_groups(schur, zeros, groups(&eigenvalues, zeros, |_, _, _| false));
    if first.condition() <= WELL_CONDITIONED {
        return first;
    }
    // In the order of the Schur form, as the eigenvalues are.
    let sensitivity = first.sensitivity.clone();
    let shared = |a: usize, b: usize, distance: f64| {
        let least = sensitivity[a].min(sensitivity[b]);
        let explained = least > WELL_CONDITIONED && least * distance <= SHARED;
        explained || (least > HOPELESS.0 && distance <= HOPELESS.1)
    };
    let second = Found::with_groups(schur, zeros, groups(&eigenvalues, zeros, shared));
    if second.condition() < 0.5 * first.condition() {
        second
    } else {
        first
    }
}

/// Eigenvalues in groups: for each the number of its group, 0 for those near zero. `share`
/// says of two eigenvalues and their relative distance whether they belong together.
fn groups(
    eigenvalues: &[Complex<f64>],
    zeros: usize,
    share: impl Fn(usize, usize, f64) -> bool,
) -> Vec<usize> {
    let mut group: Vec<usize> = (0..eigenvalues.len())
        .map(|place| if place < zeros { 0 } else { place + 1 })
        .collect();
    for a in zeros..eigenvalues.len() {
        for b in a + 1..eigenvalues.len() {
            let (x, y) = (eigenvalues[a], eigenvalues[b]);
            let distance = 2.0 * (x - y).norm() / (x.norm() + y.norm());
            if (distance <= EQUAL || share(a, b, distance)) && group[a] != group[b] {
                let (kept, gone) = (group[a], group[b]);
                for place in &mut group {
                    if *place == gone {
                        *place = kept;
                    }
                }
            }
        }
    }
    group
}

/// Parts found with one grouping, in the balanced inner state.
struct Found {
    subspaces: Subspaces,
    /// How many dimensions are near zero, the first ones.
    zeros: usize,
    /// The largest magnitude of the eigenvalues near zero, 1/s.
    radius: f64,
    scale: Vec<f64>,
    /// The sensitivity of each eigenvalue, in the order of the Schur form.
    sensitivity: Vec<f64>,
    /// The group of each, in the same order.
    numbers: Vec<usize>,
}

impl Found {
    /// `numbers`: the group of each eigenvalue, 0 for those near zero, in the order of the
    /// Schur form.
    fn with_groups(schur: &SchurForm, zeros: usize, numbers: Vec<usize>) -> Self {
        let mut order: Vec<usize> = (0..numbers.len()).collect();
        order.sort_by_key(|place| numbers[*place]);
        let mut group = numbers.clone();
        let mut form = SchurForm {
            triangle: schur.triangle.clone(),
            basis: schur.basis.clone(),
            scale: schur.scale.clone(),
        };
        form.sort_by_key(group.clone());
        group.sort_unstable();
        let blocks = runs(&group);
        let near_zero = (0..zeros).map(|place| form.triangle[(place, place)].norm());
        let radius = near_zero.fold(0.0, f64::max);
        let coupling = decouple(&form.triangle, &blocks);
        let columns = &form.basis * &coupling;
        let rows = inverse(&coupling) * form.basis.adjoint();
        let mut sensitivity = vec![1.0; group.len()];
        for (place, original) in order.into_iter().enumerate().skip(zeros) {
            sensitivity[original] = columns.column(place).norm() * rows.row(place).norm();
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

    /// The same with these pairs of blocks made one; nothing if there are none, or if what is
    /// near zero would have to join.
    fn merged(self, schur: &SchurForm, pairs: &[(usize, usize)]) -> Option<Self> {
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
        found.then(|| Self::with_groups(schur, self.zeros, numbers))
    }

    /// Makes the parts exact, those near zero in a real basis.
    fn refine(&mut self, inner: &DMatrix<f64>) -> Refinement {
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
        let basis = real_basis(&spanned);
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

    /// The sensitivity of the most sensitive eigenvalue.
    fn condition(&self) -> f64 {
        self.sensitivity.iter().fold(0.0, |largest: f64, s| {
            if s.is_finite() {
                largest.max(*s)
            } else {
                f64::MAX
            }
        })
    }

    /// The parts in the whole state, where `pure` states integrate `outer` times the inner.
    fn in_full_state(self, outer: &DMatrix<f64>, pure: &[usize], felt: &[usize]) -> Decomposition {
        let unscaled = |mut matrix: DMatrix<Complex<f64>>, power: i32| {
            for (place, scale) in self.scale.iter().enumerate() {
                let factor = Complex::new(scale.powi(power), 0.0);
                if power > 0 {
                    matrix.row_mut(place).scale_mut(factor.re);
                } else {
                    matrix.column_mut(place).scale_mut(factor.re);
                }
            }
            matrix
        };
        let columns = unscaled(self.subspaces.columns.clone(), 1);
        let rows = unscaled(self.subspaces.rows.clone(), -1);
        let outer_complex = outer.map(|entry| Complex::new(entry, 0.0));
        let states = pure.len() + felt.len();
        let mut parts = Vec::new();
        // What the moving parts contribute to the pure integrals, to be taken off them.
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

    /// For each block 2, 1 or, for those that another one stands for, 0.
    fn weights(&self) -> Vec<f64> {
        let matrix = &self.subspaces.matrix;
        let imaginary = |block: &Range<usize>| -> (f64, f64) {
            let parts = block.clone().map(|place| matrix[(place, place)].im);
            let (low, high) = (f64::INFINITY, f64::NEG_INFINITY);
            parts.fold((low, high), |(low, high), im| (low.min(im), high.max(im)))
        };
        let bounds: Vec<(f64, f64)> = self.subspaces.blocks.iter().map(imaginary).collect();
        let largest = (0..matrix.nrows())
            .map(|place| matrix[(place, place)].norm())
            .fold(0.0, f64::max);
        let mut tolerance = REAL * largest;
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

    /// The part near zero together with the pure integrals, in a real basis.
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
        for (place, state) in pure.iter().enumerate() {
            columns[(*state, place)] = 1.0;
            rows[(place, *state)] = 1.0;
            for (column, other) in felt.iter().enumerate() {
                rows[(place, *other)] = -carried[(place, column)];
            }
        }
        for (place, state) in felt.iter().enumerate() {
            for column in 0..zeros {
                columns[(*state, pure.len() + column)] = inner_columns[(place, column)];
                rows[(pure.len() + column, *state)] = inner_rows[(column, place)];
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

/// Ranges of equal neighbours.
fn runs(group: &[usize]) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for (place, number) in group.iter().enumerate() {
        match runs.last_mut() {
            Some(run) if group[run.start] == *number => run.end = place + 1,
            _ => runs.push(place..place + 1),
        }
    }
    runs
}

/// X of X A = B.
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

/// A matrix of `states` rows with the rows of others at the given places.
fn scatter_rows(
    states: usize,
    pieces: &[(&[usize], &DMatrix<Complex<f64>>)],
) -> DMatrix<Complex<f64>> {
    let columns = pieces.first().map_or(0, |(_, piece)| piece.ncols());
    let mut whole = DMatrix::zeros(states, columns);
    for (places, piece) in pieces {
        for (row, place) in places.iter().enumerate() {
            whole.row_mut(*place).copy_from(&piece.row(row));
        }
    }
    whole
}

/// An orthonormal real basis of what complex columns span, given that they span a space
/// that is its own conjugate: Gram-Schmidt with the largest remainder next.
fn real_basis(columns: &DMatrix<Complex<f64>>) -> DMatrix<f64> {
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
        // Once more, against what rounding leaves.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The matrix that the parts make.
    fn composed(found: &Decomposition) -> (DMatrix<f64>, DMatrix<f64>) {
        let integrals = &found.integrals;
        let mut matrix = &integrals.columns * &integrals.matrix * &integrals.rows;
        let mut identity = &integrals.columns * &integrals.rows;
        for part in &found.parts {
            let size = part.matrix.nrows();
            let triangle = &part.matrix + DMatrix::from_diagonal_element(size, size, part.centre);
            matrix += (&part.columns * triangle * &part.rows).map(|e| part.weight * e.re);
            identity += (&part.columns * &part.rows).map(|e| part.weight * e.re);
        }
        (matrix, identity)
    }

    fn check(matrix: &DMatrix<f64>, tolerance: f64) -> Decomposition {
        let found = Decomposition::of(matrix, 0.0, 0.0).expect("decomposes");
        let (back, identity) = composed(&found);
        let size = matrix.nrows();
        assert!((identity - DMatrix::identity(size, size)).norm() < tolerance);
        assert!((back - matrix).norm() < tolerance * matrix.norm().max(1.0));
        found
    }

    #[test]
    fn free_masses_and_an_oscillator() {
        // Two free masses, one of them dragged, and an oscillator driven by the second rate.
        let matrix = DMatrix::from_row_slice(
            6,
            6,
            &[
                0.0, 0.0, 0.0, 1.0, 0.0, 0.0, //
                0.0, 0.0, 0.0, 0.0, 1.0, 0.0, //
                0.0, 0.0, 0.0, 0.0, 0.0, 1.0, //
                0.0, 0.0, 0.0, -94.0, 0.0, 0.0, //
                0.0, 0.0, 0.0, 0.0, 0.0, 0.0, //
                0.0, 0.0, -1e8, 0.0, 3.0, -20.0,
            ],
        );
        let found = check(&matrix, 1e-11);
        assert_eq!(found.integrals.matrix.nrows(), 3);
        assert_eq!(found.parts.len(), 2);
    }

    #[test]
    fn critically_damped_and_equal_oscillators() {
        let mut matrix = DMatrix::zeros(8, 8);
        for body in 0..4 {
            matrix[(body, body + 4)] = 1.0;
            matrix[(body + 4, body)] = -100.0;
        }
        matrix[(4, 4)] = -20.0; // critical: a defective pair
        matrix[(5, 5)] = -20.0 * (1.0 + 1e-9);
        check(&matrix, 1e-8);
    }

    #[test]
    fn nothing_moves() {
        let found = check(&DMatrix::zeros(4, 4), 1e-15);
        assert_eq!(found.integrals.matrix.nrows(), 4);
        assert!(found.parts.is_empty());
        check(&DMatrix::zeros(0, 0), 1e-15);
    }

    #[test]
    fn numbers_that_are_none_are_refused() {
        let mut matrix = DMatrix::zeros(2, 2);
        matrix[(1, 0)] = f64::NAN;
        assert_eq!(
            Decomposition::of(&matrix, 0.0, 0.0).err(),
            Some(Failure::NotFinite)
        );
    }
}
