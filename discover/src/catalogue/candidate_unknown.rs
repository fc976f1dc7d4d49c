//! A candidate's parameter as something to be estimated.

use crate::catalogue::candidate::{CandidateParameter, NEARLY_INFINITE};
use crate::interval::Interval;
use crate::model::unknowns::{Unknown, What};
use crate::thresholds;

/// A candidate's parameter with its bounds and the size tried, SI.
#[derive(Clone, Debug)]
pub struct CandidateUnknown {
    /// The unknown.
    pub unknown: Unknown,
    /// Its value where the effect is absent, SI.
    pub base: f64,
    /// Whether it shapes the effect without scaling it; its value is then kept.
    pub is_shape: bool,
}

impl CandidateUnknown {
    /// A candidate's parameter as an unknown.
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
