//! Interface to the equations of motion under test.

/// Equations of motion of one model at one order, with fixed parameters.
///
/// The state contains coordinates, then rates, then first-order states, in SI and in the order of
/// the specification. With n coordinates, the equations are M q'' + c = f.
///
/// # Errors
/// Methods return a message if they cannot be evaluated, for example if a pivot is not positive.
pub trait Variant {
    /// Returns the names of the generalised coordinates in the order of the state.
    fn coordinate_names(&self) -> Vec<String>;

    /// Writes the time derivative of the state to `rates`, which has the length of the state.
    fn rates(
        &mut self,
        time: f64,
        state: &[f64],
        inputs: &[f64],
        rates: &mut [f64],
    ) -> Result<(), String>;

    /// Writes the n by n mass matrix to `mass`, row by row.
    fn mass_matrix(
        &mut self,
        time: f64,
        state: &[f64],
        inputs: &[f64],
        mass: &mut [f64],
    ) -> Result<(), String>;

    /// Writes the velocity terms c and the generalised forces f, n numbers each.
    fn bias_and_forces(
        &mut self,
        time: f64,
        state: &[f64],
        inputs: &[f64],
        bias: &mut [f64],
        forces: &mut [f64],
    ) -> Result<(), String>;

    /// Returns the energy T + V, in J.
    fn energy(&mut self, time: f64, state: &[f64], inputs: &[f64]) -> Result<f64, String>;

    /// Returns the power of all non-conservative forces, in W.
    fn power(&mut self, time: f64, state: &[f64], inputs: &[f64]) -> Result<f64, String>;

    /// Returns the switching function of a surface at which the energies, and therefore the rates, jump; `None` if
    /// there is no such surface.
    fn corner(&self) -> Option<String> {
        None
    }

    /// Returns the guards. A guard changes sign at the switching surface of a piecewise function.
    fn guards(&mut self, time: f64, state: &[f64], inputs: &[f64]) -> Result<Vec<f64>, String>;

    /// Returns the observables in the order of the specification.
    fn observables(&mut self, time: f64, state: &[f64], inputs: &[f64])
    -> Result<Vec<f64>, String>;
}
