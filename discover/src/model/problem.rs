//! What all fits to one dataset share: its windows, the noise of its channels, and how models of
//! specifications are run along them and initial states found. Fits are [`crate::fit::full`]'s.

use model_spec::source::Source;
use rayon::prelude::*;

use crate::catalogue::candidate::Candidate;
use crate::fit::continuation::Follow;
use crate::fit::full::Fit;
use crate::fit::gauss_newton::{self, Estimate, StartPrior};
use crate::fit::initial_states;
use crate::fit::shooting::Shooting;
use crate::model::plant::{Plant, is_linear};
use crate::model::unknowns::Unknown;
use crate::thresholds;
use eomgen_records::dataset::{Dataset, Start};
use eomgen_records::record::Record;
use eomgen_records::windows::Windows;

/// The parts of a window over which initial states are fitted, one after the other.
pub(crate) const HORIZONS: [f64; 4] = [0.08, 0.25, 0.5, 1.0];

/// Others, for another try: where impacts fold the outputs, one way may end in the wrong fold
/// and another in the right one.
pub(crate) const OTHER_HORIZONS: [f64; 5] = [0.05, 0.12, 0.3, 0.7, 1.0];

/// The part of a window on which unknowns are first approached, and the horizons up to it.
pub const FIRST_PART: (f64, usize) = (0.25, 2);

/// What all fits to one dataset share.
pub struct Setting<'d> {
    /// The dataset.
    pub dataset: &'d Dataset,
    /// The noise of each channel, SI.
    pub noise: Vec<f64>,
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
}

impl<'d> Setting<'d> {
    /// The setting of a dataset and of a specification's text.
    pub fn new(dataset: &'d Dataset, order: Option<usize>, path: &str, text: &str) -> Self {
        let states = || {
            let model = model_spec::check(Source::new(path, text)).ok()?.model;
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
            train: Windows::cut(&dataset.train, dataset.window),
            test: Windows::cut(&dataset.test, dataset.window),
            order,
            path: path.to_owned(),
        }
    }

    /// The model of a text, ready to run on these records. `linear`: the text without terms
    /// that are not linear between switches, where there are such.
    ///
    /// # Errors
    /// What is wrong with the text.
    pub fn plant(&self, text: &str, linear: Option<&str>) -> Result<Plant, String> {
        let channels = &self.dataset.channels;
        let mut plant = Plant::of(text, linear, &self.path, self.order, channels)?;
        let record = &self.dataset.train[0];
        let first = self.first_state(&plant, record);
        plant.choose_steps(record, &first, &self.noise);
        Ok(plant)
    }

    /// A specification's text and its linear part's with a candidate at these values.
    ///
    /// # Errors
    /// A place of the edits that the text lacks, in words.
    pub fn with(
        &self,
        (text, linear): (&str, &str),
        candidate: &Candidate,
        values: &[f64],
    ) -> Result<(String, String), String> {
        let written = |text| candidate.written(text, &self.path, values, "");
        let extended = written(text).map_err(|error| error.to_string())?;
        // What is linear between switches itself belongs to the linear part.
        let linear = match written(linear) {
            Ok(extended) if is_linear(&extended, &self.path, self.order) => extended,
            _ => linear.to_owned(),
        };
        Ok((extended, linear))
    }

    /// The first state of a record, as far as it is known.
    pub fn first_state(&self, plant: &Plant, record: &Record) -> Vec<f64> {
        initial_states::first_state(plant, record, &self.dataset.channels, &self.dataset.initial)
    }

    /// Whether initial states are fitted.
    pub fn fits_starts(&self) -> bool {
        self.dataset.start == Start::Fitted
    }

    /// Windows to be explained by a plant.
    pub fn shooting<'a>(
        &'a self,
        plant: &'a Plant,
        windows: &'a Windows<'a>,
        unknowns: &'a [Unknown],
        ranges: &'a [f64],
    ) -> Shooting<'a> {
        Shooting {
            plant,
            windows,
            noise: &self.noise,
            unknowns,
            ranges: self.fits_starts().then_some(ranges),
            part: 1.0,
            prior_weight: 1.0,
        }
    }

    /// The range of each state in the training records. That of a coordinate which a candidate
    /// adds, and which nobody has seen move yet, counts several times.
    pub fn ranges(&self, plant: &Plant, values: &[f64]) -> Vec<f64> {
        let first = self.first_state(plant, &self.dataset.train[0]);
        let mut ranges = initial_states::ranges(plant, values, &self.dataset.train, &first);
        for (range, state) in ranges.iter_mut().zip(&plant.states) {
            if !self.states.contains(state) {
                *range *= thresholds::ADDED_STATE;
            }
        }
        ranges
    }

    /// Initial states of all windows at these unknowns.
    pub(crate) fn starts(
        &self,
        shooting: &Shooting<'_>,
        theta: &[f64],
        ranges: &[f64],
        horizons: &[f64],
        before: Option<&[Vec<f64>]>,
    ) -> Result<(StartPrior, Vec<Vec<f64>>), String> {
        if !self.fits_starts() {
            let read = initial_states::read_smoothed(
                shooting.plant,
                shooting.windows,
                &self.dataset.channels,
            );
            return Ok((StartPrior::default(), read.map_err(not_shown)?));
        }
        let records = shooting.windows.records.iter();
        let firsts: Vec<Vec<f64>> = records
            .map(|r| self.first_state(shooting.plant, r))
            .collect();
        Ok(initial_states::followed(
            shooting, theta, &firsts, ranges, horizons, before,
        ))
    }

    /// Initial states of all windows at these unknowns, found as they are in a fit.
    ///
    /// # Errors
    /// If they are to be read from the record and no channel shows a coordinate.
    pub fn all_starts(
        &self,
        shooting: &Shooting<'_>,
        theta: &[f64],
        ranges: &[f64],
    ) -> Result<Vec<Vec<f64>>, String> {
        let ladders = [&HORIZONS[..], &OTHER_HORIZONS];
        let ladders = if self.fits_starts() {
            &ladders[..]
        } else {
            &ladders[..1]
        };
        let found: Vec<Result<Estimate, String>> = ladders
            .par_iter()
            .map(|horizons| {
                let (_, starts) = self.starts(shooting, theta, ranges, horizons, None)?;
                let prior = StartPrior::default();
                Ok(gauss_newton::evaluated(
                    shooting,
                    &prior,
                    theta.to_vec(),
                    starts,
                ))
            })
            .collect();
        let found = found
            .into_iter()
            .collect::<Result<Vec<Estimate>, String>>()?;
        let best = (0..shooting.windows.list.len()).map(|window| {
            let order =
                |a: &&Estimate, b: &&Estimate| a.squares[window].total_cmp(&b.squares[window]);
            let best = found.iter().min_by(order);
            best.map_or_else(Vec::new, |found| found.starts[window].clone())
        });
        Ok(best.collect())
    }

    /// Initial states that follow unknowns, by so many horizons.
    pub(crate) fn follow<'f>(
        &'f self,
        shooting: &'f Shooting<'f>,
        ranges: &'f [f64],
        horizons: usize,
    ) -> Box<Follow<'f>> {
        Box::new(move |theta, before| {
            let horizons = &HORIZONS[..horizons];
            self.starts(shooting, theta, ranges, horizons, before)
                .unwrap_or_default()
        })
    }

    /// So much of each window at a fit: what is known of initial states, and states that suit
    /// these parts.
    pub fn beginnings(&self, fit: &Fit, part: f64) -> (StartPrior, Estimate) {
        if part == 1.0 || !self.fits_starts() {
            return (fit.prior.clone(), fit.train.estimate.clone());
        }
        let whole = self.shooting(&fit.plant, &self.train, &fit.unknowns, &fit.ranges);
        let shooting = Shooting { part, ..whole };
        let theta = fit.train.estimate.theta.clone();
        let follow = self.follow(&shooting, &fit.ranges, FIRST_PART.1);
        let (prior, starts) = follow(&theta, None);
        let estimate = gauss_newton::evaluated(&shooting, &prior, theta, starts);
        (prior, estimate)
    }
}

fn not_shown(state: String) -> String {
    format!(
        "windows.start = \"smoothed\" needs a channel for every coordinate, and none shows \
         `{state}`; expected start = \"fitted\""
    )
}
