//! Measured records and what their dataset file says of them. Everything is in SI.

use std::path::PathBuf;

use eomgen_model_spec::model::ObservedRate;

use crate::experiment::{ExperimentBounds, Played};
use crate::record::Record;

/// What a channel measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// An observable, by its place.
    Observable(usize),
    /// A coordinate, by its place.
    Coordinate(usize),
    /// The rate of a coordinate, by the coordinate's place.
    Rate(usize),
    /// The acceleration of a coordinate, by the coordinate's place.
    Acceleration(usize),
    /// The rate or the acceleration of an observable.
    ObservedRate(ObservedRate),
    /// A state of first order, by its place among these.
    State(usize),
    /// An input, by its place: what the motion takes, where that is given.
    Input(usize),
}

/// A measured channel.
#[derive(Clone, Debug)]
pub struct Channel {
    /// Its name in the dataset.
    pub name: String,
    /// What it measures, as the model calls it.
    pub observable: String,
    /// What it measures.
    pub quantity: Quantity,
    /// The quantity's SI unit.
    pub unit: String,
    /// One standard deviation of its noise, SI.
    pub noise: f64,
    /// What the dataset says of the sensor.
    pub priors: TransducerPriors,
}

/// What a dataset says of a sensor: measured(t) = gain * quantity(t - delay) + bias. None where it
/// says nothing, and the usual holds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TransducerPriors {
    /// Of the gain.
    pub gain: Option<Expected>,
    /// Of the bias, SI.
    pub bias: Option<Expected>,
    /// Of the delay, s.
    pub delay: Option<Expected>,
}

/// What a dataset says of an input: what acts at t is gain * (recorded(t - delay) + bias). None where it
/// says nothing, and what is recorded acts.
#[derive(Clone, Debug, PartialEq)]
pub struct InputPriors {
    /// The input's name.
    pub name: String,
    /// Of the gain.
    pub gain: Option<Expected>,
    /// Of the bias, SI.
    pub bias: Option<Expected>,
    /// Of the delay, s.
    pub delay: Option<Expected>,
}

/// What is expected of a number, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Expected {
    /// Its mean, where the dataset says it.
    pub mean: Option<f64>,
    /// One standard deviation; 0 where it is known.
    pub sd: f64,
}

/// A parameter of the model that may be refitted.
#[derive(Clone, Debug, PartialEq)]
pub struct Uncertain {
    /// Its name.
    pub name: String,
    /// One standard deviation of its prior, relative to the specification's value.
    pub relative: f64,
}

/// What is known of a record's first state.
#[derive(Clone, Debug, PartialEq)]
pub enum Initial {
    /// As the model's own initial values say, at rest.
    Rest,
    /// Nothing.
    Estimate,
    /// These states, by name, SI.
    Given(Vec<(String, f64)>),
}

/// Where a window's initial state comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// Estimated inside the window.
    Fitted,
    /// Read from the smoothed record.
    Smoothed,
}

/// Records with their description.
#[derive(Clone, Debug)]
pub struct Dataset {
    /// The dataset's file.
    pub path: PathBuf,
    /// One line for people.
    pub title: String,
    /// Records to learn from.
    pub train: Vec<Record>,
    /// Records to be judged by.
    pub test: Vec<Record>,
    /// Inputs of which the dataset says how they act.
    pub inputs: Vec<InputPriors>,
    /// What was measured.
    pub channels: Vec<Channel>,
    /// What is known of the first state.
    pub initial: Initial,
    /// The length of a window, s; none if every record is one window.
    pub window: Option<f64>,
    /// Where a window's initial state comes from.
    pub start: Start,
    /// Which parameters may be refitted.
    pub uncertain: Vec<Uncertain>,
    /// Within what bounds the next experiment may be played.
    pub experiment: ExperimentBounds,
    /// How it is written down.
    pub played: Played,
    /// Where the records give the motion the coordinates, all that the model has: channels measure the
    /// inputs that it takes. None where the motion is the model's.
    pub motion: Vec<String>,
    /// What is worth a remark.
    pub notes: Vec<String>,
}

impl Dataset {
    /// Whether the records give the motion.
    pub fn gives_motion(&self) -> bool {
        !self.motion.is_empty()
    }
}
