//! Measured records with their descriptions, in SI.

use std::path::PathBuf;

use eomgen_model_spec::model::ObservedRate;

use crate::experiment::{ExperimentBounds, ExperimentUnits};
use crate::record::Record;

/// Quantity of the model that a channel measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Index of an observable.
    Observable(usize),
    /// Index of a coordinate.
    Coordinate(usize),
    /// Index of the coordinate whose rate is measured.
    Rate(usize),
    /// Index of the coordinate whose acceleration is measured.
    Acceleration(usize),
    /// Rate or acceleration of an observable.
    ObservedRate(ObservedRate),
    /// Index of a first-order state.
    State(usize),
    /// Index of an input: a force that is computed from the given motion.
    Input(usize),
}

/// Measured channel.
#[derive(Clone, Debug)]
pub struct Channel {
    /// Name in the dataset.
    pub name: String,
    /// Name of the quantity in the model.
    pub observable: String,
    /// Measured quantity.
    pub quantity: Quantity,
    /// SI unit of the quantity.
    pub unit: String,
    /// Standard deviation of the noise, in SI.
    pub noise: f64,
    /// Priors of the sensor.
    pub priors: TransducerPriors,
}

impl Channel {
    /// Returns the noise, in SI, of a quantity that cannot have a peak of one sample; `None` for accelerations and
    /// forces, in which an impact causes such peaks.
    pub(crate) fn smooth_noise(&self) -> Option<f64> {
        let is_smooth = match self.quantity {
            Quantity::Coordinate(_) | Quantity::Rate(_) | Quantity::State(_) => true,
            Quantity::Observable(_) => matches!(&*self.unit, "m" | "rad"),
            Quantity::Acceleration(_) | Quantity::ObservedRate(_) | Quantity::Input(_) => false,
        };
        is_smooth.then_some(self.noise)
    }
}

/// Priors of a sensor, measured(t) = gain * quantity(t - delay) + bias; `None` for the default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TransducerPriors {
    /// Prior of the gain.
    pub gain: Option<PriorInSi>,
    /// Prior of the bias, in SI.
    pub bias: Option<PriorInSi>,
    /// Prior of the delay, in s.
    pub delay: Option<PriorInSi>,
}

/// Priors of an input: gain * (recorded(t - delay) + bias) acts at time t. `None` means exactly known.
#[derive(Clone, Debug, PartialEq)]
pub struct InputPriors {
    /// Name of the input.
    pub name: String,
    /// Prior of the gain.
    pub gain: Option<PriorInSi>,
    /// Prior of the bias, in SI.
    pub bias: Option<PriorInSi>,
    /// Prior of the delay, in s.
    pub delay: Option<PriorInSi>,
}

/// Prior of a number, in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PriorInSi {
    /// Mean; `None` for the default.
    pub mean: Option<f64>,
    /// Standard deviation; 0 if the number is known.
    pub sd: f64,
}

/// Parameter of the model that the fit may change.
#[derive(Clone, Debug, PartialEq)]
pub struct Uncertain {
    /// Name of the parameter.
    pub name: String,
    /// Standard deviation of its prior, relative to the specification's value.
    pub relative: f64,
}

/// Information on the initial state of a record.
#[derive(Clone, Debug, PartialEq)]
pub enum Initial {
    /// Initial values of the model, at rest.
    Rest,
    /// Unknown.
    Estimate,
    /// Values of states by name, in SI.
    Values(Vec<(String, f64)>),
}

/// Source of a window's initial state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StartSource {
    /// Estimated inside the window.
    Estimate,
    /// Read from the smoothed record.
    SmoothedRecord,
}

/// Records with their descriptions.
#[derive(Clone, Debug)]
pub struct Dataset {
    /// Path of the dataset file.
    pub path: PathBuf,
    /// Title for reports.
    pub title: String,
    /// Training records.
    pub train: Vec<Record>,
    /// Test records.
    pub test: Vec<Record>,
    /// Inputs with priors.
    pub inputs: Vec<InputPriors>,
    /// Measured channels.
    pub channels: Vec<Channel>,
    /// Initial state of the records.
    pub initial: Initial,
    /// Length of a window, in s; `None` for one window per record.
    pub window: Option<f64>,
    /// Source of a window's initial state.
    pub start: StartSource,
    /// Parameters that the fit may change.
    pub uncertain: Vec<Uncertain>,
    /// Bounds of the next experiment.
    pub experiment: ExperimentBounds,
    /// Units of the next experiment's columns.
    pub experiment_units: ExperimentUnits,
    /// All coordinates of the model if the records give the motion. The channels then measure the inputs that cause
    /// this motion. Empty if the model computes the motion.
    pub motion: Vec<String>,
    /// Notes for the user.
    pub notes: Vec<String>,
}

impl Dataset {
    /// Returns true if the records give the motion.
    pub fn gives_motion(&self) -> bool {
        !self.motion.is_empty()
    }
}
