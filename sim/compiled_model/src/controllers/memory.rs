//! Memory of controllers, with which another motion continues.

/// Next sample of a controller, at `offset` + `number` `period`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NextSample {
    /// Time between two samples, s.
    pub period: f64,
    /// Time of the first sample, s.
    pub offset: f64,
    /// Number of the sample, a whole number.
    pub number: f64,
}

/// Outputs of a sample that will act.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PendingOutputs {
    /// Time of the action, s.
    pub time: f64,
    /// Index of the controller.
    pub controller: usize,
    /// Values of its inputs.
    pub values: Vec<f64>,
}

/// Memory of the controllers of a motion at the time reached. The values of the inputs are not part of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ControlMemory {
    /// States of all controllers, SI.
    pub states: Vec<f64>,
    /// Next sample of each controller.
    pub samples: Vec<NextSample>,
    /// For each input, true if an output acts on it by now.
    pub has_acted: Vec<bool>,
    /// Outputs that will act, in the order of their samples.
    pub pending: Vec<PendingOutputs>,
}

eomgen_codegen::encode_structures! {
    NextSample { period, offset, number }
    PendingOutputs { time, controller, values }
    ControlMemory { states, samples, has_acted, pending }
}
