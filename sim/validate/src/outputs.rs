//! What was asked for beside the rates, seen only through the numbers it gives.

use super::sampler::Sample;
use nalgebra::DMatrix;

/// The names of the Jacobians: of the rates and of the observables, by state, inputs and
/// independent parameters.
pub const JACOBIANS: [&str; 6] = [
    "rates_by_state",
    "rates_by_inputs",
    "rates_by_parameters",
    "observables_by_state",
    "observables_by_inputs",
    "observables_by_parameters",
];

/// The output functions of one variant. None (`None`) of those that were not asked for.
/// Observables are those of the specification with `energy` and `power` last.
pub trait Outputs {
    /// What was asked for, by the names of `--with`.
    fn names(&self) -> Vec<String>;

    /// Names of the independent parameters, in the order of columns by parameters.
    fn parameter_names(&self) -> Vec<String>;

    /// c - f of M q'' + c = f.
    fn bias_forces(&mut self, at: &Sample) -> Option<Vec<f64>>;

    /// M a + c - f for the accelerations a.
    fn inverse_dynamics(&mut self, at: &Sample, accelerations: &[f64]) -> Option<Vec<f64>>;

    /// The rates of the switching functions along the motion, the inputs held.
    fn guard_rates(&mut self, at: &Sample) -> Option<Vec<f64>>;

    /// The Jacobian of this name among [`JACOBIANS`].
    fn jacobian(&mut self, name: &str, at: &Sample) -> Option<DMatrix<f64>>;

    /// The product of the rates' Jacobian with a direction of the state and one of the inputs.
    fn jacobian_vector_product(
        &mut self,
        at: &Sample,
        state: &[f64],
        inputs: &[f64],
    ) -> Option<Vec<f64>>;

    /// The products of weights with the rates' Jacobian by state and by inputs.
    fn vector_jacobian_product(
        &mut self,
        at: &Sample,
        weights: &[f64],
    ) -> Option<(Vec<f64>, Vec<f64>)>;

    /// The product of weights with the rates' Jacobian by parameters.
    fn vector_jacobian_product_by_parameters(
        &mut self,
        at: &Sample,
        weights: &[f64],
    ) -> Option<Vec<f64>>;
}
