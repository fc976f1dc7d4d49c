//! Discrete form of a linear system whose inputs are held between samples (zero-order hold).
//!
//! With A_d = exp(A h) and B_d = (integral of exp(A s) over 0..h) B, states at the samples follow x_(k+1) = A_d
//! x_k + B_d u_k. Both are blocks of one exponential, exp([[A, B], [0, 0]] h) = [[A_d, B_d], [0, 1]] (C. F. Van
//! Loan, IEEE Trans. Autom. Control 23 (1978) 395-404). States are balanced and inputs scaled first, so that
//! units do not limit the accuracy.

use nalgebra::{DMatrix, DVector};

use crate::allowed_motions::row_by_row;
use crate::balancing::BalancedMatrix;

/// Largest norm of A h in balanced states. For faster oscillations the angles would have few correct digits.
const MAX_NORM: f64 = 1e9;

/// Matrices of x_(k+1) = A_d x_k + B_d u_k, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct DiscreteSystem {
    /// Matrix A_d: next states by states.
    pub a: Vec<f64>,
    /// Matrix B_d: next states by held inputs.
    pub b: Vec<f64>,
}

/// Reason why a system cannot be discretised.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DiscretisationError {
    /// The period is not a finite positive number.
    #[error("expected a time in s above 0")]
    Period,
    /// The matrices have different sizes, or entries that are not finite.
    #[error("the sizes of the matrices do not match, or an entry is not finite")]
    Matrices,
    /// Motions that are too fast for the period.
    #[error(
        "the fastest rate of the model times the period exceeds 1e9, so the result would have no correct digit: use a \
         shorter period"
    )]
    TooLong,
    /// A motion overflows within a period.
    #[error("the motion overflows double precision within one period: use a shorter period")]
    Overflow,
}

/// Computes the discrete form of x' = A x + B u for inputs held over `period` (s). `a` and `b` are row by row.
///
/// # Errors An inadmissible period, matrices of different sizes, and motions that are too fast for the period.
pub fn hold_inputs(
    a: &[f64],
    b: &[f64],
    states: usize,
    period: f64,
) -> Result<DiscreteSystem, DiscretisationError> {
    if !(period.is_finite() && period > 0.0) {
        return Err(DiscretisationError::Period);
    }
    let is_finite = a.iter().chain(b).all(|entry| entry.is_finite());
    if states == 0 || a.len() != states * states || !b.len().is_multiple_of(states) || !is_finite {
        return Err(DiscretisationError::Matrices);
    }
    let inputs = b.len() / states;
    let balanced = BalancedMatrix::new(&DMatrix::from_row_slice(states, states, a));
    let rotation = &balanced.matrix * balanced.scaled_time(period);
    let is_moderate = rotation.iter().all(|entry| entry.abs() <= MAX_NORM);
    if !is_moderate {
        return Err(DiscretisationError::TooLong);
    }
    let b = DMatrix::from_row_slice(states, inputs, b);
    let scaled_b = DMatrix::from_fn(states, inputs, |row, column| {
        b[(row, column)] / balanced.sizes[row]
    });
    let largest = |column: usize| scaled_b.column(column).amax();
    let input_sizes = (0..inputs).map(|column| match largest(column) {
        size if size > 0.0 => size,
        _ => 1.0,
    });
    let input_sizes = DVector::from_iterator(inputs, input_sizes);
    let mut all = DMatrix::zeros(states + inputs, states + inputs);
    (all.view_mut((0, 0), (states, states))).copy_from(&rotation);
    for column in 0..inputs {
        let scaled = scaled_b.column(column) / input_sizes[column];
        all.view_mut((0, states + column), (states, 1))
            .copy_from(&scaled);
    }
    let all = all.exp();
    let of_state = DMatrix::from_fn(states, states, |row, column| {
        all[(row, column)] * (balanced.sizes[row] / balanced.sizes[column])
    });
    let of_input = DMatrix::from_fn(states, inputs, |row, column| {
        all[(row, states + column)] * balanced.sizes[row] * (input_sizes[column] * period)
    });
    let found = DiscreteSystem {
        a: row_by_row(&of_state),
        b: row_by_row(&of_input),
    };
    match found
        .a
        .iter()
        .chain(&found.b)
        .all(|entry| entry.is_finite())
    {
        true => Ok(found),
        false => Err(DiscretisationError::Overflow),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_close(found: &[f64], right: &[f64], within: f64) {
        assert_eq!(found.len(), right.len());
        for (found, right) in found.iter().zip(right) {
            let scale = right.abs().max(1e-300);
            assert!(
                (found - right).abs() <= within * scale,
                "{found:e}, {right:e}"
            );
        }
    }

    #[test]
    fn double_integrator_and_lag_match_closed_forms() {
        // x'' = u/m and F' = (u - F)/tau.
        let (m, tau, h) = (2.5, 0.03, 0.01);
        let a = [0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0 / tau];
        let b = [0.0, 0.0, 1.0 / m, 0.0, 0.0, 1.0 / tau];
        let found = hold_inputs(&a, &b, 3, h).expect("a discrete form");
        let lag = (-h / tau).exp();
        assert_close(
            &found.a,
            &[1.0, h, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, lag],
            1e-15,
        );
        let mass = [h * h / (2.0 * m), h / m];
        let right = [mass[0], 0.0, mass[1], 0.0, 0.0, -f64::exp_m1(-h / tau)];
        assert_close(&found.b, &right, 1e-14);
    }

    #[test]
    fn oscillators_of_any_stiffness_match_closed_forms() {
        for (stiffness, h) in [(1e-8, 1e3), (30.0, 0.2), (1e9, 1e-3), (1e20, 1e-9)] {
            // x'' = -w^2 x + 1e7 u.
            let w = f64::sqrt(stiffness);
            let found = hold_inputs(&[0.0, 1.0, -stiffness, 0.0], &[0.0, 1e7], 2, h);
            let found = found.expect("a discrete form");
            let (sine, cosine) = (w * h).sin_cos();
            assert_close(&found.a, &[cosine, sine / w, -w * sine, cosine], 1e-12);
            let half = (0.5 * w * h).sin();
            let right = [2e7 * half * half / stiffness, 1e7 * sine / w];
            assert_close(&found.b, &right, 1e-12);
        }
    }

    #[test]
    fn system_without_inputs_has_no_b() {
        let found = hold_inputs(&[-3.0], &[], 1, 0.5).expect("a discrete form");
        assert_close(&found.a, &[f64::exp(-1.5)], 1e-15);
        assert!(found.b.is_empty());
    }

    #[test]
    fn inadmissible_periods_and_matrices_are_rejected() {
        let of = |a: &[f64], b: &[f64], period| hold_inputs(a, b, 1, period).err();
        for period in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(
                of(&[1.0], &[1.0], period),
                Some(DiscretisationError::Period)
            );
        }
        let (short, undefined): (&[f64], &[f64]) = (&[], &[f64::NAN]);
        for a in [short, undefined] {
            assert_eq!(of(a, &[1.0], 1.0), Some(DiscretisationError::Matrices));
        }
        assert_eq!(of(&[1e12], &[1.0], 1.0), Some(DiscretisationError::TooLong));
        assert_eq!(
            of(&[800.0], &[1.0], 1.0),
            Some(DiscretisationError::Overflow)
        );
    }
}
