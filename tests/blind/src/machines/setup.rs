//! Specification and measurement of a machine.

/// Specification of a machine.
#[derive(Clone, Debug, PartialEq)]
pub enum Specification {
    /// Name of a file in `model-spec/models`.
    Shipped(&'static str),
    /// Text of a specification.
    Text(String),
}

/// Measured channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Channel {
    /// Name in the model and in the record.
    pub name: &'static str,
    /// Unit of the record.
    pub unit: &'static str,
    /// Unit of the record in the SI unit.
    pub scale: f64,
    /// Standard deviation of the total error due to white noise and rounding, SI.
    pub noise: f64,
    /// Resolution of the encoder, SI.
    pub step: f64,
}

/// Measurement and declared uncertainties of a machine.
#[derive(Clone, Debug, PartialEq)]
pub struct Setup {
    /// Specification.
    pub specification: Specification,
    /// Truncation order of the model, if it has fields.
    pub order: Option<usize>,
    /// Channels, in the order of the machine's outputs.
    pub channels: Vec<Channel>,
    /// Name and unit of the input, if there is one.
    pub input: Option<(&'static str, &'static str)>,
    /// Sample interval, s.
    pub sample: f64,
    /// Number of integration steps per sample interval.
    pub steps: usize,
    /// Length of a record, s.
    pub duration: f64,
    /// Window length, s; `None` for the whole record.
    pub window: Option<f64>,
    /// Uncertain parameters, with the relative standard deviations of their priors.
    pub uncertain: Vec<(&'static str, f64)>,
    /// Numbers of training and test records.
    pub records: (usize, usize),
}
