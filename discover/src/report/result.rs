//! Results of a comparison and of a search. They are written as JSON in `json` and as a page in
//! `page`.

use std::collections::BTreeMap;

use maud::Markup;

use crate::experiment::next_experiment::{ExperimentFile, NextExperiment};
use crate::free_function::curves::Curve;
use crate::report::origin::Origin;
use crate::report::playback::Playback;
use crate::report::resimulation::Resimulation;
use crate::search::acceptance::TestStatistics;
use crate::search::search_result::BestOfRound;
use crate::thresholds;

/// Values for the training and the test records.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrainTest<T> {
    /// Value for the training records.
    pub train: T,
    /// Value for the held-out records.
    pub test: T,
}

/// Estimate with its unit.
#[derive(Clone, Debug, PartialEq)]
pub struct EstimateWithUnit {
    /// Value.
    pub value: f64,
    /// Standard deviation.
    pub sd: f64,
    /// Unit of value and standard deviation.
    pub unit: String,
}

/// RMS residuals of a channel, in its SI unit.
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelGap {
    /// SI unit.
    pub unit: String,
    /// Noise floor.
    pub floor: f64,
    /// RMS residual of the original model.
    pub before: TrainTest<f64>,
    /// RMS residual of the model with the found effects; `None` in a comparison.
    pub after: Option<TrainTest<f64>>,
}

/// Errors of a sensor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorEstimate {
    /// Bias in the SI unit of the channel.
    pub bias: f64,
    /// Gain, without unit.
    pub gain: f64,
    /// Delay, s.
    pub delay: f64,
}

/// Results of a comparison that a search also has.
#[derive(Clone, Debug)]
pub struct CommonResult {
    /// Title of the dataset, or of the model if the dataset has none.
    pub title: String,
    /// Gap of each channel, by its name.
    pub gap: BTreeMap<String, ChannelGap>,
    /// Parameters of the null model, by name.
    pub refitted: BTreeMap<String, EstimateWithUnit>,
    /// Sensor of each channel, by the name of the channel.
    pub sensors: BTreeMap<String, SensorEstimate>,
    /// Noise floor over all channels, in standard deviations of the noise.
    pub noise_floor: f64,
    /// Sentences about the location of the difference.
    pub location: String,
    /// Notes.
    pub notes: Vec<String>,
    /// Nuisances of the fit with their declared priors.
    pub nuisances: Vec<Nuisance>,
    /// Origin of the result.
    pub origin: Origin,
    /// Figures of the page.
    pub(crate) pictures: ResultFigures,
}

/// Nuisance with its declared and estimated value.
#[derive(Clone, Debug, PartialEq)]
pub struct Nuisance {
    /// Name of the parameter, input or channel.
    pub name: String,
    /// `gain`, `bias` or `delay` of a sensor or an input; `None` for a parameter.
    pub fault: Option<&'static str>,
    /// Declared mean and standard deviation, in the unit of the estimate.
    pub declared: (f64, f64),
    /// Estimated value.
    pub estimate: EstimateWithUnit,
}

impl Nuisance {
    /// Returns the distance from the declared mean, in declared standard deviations.
    pub fn deviations_from_prior(&self) -> f64 {
        let (mean, sd) = self.declared;
        (self.estimate.value - mean) / sd
    }

    /// Returns true if the estimate is at the bound of the fit.
    pub fn is_at_bound(&self) -> bool {
        self.deviations_from_prior().abs()
            >= thresholds::BOUND_FRACTION * thresholds::MAX_PRIOR_DEVIATION
    }

    /// Returns the name for use in a sentence.
    pub(crate) fn full_name(&self) -> String {
        match self.fault {
            Some(fault) => format!("the {fault} of {}", self.name),
            None => self.name.clone(),
        }
    }
}

/// Figures, as parts of a page.
#[derive(Clone, Debug)]
pub(crate) struct ResultFigures {
    /// Interactive simulation.
    pub playback: Playback,
    /// Measured and simulated motion.
    pub overlay: Markup,
    /// Residuals over time, and their spectra.
    pub residuals: Markup,
    /// Next experiments with their predictions.
    pub experiments: Markup,
    /// Comparison of the equations, and profiles of the residual force.
    pub force: Option<Markup>,
}

/// Result of a comparison.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// True if the gap is larger than for a correct model.
    pub has_gap: bool,
    /// Results that a search also has.
    pub compared: CommonResult,
}

/// Result of a search.
#[derive(Clone, Debug)]
pub struct Discovery {
    /// Verdict.
    pub verdict: Verdict,
    /// Accepted effects, sorted by decreasing closure.
    pub effects: Vec<FoundEffect>,
    /// Tested and rejected effects.
    pub rejected: Vec<RejectedEffect>,
    /// Effects that the records cannot show.
    pub untestable: Vec<RejectedEffect>,
    /// Proposed experiments.
    pub experiments: Vec<ExperimentFile>,
    /// Closed fraction of the gap; `None` if the gap is negligible.
    pub closure: TrainTest<Option<f64>>,
    /// Residual of the test records after each step.
    pub steps: Vec<SearchStep>,
    /// Results that a comparison also has.
    pub compared: CommonResult,
    /// Text of the original specification.
    pub original: String,
    /// Text of the specification with the found effects.
    pub extended: String,
    /// Residuals of the extended specification, simulated on the records.
    pub resimulation: Resimulation,
    /// Result of the validation of the equations, if it was requested.
    pub validation: Option<Validation>,
    /// Free function that explains the residual of the original model best, if it is adequate.
    pub curve: Option<Curve>,
    /// State of the search at its time limit; `None` if the search is complete.
    pub unfinished: Option<String>,
}

/// Verdict of a search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Effects were accepted.
    EffectsFound,
    /// The gap is not larger than for a correct model.
    NoSignificantGap,
    /// A gap remains, and no effect was accepted.
    Unexplained,
}

impl Verdict {
    /// Returns the name in documents.
    pub fn name(self) -> &'static str {
        match self {
            Self::EffectsFound => "effects_found",
            Self::NoSignificantGap => "no_significant_gap",
            Self::Unexplained => "unexplained",
        }
    }
}

/// Effect and its site.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EffectSite {
    /// Name of the effect.
    pub effect: String,
    /// Name of the site.
    pub site: String,
    /// Shaft order of a periodic effect.
    pub order: Option<ShaftOrder>,
}

/// Certainty of the name of an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EffectStatus {
    /// The effect is identified.
    Named,
    /// The effect explains the records best, but a large gap remains or a nuisance is at its bound.
    /// Another effect may be the cause.
    Provisional,
    /// The effect is a member of a class.
    Class,
    /// The effect is an empirical expression.
    Empirical,
}

impl EffectStatus {
    /// Returns the name in documents.
    pub fn name(self) -> &'static str {
        match self {
            Self::Named => "named",
            Self::Provisional => "provisional",
            Self::Class => "class",
            Self::Empirical => "empirical",
        }
    }
}

/// Angle and order of a periodic effect.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShaftOrder {
    /// Angle.
    pub angle: String,
    /// Order, in periods per turn.
    pub order: u32,
}

/// Effect that is inseparable from an accepted effect.
#[derive(Clone, Debug)]
pub struct EquivalentEffect {
    /// Effect and site.
    pub at: EffectSite,
    /// Parameters of the effect in its fit, by name; empty if the effect was not fitted.
    pub parameters: BTreeMap<String, EstimateWithUnit>,
}

/// Size of an accepted effect if another accepted effect is replaced by a member of its class.
#[derive(Clone, Debug)]
pub struct ConditionalSize {
    /// Name of the parameter.
    pub parameter: String,
    /// Its estimate with the member.
    pub size: EstimateWithUnit,
    /// The member.
    pub with: EffectSite,
    /// The replaced effect.
    pub in_place_of: EffectSite,
}

/// Accepted effect.
#[derive(Clone, Debug)]
pub struct FoundEffect {
    /// Effect and site.
    pub at: EffectSite,
    /// Description of the effect.
    pub description: String,
    /// Certainty of the name of the effect.
    pub status: EffectStatus,
    /// Effects that are inseparable from this effect.
    pub equivalents: Vec<EquivalentEffect>,
    /// Parameters of the effect, by name. The standard deviations contain the deviations of the
    /// estimates with members of the classes of other effects.
    pub parameters: BTreeMap<String, EstimateWithUnit>,
    /// Sizes with members of the classes of other effects, if they differ significantly.
    pub conditional: Vec<ConditionalSize>,
    /// Added line that represents the change of the specification.
    pub term: String,
    /// Statistics of the acceptance test.
    pub statistics: TestStatistics,
    /// P-value adjusted for all hypotheses tested on the test records.
    pub adjusted_p_value: Option<f64>,
    /// Spring or mesh whose load scales the effect.
    pub load: Option<String>,
    /// Experiment that separates the effect from its equivalents, if any.
    pub experiment: Option<String>,
    /// Proposed input for the experiment.
    pub next_experiment: Option<NextExperiment>,
}

/// Rejected effect.
#[derive(Clone, Debug)]
pub struct RejectedEffect {
    /// Effect and site.
    pub at: EffectSite,
    /// Reason for the rejection.
    pub reason: String,
    /// Best effect of the same round, if the reason is a reduction of the residual.
    pub best_of_round: Option<BestOfRound>,
    /// True if the effect was fitted, at least to the initial segments of windows.
    pub is_fitted: bool,
    /// Experiment that shows the effect.
    pub experiment: String,
    /// Proposed input for the experiment, if it was computed.
    pub next_experiment: Option<NextExperiment>,
    /// P-value of the test records, and the p-value adjusted for all tested hypotheses. `None` if
    /// the effect was not fitted.
    pub p_values: Option<(f64, f64)>,
}

/// Step of the search.
#[derive(Clone, Debug)]
pub struct SearchStep {
    /// Effects added in this step; empty in the first step.
    pub added: Vec<String>,
    /// RMS residual of the test records, in standard deviations of the noise.
    pub test_rms: f64,
}

/// Result of the validation of the extended equations.
#[derive(Clone, Debug)]
pub struct Validation {
    /// True if all checks passed.
    pub has_passed: bool,
    /// Names of the executed checks.
    pub checks: Vec<String>,
    /// Names of the failed checks.
    pub failed: Vec<String>,
}
