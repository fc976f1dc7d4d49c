//! The next experiments as results.

use std::fmt;

use crate::catalogue::candidate::Candidate;
use crate::experiment::bounds::Bounds;
use crate::experiment::discrimination::NoExperiment;

/// All experiments.
#[derive(Clone, Debug, Default)]
pub struct Experiments {
    /// What is to be played.
    pub files: Vec<ExperimentFile>,
    /// For each accepted effect what separates its class; none where it is no class.
    pub of_effects: Vec<Option<NextExperiment>>,
    /// For each rejected one what would show it; none where that was not asked.
    pub of_rejected: Vec<Option<NextExperiment>>,
}

impl Experiments {
    /// None for so many accepted and rejected effects.
    pub fn none(accepted: usize, rejected: usize) -> Self {
        Self {
            files: Vec::new(),
            of_effects: vec![None; accepted],
            of_rejected: vec![None; rejected],
        }
    }
}

/// A member of a class.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MemberAt {
    /// The effect.
    pub effect: String,
    /// Its place.
    pub on: String,
}

impl MemberAt {
    /// Of a candidate.
    pub fn of(candidate: &Candidate) -> Self {
        Self {
            effect: candidate.effect.clone(),
            on: candidate.on.clone(),
        }
    }

    /// As words.
    pub fn words(&self) -> String {
        format!("{} on {}", self.effect.replace('_', " "), self.on)
    }
}

/// An experiment that can be played.
#[derive(Clone, Debug)]
pub struct ExperimentFile {
    /// The file's name: `experiment.csv`, then `experiment_2.csv` and so on.
    pub name: String,
    /// Its text.
    pub text: String,
    /// The input that is played.
    pub input: String,
    /// That input's SI unit.
    pub unit: String,
    /// The times of its samples, s.
    pub times: Vec<f64>,
    /// Its values, SI.
    pub values: Vec<f64>,
    /// The two members that it separates least of those that it separates, or the model with what it
    /// shows and without that.
    pub members: [String; 2],
    /// What the sensors show of the first, and of the second fitted to that: a column for each channel,
    /// SI.
    pub predicted: [Vec<Vec<f64>>; 2],
}

impl ExperimentFile {
    /// The name of one of several, counted from 0.
    pub(super) fn numbered(place: usize) -> String {
        match place {
            0 => "experiment.csv".to_owned(),
            place => format!("experiment_{}.csv", place + 1),
        }
    }
}

/// How far an experiment separates two members.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// The one whose prediction is taken for the truth.
    pub truth: MemberAt,
    /// The one that is fitted to it.
    pub rival: MemberAt,
    /// The root mean square of what that leaves, in standard deviations of the noise.
    pub separation: f64,
    /// The channel that shows it best.
    pub channel: String,
}

/// How small something may be to be shown.
#[derive(Clone, Debug, PartialEq)]
pub struct Shown {
    /// What scales it.
    pub what: String,
    /// From which value on it is shown, in its unit.
    pub from: f64,
    /// The unit.
    pub unit: String,
}

/// What would tell the members of a class apart, or show what the records could not.
#[derive(Clone, Debug, PartialEq)]
pub struct NextExperiment {
    /// Which of the files; none if nothing within the bounds separates them.
    pub file: Option<usize>,
    /// The input; none if nothing can be played.
    pub input: Option<String>,
    /// What is played on it, in words.
    pub form: Option<String>,
    /// The least separation of the pairs that are separated, in standard deviations of the noise; the
    /// least of all if none is.
    pub separation: Option<f64>,
    /// All pairs, either way.
    pub pairs: Vec<Pair>,
    /// Members that could not be fitted.
    pub left_out: Vec<MemberAt>,
    /// Of what the records could not show, how small it may be.
    pub shows: Option<Shown>,
    /// Why nothing can be played, if so.
    pub reason: Option<String>,
    /// Where the bounds come from.
    pub bounds: String,
}

impl NextExperiment {
    /// None, for a reason.
    pub(super) fn none(reason: &str, bounds: &Bounds) -> Self {
        Self {
            file: None,
            input: None,
            form: None,
            separation: None,
            pairs: Vec::new(),
            left_out: Vec::new(),
            shows: None,
            reason: Some(reason.to_owned()),
            bounds: bounds.words.clone(),
        }
    }
}

impl fmt::Display for NoExperiment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoInput => f.write_str(
                "nothing can be played: the model has no input that a column of the records drives and that may move",
            ),
            Self::Leaves(count, name) => write!(
                f,
                "none of {count} inputs that were tried can be played: with most of them {name} leaves its limits; \
                 expected wider [experiment] limits, or a smaller range"
            ),
            Self::Unfollowed(count) => write!(
                f,
                "none of {count} inputs that were tried can be played: no motion can be followed"
            ),
        }
    }
}
