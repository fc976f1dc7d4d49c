//! Summary of a result as text, for page, document and terminal. The first sentence contains the
//! result and its certainty, the following sentences the evidence.

use std::collections::BTreeMap;

use crate::catalogue::effect::effect_in_words;
use crate::report::quantity::{format_estimate, format_percent};
use crate::report::remaining_gap::{ModelStage, RemainingGap};
use crate::report::result::{
    Comparison, ConditionalSize, Discovery, EffectSite, EffectStatus, EstimateWithUnit,
    FoundEffect, Nuisance, TrainTest, Verdict,
};

/// Summary of a comparison or search.
pub(crate) struct Summary {
    /// Sentence with the result.
    pub(crate) headline: String,
    /// Sentences with the evidence.
    pub(crate) details: String,
}

impl Summary {
    /// Returns the whole summary.
    pub(crate) fn to_text(&self) -> String {
        format!("{} {}", self.headline, self.details)
    }

    /// Summarises a comparison.
    pub(crate) fn from_comparison(comparison: &Comparison) -> Self {
        let left =
            RemainingGap::from_channels(&comparison.compared.gap, ModelStage::Original).describe();
        match comparison.has_gap {
            true => Self {
                headline: "The model does not explain the records.".to_owned(),
                details: format!(
                    "Its residual is {left} (1 = a correct model). Run `eomgen discover` to find the missing \
                     effect."
                ),
            },
            false => Self {
                headline: summarise_no_gap(&comparison.compared.nuisances, "."),
                details: format!("Its residual is {left}, the level of a correct model."),
            },
        }
    }

    /// Summarises a search.
    pub(crate) fn from_discovery(discovery: &Discovery) -> Self {
        let gap = &discovery.compared.gap;
        let [before, after] = [ModelStage::Original, ModelStage::Extended]
            .map(|stage| RemainingGap::from_channels(gap, stage));
        let answer = match discovery.verdict {
            Verdict::NoSignificantGap => Self {
                headline: summarise_no_gap(
                    &discovery.compared.nuisances,
                    "; they show no missing effect.",
                ),
                details: format!(
                    "The residual is {}, the level of a correct model.",
                    after.describe()
                ),
            },
            Verdict::Unexplained => Self {
                headline: "An effect is missing, and no tested effect explains it.".to_owned(),
                details: format!(
                    "The residual on the held-out records is {} (1 = a correct model).",
                    after.describe()
                ),
            },
            Verdict::EffectsFound => summarise_effects(discovery, &before, &after),
        };
        match (&discovery.unfinished, discovery.verdict) {
            (None, _) => answer,
            (Some(unfinished), Verdict::EffectsFound) => Self {
                details: format!("{} The search reached its time limit: {unfinished}.", answer.details),
                ..answer
            },
            (Some(unfinished), _) => Self {
                headline: "An effect is missing, and the search reached its time limit before it was found."
                    .to_owned(),
                details: format!("{} State of the search: {unfinished}.", answer.details),
            },
        }
    }
}

/// Describes the refitted parameters and sensors at the bound of the fit; `None` if there are none.
fn describe_bounds(nuisances: &[Nuisance]) -> Option<String> {
    let at_bound = nuisances.iter().filter(|of| of.is_at_bound());
    let names: Vec<String> = at_bound.map(Nuisance::full_name).collect();
    let which = match &names[..] {
        [] => return None,
        [only] => only.clone(),
        [first, rest @ ..] => format!("{first} and {} more", rest.len()),
    };
    Some(format!("with {which} at the bound of the fit"))
}

/// Returns the headline for a model that explains the records. `end`: end of the sentence if no
/// nuisance is at its bound.
fn summarise_no_gap(nuisances: &[Nuisance], end: &str) -> String {
    let end = match describe_bounds(nuisances) {
        None => end.to_owned(),
        Some(at_bounds) => format!(" only {at_bounds}; a missing effect may be the cause."),
    };
    format!("The model explains the records{end}")
}

/// Summarises a search with accepted effects. If the names of the effects are not certain, the
/// headline reports this.
fn summarise_effects(
    discovery: &Discovery,
    before: &RemainingGap,
    after: &RemainingGap,
) -> Summary {
    let (found, closed) = (
        list_effects(&discovery.effects),
        describe_closure(discovery.closure),
    );
    let at_bounds = describe_bounds(&discovery.compared.nuisances);
    let held = at_bounds
        .as_ref()
        .map_or(String::new(), |at| format!(", {at}"));
    let left = after.describe();
    let is_provisional = |effect: &FoundEffect| effect.status == EffectStatus::Provisional;
    if after.is_large() || at_bounds.is_some() || discovery.effects.iter().any(is_provisional) {
        return Summary {
            headline: format!(
                "The named effects may be substitutes for others: the extended model {closed} and leaves \
                 {left}{held}."
            ),
            details: format!(
                "Found: {found}. The residual before the search was {} (1 = a correct model).",
                before.describe()
            ),
        };
    }
    Summary {
        headline: format!("Found: {found}."),
        details: format!(
            "The extended model {closed}. {}{}.",
            before.describe_fall_to(after),
            after.explain_level()
        ),
    }
}

/// Describes the closure on held-out records.
fn describe_closure(closure: TrainTest<Option<f64>>) -> String {
    match closure.test {
        Some(part) if part > 0.0 => format!(
            "closes {} of the gap between model and measurement on held-out records",
            format_percent(part)
        ),
        Some(_) => "closes none of the gap on held-out records".to_owned(),
        None => "had almost no gap to close".to_owned(),
    }
}

/// Joins the effects for use in a sentence.
fn list_effects(effects: &[FoundEffect]) -> String {
    let named: Vec<String> = effects.iter().map(name_effect).collect();
    match &named[..] {
        [all @ .., last] if !all.is_empty() => format!("{} and {last}", all.join(", ")),
        all => all.concat(),
    }
}

/// Describes an effect with its size and the effects that are inseparable from it.
fn name_effect(effect: &FoundEffect) -> String {
    let mut text = describe_with_sizes(&effect.at, &effect.parameters);
    if effect.status == EffectStatus::Class && !effect.equivalents.is_empty() {
        let others = effect.equivalents.iter();
        let others = others.map(|other| describe_with_sizes(&other.at, &other.parameters));
        let others: Vec<String> = others.collect();
        text += &format!(
            " (or {}; the records do not separate them)",
            others.join(", or ")
        );
    }
    text
}

/// Describes an effect with its sizes.
pub(crate) fn describe_with_sizes(
    at: &EffectSite,
    sizes: &BTreeMap<String, EstimateWithUnit>,
) -> String {
    let sizes = sizes
        .iter()
        .map(|(name, of)| format!("{name} = {}", format_estimate(of.value, of.sd, &of.unit)));
    let sizes: Vec<String> = sizes.collect();
    match sizes.is_empty() {
        true => describe_with_order(at),
        false => format!("{}, {}", describe_with_order(at), sizes.join(" and ")),
    }
}

/// Describes the size of an effect with a member of the class of another effect.
pub(crate) fn describe_conditional(of: &ConditionalSize) -> String {
    format!(
        "{} = {} with {} in place of {}",
        of.parameter,
        format_estimate(of.size.value, of.size.sd, &of.size.unit),
        describe_with_order(&of.with),
        describe_with_order(&of.in_place_of)
    )
}

/// Returns name, site and order of an effect in words.
pub(crate) fn describe_with_order(at: &EffectSite) -> String {
    match &at.order {
        Some(order) => format!(
            "{} ({} per turn of {})",
            describe_effect(at),
            order.order,
            order.angle
        ),
        None => describe_effect(at),
    }
}

/// Returns name and site of an effect in words.
pub(crate) fn describe_effect(at: &EffectSite) -> String {
    format!("{} on {}", effect_in_words(&at.effect), at.site)
}
