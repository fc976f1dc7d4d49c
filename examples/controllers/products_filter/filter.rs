//! Interface of the filters.

use crate::motion::State;
use arm::Coefficients;

/// Kalman filter: propagation of the covariance and measurement update.
pub trait Filter {
    fn propagate(&mut self, arm: &Coefficients, t: f64);
    fn update(&mut self, arm: &Coefficients, t: f64, which: usize, value: f64, deviation: f64);
    fn estimate(&self) -> &State;
    fn variance(&self, i: usize) -> f64;
}
