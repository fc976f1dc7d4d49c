//! Units, initial values and ranges of states and inputs, which emitted files offer as data.

/// Units, initial values and ranges in SI, at the parameter values of the specification.
#[derive(Clone, Debug, Default)]
pub struct Domain {
    /// Unit of each state.
    pub state_units: Vec<String>,
    /// Initial state.
    pub initial_state: Vec<f64>,
    /// Both ends of the range of each state, infinite if the specification gives none.
    pub state_ranges: Vec<[f64; 2]>,
    /// Both ends of the range of each input, infinite if the specification gives none.
    pub input_ranges: Vec<[f64; 2]>,
}
