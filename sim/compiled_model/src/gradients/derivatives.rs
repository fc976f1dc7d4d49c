/// Derivatives of a number with respect to state, program inputs and independent parameters.
#[derive(Clone, Debug)]
pub(super) struct Derivatives {
    pub state: Vec<f64>,
    pub inputs: Vec<f64>,
    pub parameters: Vec<f64>,
}

impl Derivatives {
    pub fn zeros(states: usize, inputs: usize, parameters: usize) -> Self {
        Self {
            state: vec![0.0; states],
            inputs: vec![0.0; inputs],
            parameters: vec![0.0; parameters],
        }
    }
}
