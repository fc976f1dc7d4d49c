//! Results against labels: which verdict every effect got, and the figures that count - right
//! effects at the right place, false alarms, wrong signs, intervals, closures, classes.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;
use serde_json::Value;

use crate::hidden::Effect;
use crate::plan::Group;
use crate::records::{Label, Truth};
use crate::run::{Ending, Outcome};

/// Effects below so many floors need not be found.
pub const FLOORS: f64 = 2.9;

/// Half of a 90 % interval, in standard deviations.
const NINETY: f64 = 1.645;

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
    /// How many accepted effects are none of those hidden.
    pub extra: usize,
    /// How many parameters of right effects have the other sign.
    pub wrong_signs: usize,
    /// Intervals of right effects' parameters that hold the true value, and all of them.
    pub intervals: (usize, usize),
    /// The same for refitted parameters.
    pub refitted: (usize, usize),
    /// Closure on held-out records.
    pub closure: Option<f64>,
    /// How long it took, s.
    pub seconds: f64,
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
    /// The same, where a class that holds the effect is enough.
    pub named_or_class: (usize, usize),
    /// Cases with nothing hidden in which an effect was reported, and all of them.
    pub false_alarms: (usize, usize),
    /// Parameters of right effects with the wrong sign.
    pub wrong_signs: usize,
    /// Intervals that hold the true value, and all of them.
    pub intervals: (usize, usize),
    /// Intervals of refitted parameters.
    pub refitted: (usize, usize),
    /// Single effects of 3 floors or more: mean closure of the answered, those of 0.8 or more,
    /// and all of them.
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
    /// Their mean, an absent one counted as 0.
    pub mean: f64,
    /// How many reach what they should.
    pub reached: usize,
    /// Of how many.
    pub of: usize,
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
    let are = |wanted: &[Judgement]| {
        let right = singles
            .iter()
            .filter(|judged| wanted.contains(&judged.judgement));
        (right.count(), singles.len())
    };
    let all = |part: fn(&Judged) -> (usize, usize)| {
        let add = |sum: (usize, usize), next: (usize, usize)| (sum.0 + next.0, sum.1 + next.1);
        cases.iter().map(part).fold((0, 0), add)
    };
    let ended = |is: Judgement| cases.iter().filter(|judged| judged.judgement == is).count();
    let nothing: Vec<&Judged> = of(Group::Nothing).collect();
    Score {
        named: are(&[Judgement::Right]),
        named_or_class: are(&[Judgement::Right, Judgement::Class]),
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
    let values = || of.iter().map(|judged| judged.closure.unwrap_or(0.0));
    Closure {
        mean: values().sum::<f64>() / of.len().max(1) as f64,
        reached: values().filter(|value| *value >= enough).count(),
        of: of.len(),
    }
}

/// Judges one case.
pub fn judge(label: &Label, outcome: &Outcome) -> Judged {
    let empty = Vec::new();
    let discovery = outcome.discovery.as_ref();
    let list = |key: &str| discovery.and_then(|d| d[key].as_array()).unwrap_or(&empty);
    let effects = list("effects");
    let mut judged = Judged {
        case: label.case,
        group: label.group,
        hidden: (label.hidden.iter())
            .map(|t| (t.effect.clone(), t.hidden.on.clone(), t.floors))
            .collect(),
        found: effects
            .iter()
            .map(|e| (word(e, "effect"), word(e, "on"), word(e, "status")))
            .collect(),
        judgement: judgement(label, outcome, effects),
        extra: 0,
        wrong_signs: 0,
        intervals: (0, 0),
        refitted: (0, 0),
        closure: discovery.and_then(|d| d["closure"]["test"].as_f64()),
        seconds: outcome.seconds,
    };
    for found in effects {
        match label
            .hidden
            .iter()
            .find(|truth| is(found, truth) == Match::Named)
        {
            Some(truth) => check(truth, found, &mut judged),
            None if label
                .hidden
                .iter()
                .any(|truth| is(found, truth) == Match::Class) => {}
            None => judged.extra += 1,
        }
    }
    if let Some(discovery) = discovery {
        judged.refitted = refitted(label, discovery);
    }
    judged
}

fn judgement(label: &Label, outcome: &Outcome, effects: &[Value]) -> Judgement {
    match outcome.ending {
        Ending::Timeout => return Judgement::Timeout,
        Ending::Failed => return Judgement::Failed,
        Ending::Answered if outcome.discovery.is_none() => return Judgement::Failed,
        Ending::Answered => {}
    }
    let empirical = |e: &Value| word(e, "status") == "empirical";
    match (label.group, effects) {
        (Group::Nothing, []) => return Judgement::Right,
        (Group::Outside, found) if found.iter().all(empirical) => {
            let verdict = outcome.discovery.as_ref().map(|d| word(d, "verdict"));
            return match verdict.as_deref() {
                Some("no_significant_gap") => Judgement::Missed,
                _ => Judgement::Right,
            };
        }
        (Group::Outside | Group::Nothing, _) => return Judgement::Wrong,
        (_, []) => {
            let verdict = outcome.discovery.as_ref().map(|d| word(d, "verdict"));
            return match verdict.as_deref() {
                Some("no_significant_gap") => Judgement::Missed,
                _ => Judgement::Unexplained,
            };
        }
        _ => {}
    }
    let count = label.hidden.len();
    let matches: Vec<Match> = (label.hidden.iter())
        .map(|truth| {
            let first = effects.iter().take(count).map(|found| is(found, truth));
            first.max().unwrap_or(Match::None)
        })
        .collect();
    let needs_class = label.group == Group::Untellable;
    if matches.contains(&Match::None) {
        let some = matches.iter().any(|m| *m != Match::None);
        return if some {
            Judgement::Part
        } else {
            Judgement::Wrong
        };
    }
    let as_can_be = |(m, truth): (&Match, &Truth)| match m {
        Match::Named => !needs_class,
        Match::Class => needs_class || !truth.alike.is_empty(),
        Match::None => false,
    };
    if matches.iter().zip(&label.hidden).all(as_can_be) {
        Judgement::Right
    } else if needs_class {
        Judgement::Part
    } else {
        Judgement::Class
    }
}

/// How an accepted effect agrees with a hidden one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Match {
    None,
    /// A class that holds it.
    Class,
    Named,
}

fn is(found: &Value, truth: &Truth) -> Match {
    let same = |entry: &Value| {
        word(entry, "effect") == truth.effect && word(entry, "on") == truth.hidden.on
    };
    let equivalent = found["equivalent"].as_array().into_iter().flatten();
    let class = word(found, "status") == "class";
    if class && (same(found) || equivalent.into_iter().any(same)) {
        Match::Class
    } else if !class && same(found) {
        Match::Named
    } else {
        Match::None
    }
}

/// Signs and intervals of a right effect's parameters, which stand in the order of names.
fn check(truth: &Truth, found: &Value, judged: &mut Judged) {
    let Some(parameters) = found["parameters"].as_object() else {
        return;
    };
    if parameters.len() != truth.parameters.len() {
        return;
    }
    for (entry, expected) in parameters.values().zip(&truth.parameters) {
        let (Some(value), Some(sd)) = (entry["value"].as_f64(), entry["sd"].as_f64()) else {
            continue;
        };
        // A cosine or sine that happens to be small may well come out on the other side.
        let clear = expected.abs() > NINETY * 2.0 * sd;
        judged.wrong_signs += usize::from(clear && value * expected < 0.0);
        judged.intervals.0 += usize::from((value - expected).abs() <= NINETY * sd);
        judged.intervals.1 += 1;
    }
}

/// Intervals of the declared parameters where everything hidden was found.
fn refitted(label: &Label, discovery: &Value) -> (usize, usize) {
    let mut counts = (0, 0);
    let shifted = |name: &str| {
        let of = |t: &Truth| t.hidden.effect == Effect::ParameterShift && t.hidden.on == name;
        label.hidden.iter().any(of)
    };
    for (name, factor) in &label.declared {
        let entry = &discovery["refitted"][name];
        let nominal = nominal(label, name);
        let (Some(value), Some(sd), Some(nominal)) =
            (entry["value"].as_f64(), entry["sd"].as_f64(), nominal)
        else {
            continue;
        };
        if !shifted(name) && label.hidden.is_empty() {
            counts.0 += usize::from((value - factor * nominal).abs() <= NINETY * sd);
            counts.1 += 1;
        }
    }
    counts
}

/// What a specification says of a declared parameter, in its unit.
fn nominal(label: &Label, name: &str) -> Option<f64> {
    use crate::machines::Machine;
    match (label.machine.nominal(), name) {
        (Machine::Arm(arm), "b_m") => Some(arm.b_m),
        (Machine::Stage(stage), "M") => Some(stage.mass),
        (Machine::Stage(stage), "F_v") => Some(stage.viscous),
        (Machine::Pendulum(pendulum), "k") => Some(pendulum.viscous),
        (Machine::Pendulum(pendulum), "I") => Some(pendulum.inertia),
        _ => None,
    }
}

fn word(value: &Value, key: &str) -> String {
    value[key].as_str().unwrap_or_default().to_owned()
}

/// The figures and the confusion table as text.
pub fn table(score: &Score) -> String {
    let mut rows: BTreeMap<String, BTreeMap<String, usize>> = BTreeMap::new();
    for judged in &score.cases {
        let (row, column) = place(judged);
        *rows.entry(row).or_default().entry(column).or_default() += 1;
    }
    let mut text = "hidden                                    found\n".to_owned();
    for (row, columns) in rows {
        let list: Vec<String> = columns
            .iter()
            .map(|(name, n)| format!("{n} {name}"))
            .collect();
        text += &format!("{row:<42}{}\n", list.join(", "));
    }
    let part = |(a, b): (usize, usize)| {
        format!("{a} of {b} ({:.0} %)", 100.0 * a as f64 / b.max(1) as f64)
    };
    let closed = |closure: &Closure, enough: f64| {
        format!(
            "mean {:.2}, {} of {} reach {enough}",
            closure.mean, closure.reached, closure.of
        )
    };
    for (name, figure) in [
        ("single effects of 3 floors named first", part(score.named)),
        ("... or in a class", part(score.named_or_class)),
        ("false alarms", part(score.false_alarms)),
        ("wrong signs", score.wrong_signs.to_string()),
        ("90 % intervals that hold", part(score.intervals)),
        ("... of refitted parameters", part(score.refitted)),
        (
            "closure, single effects",
            closed(&score.single_closure, 0.8),
        ),
        ("closure, pairs", closed(&score.pair_closure, 0.6)),
        ("pairs found whole", part(score.pairs)),
        ("untellable reported as a class", part(score.classes)),
        ("outside the catalogue, not named", part(score.outside)),
        ("too long, no answer", format!("{:?}", score.without_answer)),
        (
            "seconds in all, longest",
            format!("{:.0}, {:.1}", score.seconds.0, score.seconds.1),
        ),
    ] {
        text += &format!("{name:<42}{figure}\n");
    }
    text
}

/// The row and column of a case in the table.
fn place(judged: &Judged) -> (String, String) {
    let group = format!("{:?}", judged.group).to_lowercase();
    let row = match (&judged.hidden[..], judged.group) {
        ([(effect, _, floors)], Group::Single) => {
            let size = if *floors >= FLOORS { "" } else { ", small" };
            format!("{effect}{size}")
        }
        ([(effect, ..)], _) => format!("{group}: {effect}"),
        _ => group,
    };
    let found: Vec<String> = judged
        .found
        .iter()
        .map(|(effect, on, _)| format!("{effect} on {on}"))
        .collect();
    let column = match judged.judgement {
        Judgement::Wrong | Judgement::Part => found.join(" and "),
        other => format!("{other:?}").to_lowercase(),
    };
    (row, column)
}
