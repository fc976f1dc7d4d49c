//! Natural modes of a linearised machine with constraints.
//!
//! The constraints C x = 0 determine some states by the others, which `independent_states` selects: x = N y
//! with the identity in the rows of the independent states y. The modes are the natural modes of y' = S A N y,
//! where S selects these rows. States are measured relative to their typical sizes.

use nalgebra::{Complex, DMatrix, DVector};

use crate::allowed_motions::row_by_row;
use crate::error::AnalysisError;
use crate::independent_parts::independent_parts;
use crate::independent_states::independent_states;
use crate::natural_modes::{NaturalMode, collect_modes, connected_modes, natural_modes};
use crate::rounding::product_without_rounding;

/// Computes the natural modes of d(q, q', z)/dt = A (q, q', z), subject to C (q, q', z) = 0, lowest
/// frequency first. `matrix` and `held` are A and C row by row; `degrees` is the number of
/// coordinates q. A multiple eigenvalue is listed once per shape. `sizes` are typical sizes of the
/// states, powers of two.
///
/// # Errors Same as [`natural_modes`].
pub fn constrained_modes(
    matrix: &[f64],
    held: &[f64],
    degrees: usize,
    sizes: &[f64],
) -> Result<Vec<NaturalMode>, AnalysisError> {
    let states = sizes.len();
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
    let matrix = DMatrix::from_fn(states, states, |row, column| {
        matrix[row * states + column] * (sizes[column] / sizes[row])
    });
    let held = DMatrix::from_fn(held.len() / states, states, |row, column| {
        held[row * states + column] * sizes[column]
    });
    let amplitudes = sizes[..degrees].iter().chain(&sizes[2 * degrees..]);
    let amplitudes: Vec<f64> = amplitudes.copied().collect();
    let parts = independent_parts(&matrix, &held, degrees);
    let mut modes = collect_modes(states - degrees, parts, |part| {
        match part.constraints.nrows() {
            0 => connected_modes(&part.matrix, part.degrees),
            _ => constrained_modes_of_part(&part.matrix, &part.constraints, part.degrees),
        }
    })?;
    for mode in &mut modes {
        for (entry, size) in mode.shape.iter_mut().zip(&amplitudes) {
            *entry *= *size;
        }
        normalise(&mut mode.shape, degrees);
    }
    Ok(modes)
}

fn constrained_modes_of_part(
    matrix: &DMatrix<f64>,
    held: &DMatrix<f64>,
    degrees: usize,
) -> Result<Vec<NaturalMode>, AnalysisError> {
    let independent = independent_states(held, degrees);
    if independent.states.is_empty() {
        return Ok(Vec::new());
    }
    let rows = matrix.select_rows(&independent.states);
    let reduced = row_by_row(&product_without_rounding(&rows, &independent.basis));
    let basis = independent.basis.map(Complex::from);
    let modes = natural_modes(&reduced, independent.degrees)?;
    let modes = modes.into_iter().map(|mode| {
        let (coordinates, others) = mode.shape.split_at(independent.degrees);
        let rates = coordinates.iter().map(|entry| entry * mode.eigenvalue);
        let all = coordinates.iter().copied().chain(rates);
        let all = all.chain(others.iter().copied());
        let motion = DVector::from_iterator(independent.states.len(), all);
        let motion = &basis * motion;
        let amplitudes = motion.iter().take(degrees);
        let amplitudes = amplitudes.chain(motion.iter().skip(2 * degrees));
        NaturalMode {
            shape: amplitudes.copied().collect(),
            ..mode
        }
    });
    Ok(modes.collect())
}

/// Scales a shape so that its largest coordinate is 1, or the largest first-order state if no coordinate moves.
fn normalise(shape: &mut [Complex<f64>], degrees: usize) {
    let largest = |entries: &[Complex<f64>]| {
        let largest = entries.iter().max_by(|a, b| a.norm().total_cmp(&b.norm()));
        largest.copied().filter(|entry| entry.norm() > 0.0)
    };
    let unit = largest(&shape[..degrees]).or_else(|| largest(shape));
    let unit = unit.unwrap_or_else(|| 1.0.into());
    shape.iter_mut().for_each(|entry| *entry /= unit);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn held_mass_has_no_modes() {
        let a = [[0.0, 1.0], [-9.0, 0.0]];
        let held = [[1.0, 0.0], [0.0, 1.0]];
        let modes = constrained_modes(a.as_flattened(), held.as_flattened(), 1, &[1.0; 2]).unwrap();
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
        let modes = constrained_modes(
            a.as_flattened(),
            held.as_flattened(),
            2,
            &[4.0, 1.0, 8.0, 0.5],
        )
        .unwrap();
        assert_eq!(modes.len(), 1);
        assert!((modes[0].eigenvalue.im - 4.5_f64.sqrt()).abs() < 1e-12);
        assert!((modes[0].shape[0] - modes[0].shape[1]).norm() < 1e-12);
    }
}
