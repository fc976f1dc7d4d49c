//! A real matrix as a sum of independent parts: A = sum of columns matrix rows.
//!
//! Integrals (states that affect no other state, and all eigenvalues near zero) are one part with a
//! real basis and a nearly nilpotent matrix: its exponential is a polynomial. The eigenvectors of
//! such a cluster have a condition number of 1e12 and more. Every other eigenvalue is a separate
//! part, except that eigenvalues with nearly equal eigenvectors share one.

use nalgebra::{Complex, DMatrix};

use super::clustering::{clusters, near_zero};
use super::invariant::Found;
use super::schur::SchurForm;

/// Eigenvectors are well-conditioned if no eigenvalue is more sensitive than this. Amplitudes
/// and eigenvalues are both wrong by it: four digits of sixteen at most.
const WELL_CONDITIONED: f64 = 100.0;

/// Bound on the sensitivity of two eigenvalues with nearly equal eigenvectors, times their relative
/// distance. A higher sensitivity has other causes.
const SENSITIVITY_FACTOR: f64 = 3.0;

/// Sensitivity of unusable eigenvectors, and the relative distance that then counts as close.
const EXTREME_SENSITIVITY: (f64, f64) = (1e6, 1e-2);

/// Error of a matrix that the QR iteration leaves, relative. In 1200 random chains of 4 to 10
/// integrators, 4 to 1024 roundings find the same zeros; one rounding misses 10 % of them.
const ITERATION_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// A part of a matrix: A columns = columns (centre + matrix).
#[derive(Clone, Debug)]
pub(super) struct Part {
    /// Centre of the eigenvalues, 1/s.
    pub centre: Complex<f64>,
    /// The rest: upper triangular with small diagonal, 1/s.
    pub matrix: DMatrix<Complex<f64>>,
    /// states x size.
    pub columns: DMatrix<Complex<f64>>,
    /// size x states; rows columns = 1.
    pub rows: DMatrix<Complex<f64>>,
    /// 2 for a part that represents its conjugate as well, 1 for a real part.
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
    /// Number of coordinates that affect no other coordinate; they are the first ones.
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
pub(super) enum DecompositionError {
    /// It holds infinite numbers or none.
    NotFinite,
    /// The eigenvalue iteration did not converge.
    NotConverged,
}

impl Decomposition {
    /// The parts of a square matrix whose state begins with so many positions and as many rates, on which forces act as fast as `forcing`, 1/s. Real
    /// eigenvalues up to `slow` in magnitude, 1/s, go to the integrals.
    pub fn decompose(
        matrix: &DMatrix<f64>,
        degrees: usize,
        forcing: f64,
        slow: f64,
    ) -> Result<Self, DecompositionError> {
        if matrix.iter().any(|entry| !entry.is_finite()) {
            return Err(DecompositionError::NotFinite);
        }
        let unfelt = |state: &usize| matrix.column(*state).iter().all(|entry| *entry == 0.0);
        let (pure, felt): (Vec<usize>, Vec<usize>) = (0..matrix.ncols()).partition(unfelt);
        let inner = matrix.select_columns(&felt).select_rows(&felt);
        let outer = matrix.select_columns(&felt).select_rows(&pure);
        let mut schur = SchurForm::decompose(&inner, time_scale(matrix, degrees, &felt))
            .ok_or(DecompositionError::NotConverged)?;
        let mut undetermined = 0.0;
        let (zeros, mut found) = loop {
            let near_zero = near_zero(&schur.eigenvalues(), forcing, [slow, undetermined]);
            schur.sort_by_key(near_zero.iter().map(|near| usize::from(!near)).collect());
            let zeros = near_zero.iter().filter(|near| **near).count();
            let found = best_parts(&schur, zeros);
            let radius = undetermined_radius(&schur, zeros, &found.sensitivity);
            if radius <= undetermined {
                break (zeros, found);
            }
            undetermined = radius;
        };
        for _ in 0..=zeros.max(inner.nrows()) {
            let refinement = found.refine(&inner);
            if refinement.converged {
                return Ok(found.in_full_state(&outer, &pure, &felt));
            }
            found = found
                .merge(&schur, &refinement.inseparable)
                .ok_or(DecompositionError::NotConverged)?;
        }
        Err(DecompositionError::NotConverged)
    }
}

/// Returns a unit of time for each state in which positions and rates have similar magnitudes: 1
/// for the positions, which are the first states, and for states of first order; a power of two
/// near the fastest rate for the rates between them. If forces act on rates only through states of
/// first order, rounding errors of other entries must not set the unit.
fn time_scale(matrix: &DMatrix<f64>, degrees: usize, felt: &[usize]) -> Vec<f64> {
    let filters = matrix.ncols() - 2 * degrees;
    let block = |row: usize, column: usize| {
        let size = |place: usize| if place == 2 { filters } else { degrees };
        let (shape, place) = ((size(row), size(column)), (row * degrees, column * degrees));
        matrix.view(place, shape).amax()
    };
    // A filter faster than its load acts as a gain, a slower one as an integral.
    let filter = block(2, 2);
    let through = [block(1, 2) * block(2, 0), block(1, 2) * block(2, 1)];
    let at_gain = through.map(|product| match product > 0.0 {
        true => product / filter,
        false => 0.0,
    });
    let loops = [
        block(1, 0).sqrt(),
        block(1, 1),
        through[0].cbrt().min(at_gain[0].sqrt()),
        through[1].sqrt().min(at_gain[1]),
    ];
    let fastest = loops.into_iter().fold(0.0, f64::max);
    let unit = if fastest > 0.0 {
        fastest.log2().round().exp2()
    } else {
        1.0
    };
    let of = |state: &usize| match state / degrees.max(1) {
        1 => unit,
        _ => 1.0,
    };
    felt.iter().map(of).collect()
}

/// Returns the largest magnitude, 1/s, of the eigenvalues after the first `zeros` that rounding
/// errors could have moved from zero. A chain of k integrators has k-fold zeros, which rounding
/// errors move by their k-th root.
fn undetermined_radius(schur: &SchurForm, zeros: usize, sensitivity: &[f64]) -> f64 {
    let error = ITERATION_ROUNDING * schur.triangle.norm();
    let eigenvalues = schur.eigenvalues().into_iter().zip(sensitivity);
    let magnitudes = eigenvalues.map(|(e, sensitivity)| (e.norm(), sensitivity * error));
    magnitudes
        .skip(zeros)
        .filter(|(magnitude, error)| magnitude <= error)
        .fold(0.0, |largest, (magnitude, _)| largest.max(magnitude))
}

/// The parts, with those eigenvalues together that are sensitive because of each other.
fn best_parts(schur: &SchurForm, zeros: usize) -> Found {
    let eigenvalues = schur.eigenvalues();
    let first = Found::with_clusters(schur, zeros, clusters(&eigenvalues, zeros, |_, _, _| false));
    if first.condition() <= WELL_CONDITIONED {
        return first;
    }
    // In the order of the Schur form, as the eigenvalues are.
    let sensitivity = first.sensitivity.clone();
    let shared = |a: usize, b: usize, distance: f64| {
        let least = sensitivity[a].min(sensitivity[b]);
        let explained = least > WELL_CONDITIONED && least * distance <= SENSITIVITY_FACTOR;
        explained || (least > EXTREME_SENSITIVITY.0 && distance <= EXTREME_SENSITIVITY.1)
    };
    let second = Found::with_clusters(schur, zeros, clusters(&eigenvalues, zeros, shared));
    if second.condition() < 0.5 * first.condition() {
        second
    } else {
        first
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the sum of the parts and the sum of their projections.
    fn compose(found: &Decomposition) -> (DMatrix<f64>, DMatrix<f64>) {
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
        let found =
            Decomposition::decompose(matrix, matrix.nrows() / 2, 0.0, 0.0).expect("decomposes");
        let (back, identity) = compose(&found);
        let size = matrix.nrows();
        assert!((identity - DMatrix::identity(size, size)).norm() < tolerance);
        assert!((back - matrix).norm() < tolerance * matrix.norm().max(1.0));
        found
    }

    #[test]
    fn free_masses_and_oscillator_are_decomposed() {
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
    fn critically_damped_and_equal_oscillators_are_decomposed() {
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
    fn zero_matrix_is_decomposed() {
        let found = check(&DMatrix::zeros(4, 4), 1e-15);
        assert_eq!(found.integrals.matrix.nrows(), 4);
        assert!(found.parts.is_empty());
        check(&DMatrix::zeros(0, 0), 1e-15);
    }

    #[test]
    fn non_finite_matrices_are_rejected() {
        let mut matrix = DMatrix::zeros(2, 2);
        matrix[(1, 0)] = f64::NAN;
        assert_eq!(
            Decomposition::decompose(&matrix, matrix.nrows() / 2, 0.0, 0.0).err(),
            Some(DecompositionError::NotFinite)
        );
    }
}
