//! Why a series could not be analysed, and the checks that several analyses share.

use std::fmt;

use nalgebra::DMatrix;

/// Why a series could not be analysed. Samples are counted from 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum AnalysisError {
    /// There are too few values.
    TooFew {
        /// How many are needed.
        needed: usize,
        /// How many there are.
        given: usize,
    },
    /// A value is not finite, or so large that its square is not.
    NotFinite {
        /// Which value.
        sample: usize,
    },
    /// Slices that belong together have different lengths.
    Lengths {
        /// The length of the first.
        expected: usize,
        /// The length of the other.
        given: usize,
    },
    /// A length, a step or a scale that must be positive is not.
    NotPositive {
        /// What it is.
        what: &'static str,
    },
    /// Eigenvalues were not found within the steps allowed.
    NotConverged {
        /// How many powers of ten lie between the smallest and the largest entry of the matrix.
        decades: u32,
    },
    /// Natural frequencies do not ascend.
    NotAscending {
        /// Which frequency is not above the one before.
        index: usize,
    },
}

impl AnalysisError {
    /// The failure of an eigenvalue iteration on this matrix.
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

impl fmt::Display for AnalysisError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooFew { needed, given } => {
                write!(
                    f,
                    "the series has {given} values; the analysis needs {needed}"
                )
            }
            Self::NotFinite { sample } => write!(f, "value {sample} of the series is not finite"),
            Self::Lengths { expected, given } => {
                write!(f, "a series has {given} values where {expected} belong")
            }
            Self::NotPositive { what } => write!(f, "{what} must be positive and finite"),
            Self::NotConverged { decades } => write!(
                f,
                "the eigenvalues were not found: the entries of the state matrix span {decades} powers of ten; \
                 look for a stiffness or a mass in a wrong unit"
            ),
            Self::NotAscending { index } => write!(
                f,
                "natural frequency {index} is not above the one before it"
            ),
        }
    }
}

impl std::error::Error for AnalysisError {}

/// Refuses fewer than `needed` values and values whose squares overflow.
pub(super) fn check(values: &[f64], needed: usize) -> Result<(), AnalysisError> {
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

/// Refuses what is not a positive number of ordinary size.
pub(super) fn check_positive(value: f64, what: &'static str) -> Result<(), AnalysisError> {
    if (1e-100..1e100).contains(&value) {
        Ok(())
    } else {
        Err(AnalysisError::NotPositive { what })
    }
}

/// The arithmetic mean; not a number for no values.
pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}
