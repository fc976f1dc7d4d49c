//! What the filters have in common.

use crate::motion::State;
use arm::Coefficients;

/// A filter: how it carries its covariance from measurement to measurement, and takes one in.
pub trait Filter {
    fn carried(&mut self, arm: &Coefficients, t: f64);
    fn taken(&mut self, arm: &Coefficients, t: f64, which: usize, value: f64, deviation: f64);
    fn estimate(&self) -> &State;
    fn variance(&self, i: usize) -> f64;
}
