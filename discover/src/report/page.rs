//! A page that an engineer can hand on: what was measured and simulated before and after, what
//! was found and what was not, and what changed in the specification.

use eomgen_page::{document, section, table};
use maud::{Markup, html};

use crate::report::json::{estimates, sensors};
use crate::report::result::{
    Compared, Comparison, Discovery, FoundEffect, OnRecords, RejectedEffect, Step,
};

impl Comparison {
    /// The page, a complete HTML document that refers to nothing outside.
    pub fn page(&self) -> String {
        let compared = &self.compared;
        whole(
            compared,
            &html! {
                (opening(compared, self.verdict()))
                (closing(compared))
            },
        )
    }
}

impl Discovery {
    /// The page, a complete HTML document that refers to nothing outside.
    pub fn page(&self) -> String {
        let compared = &self.compared;
        let untestable = "Not testable with these records";
        whole(
            compared,
            &html! {
                (opening(compared, self.verdict.word()))
                (section("What was found", &effects_table(&self.effects)))
                (section("Step by step", &html! { (step_table(&self.steps)) (validation_line(self)) }))
                (closing(compared))
                (section("Rejected", &rejected_table(&self.rejected, false)))
                (section(untestable, &rejected_table(&self.not_testable, true)))
                @if self.original != self.extended {
                    (section("The specification, changed", &difference(&self.original, &self.extended)))
                }
            },
        )
    }
}

fn title(compared: &Compared) -> &str {
    match compared.title.as_str() {
        "" => "Model and measurement",
        title => title,
    }
}

/// A document around a body.
fn whole(compared: &Compared, body: &Markup) -> String {
    let title = title(compared);
    document(title, &html! { header { h1 { (title) } } main { (body) } })
}

/// Verdict, where the gap is, notes, and the gap.
fn opening(compared: &Compared, verdict: &str) -> Markup {
    html! {
        p.lead { "Verdict: " strong { (verdict) } }
        p { (compared.location) }
        @for note in &compared.notes { p.note { (note) } }
        (section("The gap", &gap_table(compared)))
    }
}

/// Pictures, and what was refitted.
fn closing(compared: &Compared) -> Markup {
    let (refitted, sensors) = (estimates(&compared.refitted), sensors(&compared.sensors));
    let text = format!("{refitted:#}\n{sensors:#}");
    html! {
        (section("The test record", &compared.pictures.residuals))
        @if let Some((equation, force)) = &compared.pictures.force {
            (section(&format!("The residual force on {equation}"), force))
        }
        (section("Refitted", &html! { pre { (text) } }))
    }
}

fn number(value: f64) -> String {
    if value.is_finite() {
        format!("{value:.4e}")
    } else {
        String::new()
    }
}

fn gap_table(compared: &Compared) -> Markup {
    let rows = html! {
        @for (name, gap) in &compared.gap {
            @let after = |of: fn(OnRecords<f64>) -> f64| gap.after.map_or_else(String::new, |after| number(of(after)));
            tr {
                td { (name) }
                td { (gap.unit) }
                td { (number(gap.floor)) }
                td { (number(gap.before.train)) }
                td { (after(|after| after.train)) }
                td { (number(gap.before.test)) }
                td { (after(|after| after.test)) }
            }
        }
    };
    let headings = [
        "channel",
        "unit",
        "floor",
        "train before",
        "train after",
        "test before",
        "test after",
    ];
    table(&headings, &rows)
}

fn effects_table(effects: &[FoundEffect]) -> Markup {
    if effects.is_empty() {
        return html! { p { "Nothing." } };
    }
    let rows = html! {
        @for effect in effects {
            tr {
                td { (effect.at.effect) }
                td { (effect.at.on) }
                td { (effect.status.word()) }
                td {
                    @for (place, (name, of)) in effect.parameters.iter().enumerate() {
                        @if place > 0 { br; }
                        (name) " = " (number(of.value)) " ± " (number(of.sd)) " " (of.unit)
                    }
                }
                td { code { (effect.term) } }
            }
        }
    };
    table(&["effect", "on", "status", "parameters", "term"], &rows)
}

/// The test gap after each step.
fn step_table(steps: &[Step]) -> Markup {
    let rows = html! {
        @for step in steps {
            tr {
                td {
                    @if step.added.is_empty() { "the model as it is" }
                    @else { "+ " (step.added.join(", ")) }
                }
                td { (number(step.test_rms)) }
            }
        }
    };
    table(
        &["model", "test gap, in standard deviations of the noise"],
        &rows,
    )
}

/// Whether the equations of the specification that was written are right.
fn validation_line(discovery: &Discovery) -> Markup {
    let Some(validation) = &discovery.validation else {
        return html! {};
    };
    let deviations = |rms: f64| match rms.is_finite() {
        true => format!("{rms:.2}"),
        false => "?".to_owned(),
    };
    let text = match validation.passed {
        true => format!(
            "The specification that was written was derived anew; its equations pass all {} checks of eomgen validate. Simulated on the records, its residuals are {} standard deviations of the noise in training and {} in test.",
            validation.checks.len(),
            deviations(discovery.resimulation.train),
            deviations(discovery.resimulation.test)
        ),
        false => format!(
            "The specification that was written was derived anew; its equations FAIL {}.",
            validation.failed.join(", ")
        ),
    };
    html! { p { (text) } }
}

fn rejected_table(list: &[RejectedEffect], has_experiment: bool) -> Markup {
    let rows = html! {
        @for of in list {
            tr {
                td { (of.at.effect) }
                td { (of.at.on) }
                td { (of.reason) }
                td { @if has_experiment { (of.experiment) } }
            }
        }
    };
    table(&["effect", "on", "reason", "what would tell"], &rows)
}

/// Lines that were added or changed, with those they replace.
fn difference(before: &str, after: &str) -> Markup {
    let old: Vec<&str> = before.lines().collect();
    let new: Vec<&str> = after.lines().collect();
    html! {
        pre {
            @for line in old.iter().filter(|line| !new.contains(line)) {
                span.removed { "- " (line) } "\n"
            }
            @for line in new.iter().filter(|line| !old.contains(line)) {
                span.added { "+ " (line) } "\n"
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::report::resimulation::Resimulation;
    use crate::report::result::{
        ChannelGap, EffectAt, Estimated, Pictures, Sensor, Status, Validation, Verdict,
    };
    use crate::search::acceptance::TestStatistics;

    /// A discovery with `text` wherever a dataset, a specification or a file name could put it.
    fn discovery(text: &str) -> Discovery {
        let name = || text.to_owned();
        let at = || EffectAt {
            effect: name(),
            on: name(),
        };
        let both = OnRecords {
            train: 2e-6,
            test: 3e-6,
        };
        let estimated = Estimated {
            value: 1.5,
            sd: 0.1,
            unit: name(),
        };
        let gap = ChannelGap {
            unit: name(),
            floor: 1e-6,
            before: both,
            after: Some(both),
        };
        let rejected = RejectedEffect {
            at: at(),
            reason: name(),
            experiment: name(),
        };
        Discovery {
            verdict: Verdict::EffectsFound,
            effects: vec![FoundEffect {
                at: at(),
                status: Status::Named,
                equivalent: vec![at()],
                parameters: BTreeMap::from([(name(), estimated.clone())]),
                term: name(),
                statistics: TestStatistics {
                    held_out: 0.5,
                    held_out_errors: 9.0,
                    information: 40.0,
                    t: 8.0,
                    size: 3.0,
                },
                order: None,
                experiment: Some(name()),
            }],
            rejected: vec![rejected.clone()],
            not_testable: vec![rejected],
            closure: OnRecords {
                train: Some(0.9),
                test: None,
            },
            steps: vec![Step {
                added: vec![name()],
                test_rms: 1.2,
            }],
            compared: Compared {
                title: name(),
                gap: BTreeMap::from([(name(), gap)]),
                refitted: BTreeMap::from([(name(), estimated)]),
                sensors: BTreeMap::from([(
                    name(),
                    Sensor {
                        bias: 0.0,
                        gain: 1.0,
                        delay: 0.0,
                    },
                )]),
                location: name(),
                notes: vec![name()],
                pictures: Pictures {
                    residuals: html! {},
                    force: Some((name(), html! {})),
                },
            },
            original: format!("{text} before"),
            extended: format!("{text} after"),
            resimulation: Resimulation {
                train: 1.0,
                test: 1.1,
            },
            validation: Some(Validation {
                passed: false,
                checks: vec![name()],
                failed: vec![name()],
            }),
        }
    }

    fn comparison(text: &str) -> Comparison {
        Comparison {
            has_gap: true,
            compared: discovery(text).compared,
        }
    }

    /// The names of the elements that are opened, in order.
    fn elements(page: &str) -> Vec<&str> {
        let opened = page.split('<').skip(1);
        opened
            .filter_map(|piece| piece.split(|c: char| !c.is_ascii_alphanumeric()).next())
            .filter(|name| !name.is_empty())
            .collect()
    }

    #[test]
    fn text_from_outside_stays_text() {
        let hostile = "</pre></title>\"'><script>alert(\"1\")</script>&<img src=x onerror='a'>";
        let pages = [
            (discovery(hostile).page(), discovery("plain").page()),
            (comparison(hostile).page(), comparison("plain").page()),
        ];
        for (page, plain) in pages {
            for forbidden in ["<script", "<img", "alert(\"1", "&<"] {
                assert!(!page.contains(forbidden), "{forbidden}");
            }
            assert!(page.matches("&lt;script&gt;").count() >= 8, "{page}");
            assert_eq!(elements(&page), elements(&plain));
        }
    }

    #[test]
    fn nothing_refers_to_the_outside() {
        let page = discovery("x").page();
        for forbidden in ["http", "//", "<script", "<link", "src=", "url(", "href"] {
            assert!(!page.contains(forbidden), "{forbidden}");
        }
    }
}
