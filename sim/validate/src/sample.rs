//! State with time and inputs, as a point of comparison.

/// State with time and inputs.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// Time, in s.
    pub time: f64,
    /// Coordinates, their rates, first-order states.
    pub state: Vec<f64>,
    /// Inputs in the order of the model.
    pub inputs: Vec<f64>,
}
