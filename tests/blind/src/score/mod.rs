//! Results against labels: which verdict every effect got, and the figures that count - right
//! effects at the right place, false alarms, wrong signs, intervals, closures, classes.

mod judge;
mod table;

use std::path::Path;

use serde::Serialize;

use crate::plan::Group;

pub use judge::judge;
pub use table::table;

/// Effects below so many floors need not be found: three, as near as sizes are sought.
pub const FLOORS: f64 = 2.85;

/// How a case was judged.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Judged {
    /// Its number.
    pub case: usize,
    /// What kind of case it is.
    pub group: Group,
    /// What is hidden: effects, places and floors.
    pub hidden: Vec<(String, String, f64)>,
    /// What was found: effects, places and how sure.
    pub found: Vec<(String, String, String)>,
    /// In a word.
    pub judgement: Judgement,
    /// Whether everything else is off as the priors say.
    pub full_priors: bool,
    /// How many effects each class that was found holds.
    pub classes: Vec<usize>,
    /// How many accepted effects are none of those hidden.
    pub extra: usize,
    /// How many parameters of right effects have the other sign.
    pub wrong_signs: usize,
    /// Intervals of right effects' parameters that hold the true value, and all of them.
    pub intervals: (usize, usize),
    /// The same for refitted parameters.
    pub refitted: (usize, usize),
    /// Closure on held-out records: none where an answer says that there was no gap to close,
    /// nothing where there is no answer.
    pub closure: Option<f64>,
    /// How long it took, s.
    pub seconds: f64,
}

impl Judged {
    /// Whether there is an answer, and every effect in it is one that is hidden, or a class that holds
    /// one, with the right sign; an answer that names nothing too.
    pub fn says_nothing_false(&self) -> bool {
        let is_answer = !matches!(self.judgement, Judgement::Timeout | Judgement::Failed);
        is_answer && self.extra == 0 && self.wrong_signs == 0
    }

    /// Whether what is hidden stands first in the answer, alone or before what is not told from it.
    fn is_first(&self) -> bool {
        let is_right = matches!(self.judgement, Judgement::Right | Judgement::Class);
        let mut pairs = self.hidden.iter().zip(&self.found);
        let is_same = |(hidden, found): (&(String, String, f64), &(String, String, String))| {
            (&hidden.0, &hidden.1) == (&found.0, &found.1)
        };
        is_right && pairs.all(is_same)
    }
}

/// A case in a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Judgement {
    /// Everything hidden was named, first of all; nothing where there is nothing; a class
    /// where nothing better can be said.
    Right,
    /// A class that holds what was hidden, though it could be told.
    Class,
    /// A part of what was hidden.
    Part,
    /// Something else.
    Wrong,
    /// No gap was seen.
    Missed,
    /// A gap was seen, not named.
    Unexplained,
    /// It took too long.
    Timeout,
    /// No answer.
    Failed,
}

/// The figures of a suite.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Score {
    /// Single effects of 3 floors or more: named first at their place, and all of them.
    pub named: (usize, usize),
    /// The same, where the first of a class is enough.
    pub named_or_first_of_class: (usize, usize),
    /// The same, where a class that holds the effect is enough.
    pub named_or_class: (usize, usize),
    /// Those of the first with everything else off as the priors say.
    pub named_at_full_priors: (usize, usize),
    /// Answers with nothing false in them, and all cases.
    pub nothing_false: (usize, usize),
    /// Classes that were found: how many, how many effects they hold in all, and the largest.
    pub class_sizes: (usize, usize, usize),
    /// Cases with nothing hidden in which an effect was reported, and all of them.
    pub false_alarms: (usize, usize),
    /// Parameters of right effects with the wrong sign.
    pub wrong_signs: usize,
    /// Intervals that hold the true value, and all of them.
    pub intervals: (usize, usize),
    /// Intervals of refitted parameters.
    pub refitted: (usize, usize),
    /// Single effects of 3 floors or more: mean closure, those of 0.8 or more, all that had a
    /// gap, and those that had none.
    pub single_closure: Closure,
    /// Pairs: the same with 0.6.
    pub pair_closure: Closure,
    /// Pairs of which both were found, and all of them.
    pub pairs: (usize, usize),
    /// Untellable cases reported as a class that holds the effect, and all of them.
    pub classes: (usize, usize),
    /// Effects outside the catalogue that got no name of it, and all of them.
    pub outside: (usize, usize),
    /// Cases that took too long, and those without an answer.
    pub without_answer: (usize, usize),
    /// Seconds: in all, and the longest.
    pub seconds: (f64, f64),
    /// Every case.
    pub cases: Vec<Judged>,
}

/// Closures of a group.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Closure {
    /// Their mean where there is one.
    pub mean: f64,
    /// How many reach what they should.
    pub reached: usize,
    /// Of how many that have one.
    pub of: usize,
    /// How many have none: there was no gap to close.
    pub without_gap: usize,
}

/// Scores the cases of a folder.
///
/// # Errors
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
    Ok(summed(judged))
}

/// Sums up judged cases.
pub fn summed(cases: Vec<Judged>) -> Score {
    let large = |judged: &&Judged| {
        judged.group == Group::Single && judged.hidden.iter().all(|(_, _, f)| *f >= FLOORS)
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
                .filter(|judged| judged.says_nothing_false())
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
