//! Parameters of candidates as unknowns of an estimation.

use crate::catalogue::candidate::{CandidateParameter, NEARLY_INFINITE};
use crate::interval::Interval;
use crate::model::unknowns::{Unknown, What};
use crate::thresholds;

/// Parameter of a candidate with bounds and trial size, SI.
#[derive(Clone, Debug)]
pub struct CandidateUnknown {
    /// The unknown.
    pub unknown: Unknown,
    /// Value without the effect, SI.
    pub base: f64,
    /// Whether the parameter shapes the effect without scaling it. Its value is then fixed.
    pub is_shape: bool,
}

impl CandidateUnknown {
    /// Converts a parameter of a candidate to an unknown.
    pub fn of(parameter: &CandidateParameter) -> Self {
        let low = match (parameter.inverse, parameter.positive) {
            (true, _) => 1.0 / (NEARLY_INFINITE * parameter.typical_size),
            (false, true) => 0.0,
            (false, false) => f64::NEG_INFINITY,
        };
        let name = parameter.name.clone();
        let base = parameter.base();
        let bounds = match (parameter.shape, &parameter.offset) {
            (Some(shape), _) => thresholds::SHAPE_RANGE.times(shape),
            (None, Some(offset)) => offset.bounds,
            (None, None) => Interval::new(low, f64::INFINITY),
        };
        let unknown = Unknown {
            label: format!("`{name}`"),
            what: if parameter.inverse {
                What::Inverse(name)
            } else {
                What::Parameter(name)
            },
            start: parameter.shape.unwrap_or(base.max(low)),
            prior: None,
            bounds,
            limits: bounds,
            scale: match (parameter.shape, parameter.inverse) {
                (Some(shape), _) => shape,
                (None, true) => 1e-4 / parameter.typical_size,
                (None, false) if base == 0.0 => parameter.typical_size,
                (None, false) => base.abs(),
            },
        };
        Self {
            unknown,
            base,
            is_shape: parameter.shape.is_some(),
        }
    }
}
