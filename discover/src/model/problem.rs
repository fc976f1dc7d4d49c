//! What all fits to one dataset share: its windows, the standard deviation of its channels' noise,
//! and the models of specifications ready to run along them.

use std::sync::atomic::{AtomicUsize, Ordering};

use eomgen_model_spec::source::Source;

use crate::error::DiscoverError;
use crate::model::estimation_model::EstimationModel;
use crate::model::first_state;
use crate::model::output_times::OutputRate;
use crate::model::stop::Stop;
use crate::thresholds;
use eomgen_records::dataset::{Dataset, Start};
use eomgen_records::record::Record;
use eomgen_records::windows::Windows;

/// What all fits to one dataset share.
pub struct EstimationProblem<'d> {
    /// The dataset.
    pub dataset: &'d Dataset,
    /// The noise of each channel, SI.
    pub noise: Vec<f64>,
    /// How often quantities are computed from sample to sample.
    pub output_rate: OutputRate,
    /// The windows to fit to.
    pub train: Windows<'d>,
    /// The windows held out.
    pub test: Windows<'d>,
    /// The order of the model's fields, if not their own.
    pub order: Option<usize>,
    /// The specification's path, for messages.
    pub path: String,
    /// The states of the specification's own model; others are candidates'.
    pub states: Vec<String>,
    /// By which all of it can be told to stop.
    pub stop: Stop,
    /// How many hypotheses were judged by the test records.
    pub judged: Judged,
}

/// How many hypotheses were judged by the test records, on all threads: so many p-values there are to
/// choose from.
#[derive(Debug, Default)]
pub struct Judged(AtomicUsize);

impl Judged {
    /// One more.
    pub fn count(&self) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }

    /// So many.
    pub fn number(&self) -> usize {
        self.0.load(Ordering::Relaxed)
    }

    /// A p-value over all of them (Bonferroni), however they depend on each other.
    pub fn adjusted(&self, p_value: f64) -> f64 {
        (p_value * self.number().max(1) as f64).min(1.0)
    }
}

impl<'d> EstimationProblem<'d> {
    /// The problem of a dataset and of a specification's text.
    pub fn new(dataset: &'d Dataset, order: Option<usize>, path: &str, text: &str) -> Self {
        let states = || {
            let model = eomgen_model_spec::check(Source::new(path, text))
                .ok()?
                .model;
            Some(model.state_names(&model.orders(order).ok()?))
        };
        Self {
            // What is wrong with a text is said where it is derived.
            states: states().unwrap_or_default(),
            dataset,
            noise: dataset
                .channels
                .iter()
                .map(|channel| channel.noise)
                .collect(),
            output_rate: OutputRate::of(dataset),
            train: Windows::cut(&dataset.train, dataset.window),
            test: Windows::cut(&dataset.test, dataset.window),
            order,
            path: path.to_owned(),
            stop: Stop::default(),
            judged: Judged::default(),
        }
    }

    /// The model of a text, ready to run on these records. `linear`: the text without terms
    /// that are not linear between switches, where there are such.
    ///
    /// # Errors
    /// What is wrong with the text; [`DiscoverError::Stopped`].
    pub fn model(
        &self,
        text: &str,
        linear: Option<&str>,
    ) -> Result<EstimationModel, DiscoverError> {
        self.stop.check()?;
        let channels = &self.dataset.channels;
        let mut model = EstimationModel::of(text, linear, &self.path, self.order, channels)?;
        model.stop = self.stop.clone();
        let record = &self.dataset.train[0];
        let first = self.first_state(&model, record);
        let numbers = self.train.numbers();
        model.choose_steps(record, &first, &self.noise, numbers, self.output_rate);
        Ok(model)
    }

    /// The first state of a record, as far as it is known.
    pub fn first_state(&self, model: &EstimationModel, record: &Record) -> Vec<f64> {
        first_state::first_state(model, record, &self.dataset.channels, &self.dataset.initial)
    }

    /// Whether initial states are fitted: not where they are read from the record, or the motion is given.
    pub fn estimates_initial_states(&self) -> bool {
        self.dataset.start == Start::Fitted && !self.dataset.gives_motion()
    }

    /// The range of each state in the training records. That of a coordinate which a candidate
    /// adds, and which nobody has seen move yet, counts several times.
    pub fn ranges(&self, model: &EstimationModel, values: &[f64]) -> Vec<f64> {
        let first = self.first_state(model, &self.dataset.train[0]);
        let mut ranges =
            first_state::ranges(model, values, &self.dataset.train, &first, &self.noise);
        for (range, state) in ranges.iter_mut().zip(&model.states) {
            if !self.states.contains(state) {
                *range *= thresholds::ADDED_STATE;
            }
        }
        ranges
    }
}
