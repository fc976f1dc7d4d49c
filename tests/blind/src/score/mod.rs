//! Comparison of results with labels: the judgement of every case and the success rates - correct
//! effects at the correct place, false alarms, wrong signs, intervals, closures, classes.

mod judge;
mod table;

use std::path::Path;

use serde::Serialize;

use crate::plan::Group;

pub use judge::judge;
pub use table::table;

/// Minimum size, in noise floors, of effects that must be found: three, minus the accuracy of the
/// sizes.
pub const MIN_FLOORS: f64 = 2.85;

/// Judgement of a case.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Judged {
    /// Number of the case.
    pub case: usize,
    /// Group.
    pub group: Group,
    /// Hidden effects with places and sizes in noise floors.
    pub hidden: Vec<(String, String, f64)>,
    /// Found effects with places and status.
    pub found: Vec<(String, String, String)>,
    /// Judgement.
    pub judgement: Judgement,
    /// True if all nuisances are at full priors.
    pub full_priors: bool,
    /// Number of effects in each found class.
    pub classes: Vec<usize>,
    /// Number of accepted effects that are not hidden.
    pub extra: usize,
    /// Number of parameters of correct effects with the wrong sign.
    pub wrong_signs: usize,
    /// Number of intervals of correct effects' parameters with the true value, and their total.
    pub intervals: (usize, usize),
    /// The same for refitted parameters.
    pub refitted: (usize, usize),
    /// Closure on held-out records: `None` if the answer reports no gap, zero if there is no
    /// answer.
    pub closure: Option<f64>,
    /// Duration, s.
    pub seconds: f64,
}

impl Judged {
    /// Returns true if there is an answer without a false effect: every effect, if any, is hidden
    /// or is a class with a hidden one, with the correct sign.
    pub fn has_no_false_effect(&self) -> bool {
        let is_answer = !matches!(self.judgement, Judgement::Timeout | Judgement::Failed);
        is_answer && self.extra == 0 && self.wrong_signs == 0
    }

    /// Returns true if the hidden effect is first in the answer, by itself or as the first of its
    /// class.
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
    /// All hidden effects are named first; nothing, if nothing is hidden; or a class, if the record
    /// cannot distinguish its members.
    Right,
    /// A class with the hidden effect, although it could be distinguished.
    Class,
    /// A part of the hidden effects.
    Part,
    /// Other effects.
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
    /// Single effects of 3 floors or more: named first at their place, and their total.
    pub named: (usize, usize),
    /// The same, counting the first effect of a class.
    pub named_or_first_of_class: (usize, usize),
    /// The same, counting any class that contains the effect.
    pub named_or_class: (usize, usize),
    /// The same as `named`, only with nuisances at full priors.
    pub named_at_full_priors: (usize, usize),
    /// Answers without a false effect, and the number of cases.
    pub nothing_false: (usize, usize),
    /// Found classes: their number, the sum of their sizes, and the largest.
    pub class_sizes: (usize, usize, usize),
    /// Cases with nothing hidden and a reported effect, and their total.
    pub false_alarms: (usize, usize),
    /// Parameters of correct effects with the wrong sign.
    pub wrong_signs: usize,
    /// Intervals that contain the true value, and their total.
    pub intervals: (usize, usize),
    /// Intervals of refitted parameters.
    pub refitted: (usize, usize),
    /// Single effects of 3 floors or more: closures, with a threshold of 0.8.
    pub single_closure: Closure,
    /// Pairs: closures, with a threshold of 0.6.
    pub pair_closure: Closure,
    /// Pairs of which both effects were found, and their total.
    pub pairs: (usize, usize),
    /// Indistinguishable cases reported as a class with the effect, and their total.
    pub classes: (usize, usize),
    /// Effects outside the catalogue that were not named as one of it, and their total.
    pub outside: (usize, usize),
    /// Cases beyond the time limit, and cases without an answer.
    pub without_answer: (usize, usize),
    /// Total and maximum duration, s.
    pub seconds: (f64, f64),
    /// Judgements of all cases.
    pub cases: Vec<Judged>,
}

/// Closures of a group.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Closure {
    /// Mean of the closures.
    pub mean: f64,
    /// Number of closures above the threshold.
    pub reached: usize,
    /// Number of closures.
    pub of: usize,
    /// Number of cases without a gap to close.
    pub without_gap: usize,
}

/// Scores the cases of a folder.
///
/// # Errors
/// Returns an error if a label or result cannot be read.
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

/// Sums the judgements of cases.
pub fn sum_judgements(cases: Vec<Judged>) -> Score {
    let large = |judged: &&Judged| {
        judged.group == Group::Single && judged.hidden.iter().all(|(_, _, f)| *f >= MIN_FLOORS)
    };
    let of = |group: Group| cases.iter().filter(move |judged| judged.group == group);
    let count = |group: Group, is: Judgement| {
        let right = of(group).filter(|judged| judged.judgement == is).count();
        (right, of(group).count())
    };
    let singles: Vec<&Judged> = cases.iter().filter(large).collect();
    let pairs: Vec<&Judged> = of(Group::Pair).collect();
    let are = |of: &[&Judged], wanted: &[Judgement]| {
        let right = of
            .iter()
            .filter(|judged| wanted.contains(&judged.judgement));
        (right.count(), of.len())
    };
    let full: Vec<&Judged> = singles
        .iter()
        .copied()
        .filter(|judged| judged.full_priors)
        .collect();
    let sizes = || {
        cases
            .iter()
            .flat_map(|judged| judged.classes.iter().copied())
    };
    let all = |part: fn(&Judged) -> (usize, usize)| {
        let add = |sum: (usize, usize), next: (usize, usize)| (sum.0 + next.0, sum.1 + next.1);
        cases.iter().map(part).fold((0, 0), add)
    };
    let ended = |is: Judgement| cases.iter().filter(|judged| judged.judgement == is).count();
    let nothing: Vec<&Judged> = of(Group::Nothing).collect();
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
        single_closure: closure(&singles, 0.8),
        pair_closure: closure(&pairs, 0.6),
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

fn closure(of: &[&Judged], enough: f64) -> Closure {
    let values: Vec<f64> = of.iter().filter_map(|judged| judged.closure).collect();
    Closure {
        mean: values.iter().sum::<f64>() / values.len().max(1) as f64,
        reached: values.iter().filter(|value| **value >= enough).count(),
        of: values.len(),
        without_gap: of.len() - values.len(),
    }
}
