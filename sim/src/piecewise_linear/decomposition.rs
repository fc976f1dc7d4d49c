//! Decomposition of a real matrix into independent parts: A = sum of columns matrix rows.
//!
//! The *integrals* are one part with a real basis: states that affect no other state, and all eigenvalues near
//! zero. The matrix of this part is nearly nilpotent, so its exponential is a polynomial. The eigenvectors of
//! such a cluster would have a condition number of 1e12 and more. Every other eigenvalue is a separate part,
//! but eigenvalues with nearly equal eigenvectors share one.

use nalgebra::{Complex, DMatrix};

use super::clustering::{clusters, find_near_zero};
use super::invariant::InvariantSubspaces;
use super::schur::SchurForm;

/// Largest sensitivity of well-conditioned eigenvalues. The relative errors of amplitudes and eigenvalues grow
/// by this factor, which costs at most four of sixteen digits.
const MAX_GOOD_SENSITIVITY: f64 = 100.0;

/// Bound on the sensitivity of two eigenvalues with nearly equal eigenvectors, times their relative distance. A
/// higher sensitivity has other causes.
const SENSITIVITY_FACTOR: f64 = 3.0;

/// Sensitivity above which eigenvectors are unusable, and the relative distance below which eigenvalues then
/// share a part.
const EXTREME_SENSITIVITY: (f64, f64) = (1e6, 1e-2);

/// Relative error of a matrix after the QR iteration. In 1200 random chains of 4 to 10 integrators, thresholds
/// of 4 to 1024 roundings find the same zeros; one rounding misses 10 % of them.
const ITERATION_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// One part of a matrix: A columns = columns (centre + matrix).
#[derive(Clone, Debug)]
pub(super) struct Part {
    /// Centre of the eigenvalues, 1/s.
    pub centre: Complex<f64>,
    /// Matrix relative to the centre: upper triangular with a small diagonal, 1/s.
    pub matrix: DMatrix<Complex<f64>>,
    /// Basis of the invariant subspace, states x size.
    pub columns: DMatrix<Complex<f64>>,
    /// Left inverse of `columns`, size x states: rows columns = 1.
    pub rows: DMatrix<Complex<f64>>,
    /// 2 for a part that also represents its conjugate, 1 for a real part.
    pub weight: f64,
}

/// Part with the eigenvalues near zero.
#[derive(Clone, Debug)]
pub(super) struct Integrals {
    /// Matrix in the basis `columns`, 1/s.
    pub matrix: DMatrix<f64>,
    /// Basis of the invariant subspace, states x size.
    pub columns: DMatrix<f64>,
    /// Left inverse of `columns`, size x states.
    pub rows: DMatrix<f64>,
    /// Largest magnitude of the eigenvalues, 1/s.
    pub radius: f64,
    /// Number of coordinates that affect no other coordinate; they are the first ones.
    pub pure: usize,
}

/// Parts of a matrix. Its exponential is the sum of the exponentials of the parts, with twice the real part if
/// the weight is 2.
#[derive(Clone, Debug)]
pub(super) struct Decomposition {
    pub integrals: Integrals,
    pub parts: Vec<Part>,
}

/// Reason why a matrix cannot be decomposed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum DecompositionError {
    /// An entry is infinite or NaN.
    NotFinite,
    /// The eigenvalue iteration did not converge.
    NotConverged,
}

impl Decomposition {
    /// Decomposes a square matrix whose state starts with `degrees` positions and the same number of rates.
    /// Forces act on the rates as fast as `forcing`, 1/s. Real eigenvalues with magnitudes up to `slow`, 1/s,
    /// become part of the integrals.
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
            let near_zero = find_near_zero(&schur.eigenvalues(), forcing, [slow, undetermined]);
            schur.sort_by_key(near_zero.iter().map(|near| usize::from(!near)).collect());
            let zeros = near_zero.iter().filter(|near| **near).count();
            let found = find_best_parts(&schur, zeros);
            let radius = find_undetermined_radius(&schur, zeros, &found.sensitivity);
            if radius <= undetermined {
                break (zeros, found);
            }
            undetermined = radius;
        };
        for _ in 0..=zeros.max(inner.nrows()) {
            let refinement = found.refine(&inner);
            if refinement.converged {
                return Ok(found.extend_to_full_state(&outer, &pure, &felt));
            }
            found = found
                .merge(&schur, &refinement.inseparable)
                .ok_or(DecompositionError::NotConverged)?;
        }
        Err(DecompositionError::NotConverged)
    }
}

/// Returns a time unit for each state in which positions and rates have similar magnitudes. It is 1 for the
/// positions, which are the first states, and for first-order states. For the rates between them it is a power
/// of two near the fastest rate. If forces act on rates only through first-order states, rounding errors of
/// other entries must not determine the unit.
fn time_scale(matrix: &DMatrix<f64>, degrees: usize, felt: &[usize]) -> Vec<f64> {
    let filters = matrix.ncols() - 2 * degrees;
    let block = |row: usize, column: usize| {
        let size = |index: usize| if index == 2 { filters } else { degrees };
        let (shape, index) = ((size(row), size(column)), (row * degrees, column * degrees));
        matrix.view(index, shape).amax()
    };
    // A filter faster than its load acts as a gain, a slower one as an integrator.
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

/// Returns the largest magnitude, 1/s, of the eigenvalues after the first `zeros` that are zero up to rounding.
/// A chain of k integrators has a k-fold eigenvalue zero, which rounding errors displace by their k-th root.
fn find_undetermined_radius(schur: &SchurForm, zeros: usize, sensitivity: &[f64]) -> f64 {
    let error = ITERATION_ROUNDING * schur.triangle.norm();
    let eigenvalues = schur.eigenvalues().into_iter().zip(sensitivity);
    let magnitudes = eigenvalues.map(|(e, sensitivity)| (e.norm(), sensitivity * error));
    magnitudes
        .skip(zeros)
        .filter(|(magnitude, error)| magnitude <= error)
        .fold(0.0, |largest, (magnitude, _)| largest.max(magnitude))
}

/// Returns the parts. Eigenvalues that are sensitive because they are close to each other share a part.
fn find_best_parts(schur: &SchurForm, zeros: usize) -> InvariantSubspaces {
    let eigenvalues = schur.eigenvalues();
    let first = InvariantSubspaces::with_clusters(
        schur,
        zeros,
        clusters(&eigenvalues, zeros, |_, _, _| false),
    );
    if first.condition() <= MAX_GOOD_SENSITIVITY {
        return first;
    }
    // The sensitivities have the order of the Schur form, like the eigenvalues.
    let sensitivity = first.sensitivity.clone();
    let shared = |a: usize, b: usize, distance: f64| {
        let least = sensitivity[a].min(sensitivity[b]);
        let explained = least > MAX_GOOD_SENSITIVITY && least * distance <= SENSITIVITY_FACTOR;
        explained || (least > EXTREME_SENSITIVITY.0 && distance <= EXTREME_SENSITIVITY.1)
    };
    let second =
        InvariantSubspaces::with_clusters(schur, zeros, clusters(&eigenvalues, zeros, shared));
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
        // Two free masses, one of them with drag, and an oscillator that the second rate drives.
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
