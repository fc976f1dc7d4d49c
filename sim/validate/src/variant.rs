//! What a certificate judges: equations of motion that someone else derived, seen only
//! through the numbers they give.

/// Equations of motion of one model at one order. States are coordinates, then rates, then states of
/// first order, in SI and in the order of the specification; parameters are fixed beforehand.
pub trait Variant {
    /// Names of the generalised coordinates in the order of the state.
    fn coordinate_names(&self) -> Vec<String>;

    /// The time derivative of the state into `rates`, of the state's length.
    ///
    /// # Errors
    /// What went wrong (a pivot that is not positive, a length that does not fit).
    fn rates(
        &mut self,
        time: f64,
        state: &[f64],
        inputs: &[f64],
        rates: &mut [f64],
    ) -> Result<(), String>;

    /// The n by n mass matrix, row by row, into `mass`.
    ///
    /// # Errors
    /// As [`Variant::rates`].
    fn mass_matrix(
        &mut self,
        time: f64,
        state: &[f64],
        inputs: &[f64],
        mass: &mut [f64],
    ) -> Result<(), String>;

    /// Velocity terms c and generalised forces f of M q'' + c = f, n numbers each.
    ///
    /// # Errors
    /// As [`Variant::rates`].
    fn bias_and_forces(
        &mut self,
        time: f64,
        state: &[f64],
        inputs: &[f64],
        bias: &mut [f64],
        forces: &mut [f64],
    ) -> Result<(), String>;

    /// T + V, in J.
    ///
    /// # Errors
    /// As [`Variant::rates`].
    fn energy(&mut self, time: f64, state: &[f64], inputs: &[f64]) -> Result<f64, String>;

    /// The power of all non-conservative forces, in W.
    ///
    /// # Errors
    /// As [`Variant::rates`].
    fn power(&mut self, time: f64, state: &[f64], inputs: &[f64]) -> Result<f64, String>;

    /// The switching functions: each changes sign where a piecewise function switches.
    ///
    /// # Errors
    /// As [`Variant::rates`].
    fn guards(&mut self, time: f64, state: &[f64], inputs: &[f64]) -> Result<Vec<f64>, String>;

    /// The observables of the specification in its order.
    ///
    /// # Errors
    /// As [`Variant::rates`].
    fn observables(&mut self, time: f64, state: &[f64], inputs: &[f64])
    -> Result<Vec<f64>, String>;
}
