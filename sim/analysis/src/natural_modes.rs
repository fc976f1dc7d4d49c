//! Natural modes of a linearised machine: the eigenvalues of q'' = K q + D q' + F z with states of
//! first order z' = G q + H z + E q', where there are such, and the shapes that belong to them.
//!
//! The eigenvalues are those of the state matrix, balanced first (Parlett and Reinsch 1969), by its
//! real Schur form; shapes by inverse iteration on lambda^2 - lambda D - K (Golub and Van Loan,
//! *Matrix Computations*, 7.5 and 7.6). A rigid motion has the eigenvalue 0, mostly twice and
//! defective, which rounding turns into numbers as large as the root of the unit roundoff; how
//! often it is one is therefore counted by the ranks of K and of D on its null space, and, beside
//! states of first order, whose integrals make longer chains, by taking null spaces away one after
//! the other (Golub and Van Loan, 7.6.5).

use nalgebra::linalg::balancing::balance_parlett_reinsch;
use nalgebra::{Complex, DMatrix, DVector};

use crate::error::AnalysisError;
use crate::qr_iteration;

/// Below this, relative to the largest, a singular value is rounding.
const RANK: f64 = 1e-12;

/// Eigenvalues that differ by less, relative to their size, share a space of shapes.
const EQUAL: f64 = 1e-7;

/// How far beside its eigenvalue the matrix of the inverse iteration is taken, relative to its size:
/// there it is not singular, and one step gains as many digits.
const BESIDE: f64 = 1e-11;

/// A natural mode: the motion exp(lambda t) v, or its real part.
#[derive(Clone, Debug, PartialEq)]
pub struct NaturalMode {
    /// lambda, 1/s. Of a conjugate pair that with the positive imaginary part.
    pub eigenvalue: Complex<f64>,
    /// v: the coordinates' amplitudes in their SI units, the largest number of them 1, and those of
    /// states of first order; where no coordinate moves, the largest of these is 1.
    pub shape: Vec<Complex<f64>>,
}

impl NaturalMode {
    /// The undamped natural frequency abs(lambda)/(2 pi), Hz; 0 of a rigid motion.
    pub fn frequency(&self) -> f64 {
        self.eigenvalue.norm() / std::f64::consts::TAU
    }

    /// The damping ratio -Re(lambda)/abs(lambda): 1 of a motion that decays without swinging,
    /// negative of one that grows, 0 of a rigid motion.
    pub fn damping(&self) -> f64 {
        let size = self.eigenvalue.norm();
        if size > 0.0 {
            // Not -0 where nothing damps.
            0.0 - self.eigenvalue.re / size
        } else {
            0.0
        }
    }
}

/// The natural modes of d(q, q', z)/dt = A (q, q', z) with so many degrees of freedom, lowest
/// frequency first: `matrix` is A row by row, the rows of q being (0 1 0).
///
/// # Errors
///
/// A matrix that is not square with at least two rows for each degree of freedom, entries that are not finite, and
/// eigenvalues that cannot be computed.
pub fn natural_modes(matrix: &[f64], degrees: usize) -> Result<Vec<NaturalMode>, AnalysisError> {
    let states = matrix.len().isqrt().max(2 * degrees);
    if states * states != matrix.len() {
        let (expected, given) = (states * states, matrix.len());
        return Err(AnalysisError::Lengths { expected, given });
    }
    if let Some(sample) = matrix.iter().position(|entry| !entry.is_finite()) {
        return Err(AnalysisError::NotFinite { sample });
    }
    if states == 0 {
        return Ok(Vec::new());
    }
    let mut balanced = DMatrix::from_row_slice(states, states, matrix);
    let sizes = balance_parlett_reinsch(&mut balanced);
    let mut eigenvalues =
        qr_iteration::eigenvalues(&balanced).ok_or(AnalysisError::NotConverged)?;
    eigenvalues.sort_by(|a, b| a.norm().total_cmp(&b.norm()));
    let pencil = Pencil::of(&balanced, &sizes, degrees);
    let mut rigid = pencil.rigid();
    if states > 2 * degrees {
        rigid.multiplicity = zero_eigenvalues(balanced);
    }
    let mut modes: Vec<(Complex<f64>, DVector<Complex<f64>>)> = Vec::new();
    modes.extend(rigid.shapes.into_iter().map(|shape| (0.0.into(), shape)));
    for eigenvalue in eigenvalues.into_iter().skip(rigid.multiplicity) {
        if eigenvalue.im < 0.0 {
            continue;
        }
        let close = |other: &Complex<f64>| (eigenvalue - other).norm() < EQUAL * eigenvalue.norm();
        let earlier = modes.iter().filter(|(other, _)| close(other));
        let earlier: Vec<_> = earlier.map(|(_, shape)| shape.clone()).collect();
        modes.push((eigenvalue, pencil.shape(eigenvalue, &earlier)));
    }
    let scaled = modes.into_iter().map(|(eigenvalue, shape)| NaturalMode {
        eigenvalue,
        shape: pencil.in_si(&shape),
    });
    Ok(scaled.collect())
}

/// lambda^2 - lambda D - K in balanced coordinates, states of first order after them with
/// lambda in place of lambda^2.
struct Pencil {
    /// (K F; G H)
    stiffness: DMatrix<f64>,
    /// (D 0; E 0)
    damping: DMatrix<f64>,
    /// From the upper rows: q' in balanced numbers for each q; 1 for states of first order.
    ratio: DVector<f64>,
    /// What a balanced number is in SI.
    sizes: DVector<f64>,
    degrees: usize,
}

/// The motions with the eigenvalue 0.
struct Rigid {
    shapes: Vec<DVector<Complex<f64>>>,
    /// How often 0 is an eigenvalue.
    multiplicity: usize,
}

impl Pencil {
    fn of(balanced: &DMatrix<f64>, sizes: &DVector<f64>, degrees: usize) -> Self {
        let count = balanced.nrows() - degrees;
        // Positions and states of first order, by their places in the state.
        let held = |place: usize| {
            if place < degrees {
                place
            } else {
                place + degrees
            }
        };
        Self {
            stiffness: DMatrix::from_fn(count, count, |row, column| {
                balanced[(degrees + row, held(column))]
            }),
            damping: DMatrix::from_fn(count, count, |row, column| match column < degrees {
                true => balanced[(degrees + row, degrees + column)],
                false => 0.0,
            }),
            ratio: DVector::from_fn(count, |place, _| match place < degrees {
                true => balanced[(place, degrees + place)],
                false => 1.0,
            }),
            sizes: DVector::from_fn(count, |place, _| sizes[held(place)]),
            degrees,
        }
    }

    /// lambda (lambda/ratio) - (lambda/ratio) D - K: the rates are lambda/ratio of the coordinates.
    fn at(&self, eigenvalue: Complex<f64>) -> DMatrix<Complex<f64>> {
        let count = self.ratio.len();
        DMatrix::from_fn(count, count, |row, column| {
            let rate = eigenvalue / self.ratio[column];
            let inertia = match row == column {
                true if row < self.degrees => eigenvalue * rate,
                true => eigenvalue,
                false => 0.0.into(),
            };
            inertia - rate * self.damping[(row, column)] - self.stiffness[(row, column)]
        })
    }

    fn rigid(&self) -> Rigid {
        // Rows of one size: whether a soft spring is there does not depend on a stiff one.
        let mut equilibrated = self.stiffness.clone();
        for mut row in equilibrated.row_iter_mut() {
            let size = row.amax();
            if size > 0.0 {
                row /= size;
            }
        }
        let (right, left) = (
            null_space(&equilibrated),
            null_space(&equilibrated.transpose()),
        );
        let rows = self.stiffness.row_iter().map(|row| row.amax());
        let weights: Vec<f64> = rows
            .map(|size| if size > 0.0 { size } else { 1.0 })
            .collect();
        if right.ncols() == 0 {
            return Rigid {
                shapes: Vec::new(),
                multiplicity: 0,
            };
        }
        // Back from the equilibrated rows to those of the equations.
        let left = DMatrix::from_fn(left.nrows(), left.ncols(), |row, column| {
            left[(row, column)] / weights[row]
        });
        let rates = DMatrix::from_fn(right.nrows(), right.ncols(), |row, column| {
            right[(row, column)] / self.ratio[row]
        });
        let damped = left.transpose() * &self.damping * &rates;
        let most = left.abs().transpose() * self.damping.abs() * rates.abs();
        let singular = damped.clone().svd(false, false).singular_values;
        let most = most.amax();
        let again = singular
            .iter()
            .filter(|value| **value <= RANK * most)
            .count();
        let complex = |column: nalgebra::DVectorView<'_, f64>| column.map(Complex::from);
        Rigid {
            shapes: right.column_iter().map(complex).collect(),
            multiplicity: right.ncols() + again,
        }
    }

    /// The shape of an eigenvalue, orthogonal to those that it has already.
    fn shape(
        &self,
        eigenvalue: Complex<f64>,
        earlier: &[DVector<Complex<f64>>],
    ) -> DVector<Complex<f64>> {
        let count = self.ratio.len();
        let singular = self.at(eigenvalue * (1.0 + BESIDE)).lu();
        // Of no symmetry that a machine might have too.
        let mut shape = DVector::from_fn(count, |row, _| {
            Complex::new(1.0 + (1.7 * (row + earlier.len()) as f64).sin() / 2.0, 0.1)
        });
        for _ in 0..4 {
            for other in earlier {
                let part = other.dotc(&shape);
                shape.axpy(-part, other, Complex::from(1.0));
            }
            let Some(next) = singular.solve(&shape) else {
                break;
            };
            let size = next.norm();
            if !(size > 0.0 && size.is_finite()) {
                break;
            }
            shape = next.unscale(size);
        }
        shape
    }

    /// Coordinates in SI, the largest number 1, and states of first order.
    fn in_si(&self, shape: &DVector<Complex<f64>>) -> Vec<Complex<f64>> {
        let amplitudes: Vec<Complex<f64>> = shape
            .iter()
            .zip(&self.sizes)
            .map(|(value, size)| value * *size)
            .collect();
        let largest = |of: &[Complex<f64>]| {
            let most = of
                .iter()
                .copied()
                .max_by(|a, b| a.norm().total_cmp(&b.norm()));
            most.filter(|value| value.norm() > 0.0)
        };
        // What rounding moves does not count.
        let moves = shape.rows(0, self.degrees).norm() > RANK * shape.norm();
        let largest = largest(&amplitudes[..self.degrees])
            .filter(|_| moves)
            .or_else(|| largest(&amplitudes))
            .unwrap_or(1.0.into());
        amplitudes.iter().map(|value| value / largest).collect()
    }
}

/// How often 0 is an eigenvalue, chains of any length counted: null spaces are taken away until
/// there is none.
pub(crate) fn zero_eigenvalues(mut matrix: DMatrix<f64>) -> usize {
    let mut count = 0;
    loop {
        // Rows of one size, as in [`Pencil::rigid`]: the null space is the same.
        let mut equilibrated = matrix.clone();
        for mut row in equilibrated.row_iter_mut() {
            let size = row.amax();
            if size > 0.0 {
                row /= size;
            }
        }
        let null = null_space(&equilibrated);
        if null.ncols() == 0 {
            return count;
        }
        count += null.ncols();
        if null.ncols() == matrix.ncols() {
            return count;
        }
        // An orthonormal basis of what is left: the null space of the null space.
        let rest = null_space(&(&null * null.transpose()));
        matrix = rest.transpose() * matrix * rest;
    }
}

/// An orthonormal basis of what a matrix maps to 0, as columns.
pub(crate) fn null_space(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let decomposed = matrix.clone().svd(false, true);
    let Some(rows) = decomposed.v_t else {
        return DMatrix::zeros(matrix.ncols(), 0);
    };
    let most = decomposed.singular_values.amax();
    let small: Vec<_> = decomposed
        .singular_values
        .iter()
        .zip(rows.row_iter())
        .filter(|(value, _)| **value <= RANK * most)
        .map(|(_, row)| row.transpose())
        .collect();
    if small.is_empty() {
        return DMatrix::zeros(matrix.ncols(), 0);
    }
    DMatrix::from_columns(&small)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The state matrix of q'' = K q + D q'.
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
    fn a_damped_oscillator_has_its_closed_form() -> Result<(), AnalysisError> {
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
    fn two_masses_on_a_spring_move_rigidly_once() -> Result<(), AnalysisError> {
        // Masses 1 and 3, stiffness 1e6 beside a second pair a million times softer.
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
    fn a_free_mass_with_friction_moves_rigidly_and_decays() -> Result<(), AnalysisError> {
        let modes = natural_modes(&matrix(&[&[0.0]], &[&[-3.0]]), 1)?;
        let found: Vec<(f64, f64)> = modes
            .iter()
            .map(|m| (m.eigenvalue.re, m.damping()))
            .collect();
        assert_eq!(found, [(0.0, 0.0), (-3.0, 1.0)]);
        Ok(())
    }

    #[test]
    fn an_integral_of_a_free_position_makes_a_chain_of_three() -> Result<(), AnalysisError> {
        // q'' = -3 u with u' = -5 u + 2 q', and an integral of q: eigenvalues 0 twice, and those
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
        // u = -lambda^2 q/3, and an integral of 1/lambda.
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
    fn equal_frequencies_have_shapes_of_their_own() -> Result<(), AnalysisError> {
        let none: &[f64] = &[0.0, 0.0];
        let modes = natural_modes(&matrix(&[&[-9.0, 0.0], &[0.0, -9.0]], &[none, none]), 2)?;
        assert_eq!(modes.len(), 2);
        let (a, b) = (&modes[0].shape, &modes[1].shape);
        let area = a[0] * b[1] - a[1] * b[0];
        assert!(area.norm() > 0.5, "{modes:?}");
        Ok(())
    }

    #[test]
    fn what_is_no_state_matrix_is_refused() {
        assert!(natural_modes(&[1.0; 8], 1).is_err());
        assert!(natural_modes(&[1.0; 4], 2).is_err());
        assert!(natural_modes(&[f64::NAN; 4], 1).is_err());
        assert_eq!(natural_modes(&[], 0), Ok(Vec::new()));
    }
}
