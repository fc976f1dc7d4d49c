//! Memory of controllers, to continue a motion.

/// Next sample of a controller, at the time `offset` + `number` `period`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NextSample {
    /// Time between two samples, s.
    pub period: f64,
    /// Time of the first sample, s.
    pub offset: f64,
    /// Number of the sample, a whole number.
    pub number: f64,
}

/// Outputs of a sample that have not acted yet.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PendingOutputs {
    /// Time of the action, s.
    pub time: f64,
    /// Index of the controller.
    pub controller: usize,
    /// Values of the driven inputs.
    pub values: Vec<f64>,
}

/// Memory of the controllers at the current time. The input values are not part of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ControlMemory {
    /// States of all controllers, SI.
    pub states: Vec<f64>,
    /// Next sample of each controller.
    pub samples: Vec<NextSample>,
    /// For each input, true if a controller output has acted on it.
    pub has_acted: Vec<bool>,
    /// Outputs that have not acted yet, in the order of their samples.
    pub pending: Vec<PendingOutputs>,
}

eomgen_codegen::encode_structures! {
    NextSample { period, offset, number }
    PendingOutputs { time, controller, values }
    ControlMemory { states, samples, has_acted, pending }
}
