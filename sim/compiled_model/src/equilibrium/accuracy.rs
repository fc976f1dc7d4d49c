//! Accuracy of an equilibrium: rounding errors of the accelerations, and the resulting errors of the unknowns.
//!
//! Notation: r are the accelerations at the equilibrium, and J are their derivatives with respect to the unknowns. J_k
//! is J without directions whose slopes are rounding, and J_k^+ is its pseudoinverse. No change of the unknowns removes
//! the part r - J_k J_k^+ r, so it must be rounding. A direction whose slope is lost beside stiffer ones is no free
//! motion if a force acts along it. The errors of the unknowns are |J_k^+ r| and |J_k^+| times the rounding errors of
//! r.

use eomgen_codegen::program::evaluator::Point;
use eomgen_codegen::rounding::bound_rates;
use eomgen_model_spec::interval::Interval;
use eomgen_sim::ode::ROUNDING_FACTOR;
use nalgebra::{DMatrix, DVector};

use crate::instance::Instance;

use super::linear::{KeptDirections, LinearisedEquations, ScaledSystem};

/// Largest error of an unknown, relative to its value or its size. It gives the six digits of a table.
const MAX_ERROR_FRACTION: f64 = 1e-6;

/// An acceleration that no change of the unknowns removes is nonzero beyond this multiple of its rounding error.
const BALANCE_FACTOR: f64 = 2.0;

/// Reason why a point is not an equilibrium to six digits of its unknowns.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Inaccuracy {
    /// An acceleration remains; its row.
    Unbalanced(usize),
    /// An unknown has a large error; its index and the error.
    Uncertain(usize, f64),
    /// The terms with a parameter are lost in the rounding of other terms; its name.
    Hidden(String),
}

/// Linearised equations at a point, and the directions in which a change of the unknowns removes accelerations.
pub(super) struct Accuracy<'e> {
    equations: &'e LinearisedEquations,
    system: &'e ScaledSystem,
    kept: KeptDirections,
    residuals: DVector<f64>,
}

impl<'e> Accuracy<'e> {
    /// Prepares the directions. Singular values below `least` times the largest count as 0.
    pub fn new(equations: &'e LinearisedEquations, system: &'e ScaledSystem, least: f64) -> Self {
        Self {
            equations,
            system,
            kept: system.find_kept_directions(least),
            residuals: &system.rows * &equations.accelerations,
        }
    }

    /// Returns true if a change of the unknowns changes no acceleration.
    pub fn has_free_motion(&self) -> bool {
        self.kept.left.ncols() < self.system.matrix.ncols()
    }

    /// Returns an acceleration that no change of the unknowns removes and that exceeds its rounding error.
    pub fn find_unbalanced(&self, roundings: &DVector<f64>) -> Option<Inaccuracy> {
        let rows = self.system.rows.abs();
        let count = self.residuals.len();
        let left = &self.kept.left;
        if left.ncols() == count {
            return None;
        }
        let projection = DMatrix::identity(count, count) - left * left.transpose();
        let remaining = (&projection * &self.residuals).abs();
        let rounding = ROUNDING_FACTOR * f64::EPSILON * self.residuals.amax();
        let allowed = projection.abs() * (&rows * roundings);
        let floor = rows * &self.equations.largest * f64::EPSILON;
        let limit = |row: usize| BALANCE_FACTOR * (allowed[row] + rounding) + floor[row];
        let exceeds = |row: &usize| remaining[*row].is_nan() || remaining[*row] > limit(*row);
        let row = (0..count).find(exceeds)?;
        let row = self.system.find_main_acceleration(row, self.equations);
        Some(Inaccuracy::Unbalanced(row))
    }

    /// Returns the unknown with the largest error if the error is too large. `roundings` are rounding errors of the
    /// accelerations, and `magnitudes` those of the unknowns, 0 if unknown.
    pub fn find_uncertain(
        &self,
        roundings: &DVector<f64>,
        magnitudes: &DVector<f64>,
    ) -> Option<Inaccuracy> {
        let inverse = &self.system.changes * &self.kept.inverse;
        let corrections = (&inverse * &self.residuals).abs();
        let errors = corrections + inverse.abs() * (self.system.rows.abs() * roundings);
        let relative = |place: usize| {
            let size = match magnitudes[place] {
                0.0 => self.system.changes.row(place).amax(),
                size => size,
            };
            if errors[place] == 0.0 {
                0.0
            } else {
                errors[place] / size
            }
        };
        let worst = (0..errors.len()).max_by(|a, b| relative(*a).total_cmp(&relative(*b)))?;
        let is_accurate = relative(worst) <= MAX_ERROR_FRACTION;
        (!is_accurate).then(|| Inaccuracy::Uncertain(worst, errors[worst]))
    }
}

impl Instance<'_> {
    /// Returns bounds on the rounding errors of the accelerations and of the rates of first-order states at a point;
    /// `None` if one has no bound.
    pub(super) fn bound_rate_roundings(&self, point: Point<'_>) -> Option<Vec<f64>> {
        let numbers = std::iter::once(&point.t).chain(point.state);
        let numbers = numbers.chain(point.inputs).chain(self.parameters());
        let ranges: Vec<Option<Interval>> = numbers
            .map(|&number| {
                Some(Interval {
                    low: number,
                    high: number,
                })
            })
            .collect();
        bound_rates(self.model().program(), &ranges).ok()
    }
}
