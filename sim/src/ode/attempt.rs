//! One step of the Adams method with a given length and order: prediction, evaluation, correction, and the
//! error estimates of this order and of lower orders. `adams` selects the next step by these errors.

use super::history::{History, Weights};
use super::magnitudes::Magnitudes;
use super::stepper::Point;
use super::system::System;
use super::watch::WatchedSystem;

/// Adams step of one length, before the evaluation of the rates at its corrected end.
pub struct Attempt {
    /// Coefficients of the step.
    pub weights: Weights,
    /// Order of the predictor; the order of the corrector is higher by one.
    pub order: usize,
    /// Difference between the rates at the predicted state and their prediction.
    pub difference: Vec<f64>,
    /// End of the step.
    pub end: Point,
}

/// Estimated errors of a step relative to the allowed error, for several orders of the predictor.
#[derive(Clone, Copy)]
pub struct Errors {
    /// Error of the order used.
    pub same_order: f64,
    /// Error of the next lower order; infinite if there is none.
    pub lower_order: f64,
    /// True if a lower order would be as accurate.
    pub is_lower_enough: bool,
}

impl Attempt {
    /// Makes a step of `length` s from `start`, where `history` ends.
    pub fn new<S: System + ?Sized>(
        watched: &WatchedSystem<'_, S>,
        start: &Point,
        history: &History,
        order: usize,
        length: f64,
    ) -> Self {
        let weights = history.weights(length);
        let mut y = start.y.clone();
        history.predict(&weights, order, &mut y);
        let t = start.t + length;
        let mut surprise = vec![0.0; y.len()];
        watched.rates(t, &y, &mut surprise);
        history.write_prediction_difference(&weights, order, &mut surprise);
        let factor = length * weights.g(order);
        for (y, surprise) in y.iter_mut().zip(&surprise) {
            *y += factor * surprise;
        }
        Self {
            weights,
            order,
            difference: surprise,
            end: Point { t, y },
        }
    }

    /// Returns the estimated errors of predictors of this order and of lower orders.
    pub fn estimate_errors(&self, history: &History, magnitudes: &Magnitudes) -> Errors {
        let same = self.error_norm(self.order, self.difference.iter().copied(), magnitudes);
        let mut difference = self.difference.clone();
        let mut at_order = |order: usize| {
            let continued = history.extrapolate_difference(&self.weights, order);
            for (entry, continued) in difference.iter_mut().zip(continued) {
                *entry += continued;
            }
            self.error_norm(order, difference.iter().copied(), magnitudes)
        };
        let (lower, is_lower_enough) = match self.order {
            0 | 1 => (f64::INFINITY, false),
            2 => {
                let lower = at_order(1);
                (lower, lower <= 0.5 * same)
            }
            order => {
                let lower = at_order(order - 1);
                (lower, lower.max(at_order(order - 2)) <= same)
            }
        };
        Errors {
            same_order: same,
            lower_order: lower,
            is_lower_enough,
        }
    }

    /// Returns the estimated error of the method of this order, from the difference of this order.
    pub fn error_norm(
        &self,
        order: usize,
        differences: impl Iterator<Item = f64>,
        magnitudes: &Magnitudes,
    ) -> f64 {
        let errors = differences.map(|entry| self.weights.error(order) * entry);
        magnitudes.norm(errors, &self.end.y)
    }
}
