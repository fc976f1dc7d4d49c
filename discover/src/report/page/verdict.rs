//! The verdict in words: what was found, how much of the gap it closes, and what is left in noise
//! floors.

use maud::{Markup, html};

use crate::report::quantity::{estimate, percent, plain};
use crate::report::result::{
    Compared, Comparison, Discovery, EffectAt, FoundEffect, OnRecords, Status, Verdict,
};

/// What leaves more floors than this may be something else than what it is called.
const MAY_STAND_IN: f64 = 3.0;

/// The most a right model leaves, in floors, as it is counted here: noise is drawn anew in each
/// record.
const ONE_FLOOR: f64 = 1.5;

pub(super) fn of_comparison(comparison: &Comparison) -> Markup {
    let left = Left::of(&comparison.compared, Stage::Before);
    html! {
        p.verdict {
            @if comparison.has_gap {
                strong { "The model does not explain the records." }
                " It leaves " (left.words()) "; a right model leaves one. What is missing is for "
                code { "eomgen discover" } " to find."
            } @else {
                strong { "The model explains the records." }
                " It leaves " (left.words()) ", no more than a right model would."
            }
        }
    }
}

pub(super) fn of_discovery(discovery: &Discovery) -> Markup {
    let compared = &discovery.compared;
    let [before, after] = [Stage::Before, Stage::After].map(|stage| Left::of(compared, stage));
    match discovery.verdict {
        Verdict::NoSignificantGap => html! {
            p.verdict {
                strong { "The model explains the records; nothing is missing that they could show." }
                " It leaves " (after.words()) ", no more than a right model would."
            }
        },
        Verdict::Unexplained => html! {
            p.verdict {
                strong { "Something is missing, and nothing that was tried explains it." }
                " The model leaves " (after.words()) " on the held-out records; a right model leaves one."
            }
        },
        Verdict::EffectsFound => html! {
            p.verdict {
                strong { "Found: " (listed(&discovery.effects)) "." }
                " " (closed(discovery.closure)) " " (before.words()) " were left before, "
                (after.words()) " after" (after.meaning()) "."
            }
            @if after.floors > MAY_STAND_IN || !after.floors.is_finite() {
                p.warning {
                    "Much is left: what is named may stand in for something else."
                }
            }
        },
    }
}

/// How much of the gap is closed on the records held out.
fn closed(closure: OnRecords<Option<f64>>) -> String {
    match closure.test {
        Some(part) => format!(
            "It closes {} of the gap between model and measurement on records that were held out.",
            percent(part)
        ),
        None => "There was hardly a gap to close.".to_owned(),
    }
}

/// Effects in a sentence.
fn listed(effects: &[FoundEffect]) -> Markup {
    html! {
        @for (place, effect) in effects.iter().enumerate() {
            @match place {
                0 => {},
                place if place + 1 == effects.len() => { " and " },
                _ => { ", " },
            }
            (named(effect))
        }
    }
}

/// An effect with its size; with what the records do not tell from it.
fn named(effect: &FoundEffect) -> Markup {
    html! {
        (words(&effect.at))
        @for (place, (name, of)) in effect.parameters.iter().enumerate() {
            @if place == 0 { ", " } @else { " and " }
            (name) " = " (estimate(of.value, of.sd, &of.unit))
        }
        @if effect.status == Status::Class && !effect.equivalent.is_empty() {
            " (or " (effect.equivalent.iter().map(words).collect::<Vec<String>>().join(", or "))
            ", which these records do not tell from it)"
        }
    }
}

/// An effect's name as words, and its place.
pub(super) fn words(at: &EffectAt) -> String {
    format!("{} on {}", at.effect.replace('_', " "), at.on)
}

/// Of which model something is left.
#[derive(Clone, Copy)]
enum Stage {
    Before,
    After,
}

/// What is left of the channel of which most is left on the test records, in noise floors.
struct Left {
    floors: f64,
    channel: String,
    is_only: bool,
}

impl Left {
    fn of(compared: &Compared, stage: Stage) -> Self {
        let floors = compared.gap.iter().map(|(name, gap)| {
            let left = match (stage, gap.after) {
                (Stage::After, Some(after)) => after.test,
                _ => gap.before.test,
            };
            (left / gap.floor, name)
        });
        let worst = floors.max_by(|a, b| a.0.total_cmp(&b.0));
        let (floors, channel) = worst.map_or((f64::NAN, String::new()), |(f, n)| (f, n.clone()));
        let is_only = compared.gap.len() < 2;
        Self {
            floors,
            channel,
            is_only,
        }
    }

    fn words(&self) -> String {
        let floors = match self.floors {
            floors if floors.is_nan() => return "an unknown part".to_owned(),
            floors if floors.is_infinite() => return "a motion that cannot be followed".to_owned(),
            floors if floors < 10.0 => format!("{floors:.1}"),
            floors => plain(floors, 2),
        };
        match self.is_only {
            true => format!("{floors} noise floors"),
            false => format!("{floors} noise floors in {}", self.channel),
        }
    }

    fn meaning(&self) -> &'static str {
        match self.floors < ONE_FLOOR {
            true => ", about what a right model leaves",
            false => "; a right model leaves one",
        }
    }
}
