//! Data that all fits to one dataset share: windows, noise of the channels, and compilation of
//! specifications.

use std::sync::atomic::{AtomicUsize, Ordering};

use crate::error::DiscoverError;
use crate::model::estimation_model::EstimationModel;
use crate::model::first_state;
use crate::model::input_jumps::compute_jump_errors;
use crate::model::output_times::OutputRate;
use crate::model::specification_texts::edited_source;
use crate::model::stop::StopRequest;
use crate::model::work::WorkLimit;
use crate::thresholds;
use eomgen_records::dataset::{Dataset, StartSource};
use eomgen_records::record::Record;
use eomgen_records::windows::Windows;

/// Data that all fits to one dataset share.
pub struct EstimationProblem<'d> {
    /// The dataset.
    pub dataset: &'d Dataset,
    /// Noise of each channel, SI.
    pub noise: Vec<f64>,
    /// Number of computed outputs per sample interval.
    pub output_rate: OutputRate,
    /// Training windows.
    pub train: Windows<'d>,
    /// Held-out windows.
    pub test: Windows<'d>,
    /// Order of the fields of the model; `None` for the default order.
    pub order: Option<usize>,
    /// Path of the specification, for messages.
    pub path: String,
    /// States of the specification. Additional states belong to candidates.
    pub states: Vec<String>,
    /// Stop request of the search.
    pub stop: StopRequest,
    /// Number of hypotheses tested on the test records.
    pub tested_hypotheses: TestCounter,
    /// Maximum number of evaluations of the rates in a fit.
    most_evaluations: u64,
}

/// Number of hypotheses tested on the test records, over all threads. It is used to adjust
/// p-values.
#[derive(Debug, Default)]
pub struct TestCounter(AtomicUsize);

impl TestCounter {
    /// Increments the number of hypotheses.
    pub fn increment(&self) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }

    /// Returns the number of hypotheses.
    pub fn number(&self) -> usize {
        self.0.load(Ordering::Relaxed)
    }

    /// Returns a p-value adjusted for all hypotheses (Bonferroni), which is valid for any
    /// dependence between them.
    pub fn adjust_p_value(&self, p_value: f64) -> f64 {
        (p_value * self.number().max(1) as f64).min(1.0)
    }
}

/// Returns the interpolation error of each channel due to jumps of the inputs, SI. Empty if the
/// motion is given or the text is invalid.
fn estimate_jump_errors(
    dataset: &Dataset,
    order: Option<usize>,
    path: &str,
    text: &str,
) -> Vec<f64> {
    if dataset.gives_motion() {
        return Vec::new();
    }
    let model = EstimationModel::derive_equations(text, path, order, &dataset.channels);
    model.map_or_else(|_| Vec::new(), |model| compute_jump_errors(&model, dataset))
}

impl<'d> EstimationProblem<'d> {
    /// Creates the problem of a dataset and a specification.
    pub fn new(dataset: &'d Dataset, order: Option<usize>, path: &str, text: &str) -> Self {
        let states = || {
            let model = eomgen_model_spec::check(edited_source(path, text))
                .ok()?
                .model;
            Some(model.state_names(&model.orders(order).ok()?))
        };
        Self {
            // Errors of an invalid text are reported by the derivation.
            states: states().unwrap_or_default(),
            dataset,
            noise: dataset
                .channels
                .iter()
                .map(|channel| channel.noise)
                .collect(),
            output_rate: OutputRate::select(
                dataset,
                &estimate_jump_errors(dataset, order, path, text),
            ),
            train: Windows::split_records(&dataset.train, dataset.window),
            test: Windows::split_records(&dataset.test, dataset.window),
            order,
            path: path.to_owned(),
            stop: StopRequest::default(),
            tested_hypotheses: TestCounter::default(),
            most_evaluations: u64::MAX,
        }
    }

    /// Returns the problem with a maximum number of evaluations of the rates in each fit.
    pub fn limit_evaluations(&self, most: u64) -> Self {
        Self {
            dataset: self.dataset,
            noise: self.noise.clone(),
            output_rate: self.output_rate,
            train: self.train.clone(),
            test: self.test.clone(),
            order: self.order,
            path: self.path.clone(),
            states: self.states.clone(),
            stop: self.stop.clone(),
            tested_hypotheses: TestCounter::default(),
            most_evaluations: most,
        }
    }

    /// Compiles the model of a specification for the records. `linear`: text without the terms that
    /// are nonlinear between switches, if it has such terms.
    ///
    /// # Errors
    ///
    /// An invalid text; [`DiscoverError::Stopped`].
    pub fn compile_model(
        &self,
        text: &str,
        linear: Option<&str>,
    ) -> Result<EstimationModel, DiscoverError> {
        self.stop.check_not_stopped()?;
        let channels = &self.dataset.channels;
        let mut model = EstimationModel::derive(text, linear, &self.path, self.order, channels)?;
        model.stop = self.stop.clone();
        model.work = WorkLimit::new(self.most_evaluations);
        let record = &self.dataset.train[0];
        let first = self.estimate_first_state(&model, record);
        let numbers = self.train.measurement_count();
        model.choose_steps(record, &first, &self.noise, numbers, self.output_rate);
        Ok(model)
    }

    /// Estimates the initial state of a record.
    pub fn estimate_first_state(&self, model: &EstimationModel, record: &Record) -> Vec<f64> {
        first_state::estimate_first_state(
            model,
            record,
            &self.dataset.channels,
            &self.dataset.initial,
        )
    }

    /// Returns true if initial states are fitted, not read from the record. With given motion they
    /// are not fitted.
    pub fn estimates_initial_states(&self) -> bool {
        self.dataset.start == StartSource::Estimate && !self.dataset.gives_motion()
    }

    /// Returns the range of each state in the training records, for given first states. The range
    /// of a coordinate that a candidate adds is multiplied by a factor, because its motion is
    /// unknown.
    pub fn compute_state_ranges(
        &self,
        model: &EstimationModel,
        values: &[f64],
        firsts: &[Vec<f64>],
    ) -> Vec<f64> {
        let mut ranges = first_state::compute_state_ranges(
            model,
            values,
            &self.dataset.train,
            firsts,
            &self.noise,
        );
        for (range, state) in ranges.iter_mut().zip(&model.states) {
            if !self.states.contains(state) {
                *range *= thresholds::ADDED_STATE_PRIOR_FACTOR;
            }
        }
        ranges
    }
}
