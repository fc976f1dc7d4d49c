//! The results of a comparison and of a search. They are serialised in `json`, and shown in
//! `page`.

use std::collections::BTreeMap;

use maud::Markup;

use crate::experiment::next::{ExperimentFile, NextExperiment};
use crate::report::origin::Origin;
use crate::report::playback::Playback;
use crate::report::resimulation::Resimulation;
use crate::search::acceptance::TestStatistics;
use crate::thresholds;

/// A root mean square of each set of records.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OnRecords<T> {
    /// Of the records that were fitted to.
    pub train: T,
    /// Of the records held out.
    pub test: T,
}

/// An estimate, in its unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimated {
    /// The value.
    pub value: f64,
    /// One standard deviation.
    pub sd: f64,
    /// The unit of both.
    pub unit: String,
}

/// The root mean squares of a channel's residuals, in its SI unit.
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelGap {
    /// The unit.
    pub unit: String,
    /// What a right model would leave.
    pub floor: f64,
    /// What the model leaves as it is.
    pub before: OnRecords<f64>,
    /// What it leaves with what was found; none in a comparison.
    pub after: Option<OnRecords<f64>>,
}

/// How a sensor differs from a true one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensor {
    /// In the channel's SI unit.
    pub bias: f64,
    /// Without unit.
    pub gain: f64,
    /// In s.
    pub delay: f64,
}

/// What both a comparison and a search tell.
#[derive(Clone, Debug)]
pub struct Compared {
    /// The dataset's title; empty where it has none.
    pub title: String,
    /// The gap of each channel, by its name.
    pub gap: BTreeMap<String, ChannelGap>,
    /// Parameters of the null model, by their names.
    pub refitted: BTreeMap<String, Estimated>,
    /// The sensor of each channel, by its name.
    pub sensors: BTreeMap<String, Sensor>,
    /// Where model and records disagree, in sentences.
    pub location: String,
    /// What is worth a remark.
    pub notes: Vec<String>,
    /// What was fitted beside what is sought, with what was declared of it.
    pub nuisances: Vec<Nuisance>,
    /// From what, and by which program, this came.
    pub origin: Origin,
    /// Pictures for the page.
    pub(crate) pictures: Pictures,
}

/// Something fitted beside what is sought: what was declared of it, and what came out.
#[derive(Clone, Debug, PartialEq)]
pub struct Nuisance {
    /// A parameter's or an input's name; of a sensor its channel's.
    pub of: String,
    /// `gain`, `bias` or `delay` of a sensor or an input; none for a parameter.
    pub fault: Option<&'static str>,
    /// What was declared, and one standard deviation of it, in the estimate's unit.
    pub declared: (f64, f64),
    /// What came out.
    pub fitted: Estimated,
}

impl Nuisance {
    /// How far it is from what was declared, in standard deviations of that.
    pub fn deviations(&self) -> f64 {
        let (mean, sd) = self.declared;
        (self.fitted.value - mean) / sd
    }

    /// Whether it is as far from what was declared as the fit admits.
    pub fn is_at_bound(&self) -> bool {
        self.deviations().abs() >= thresholds::AT_BOUND * thresholds::SHIFTED
    }

    /// What it is called in a sentence.
    pub(crate) fn name(&self) -> String {
        match self.fault {
            Some(fault) => format!("the {fault} of {}", self.of),
            None => self.of.clone(),
        }
    }
}

/// Pictures, as parts of a page.
#[derive(Clone, Debug)]
pub(crate) struct Pictures {
    /// What was found, to be moved.
    pub playback: Playback,
    /// What was measured and what is simulated, over each other.
    pub overlay: Markup,
    /// Residuals over time, and their spectra.
    pub residuals: Markup,
    /// What to play next, and what is predicted of it.
    pub experiments: Markup,
    /// The equation whose residual force is shown, and that force.
    pub force: Option<(String, Markup)>,
}

/// What a comparison came to.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// Whether more is left than a right model would leave.
    pub has_gap: bool,
    /// What there is to tell.
    pub compared: Compared,
}

/// What a search came to.
#[derive(Clone, Debug)]
pub struct Discovery {
    /// In a word.
    pub verdict: Verdict,
    /// What was accepted, by decreasing gap closed.
    pub effects: Vec<FoundEffect>,
    /// What was tested and not accepted.
    pub rejected: Vec<RejectedEffect>,
    /// What these records could not have shown.
    pub not_testable: Vec<RejectedEffect>,
    /// Experiments that would tell more, to be played.
    pub experiments: Vec<ExperimentFile>,
    /// The part of the gap that was closed; none where there was hardly one.
    pub closure: OnRecords<Option<f64>>,
    /// The test gap step by step.
    pub steps: Vec<Step>,
    /// What there is to tell besides.
    pub compared: Compared,
    /// The specification as it was.
    pub original: String,
    /// The specification with what was found.
    pub extended: String,
    /// What that leaves when it is run on the records.
    pub resimulation: Resimulation,
    /// Whether its equations are right, where that was asked.
    pub validation: Option<Validation>,
    /// What is known of what the time did not suffice for; none where the search came to its end.
    pub unfinished: Option<String>,
}

/// The verdict of a search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Effects were accepted.
    EffectsFound,
    /// No more is left than a right model would leave.
    NoSignificantGap,
    /// More is left, and nothing was accepted.
    Unexplained,
}

impl Verdict {
    /// Its word in documents.
    pub fn word(self) -> &'static str {
        match self {
            Self::EffectsFound => "effects_found",
            Self::NoSignificantGap => "no_significant_gap",
            Self::Unexplained => "unexplained",
        }
    }
}

/// An effect at a place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EffectAt {
    /// The effect.
    pub effect: String,
    /// The place.
    pub on: String,
}

/// How sure an effect's name is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// It is this effect.
    Named,
    /// It explains the records best of all that was tried, and much is left, or a nuisance stands at
    /// its bound: it may stand in for something else.
    Provisional,
    /// It is this one or another of its equivalence class.
    Class,
    /// It is an expression outside the catalogue.
    Empirical,
}

impl Status {
    /// Its word in documents.
    pub fn word(self) -> &'static str {
        match self {
            Self::Named => "named",
            Self::Provisional => "provisional",
            Self::Class => "class",
            Self::Empirical => "empirical",
        }
    }
}

/// The angle with which an effect repeats, and how many times per turn.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShaftOrder {
    /// The angle.
    pub angle: String,
    /// The order.
    pub order: u32,
}

/// An effect that was accepted.
#[derive(Clone, Debug)]
pub struct FoundEffect {
    /// What and where.
    pub at: EffectAt,
    /// What such an effect is, in words.
    pub says: String,
    /// How sure its name is.
    pub status: Status,
    /// What the records do not distinguish from it.
    pub equivalent: Vec<EffectAt>,
    /// Its parameters, by their names.
    pub parameters: BTreeMap<String, Estimated>,
    /// The line that says most of the change of the specification.
    pub term: String,
    /// What spoke for it.
    pub statistics: TestStatistics,
    /// Its p-value over all hypotheses that were judged by the test records.
    pub adjusted_p_value: Option<f64>,
    /// With what it repeats.
    pub order: Option<ShaftOrder>,
    /// The spring or the pair of teeth with whose load it grows.
    pub load: Option<String>,
    /// What would separate it from its equivalents, where it has some.
    pub experiment: Option<String>,
    /// What to play for that, as it was computed.
    pub next_experiment: Option<NextExperiment>,
}

/// An effect that was not accepted.
#[derive(Clone, Debug)]
pub struct RejectedEffect {
    /// What and where.
    pub at: EffectAt,
    /// Why.
    pub reason: String,
    /// What would show it.
    pub experiment: String,
    /// What to play for that, where it was computed.
    pub next_experiment: Option<NextExperiment>,
    /// The probability that noise alone lets the test records speak for it as much, and the same over all
    /// hypotheses that were judged by these; none where it was not fitted.
    pub p_values: Option<(f64, f64)>,
}

/// A step of the search.
#[derive(Clone, Debug)]
pub struct Step {
    /// What was added; nothing in the first.
    pub added: Vec<String>,
    /// The root mean square of the test records' residuals, in standard deviations of the noise.
    pub test_rms: f64,
}

/// What the checks of the extended specification's equations say.
#[derive(Clone, Debug)]
pub struct Validation {
    /// Whether all passed.
    pub passed: bool,
    /// The checks that were made.
    pub checks: Vec<String>,
    /// Those of them that failed.
    pub failed: Vec<String>,
}
