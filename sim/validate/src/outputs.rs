//! Interface to the requested outputs under test.

use super::sampler::Sample;
use eomgen_codegen::program::Output;
use nalgebra::DMatrix;

/// Jacobians of the rates and of the observables, by state, inputs and independent parameters.
pub const JACOBIANS: [&str; 6] = [
    "rates_by_state",
    "rates_by_inputs",
    "rates_by_parameters",
    "observables_by_state",
    "observables_by_inputs",
    "observables_by_parameters",
];

/// Returns the names of the Jacobians among the requested outputs `names`.
pub fn requested_jacobians(names: &[String]) -> Vec<&'static str> {
    let outputs: Vec<Output> = names.iter().filter_map(|name| name.parse().ok()).collect();
    let is_requested = |jacobian: &&str| {
        let (_, by) = jacobian.rsplit_once('_').unwrap_or_default();
        outputs
            .iter()
            .any(|output| output.includes_jacobians_by(by))
    };
    JACOBIANS.into_iter().filter(is_requested).collect()
}

/// Output functions of one variant. A function returns `None` if its output was not requested. `energy` and `power` are
/// the last observables.
pub trait Outputs {
    /// Returns the names of the requested outputs, as in `--with`.
    fn names(&self) -> Vec<String>;

    /// Returns the names of the independent parameters, in the order of the columns by parameters.
    fn parameter_names(&self) -> Vec<String>;

    /// Returns the bias forces c - f of M q'' + c = f.
    fn bias_forces(&mut self, at: &Sample) -> Option<Vec<f64>>;

    /// Returns M a + c - f for the accelerations a.
    fn inverse_dynamics(&mut self, at: &Sample, accelerations: &[f64]) -> Option<Vec<f64>>;

    /// Returns the time derivatives of the guards along the motion with constant inputs.
    fn guard_rates(&mut self, at: &Sample) -> Option<Vec<f64>>;

    /// Returns the Jacobian with this name, one of [`JACOBIANS`].
    fn jacobian(&mut self, name: &str, at: &Sample) -> Option<DMatrix<f64>>;

    /// Returns the product of the rates' Jacobian with a direction of the state and of the inputs.
    fn jacobian_vector_product(
        &mut self,
        at: &Sample,
        state: &[f64],
        inputs: &[f64],
    ) -> Option<Vec<f64>>;

    /// Returns the products of weights with the rates' Jacobians by state and by inputs.
    fn vector_jacobian_product(
        &mut self,
        at: &Sample,
        weights: &[f64],
    ) -> Option<(Vec<f64>, Vec<f64>)>;

    /// Returns the product of weights with the rates' Jacobian by parameters.
    fn vector_jacobian_product_by_parameters(
        &mut self,
        at: &Sample,
        weights: &[f64],
    ) -> Option<Vec<f64>>;
}
