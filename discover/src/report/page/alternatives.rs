//! Tables of rejected and untestable effects, grouped by reason.

use eomgen_page::{prose, section, table};
use maud::{Markup, html};

use crate::catalogue::effect::effect_in_words;
use crate::experiment::next_experiment::{ExperimentFile, NextExperiment};
use crate::report::experiment::describe_experiment;
use crate::report::quantity::format_readable;
use crate::report::result::{EffectSite, RejectedEffect};
use crate::report::summary::describe_effect;

/// Number of rows that are always visible; further rows are folded.
const VISIBLE_ROW_COUNT: usize = 8;

/// Effects with the same reason or experiment.
struct Group<'a> {
    effects: Vec<&'a EffectSite>,
    reason: &'a str,
    experiment: &'a str,
    /// Computed experiments.
    next: Vec<&'a NextExperiment>,
}

impl<'a> Group<'a> {
    /// Groups the effects by `key`, in the order of their first effects.
    fn group_by<K: PartialEq>(
        list: &'a [RejectedEffect],
        key: impl Fn(&'a RejectedEffect) -> K,
    ) -> Vec<Self> {
        let mut groups: Vec<(K, Self)> = Vec::new();
        for of in list {
            let own = key(of);
            match groups.iter_mut().find(|(known, _)| *known == own) {
                Some((_, group)) if group.effects.contains(&&of.at) => {}
                Some((_, group)) => {
                    group.effects.push(&of.at);
                    group.next.extend(&of.next_experiment);
                }
                None => groups.push((
                    own,
                    Self {
                        effects: vec![&of.at],
                        reason: &of.reason,
                        experiment: &of.experiment,
                        next: of.next_experiment.iter().collect(),
                    },
                )),
            }
        }
        groups.into_iter().map(|(_, group)| group).collect()
    }

    /// Returns the names of the effects; sites of the same effect are joined.
    fn join_names(&self) -> String {
        let mut by_effect: Vec<(&str, Vec<&str>)> = Vec::new();
        for at in &self.effects {
            match by_effect
                .iter_mut()
                .find(|(effect, _)| *effect == at.effect)
            {
                Some((_, places)) => places.push(&at.site),
                None => by_effect.push((&at.effect, vec![&at.site])),
            }
        }
        let each = by_effect.iter().map(|(effect, places)| {
            describe_effect(&EffectSite {
                effect: (*effect).to_owned(),
                site: places.join(", "),
                order: None,
            })
        });
        each.collect::<Vec<String>>().join("; ")
    }

    /// Describes the experiments, as a continuation of the description of the required evidence.
    fn next(&self, files: &[ExperimentFile]) -> String {
        let all = self.next.iter();
        let all =
            all.map(|next| format!(". {}", format_readable(&describe_experiment(next, files))));
        all.collect()
    }

    /// Returns the first line of the reason, because compiler messages have several lines.
    fn shorten_reason(&self) -> String {
        format_readable(self.reason.lines().next().unwrap_or_default())
    }
}

/// Lists the rejected effects. Those with an individual reason are first.
pub(super) fn list_rejected(list: &[RejectedEffect]) -> Markup {
    if list.is_empty() {
        return html! {};
    }
    let mut groups = Group::group_by(list, |of| &of.reason);
    groups.sort_by_key(|group| group.effects.len());
    let row = |group: &Group<'_>| html! { tr { td { (prose(&group.join_names())) } td { (prose(&group.shorten_reason())) } } };
    section(
        "Rejected effects",
        &html! {
            p {
                (describe_counts(list))
                @if let Some(best) = describe_best(list) { " " (prose(&best)) }
            }
            (write_folded(&groups, &["effect", "reason"], row))
        },
    )
}

/// Describes the numbers of rejected, fitted and screened candidates.
fn describe_counts(list: &[RejectedEffect]) -> String {
    let fitted = list.iter().filter(|of| of.is_fitted).count();
    let candidates = match list.len() {
        1 => "1 candidate (an effect at a site) was rejected".to_owned(),
        count => format!("{count} candidates (an effect at a site) were rejected"),
    };
    format!(
        "{candidates}: {fitted} after a fit, {} after the screening, which predicts the reduction of the residual \
         without a fit. Candidates with the same reason share a row.",
        list.len() - fitted
    )
}

/// Describes the reduction by the best effect of each round, for comparison with the reductions in
/// the table.
fn describe_best(list: &[RejectedEffect]) -> Option<String> {
    let of_rounds = list.iter().filter_map(|of| of.best_of_round.as_ref());
    let mut texts: Vec<String> = of_rounds
        .map(|best| format!("{}, {}", effect_in_words(&best.label), best.reduction))
        .collect();
    texts.sort();
    texts.dedup();
    let segments = match texts.iter().any(|text| text.contains("initial-segment")) {
        true => {
            " The initial-segment residual is the squared residual at the start of each window."
        }
        false => "",
    };
    (!texts.is_empty()).then(|| {
        format!(
            "The best candidates, for comparison: {}.{segments}",
            texts.join("; ")
        )
    })
}

/// Lists the effects that the records cannot show, grouped by experiment.
pub(super) fn list_untestable(list: &[RejectedEffect], files: &[ExperimentFile]) -> Markup {
    if list.is_empty() {
        return html! {};
    }
    let groups = Group::group_by(list, |of| (&of.at.effect, &of.experiment));
    let row = |group: &Group<'_>| {
        html! { tr { td { (prose(&group.join_names())) } td { (prose(&group.shorten_reason())) } td { (prose(group.experiment)) (prose(&group.next(files))) } } }
    };
    section(
        "Effects that these records cannot show",
        &html! {
            p { "These effects may or may not be present: the records do not show the difference." }
            (write_folded(&groups, &["effect", "why", "experiment"], row))
        },
    )
}

/// Returns a table whose last rows are folded if there are many.
fn write_folded(
    groups: &[Group<'_>],
    headings: &[&str],
    row: impl Fn(&Group<'_>) -> Markup,
) -> Markup {
    let (first, rest) = groups.split_at(groups.len().min(VISIBLE_ROW_COUNT));
    let rows = |groups: &[Group<'_>]| html! { @for group in groups { (row(group)) } };
    html! {
        (table(headings, &rows(first)))
        @if !rest.is_empty() {
            details {
                summary { (rest.len()) " more" }
                (table(headings, &rows(rest)))
            }
        }
    }
}
