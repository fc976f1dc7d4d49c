//! A state at a time.

/// A state with its time and inputs.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// Time, in s.
    pub time: f64,
    /// Coordinates, their rates, states of first order.
    pub state: Vec<f64>,
    /// Inputs in the order of the model.
    pub inputs: Vec<f64>,
}
