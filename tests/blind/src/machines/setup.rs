//! How a machine is declared and measured.

/// What declares a machine.
#[derive(Clone, Debug, PartialEq)]
pub enum Specification {
    /// A file of `model-spec/models`.
    Shipped(&'static str),
    /// Its text.
    Text(String),
}

/// A measured channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Channel {
    /// Its name in the model and in the record.
    pub name: &'static str,
    /// The unit of the record.
    pub unit: &'static str,
    /// The record's unit in SI.
    pub scale: f64,
    /// One standard deviation, SI: white noise and rounding together.
    pub noise: f64,
    /// The encoder's step, SI.
    pub step: f64,
}

/// How a machine is measured and what of it is declared uncertain.
#[derive(Clone, Debug, PartialEq)]
pub struct Setup {
    /// What declares it.
    pub specification: Specification,
    /// The truncation order of the model, where it has one.
    pub order: Option<usize>,
    /// Channels, in the order of the machine's outputs.
    pub channels: Vec<Channel>,
    /// The input's name, and unit, if there is one.
    pub input: Option<(&'static str, &'static str)>,
    /// Time between samples, s.
    pub sample: f64,
    /// Steps of the integration in each of them.
    pub steps: usize,
    /// Length of a record, s.
    pub duration: f64,
    /// Length of a window, s; none for the whole record.
    pub window: Option<f64>,
    /// Uncertain parameters and the relative standard deviations of their priors.
    pub uncertain: Vec<(&'static str, f64)>,
    /// How many records to learn from, and to be judged by.
    pub records: (usize, usize),
}
