//! Declaration and measurement of a machine.

/// Specification of a machine.
#[derive(Clone, Debug, PartialEq)]
pub enum Specification {
    /// File of `model-spec/models`.
    Shipped(&'static str),
    /// Text.
    Text(String),
}

/// Measured channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Channel {
    /// Name in the model and in the record.
    pub name: &'static str,
    /// Unit of the record.
    pub unit: &'static str,
    /// Unit of the record in SI.
    pub scale: f64,
    /// Standard deviation, SI, of white noise and rounding together.
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
    /// Time between samples, s.
    pub sample: f64,
    /// Number of integration steps per sample.
    pub steps: usize,
    /// Length of a record, s.
    pub duration: f64,
    /// Window length, s; `None` for the whole record.
    pub window: Option<f64>,
    /// Uncertain parameters and the relative standard deviations of their priors.
    pub uncertain: Vec<(&'static str, f64)>,
    /// Numbers of training and test records.
    pub records: (usize, usize),
}
