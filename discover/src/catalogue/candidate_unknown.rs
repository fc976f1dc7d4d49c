//! Parameters of candidates as unknowns of a fit.

use crate::catalogue::candidate::{CandidateParameter, NEARLY_INFINITE_FACTOR};
use crate::interval::Interval;
use crate::model::unknowns::{Unknown, UnknownKind};
use crate::thresholds;

/// Parameter of a candidate with bounds and trial size, SI.
#[derive(Clone, Debug)]
pub struct CandidateUnknown {
    /// Unknown of the fit.
    pub unknown: Unknown,
    /// Value without the effect, SI.
    pub base: f64,
    /// True for a shape parameter, which does not scale the effect and is fixed.
    pub is_shape: bool,
}

impl CandidateUnknown {
    /// Converts a parameter of a candidate to an unknown.
    pub fn from_parameter(parameter: &CandidateParameter) -> Self {
        let low = match (parameter.is_inverse, parameter.is_positive) {
            (true, _) => 1.0 / (NEARLY_INFINITE_FACTOR * parameter.typical_size),
            (false, true) => 0.0,
            (false, false) => f64::NEG_INFINITY,
        };
        let name = parameter.name.clone();
        let base = parameter.base_value();
        let bounds = match (parameter.shape_size, &parameter.offset) {
            (Some(shape), _) => thresholds::SHAPE_SEARCH_RANGE.scale(shape),
            (None, Some(offset)) => offset.bounds,
            (None, None) => Interval::new(low, f64::INFINITY),
        };
        let unknown = Unknown {
            label: format!("`{name}`"),
            kind: if parameter.is_inverse {
                UnknownKind::InverseParameter(name)
            } else {
                UnknownKind::Parameter(name)
            },
            start: parameter.shape_size.unwrap_or(base.max(low)),
            prior: None,
            bounds,
            bounds_without_prior: bounds,
            scale: match (parameter.shape_size, parameter.is_inverse) {
                (Some(shape), _) => shape,
                (None, true) => 1e-4 / parameter.typical_size,
                (None, false) if base == 0.0 => parameter.typical_size,
                (None, false) => base.abs(),
            },
        };
        Self {
            unknown,
            base,
            is_shape: parameter.shape_size.is_some(),
        }
    }
}
