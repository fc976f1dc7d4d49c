//! Natural modes of a linearised machine with constraints.
//!
//! They are the modes of N^T A N, with N from [`allowed_motions`](crate::allowed_motions). Null
//! spaces give the multiplicity of the eigenvalue 0, as in [`natural_modes`](crate::natural_modes).

use nalgebra::{Complex, DMatrix, DVector};

use crate::allowed_motions::{AllowedMotions, row_by_row};
use crate::balancing::BalancedMatrix;
use crate::block_eigenvalues;
use crate::error::AnalysisError;
use crate::independent_parts::independent_parts;
use crate::inverse_iteration::{SparseRows, null_vector};
use crate::natural_modes::{
    NaturalMode, collect_modes, connected_modes, natural_modes, vectors_of_eigenvalue,
};
use crate::null_space::{null_space, zero_eigenvalues};

/// Computes the natural modes of d(q, q', z)/dt = A (q, q', z), subject to C (q, q', z) = 0, lowest
/// frequency first. `matrix` and `held` are A and C row by row; `degrees` is the number of
/// coordinates q. A multiple eigenvalue is listed once per shape.
///
/// # Errors
/// As [`natural_modes`].
pub fn constrained_modes(
    matrix: &[f64],
    held: &[f64],
    degrees: usize,
) -> Result<Vec<NaturalMode>, AnalysisError> {
    let states = matrix.len().isqrt();
    if held.is_empty() || states == 0 {
        return natural_modes(matrix, degrees);
    }
    if states * states != matrix.len() || !held.len().is_multiple_of(states) {
        let (expected, given) = (states * states, matrix.len());
        return Err(AnalysisError::LengthMismatch { expected, given });
    }
    if let Some(sample) = matrix.iter().position(|entry| !entry.is_finite()) {
        return Err(AnalysisError::NotFinite { sample });
    }
    let matrix = DMatrix::from_row_slice(states, states, matrix);
    let held = DMatrix::from_row_slice(held.len() / states, states, held);
    let parts = independent_parts(&matrix, &held, degrees);
    collect_modes(states - degrees, parts, |part| {
        match part.constraints.nrows() {
            0 => connected_modes(&part.matrix, part.degrees),
            _ => constrained_modes_of_part(&part.matrix, &part.constraints, part.degrees),
        }
    })
}

fn constrained_modes_of_part(
    matrix: &DMatrix<f64>,
    held: &DMatrix<f64>,
    degrees: usize,
) -> Result<Vec<NaturalMode>, AnalysisError> {
    let states = matrix.nrows();
    let balanced = BalancedMatrix::new(matrix);
    let not_converged = || AnalysisError::not_converged(matrix);
    let sizes = balanced.sizes.iter().cycle();
    let held: Vec<f64> = row_by_row(held)
        .iter()
        .zip(sizes)
        .map(|(entry, size)| entry * size)
        .collect();
    let allowed = AllowedMotions::new(&held, states)?;
    let allowed = allowed.basis();
    let reduced = allowed.transpose() * &balanced.matrix * allowed;
    if reduced.is_empty() {
        return Ok(Vec::new());
    }
    let mut eigenvalues = block_eigenvalues::eigenvalues(&reduced).ok_or_else(not_converged)?;
    eigenvalues.sort_by(|a, b| a.norm().total_cmp(&b.norm()));
    let rigid = null_space(&reduced).ok_or_else(not_converged)?;
    let rigid = rigid.column_iter();
    let mut modes: Vec<(Complex<f64>, DVector<Complex<f64>>)> = rigid
        .map(|motion| (0.0.into(), motion.map(Complex::from)))
        .collect();
    let count = zero_eigenvalues(reduced.clone()).ok_or_else(not_converged)?;
    let shifted = |eigenvalue: Complex<f64>| -> SparseRows {
        let rows = reduced.row_iter().enumerate();
        rows.map(|(place, row)| {
            let entries = row.iter().copied().map(Complex::from).enumerate();
            let shifted = entries.map(|(column, entry)| match column == place {
                true => (column, entry - eigenvalue),
                false => (column, entry),
            });
            shifted.collect()
        })
        .collect()
    };
    let moving = eigenvalues.into_iter().skip(count);
    for eigenvalue in moving.filter(|eigenvalue| eigenvalue.im >= 0.0) {
        let motion = null_vector(
            shifted,
            eigenvalue,
            &vectors_of_eigenvalue(&modes, eigenvalue),
        );
        modes.push((eigenvalue, motion));
    }
    let mut in_si = allowed.map(Complex::from);
    for (mut row, size) in in_si.row_iter_mut().zip(&balanced.sizes) {
        row *= Complex::from(*size);
    }
    let modes = modes.into_iter().map(|(eigenvalue, motion)| NaturalMode {
        eigenvalue: balanced.eigenvalue(eigenvalue),
        shape: shape(&(&in_si * motion), degrees),
        resolution: balanced.resolution(),
    });
    Ok(modes.collect())
}

/// Returns coordinates and first-order states of a motion, scaled so that the largest coordinate is
/// 1.
fn shape(motion: &DVector<Complex<f64>>, degrees: usize) -> Vec<Complex<f64>> {
    let coordinates = motion.iter().take(degrees);
    let all: Vec<Complex<f64>> = coordinates
        .chain(motion.iter().skip(2 * degrees))
        .copied()
        .collect();
    let largest = |entries: &[Complex<f64>]| {
        let largest = entries.iter().max_by(|a, b| a.norm().total_cmp(&b.norm()));
        largest.copied().filter(|entry| entry.norm() > 0.0)
    };
    let unit = largest(&all[..degrees]).or_else(|| largest(&all));
    all.iter()
        .map(|entry| entry / unit.unwrap_or_else(|| 1.0.into()))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn held_mass_has_no_modes() {
        let a = [[0.0, 1.0], [-9.0, 0.0]];
        let held = [[1.0, 0.0], [0.0, 1.0]];
        let modes = constrained_modes(a.as_flattened(), held.as_flattened(), 1).unwrap();
        assert!(modes.is_empty(), "{modes:?}");
    }

    #[test]
    fn two_joined_masses_have_one_mode() {
        // x_1'' = -9 x_1, x_2'' = 0 with x_1 = x_2 and equal masses: x'' = -4.5 x.
        let a = [
            [0.0, 0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
            [-4.5, 0.0, 0.0, 0.0],
            [-4.5, 0.0, 0.0, 0.0],
        ];
        let held = [[1.0, -1.0, 0.0, 0.0], [0.0, 0.0, 1.0, -1.0]];
        let modes = constrained_modes(a.as_flattened(), held.as_flattened(), 2).unwrap();
        assert_eq!(modes.len(), 1);
        assert!((modes[0].eigenvalue.im - 4.5_f64.sqrt()).abs() < 1e-12);
        assert!((modes[0].shape[0] - modes[0].shape[1]).norm() < 1e-12);
    }
}
