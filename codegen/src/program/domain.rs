//! Units, initial values and ranges of states and inputs, which emitted files contain as data.

/// Units, initial values and ranges in SI units, for the parameter values of the specification.
#[derive(Clone, Debug, Default)]
pub struct Domain {
    /// Unit of each state.
    pub state_units: Vec<String>,
    /// Initial state.
    pub initial_state: Vec<f64>,
    /// Bounds of the range of each state; infinite if the specification declares no range.
    pub state_ranges: Vec<[f64; 2]>,
    /// Bounds of the range of each input; infinite if the specification declares no range.
    pub input_ranges: Vec<[f64; 2]>,
}
