//! Found effects, steps of the search, and changes of the specification.

use eomgen_page::{prose, quantity_symbol, section, table};
use maud::{Markup, html};

use crate::catalogue::effect::effect_in_words;
use crate::experiment::next_experiment::ExperimentFile;
use crate::report::experiment::describe_experiment;
use crate::report::quantity::{format_estimate, format_number, format_percent, format_readable};
use crate::report::result::{Discovery, EffectStatus, FoundEffect, SearchStep};
use crate::report::summary::{describe_conditional, describe_effect, describe_with_sizes};

/// Lists the effects; empty without effects, because the verdict reports this.
pub(super) fn list_effects(effects: &[FoundEffect], files: &[ExperimentFile]) -> Markup {
    if effects.is_empty() {
        return html! {};
    }
    section(
        "Found effects",
        &html! { @for found in effects { (write_effect(found, files)) } },
    )
}

fn write_effect(effect: &FoundEffect, files: &[ExperimentFile]) -> Markup {
    let is_value = effect.parameters.keys().any(|name| {
        let rest = effect.term.strip_prefix(name.as_str());
        rest.is_some_and(|rest| rest.starts_with(" = "))
    });
    html! {
        h3 { (prose(&describe_effect(&effect.at))) }
        p {
            @if !effect.description.is_empty() { (prose(&capitalise(&effect.description))) ". " }
            @match effect.status {
                EffectStatus::Named => { "No other tested effect has the same response." },
                EffectStatus::Provisional => {
                    "It may be a substitute for another effect: a large residual remains, or a refitted parameter or "
                    "sensor is at the bound of the fit."
                },
                EffectStatus::Class => {
                    "The records do not separate it from "
                    (prose(&effect.equivalents.iter().map(|other| describe_with_sizes(&other.at, &other.parameters)).collect::<Vec<String>>().join(", or from "))) "."
                },
                EffectStatus::Empirical => { "It does not identify the cause." },
            }
            @for size in &effect.conditional { " " (prose(&describe_conditional(size))) "." }
            @if let Some(order) = &effect.at.order {
                " It repeats " (order.order) " times per turn of " (quantity_symbol(&order.angle)) "."
            }
            @if let Some(load) = &effect.load {
                " It increases with the load of " (quantity_symbol(load)) "."
            }
            @if let Some(experiment) = &effect.experiment {
                " Experiment to separate them: " (prose(experiment)) "."
            }
            @if let Some(next) = &effect.next_experiment {
                " " (prose(&format_readable(&describe_experiment(next, files))))
            }
        }
        dl.values {
            @for (name, of) in &effect.parameters {
                dt { (quantity_symbol(name)) }
                dd { (prose(&format_estimate(of.value, of.sd, &of.unit))) }
            }
            @if !effect.term.is_empty() && !is_value {
                dt { "in the specification" }
                dd { code { (effect.term) } }
            }
            dt { "evidence" }
            dd {
                "reduction of the held-out residual: " (prose(&format_percent(effect.statistics.held_out_reduction)))
                ", " (format_number(effect.statistics.reduction_in_standard_errors, 2)) " standard errors"
                @if let Some(p) = effect.adjusted_p_value {
                    "; probability that noise alone supports any fitted effect as strongly: " (format_probability(p))
                }
            }
        }
    }
}

/// Returns a probability in words; very small values are only given as an upper limit.
fn format_probability(p: f64) -> String {
    match p < 1e-6 {
        true => "less than one in a million".to_owned(),
        false => format_number(p, 2),
    }
}

/// Returns a text with an initial capital letter.
fn capitalise(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|c| c.to_uppercase().to_string());
    first.unwrap_or_default() + letters.as_str()
}

/// Lists the test residual after each step and the validation of the extended specification. The
/// residuals are those of all channels together; the gap table lists each channel.
pub(super) fn list_steps(discovery: &Discovery) -> Markup {
    let has_steps = discovery.steps.len() > 1;
    if !has_steps && discovery.validation.is_none() {
        return html! {};
    }
    let heading = match has_steps {
        true => "Steps of the search",
        false => "Extended specification",
    };
    section(
        heading,
        &html! {
            @if has_steps { (write_step_table(&discovery.steps, discovery.compared.noise_floor)) }
            (write_validation(discovery))
        },
    )
}

fn write_step_table(steps: &[SearchStep], noise_floor: f64) -> Markup {
    let rows = html! {
        @for step in steps {
            tr {
                td {
                    @if step.added.is_empty() { "original model" }
                    @else { "with " (prose(&effect_in_words(&step.added.join(", ")))) }
                }
                td.number { (format_number(step.test_rms / noise_floor, 3)) }
            }
        }
    };
    let headings = [
        "model",
        "residual of the held-out records over all channels, in noise floors",
    ];
    table(&headings, &rows)
}

/// Returns the result of the validation of the extended equations.
fn write_validation(discovery: &Discovery) -> Markup {
    let Some(validation) = &discovery.validation else {
        return html! {};
    };
    let left = |rms: f64| format_number(rms / discovery.compared.noise_floor, 3);
    let written = "The equations of the extended specification were derived again; they ";
    html! {
        @if validation.has_passed {
            p {
                (written) "pass all " (validation.checks.len()) " checks of " code { "eomgen validate" }
                ". The residual of its simulation over all channels is "
                (left(discovery.resimulation.train)) " noise floors on the training records and "
                (left(discovery.resimulation.test)) " on the held-out records."
            }
        } @else {
            p.warning { (written) "FAIL " (validation.failed.join(", ")) "." }
        }
    }
}

/// Shows added and changed lines of the specification together with the lines that they replace.
pub(super) fn show_change(before: &str, after: &str) -> Markup {
    if before == after {
        return html! {};
    }
    let old: Vec<&str> = before.lines().collect();
    let new: Vec<&str> = after.lines().collect();
    section(
        "Changes of the specification",
        &html! {
            pre.changes {
                @for line in old.iter().filter(|line| !new.contains(line)) {
                    span.removed { "- " (line) }
                }
                @for line in new.iter().filter(|line| !old.contains(line)) {
                    span.added { "+ " (line) }
                }
            }
        },
    )
}
