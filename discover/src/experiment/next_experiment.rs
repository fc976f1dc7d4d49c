//! Results of the search for next experiments.

use std::fmt;

use crate::catalogue::candidate::Candidate;
use crate::catalogue::effect::effect_in_words;
use crate::experiment::bounds::Bounds;
use crate::experiment::discrimination::NoExperiment;

/// All proposed experiments.
#[derive(Clone, Debug, Default)]
pub struct Experiments {
    /// Files of the experiments.
    pub files: Vec<ExperimentFile>,
    /// Experiment that separates the class of each accepted effect; `None` if the effect has no
    /// class.
    pub for_effects: Vec<Option<NextExperiment>>,
    /// Experiment that shows each rejected effect; `None` if no experiment was searched.
    pub for_rejected: Vec<Option<NextExperiment>>,
}

impl Experiments {
    /// Creates a result without experiments for given numbers of accepted and rejected effects.
    pub fn empty(accepted: usize, rejected: usize) -> Self {
        Self {
            files: Vec::new(),
            for_effects: vec![None; accepted],
            for_rejected: vec![None; rejected],
        }
    }
}

/// Member of a class.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ClassMember {
    /// Name of the effect.
    pub effect: String,
    /// Name of its site.
    pub site: String,
}

impl ClassMember {
    /// Creates the member of a candidate.
    pub fn from_candidate(candidate: &Candidate) -> Self {
        Self {
            effect: candidate.effect.clone(),
            site: candidate.site.clone(),
        }
    }

    /// Returns effect and site in words.
    pub fn label(&self) -> String {
        format!("{} on {}", effect_in_words(&self.effect), self.site)
    }
}

/// File of an experiment.
#[derive(Clone, Debug)]
pub struct ExperimentFile {
    /// Name of the file: `experiment.csv`, `experiment_2.csv`, ...
    pub name: String,
    /// Text of the file.
    pub text: String,
    /// Name of the driven input.
    pub input: String,
    /// SI unit of the input.
    pub unit: String,
    /// Sample times, s.
    pub times: Vec<f64>,
    /// Values, SI.
    pub values: Vec<f64>,
    /// The two separated members with the smallest separation, or the model with and without an
    /// undetectable effect.
    pub members: [String; 2],
    /// Predicted sensor outputs of the first member, and of the second member after a fit to them.
    /// One column per channel, SI.
    pub predictions: [Vec<Vec<f64>>; 2],
}

impl ExperimentFile {
    /// Returns the name of the file with a given index.
    pub(super) fn numbered_name(index: usize) -> String {
        match index {
            0 => "experiment.csv".to_owned(),
            index => format!("experiment_{}.csv", index + 1),
        }
    }
}

/// Separation of two members by an experiment.
#[derive(Clone, Debug, PartialEq)]
pub struct MemberPair {
    /// Member whose prediction is taken as the truth.
    pub truth: ClassMember,
    /// Member that is fitted to the prediction.
    pub rival: ClassMember,
    /// RMS residual of the rival, in standard deviations of the noise.
    pub separation: f64,
    /// Channel with the largest residual.
    pub channel: String,
}

/// Smallest detectable size of an effect.
#[derive(Clone, Debug, PartialEq)]
pub struct DetectableSize {
    /// Parameter that scales the effect.
    pub parameter: String,
    /// Smallest detectable value, in `unit`.
    pub smallest: f64,
    /// Unit of the value.
    pub unit: String,
}

/// Experiment that separates the members of a class or shows an undetectable effect.
#[derive(Clone, Debug, PartialEq)]
pub struct NextExperiment {
    /// Index of the experiment's file; `None` if no admissible input separates the members.
    pub file: Option<usize>,
    /// Name of the input; `None` if no experiment is possible.
    pub input: Option<String>,
    /// Description of the waveform.
    pub waveform: Option<String>,
    /// Smallest separation over the separated pairs, in standard deviations of the noise. If no
    /// pair is separated, smallest separation over all pairs.
    pub separation: Option<f64>,
    /// Separations of all pairs, in both directions.
    pub pairs: Vec<MemberPair>,
    /// Members that could not be fitted.
    pub failed_members: Vec<ClassMember>,
    /// Smallest detectable size of an undetectable effect.
    pub detectable: Option<DetectableSize>,
    /// Reason why no experiment is possible.
    pub reason: Option<String>,
    /// Origin of the bounds.
    pub bounds_source: String,
}

impl NextExperiment {
    /// Creates a result without an experiment, with its reason.
    pub(super) fn without_experiment(reason: &str, bounds: &Bounds) -> Self {
        Self {
            file: None,
            input: None,
            waveform: None,
            separation: None,
            pairs: Vec::new(),
            failed_members: Vec::new(),
            detectable: None,
            reason: Some(reason.to_owned()),
            bounds_source: bounds.sources.clone(),
        }
    }
}

impl fmt::Display for NoExperiment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoInput => {
                f.write_str("no experiment is possible: the records contain no input that may vary")
            }
            Self::LeavesLimits(count, name) => write!(
                f,
                "none of the {count} tested inputs is admissible: most of them violate the limits of {name}; \
                 expected wider [experiment] limits, or a smaller range"
            ),
            Self::SimulationFailed(count) => {
                write!(f, "none of the {count} tested inputs can be simulated")
            }
        }
    }
}
