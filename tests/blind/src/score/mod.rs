//! Comparison of results with labels: a judgement of every case, and success rates (correct effects
//! at the correct site, false alarms, wrong signs, intervals, closures, classes).

mod judge;
mod table;

use std::path::Path;

use serde::Serialize;

use crate::plan::Group;

pub use judge::judge;
pub use table::table;

/// Minimum size of effects that must be found, in noise floors: three, reduced by the accuracy of
/// the sizes.
pub const MIN_FLOORS: f64 = 2.85;

/// Judgement of a case.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CaseScore {
    /// Number of the case.
    pub case: usize,
    /// Group.
    pub group: Group,
    /// Hidden effects with their sites and sizes in noise floors.
    pub hidden: Vec<(String, String, f64)>,
    /// Found effects with their sites and status.
    pub found: Vec<(String, String, String)>,
    /// Judgement.
    pub judgement: Judgement,
    /// True if all nuisances deviate by their full priors.
    pub full_priors: bool,
    /// Number of effects in each found class.
    pub classes: Vec<usize>,
    /// Number of accepted effects that were not hidden.
    pub extra: usize,
    /// Number of parameters of correct effects with the wrong sign.
    pub wrong_signs: usize,
    /// Number of parameter intervals of correct effects that contain the true value, and number of
    /// all these intervals.
    pub intervals: (usize, usize),
    /// Number of intervals of refitted parameters that contain the true value, and number of all
    /// these intervals.
    pub refitted: (usize, usize),
    /// Closure on held-out records. `None` if the answer reports no gap, 0 if there is no answer.
    pub closure: Option<f64>,
    /// Duration, s.
    pub seconds: f64,
}

impl CaseScore {
    /// Returns true if there is an answer without a false effect: each reported effect was hidden,
    /// or its class contains a hidden effect, and its sign is correct.
    pub fn has_no_false_effect(&self) -> bool {
        let is_answer = !matches!(self.judgement, Judgement::Timeout | Judgement::Failed);
        is_answer && self.extra == 0 && self.wrong_signs == 0
    }

    /// Returns true if the hidden effect is the first effect of the answer, or the first member of
    /// its class.
    fn is_first(&self) -> bool {
        let is_right = matches!(self.judgement, Judgement::Right | Judgement::Class);
        let mut pairs = self.hidden.iter().zip(&self.found);
        let is_same = |(hidden, found): (&(String, String, f64), &(String, String, String))| {
            (&hidden.0, &hidden.1) == (&found.0, &found.1)
        };
        is_right && pairs.all(is_same)
    }
}

/// Judgement of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Judgement {
    /// All hidden effects are named first; or no effect is reported and none was hidden; or a class
    /// is reported for inseparable effects.
    Right,
    /// A class with the hidden effect is reported, although its members are separable.
    Class,
    /// Some of the hidden effects were found.
    Part,
    /// Other effects were found.
    Wrong,
    /// No gap was found.
    Missed,
    /// A gap was found, but no effect.
    Unexplained,
    /// Time limit exceeded.
    Timeout,
    /// No answer.
    Failed,
}

/// Success rates of a suite.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Score {
    /// Single effects of 3 noise floors or more: number named first at the correct site, and total
    /// number.
    pub named: (usize, usize),
    /// The numbers of `named`, if the first member of a class counts as named.
    pub named_or_first_of_class: (usize, usize),
    /// The numbers of `named`, if every member of a class counts as named.
    pub named_or_class: (usize, usize),
    /// The numbers of `named` for cases with nuisances at full priors.
    pub named_at_full_priors: (usize, usize),
    /// Number of answers without a false effect, and number of cases.
    pub nothing_false: (usize, usize),
    /// Found classes: number, sum of their sizes, and largest size.
    pub class_sizes: (usize, usize, usize),
    /// Number of cases without a hidden effect but with a reported effect, and number of cases
    /// without a hidden effect.
    pub false_alarms: (usize, usize),
    /// Number of parameters of correct effects with the wrong sign.
    pub wrong_signs: usize,
    /// Number of intervals that contain the true value, and number of all intervals.
    pub intervals: (usize, usize),
    /// The corresponding numbers for refitted parameters.
    pub refitted: (usize, usize),
    /// Closures of single effects of 3 noise floors or more, with a threshold of 0.8.
    pub single_closure: Closure,
    /// Closures of pairs, with a threshold of 0.6.
    pub pair_closure: Closure,
    /// Number of pairs of which both effects were found, and number of all pairs.
    pub pairs: (usize, usize),
    /// Number of cases with inseparable effects that are reported as a class with the hidden
    /// effect, and number of all these cases.
    pub classes: (usize, usize),
    /// Number of effects outside the catalogue that are not reported as an effect of the catalogue,
    /// and number of all these effects.
    pub outside: (usize, usize),
    /// Number of cases beyond the time limit, and number of cases without an answer.
    pub without_answer: (usize, usize),
    /// Total and maximum duration, s.
    pub seconds: (f64, f64),
    /// Judgements of all cases.
    pub cases: Vec<CaseScore>,
}

/// Closures of a group of cases.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Closure {
    /// Mean of the closures.
    pub mean: f64,
    /// Number of closures above the threshold.
    pub reached: usize,
    /// Number of all closures.
    pub of: usize,
    /// Number of cases without a gap to close.
    pub without_gap: usize,
}

/// Scores the cases of a folder.
///
/// # Errors
///
/// A label or result that cannot be read.
pub fn score(out: &Path, cases: &[usize]) -> std::io::Result<Score> {
    let mut judged = Vec::new();
    for case in cases {
        let name = format!("{case:03}.json");
        let label = std::fs::read_to_string(out.join("labels").join(&name))?;
        let result = std::fs::read_to_string(out.join("results").join(&name))?;
        judged.push(judge(
            &serde_json::from_str(&label)?,
            &serde_json::from_str(&result)?,
        ));
    }
    Ok(sum_judgements(judged))
}

/// Computes the success rates of judged cases.
pub fn sum_judgements(cases: Vec<CaseScore>) -> Score {
    let large = |judged: &&CaseScore| {
        judged.group == Group::Single && judged.hidden.iter().all(|(_, _, f)| *f >= MIN_FLOORS)
    };
    let of = |group: Group| cases.iter().filter(move |judged| judged.group == group);
    let count = |group: Group, is: Judgement| {
        let right = of(group).filter(|judged| judged.judgement == is).count();
        (right, of(group).count())
    };
    let singles: Vec<&CaseScore> = cases.iter().filter(large).collect();
    let pairs: Vec<&CaseScore> = of(Group::Pair).collect();
    let are = |of: &[&CaseScore], wanted: &[Judgement]| {
        let right = of
            .iter()
            .filter(|judged| wanted.contains(&judged.judgement));
        (right.count(), of.len())
    };
    let full: Vec<&CaseScore> = singles
        .iter()
        .copied()
        .filter(|judged| judged.full_priors)
        .collect();
    let sizes = || {
        cases
            .iter()
            .flat_map(|judged| judged.classes.iter().copied())
    };
    let all = |part: fn(&CaseScore) -> (usize, usize)| {
        let add = |sum: (usize, usize), next: (usize, usize)| (sum.0 + next.0, sum.1 + next.1);
        cases.iter().map(part).fold((0, 0), add)
    };
    let ended = |is: Judgement| cases.iter().filter(|judged| judged.judgement == is).count();
    let nothing: Vec<&CaseScore> = of(Group::Nothing).collect();
    Score {
        named: are(&singles, &[Judgement::Right]),
        named_or_first_of_class: (
            singles.iter().filter(|judged| judged.is_first()).count(),
            singles.len(),
        ),
        named_or_class: are(&singles, &[Judgement::Right, Judgement::Class]),
        named_at_full_priors: are(&full, &[Judgement::Right]),
        nothing_false: (
            cases
                .iter()
                .filter(|judged| judged.has_no_false_effect())
                .count(),
            cases.len(),
        ),
        class_sizes: (sizes().count(), sizes().sum(), sizes().max().unwrap_or(0)),
        false_alarms: (
            nothing
                .iter()
                .filter(|judged| !judged.found.is_empty())
                .count(),
            nothing.len(),
        ),
        wrong_signs: cases.iter().map(|judged| judged.wrong_signs).sum(),
        intervals: all(|judged| judged.intervals),
        refitted: all(|judged| judged.refitted),
        single_closure: summarise_closures(&singles, 0.8),
        pair_closure: summarise_closures(&pairs, 0.6),
        pairs: count(Group::Pair, Judgement::Right),
        classes: count(Group::Untellable, Judgement::Right),
        outside: count(Group::Outside, Judgement::Right),
        without_answer: (ended(Judgement::Timeout), ended(Judgement::Failed)),
        seconds: (
            cases.iter().map(|judged| judged.seconds).sum(),
            cases
                .iter()
                .map(|judged| judged.seconds)
                .fold(0.0, f64::max),
        ),
        cases,
    }
}

fn summarise_closures(of: &[&CaseScore], enough: f64) -> Closure {
    let values: Vec<f64> = of.iter().filter_map(|judged| judged.closure).collect();
    Closure {
        mean: values.iter().sum::<f64>() / values.len().max(1) as f64,
        reached: values.iter().filter(|value| **value >= enough).count(),
        of: values.len(),
        without_gap: of.len() - values.len(),
    }
}
