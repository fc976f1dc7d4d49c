//! Success rates and confusion table as text.

use std::collections::BTreeMap;

use super::{CaseScore, Closure, Judgement, MIN_FLOORS, Score};
use crate::plan::Group;

/// Formats the success rates and the confusion table.
pub fn table(score: &Score) -> String {
    let mut rows: BTreeMap<String, BTreeMap<String, usize>> = BTreeMap::new();
    for judged in &score.cases {
        let (row, column) = choose_row_and_column(judged);
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
            "mean {:.2}, {} of {} reach {enough}, {} had no gap to close",
            closure.mean, closure.reached, closure.of, closure.without_gap
        )
    };
    for (name, figure) in [
        ("single effects of 3 floors named first", part(score.named)),
        (
            "... or first of a class",
            part(score.named_or_first_of_class),
        ),
        ("... or anywhere in a class", part(score.named_or_class)),
        (
            "... named, with nuisances at full priors",
            part(score.named_at_full_priors),
        ),
        ("answers without a false effect", part(score.nothing_false)),
        (
            "classes: number, mean size, largest size",
            format_sizes(score.class_sizes),
        ),
        ("false alarms", part(score.false_alarms)),
        ("wrong signs", score.wrong_signs.to_string()),
        ("90 % intervals with the true value", part(score.intervals)),
        ("... of refitted parameters", part(score.refitted)),
        (
            "closure, single effects",
            closed(&score.single_closure, 0.8),
        ),
        ("closure, pairs", closed(&score.pair_closure, 0.6)),
        ("pairs of which both effects were found", part(score.pairs)),
        (
            "inseparable effects reported as a class",
            part(score.classes),
        ),
        (
            "effects outside the catalogue, not named",
            part(score.outside),
        ),
        (
            "time limit exceeded, no answer",
            format!("{:?}", score.without_answer),
        ),
        (
            "total and longest duration, s",
            format!("{:.0}, {:.1}", score.seconds.0, score.seconds.1),
        ),
    ] {
        text += &format!("{name:<42}{figure}\n");
    }
    text
}

fn format_sizes((count, sum, largest): (usize, usize, usize)) -> String {
    match count {
        0 => "0".to_owned(),
        _ => format!("{count}, {:.1}, {largest}", sum as f64 / count as f64),
    }
}

fn choose_row_and_column(judged: &CaseScore) -> (String, String) {
    let group = format!("{:?}", judged.group).to_lowercase();
    let row = match (&judged.hidden[..], judged.group) {
        ([(effect, _, floors)], Group::Single) => {
            let size = if *floors >= MIN_FLOORS { "" } else { ", small" };
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
