//! Errors of analyses, and shared checks.

use nalgebra::DMatrix;
use thiserror::Error;

/// Reason for a failed analysis. Samples are counted from 0.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum AnalysisError {
    /// Too few values.
    #[error("the series has {given} values; the analysis needs {needed}")]
    TooFew {
        /// Required number of values.
        needed: usize,
        /// Given number of values.
        given: usize,
    },
    /// A value is not finite, or its square overflows.
    #[error("value {sample} of the series is not finite")]
    NotFinite {
        /// Index of the value.
        sample: usize,
    },
    /// Related slices have different lengths.
    #[error("a series has {given} values instead of {expected}")]
    LengthMismatch {
        /// Length of the first slice.
        expected: usize,
        /// Length of the other slice.
        given: usize,
    },
    /// A length, a step or a scale is not positive.
    #[error("{quantity} must be positive and finite")]
    NotPositive {
        /// Name of the quantity.
        quantity: &'static str,
    },
    /// The eigenvalue iteration did not converge.
    #[error(
        "the eigenvalues were not found: the entries of the state matrix span {decades} powers of ten; check for a \
         stiffness or a mass in a wrong unit"
    )]
    NotConverged {
        /// Decades between the smallest and the largest entry of the matrix.
        decades: u32,
    },
    /// A connected part of a machine has too many states for its modes.
    #[error(
        "a connected part of the machine has {states} states, more than the limit of {limit} for modes: the \
         computation time grows with the cube of this number; divide the machine, or lower the orders of its fields \
         (--order)"
    )]
    TooManyStates {
        /// Number of states of the part.
        states: usize,
        /// Largest permitted number.
        limit: usize,
    },
    /// Natural frequencies do not ascend.
    #[error(
        "natural frequency {index} is not greater than the previous one; give the frequencies in ascending order"
    )]
    NotAscending {
        /// Index of a frequency that is not above the previous one.
        index: usize,
    },
}

impl AnalysisError {
    pub(crate) fn not_converged(matrix: &DMatrix<f64>) -> Self {
        let sizes = matrix.iter().filter(|entry| **entry != 0.0);
        let (least, most) = sizes
            .map(|entry| entry.abs().log10())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), size| {
                (least.min(size), most.max(size))
            });
        Self::NotConverged {
            decades: (most - least).max(0.0) as u32,
        }
    }
}

/// Rejects fewer than `needed` values, and values whose squares overflow.
pub(super) fn check_values(values: &[f64], needed: usize) -> Result<(), AnalysisError> {
    if values.len() < needed {
        return Err(AnalysisError::TooFew {
            needed,
            given: values.len(),
        });
    }
    let is_ordinary = |value: &f64| value.abs() < 1e100;
    match values.iter().position(|value| !is_ordinary(value)) {
        Some(sample) => Err(AnalysisError::NotFinite { sample }),
        None => Ok(()),
    }
}

/// Rejects numbers that are not positive or would overflow.
pub(super) fn check_positive(value: f64, what: &'static str) -> Result<(), AnalysisError> {
    if (1e-100..1e100).contains(&value) {
        Ok(())
    } else {
        Err(AnalysisError::NotPositive { quantity: what })
    }
}

/// Computes the arithmetic mean; NaN without values.
pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}
