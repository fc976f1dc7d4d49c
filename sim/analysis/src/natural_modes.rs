//! Natural modes of a linearised machine: eigenvalues and shapes of q'' = K q + D q' + F z with
//! first-order states z' = G q + H z + E q'.
//!
//! The eigenvalues come from the real Schur form of the balanced state matrix, the shapes from
//! inverse iteration on lambda^2 - lambda D - K (Golub and Van Loan, *Matrix Computations*, 7.5 and
//! 7.6). A rigid motion has the eigenvalue 0, usually double and defective; rounding moves such
//! eigenvalues by the root of the unit roundoff. Their multiplicity is therefore counted by the
//! ranks of K, and of D on its null space. With first-order states, whose integrals make longer
//! chains, null spaces are removed successively (Golub and Van Loan, 7.6.5).

use nalgebra::{Complex, DMatrix, DVector};

use crate::balancing::BalancedMatrix;
use crate::block_eigenvalues;
use crate::error::AnalysisError;
use crate::independent_parts::{Part, independent_parts};
use crate::inverse_iteration::null_vector;
use crate::null_space::zero_eigenvalues;
use crate::pencil::Pencil;

/// Relative difference of eigenvalues below which they are a multiple eigenvalue.
const MAX_EQUAL_EIGENVALUE_DIFFERENCE: f64 = 1e-7;

/// Largest number of states of a connected part. The cost of the eigenvalues grows with its cube.
pub const MAX_CONNECTED_STATES: usize = 1200;

/// Natural mode: the motion exp(lambda t) v, or its real part.
#[derive(Clone, Debug, PartialEq)]
pub struct NaturalMode {
    /// Eigenvalue lambda, 1/s. For a conjugate pair, the one with positive imaginary part.
    pub eigenvalue: Complex<f64>,
    /// Shape v: amplitudes of the coordinates in SI units, scaled so that the largest is 1, then amplitudes of
    /// the first-order states. If no coordinate moves, the largest of these is 1.
    pub shape: Vec<Complex<f64>>,
    /// Rate, 1/s, up to which an eigenvalue counts as 0, because it is below the rounding of the fastest
    /// motion.
    pub resolution: f64,
}

impl NaturalMode {
    /// Returns the undamped natural frequency abs(lambda)/(2 pi), Hz; 0 for a rigid motion.
    pub fn frequency(&self) -> f64 {
        self.eigenvalue.norm() / std::f64::consts::TAU
    }

    /// Returns the greatest frequency, Hz, that a rigid motion may have; `None` if the motion is not
    /// rigid.
    pub fn frequency_limit(&self) -> Option<f64> {
        (self.eigenvalue.norm() == 0.0).then_some(self.resolution / std::f64::consts::TAU)
    }

    /// Returns the damping ratio -Re(lambda)/abs(lambda): 1 for a decay without oscillation,
    /// negative for growth, 0 for a rigid motion.
    pub fn damping(&self) -> f64 {
        let size = self.eigenvalue.norm();
        if size > 0.0 {
            // Avoids -0 without damping.
            0.0 - self.eigenvalue.re / size
        } else {
            0.0
        }
    }
}

/// Computes the natural modes of d(q, q', z)/dt = A (q, q', z), lowest frequency first. `matrix` is
/// A row by row, with the rows (0 1 0) for q; `degrees` is the number of coordinates q.
///
/// # Errors
///
/// A matrix that is not square with at least two rows per degree of freedom, entries that are not
/// finite, a connected part of more than [`MAX_CONNECTED_STATES`], an eigenvalue iteration that does
/// not converge.
pub fn natural_modes(matrix: &[f64], degrees: usize) -> Result<Vec<NaturalMode>, AnalysisError> {
    let states = matrix.len().isqrt().max(2 * degrees);
    if states * states != matrix.len() {
        let (expected, given) = (states * states, matrix.len());
        return Err(AnalysisError::LengthMismatch { expected, given });
    }
    if let Some(sample) = matrix.iter().position(|entry| !entry.is_finite()) {
        return Err(AnalysisError::NotFinite { sample });
    }
    if states == 0 {
        return Ok(Vec::new());
    }
    let matrix = DMatrix::from_row_slice(states, states, matrix);
    let parts = independent_parts(&matrix, &DMatrix::zeros(0, states), degrees);
    collect_modes(states - degrees, parts, |part| {
        connected_modes(&part.matrix, part.degrees)
    })
}

/// Collects the modes of all parts, lowest frequency first. `count` is the number of coordinates
/// and first-order states of the machine.
///
/// # Errors Errors of the modes of a part.
pub(crate) fn collect_modes(
    count: usize,
    parts: Vec<Part>,
    modes: impl Fn(&Part) -> Result<Vec<NaturalMode>, AnalysisError>,
) -> Result<Vec<NaturalMode>, AnalysisError> {
    let mut all = Vec::with_capacity(count);
    let largest = parts.iter().map(|part| part.matrix.nrows()).max();
    if let Some(states) = largest.filter(|states| *states > MAX_CONNECTED_STATES) {
        let limit = MAX_CONNECTED_STATES;
        return Err(AnalysisError::TooManyStates { states, limit });
    }
    for part in &parts {
        for mode in modes(part)? {
            let mut shape = vec![Complex::from(0.0); count];
            for (index, amplitude) in part.indices.iter().zip(mode.shape) {
                shape[*index] = amplitude;
            }
            all.push(NaturalMode { shape, ..mode });
        }
    }
    if parts.len() > 1 {
        all.sort_by(|a, b| a.frequency().total_cmp(&b.frequency()));
    }
    Ok(all)
}

pub(crate) fn connected_modes(
    matrix: &DMatrix<f64>,
    degrees: usize,
) -> Result<Vec<NaturalMode>, AnalysisError> {
    let states = matrix.nrows();
    let balanced = BalancedMatrix::new(matrix);
    let not_converged = || AnalysisError::not_converged(matrix);
    let mut eigenvalues =
        block_eigenvalues::eigenvalues(&balanced.matrix).ok_or_else(not_converged)?;
    eigenvalues.sort_by(|a, b| a.norm().total_cmp(&b.norm()));
    let pencil = Pencil::new(&balanced, degrees);
    let mut rigid = pencil.rigid_motions().ok_or_else(not_converged)?;
    if states > 2 * degrees {
        let count = zero_eigenvalues(balanced.matrix.clone());
        rigid.multiplicity = count.ok_or_else(not_converged)?;
    }
    let mut modes: Vec<(Complex<f64>, DVector<Complex<f64>>)> = Vec::new();
    modes.extend(rigid.shapes.into_iter().map(|shape| (0.0.into(), shape)));
    let moving = eigenvalues.into_iter().skip(rigid.multiplicity);
    for eigenvalue in moving.filter(|eigenvalue| eigenvalue.im >= 0.0) {
        let shape = null_vector(
            |at| pencil.evaluate(at),
            eigenvalue,
            &vectors_of_eigenvalue(&modes, eigenvalue),
        );
        modes.push((eigenvalue, shape));
    }
    let scaled = modes.into_iter().map(|(eigenvalue, shape)| NaturalMode {
        eigenvalue: balanced.eigenvalue(eigenvalue),
        shape: pencil.to_si(&shape),
        resolution: balanced.resolution(),
    });
    Ok(scaled.collect())
}

/// Returns the vectors of the modes with this eigenvalue.
pub(crate) fn vectors_of_eigenvalue(
    modes: &[(Complex<f64>, DVector<Complex<f64>>)],
    eigenvalue: Complex<f64>,
) -> Vec<DVector<Complex<f64>>> {
    let is_equal = |other: &Complex<f64>| {
        (eigenvalue - other).norm() < MAX_EQUAL_EIGENVALUE_DIFFERENCE * eigenvalue.norm()
    };
    let equal = modes.iter().filter(|(other, _)| is_equal(other));
    equal.map(|(_, vector)| vector.clone()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the state matrix of q'' = K q + D q'.
    fn matrix(stiffness: &[&[f64]], damping: &[&[f64]]) -> Vec<f64> {
        let degrees = stiffness.len();
        let mut rows = Vec::new();
        for row in 0..degrees {
            rows.extend(
                (0..2 * degrees).map(|column| f64::from(u8::from(column == row + degrees))),
            );
        }
        for (stiffness, damping) in stiffness.iter().zip(damping) {
            rows.extend_from_slice(stiffness);
            rows.extend_from_slice(damping);
        }
        rows
    }

    fn close(found: f64, right: f64) -> bool {
        (found - right).abs() <= 1e-11 * right.abs().max(1e-3)
    }

    #[test]
    fn connected_part_above_the_limit_is_rejected() {
        let degrees = MAX_CONNECTED_STATES / 2 + 1;
        let states = 2 * degrees;
        let mut rows = vec![0.0; states * states];
        for index in 0..degrees {
            rows[index * states + degrees + index] = 1.0;
            rows[(degrees + index) * states + index] = -2.0;
        }
        // Without springs between them, each mass is a separate part.
        assert_eq!(
            natural_modes(&rows, degrees).map(|modes| modes.len()),
            Ok(degrees)
        );
        for index in 1..degrees {
            rows[(degrees + index) * states + index - 1] = 1.0;
            rows[(degrees + index - 1) * states + index] = 1.0;
        }
        let limit = MAX_CONNECTED_STATES;
        assert_eq!(
            natural_modes(&rows, degrees),
            Err(AnalysisError::TooManyStates { states, limit })
        );
    }

    #[test]
    fn connected_part_at_the_limit_is_solved() -> Result<(), AnalysisError> {
        let degrees = MAX_CONNECTED_STATES / 2;
        let states = 2 * degrees;
        let stiffness = |index: usize| (1.0 + index as f64 / 100.0).powi(2);
        let mut rows = vec![0.0; states * states];
        for index in 0..degrees {
            rows[index * states + degrees + index] = 1.0;
            rows[(degrees + index) * states + index] = -stiffness(index);
            if index > 0 {
                // Each mass drives only the next one: the eigenvalues are those of single masses.
                rows[(degrees + index) * states + index - 1] = 0.01;
            }
        }
        let modes = natural_modes(&rows, degrees)?;
        assert_eq!(modes.len(), degrees);
        for (index, mode) in modes.iter().enumerate() {
            let right = stiffness(index).sqrt() / std::f64::consts::TAU;
            assert!(close(mode.frequency(), right), "{index}: {mode:?}");
        }
        Ok(())
    }

    #[test]
    fn damped_oscillator_matches_closed_form() -> Result<(), AnalysisError> {
        let modes = natural_modes(&matrix(&[&[-400.0]], &[&[-4.0]]), 1)?;
        assert_eq!(modes.len(), 1);
        assert!(close(modes[0].frequency(), 20.0 / std::f64::consts::TAU));
        assert!(close(modes[0].damping(), 0.1), "{modes:?}");
        let strong = natural_modes(&matrix(&[&[-400.0]], &[&[-50.0]]), 1)?;
        let decays: Vec<f64> = strong.iter().map(|mode| mode.eigenvalue.re).collect();
        assert!(
            close(decays[0], -10.0) && close(decays[1], -40.0),
            "{decays:?}"
        );
        assert!(strong.iter().all(|mode| mode.damping() == 1.0));
        Ok(())
    }

    #[test]
    fn two_masses_on_a_spring_have_one_rigid_motion() -> Result<(), AnalysisError> {
        // Masses 1 and 3 with stiffness 1e6, and the same masses with a stiffness of 1e-3.
        for (k, c) in [(1e6, 0.0), (1e6, 2.0), (1e-3, 0.0)] {
            let (stiffness, damping) = (
                [[-k, k], [k / 3.0, -k / 3.0]],
                [[-c, c], [c / 3.0, -c / 3.0]],
            );
            let rows = |m: &[[f64; 2]; 2]| [m[0].to_vec(), m[1].to_vec()];
            let (stiffness, damping) = (rows(&stiffness), rows(&damping));
            let modes = natural_modes(
                &matrix(&[&stiffness[0], &stiffness[1]], &[&damping[0], &damping[1]]),
                2,
            )?;
            assert_eq!(modes.len(), 2, "{modes:?}");
            assert_eq!((modes[0].frequency(), modes[0].damping()), (0.0, 0.0));
            assert!(
                (modes[0].shape[0] - modes[0].shape[1]).norm() < 1e-9,
                "{modes:?}"
            );
            let omega = (k * 4.0 / 3.0).sqrt();
            assert!(
                close(modes[1].frequency() * std::f64::consts::TAU, omega),
                "{modes:?}"
            );
            assert!((modes[1].shape[1] + 1.0 / 3.0).norm() < 1e-9, "{modes:?}");
        }
        Ok(())
    }

    #[test]
    fn free_mass_with_friction_has_a_rigid_motion_and_a_decay() -> Result<(), AnalysisError> {
        let modes = natural_modes(&matrix(&[&[0.0]], &[&[-3.0]]), 1)?;
        let found: Vec<(f64, f64)> = modes
            .iter()
            .map(|m| (m.eigenvalue.re, m.damping()))
            .collect();
        assert_eq!(found, [(0.0, 0.0), (-3.0, 1.0)]);
        Ok(())
    }

    #[test]
    fn integral_of_a_free_position_makes_a_chain_of_three() -> Result<(), AnalysisError> {
        // q'' = -3 u with u' = -5 u + 2 q', and an integral of q: the eigenvalue 0 twice, and those
        // of lambda^2 + 5 lambda + 6.
        let matrix = [
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, -3.0, 0.0],
            [0.0, 2.0, -5.0, 0.0],
            [1.0, 0.0, 0.0, 0.0],
        ];
        let modes = natural_modes(matrix.as_flattened(), 1)?;
        let found: Vec<f64> = modes.iter().map(|mode| mode.eigenvalue.re).collect();
        assert!(
            found.len() == 3 && found[0] == 0.0 && close(found[1], -2.0) && close(found[2], -3.0),
            "{found:?}"
        );
        // u = -lambda^2 q/3; the integral is 1/lambda.
        let [q, u, integral] = modes[2].shape[..] else {
            panic!("{modes:?}");
        };
        let found = [q.re, u.re, integral.re];
        let off = found
            .iter()
            .zip([1.0, -3.0, -1.0 / 3.0])
            .map(|(a, b)| (a - b).abs());
        assert!(off.fold(0.0, f64::max) < 1e-9, "{found:?}");
        Ok(())
    }

    #[test]
    fn equal_frequencies_have_independent_shapes() -> Result<(), AnalysisError> {
        let none: &[f64] = &[0.0, 0.0];
        let modes = natural_modes(&matrix(&[&[-9.0, 0.0], &[0.0, -9.0]], &[none, none]), 2)?;
        assert_eq!(modes.len(), 2);
        let (a, b) = (&modes[0].shape, &modes[1].shape);
        let area = a[0] * b[1] - a[1] * b[0];
        assert!(area.norm() > 0.5, "{modes:?}");
        Ok(())
    }

    #[test]
    fn malformed_state_matrices_are_rejected() {
        assert!(natural_modes(&[1.0; 8], 1).is_err());
        assert!(natural_modes(&[1.0; 4], 2).is_err());
        assert!(natural_modes(&[f64::NAN; 4], 1).is_err());
        assert_eq!(natural_modes(&[], 0), Ok(Vec::new()));
    }

    #[test]
    fn frequencies_do_not_depend_on_units() -> Result<(), AnalysisError> {
        // Two equal masses on two equal springs: omega^2 = k/m (3 -+ sqrt 5)/2.
        for k in [1e-300, 1e-200, 1e-9, 1.0, 1e150, 1e300] {
            let none: &[f64] = &[0.0, 0.0];
            let modes = natural_modes(&matrix(&[&[-2.0 * k, k], &[k, -k]], &[none, none]), 2)?;
            assert_eq!(modes.len(), 2, "{k:e}");
            for (mode, square) in modes.iter().zip([3.0 - 5_f64.sqrt(), 3.0 + 5_f64.sqrt()]) {
                let right = (square / 2.0).sqrt() * k.sqrt();
                assert!(
                    (mode.eigenvalue.im / right - 1.0).abs() < 1e-12,
                    "{k:e} {mode:?}"
                );
                assert_eq!(mode.shape.len(), 2);
            }
        }
        Ok(())
    }

    #[test]
    fn soft_spring_keeps_its_frequency_with_a_stiff_one() -> Result<(), AnalysisError> {
        for k in [1e100, 1e160, 1e300] {
            let none: &[f64] = &[0.0, 0.0];
            let modes = natural_modes(&matrix(&[&[-k, 0.0], &[0.0, -4.0]], &[none, none]), 2)?;
            let found: Vec<f64> = modes.iter().map(|mode| mode.eigenvalue.im).collect();
            assert!(close(found[0], 2.0), "{k:e} {found:?}");
            assert!((found[1] / k.sqrt() - 1.0).abs() < 1e-12, "{k:e} {found:?}");
        }
        // A mass on a stiff spring, and a second mass on a soft spring attached to it.
        for k in [1e8, 1e20, 1e30, 1e50, 1e70, 1e150, 1e300] {
            let none: &[f64] = &[0.0, 0.0];
            let stiffness: [&[f64]; 2] = [&[-25.0 - k, 25.0], &[25.0, -25.0]];
            let modes = natural_modes(&matrix(&stiffness, &[none, none]), 2)?;
            assert_eq!(modes.len(), 2, "{k:e} {modes:?}");
            let found = modes[0].eigenvalue.im;
            assert!((found / 5.0 - 1.0).abs() < 1e-6, "{k:e} {found}");
        }
        Ok(())
    }
}
