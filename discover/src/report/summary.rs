//! Summary of a result for the page, the document and the terminal: first the result and its
//! certainty, then the evidence.

use crate::report::left::{Left, Stage};
use crate::report::quantity::{estimate, percent};
use crate::report::result::{
    Comparison, Discovery, EffectAt, FoundEffect, Nuisance, OnRecords, Status, Verdict,
};

/// The first sentence and the following ones.
pub(crate) struct Summary {
    /// First sentence.
    pub(crate) first: String,
    /// Following sentences.
    pub(crate) rest: String,
}

impl Summary {
    /// Returns both parts.
    pub(crate) fn text(&self) -> String {
        format!("{} {}", self.first, self.rest)
    }

    /// Summarises a comparison.
    pub(crate) fn of_comparison(comparison: &Comparison) -> Self {
        let left = Left::of(&comparison.compared.gap, Stage::Before).words();
        match comparison.has_gap {
            true => Self {
                first: "The model does not explain the records.".to_owned(),
                rest: format!(
                    "It leaves {left}; a right model leaves one. What is missing is for `eomgen discover` to find."
                ),
            },
            false => Self {
                first: explained(&comparison.compared.nuisances, "."),
                rest: format!("It leaves {left}, no more than a right model would."),
            },
        }
    }

    /// Summarises a search.
    pub(crate) fn of_discovery(discovery: &Discovery) -> Self {
        let gap = &discovery.compared.gap;
        let [before, after] = [Stage::Before, Stage::After].map(|stage| Left::of(gap, stage));
        let answer = match discovery.verdict {
            Verdict::NoSignificantGap => Self {
                first: explained(
                    &discovery.compared.nuisances,
                    "; nothing is missing that they could show.",
                ),
                rest: format!(
                    "It leaves {}, no more than a right model would.",
                    after.words()
                ),
            },
            Verdict::Unexplained => Self {
                first: "Something is missing, and nothing that was tried explains it.".to_owned(),
                rest: format!(
                    "The model leaves {} on the held-out records; a right model leaves one.",
                    after.words()
                ),
            },
            Verdict::EffectsFound => found(discovery, &before, &after),
        };
        match (&discovery.unfinished, discovery.verdict) {
            (None, _) => answer,
            (Some(unfinished), Verdict::EffectsFound) => Self {
                rest: format!("{} The search was ended by its limit: {unfinished}.", answer.rest),
                ..answer
            },
            (Some(unfinished), _) => Self {
                first: "Something is missing, and the search was ended by its limit before it was found."
                    .to_owned(),
                rest: format!("{} What is known: {unfinished}.", answer.rest),
            },
        }
    }
}

/// What was fitted beside and is as far off as the fit admits; none if nothing is.
fn at_bounds(nuisances: &[Nuisance]) -> Option<String> {
    let at_bound = nuisances.iter().filter(|of| of.is_at_bound());
    let names: Vec<String> = at_bound.map(Nuisance::name).collect();
    let which = match &names[..] {
        [] => return None,
        [only] => only.clone(),
        [first, rest @ ..] => format!("{first} and {} more", rest.len()),
    };
    Some(format!("with {which} as far off as the fit admits"))
}

/// The first sentence of a model that explains the records: how it ends where nothing is at its bounds.
fn explained(nuisances: &[Nuisance], end: &str) -> String {
    let end = match at_bounds(nuisances) {
        None => end.to_owned(),
        Some(at_bounds) => format!(" only {at_bounds}: what is missing may look like that."),
    };
    format!("The model explains the records{end}")
}

/// Of a search that found something: where that is not sure, this is said first.
fn found(discovery: &Discovery, before: &Left, after: &Left) -> Summary {
    let (found, closed) = (listed(&discovery.effects), closed(discovery.closure));
    let at_bounds = at_bounds(&discovery.compared.nuisances);
    let held = at_bounds
        .as_ref()
        .map_or(String::new(), |at| format!(", {at}"));
    let left = after.words();
    if after.is_much() || at_bounds.is_some() {
        return Summary {
            first: format!(
                "What was found {closed}; {left} are left{held}: what is named may stand in for something else."
            ),
            rest: format!(
                "Found: {found}. {} were left before; a right model leaves one.",
                before.words()
            ),
        };
    }
    Summary {
        first: format!("Found: {found}."),
        rest: format!(
            "It {closed}. {} were left before, {left} after{}.",
            before.words(),
            after.meaning()
        ),
    }
}

/// How much of the gap is closed on the records held out.
fn closed(closure: OnRecords<Option<f64>>) -> String {
    match closure.test {
        Some(part) if part > 0.0 => format!(
            "closes {} of the gap between model and measurement on records that were held out",
            percent(part)
        ),
        Some(_) => "closes nothing of the gap on records that were held out".to_owned(),
        None => "had hardly a gap to close".to_owned(),
    }
}

/// Effects in a sentence.
fn listed(effects: &[FoundEffect]) -> String {
    let named: Vec<String> = effects.iter().map(named).collect();
    match &named[..] {
        [all @ .., last] if !all.is_empty() => format!("{} and {last}", all.join(", ")),
        all => all.concat(),
    }
}

/// An effect with its size; with what the records do not tell from it.
fn named(effect: &FoundEffect) -> String {
    let sizes = effect.parameters.iter();
    let sizes = sizes.map(|(name, of)| format!("{name} = {}", estimate(of.value, of.sd, &of.unit)));
    let sizes: Vec<String> = sizes.collect();
    let mut text = words(&effect.at);
    if !sizes.is_empty() {
        text += &format!(", {}", sizes.join(" and "));
    }
    if effect.status == Status::Class && !effect.equivalent.is_empty() {
        let others: Vec<String> = effect.equivalent.iter().map(words).collect();
        text += &format!(
            " (or {}, which these records do not tell from it)",
            others.join(", or ")
        );
    }
    text
}

/// Returns name and site of an effect as words.
pub(crate) fn words(at: &EffectAt) -> String {
    format!("{} on {}", at.effect.replace('_', " "), at.on)
}
