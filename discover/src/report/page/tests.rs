use std::collections::BTreeMap;

use super::*;
use crate::experiment::next_experiment::NextExperiment;
use crate::report::origin::{HashedFile, Origin};
use crate::report::playback::Playback;
use crate::report::resimulation::Resimulation;
use crate::report::result::{
    ChannelGap, ConditionalSize, EffectSite, EffectStatus, EquivalentEffect, EstimateWithUnit,
    FoundEffect, Nuisance, RejectedEffect, ResultFigures, SearchStep, SensorEstimate, TrainTest,
    Validation, Verdict,
};
use crate::search::acceptance::TestStatistics;
use crate::search::search_result::BestOfRound;

/// Returns an experiment with `text` in all fields that contain names from input files.
fn next_experiment(text: &str) -> NextExperiment {
    let name = || text.to_owned();
    NextExperiment {
        file: None,
        input: Some(name()),
        waveform: Some(name()),
        separation: Some(0.5),
        pairs: Vec::new(),
        failed_members: Vec::new(),
        detectable: None,
        reason: None,
        bounds_source: name(),
    }
}

/// Returns a discovery with `text` in all fields that contain names from input files.
fn discovery(text: &str) -> Discovery {
    let name = || text.to_owned();
    let at = || EffectSite {
        effect: name(),
        site: name(),
        order: None,
    };
    let both = TrainTest {
        train: 2e-6,
        test: 3e-6,
    };
    let estimated = EstimateWithUnit {
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
        best_of_round: Some(BestOfRound {
            label: name(),
            reduction: name(),
        }),
        is_fitted: true,
        experiment: name(),
        next_experiment: Some(next_experiment(text)),
        p_values: Some((0.2, 1.0)),
    };
    Discovery {
        curve: None,
        verdict: Verdict::EffectsFound,
        effects: vec![FoundEffect {
            at: at(),
            description: name(),
            status: EffectStatus::Class,
            equivalents: vec![EquivalentEffect {
                at: at(),
                parameters: BTreeMap::from([(name(), estimated.clone())]),
            }],
            parameters: BTreeMap::from([(name(), estimated.clone())]),
            conditional: vec![ConditionalSize {
                parameter: name(),
                size: estimated.clone(),
                with: at(),
                in_place_of: at(),
            }],
            term: name(),
            statistics: TestStatistics {
                held_out_reduction: 0.5,
                reduction_in_standard_errors: 9.0,
                information_gain: 40.0,
                t_value: 8.0,
                size_over_noise: 3.0,
                p_value: Some(1e-3),
            },
            adjusted_p_value: Some(0.02),
            load: None,
            experiment: Some(name()),
            next_experiment: Some(next_experiment(text)),
        }],
        rejected: vec![rejected.clone()],
        untestable: vec![rejected],
        experiments: Vec::new(),
        closure: TrainTest {
            train: Some(0.9),
            test: None,
        },
        steps: vec![SearchStep {
            added: vec![name()],
            test_rms: 1.2,
        }],
        compared: CommonResult {
            title: name(),
            gap: BTreeMap::from([(name(), gap)]),
            noise_floor: 0.9,
            refitted: BTreeMap::from([(name(), estimated.clone())]),
            sensors: BTreeMap::from([(
                name(),
                SensorEstimate {
                    bias: 0.0,
                    gain: 1.0,
                    delay: 0.0,
                },
            )]),
            location: name(),
            notes: vec![name()],
            nuisances: vec![Nuisance {
                name: name(),
                fault: Some("gain"),
                declared: (1.0, 0.01),
                estimate: estimated.clone(),
            }],
            origin: Origin {
                version: "0",
                date: name(),
                seed: 1,
                files: vec![HashedFile {
                    role: name(),
                    path: name(),
                    sha256: None,
                }],
            },
            pictures: ResultFigures {
                playback: Playback::NotNeeded,
                overlay: html! {},
                residuals: html! {},
                experiments: html! {},
                force: Some(html! {}),
            },
        },
        original: format!("{text} before"),
        extended: format!("{text} after"),
        unfinished: None,
        resimulation: Resimulation {
            train: 1.0,
            test: 1.1,
        },
        validation: Some(Validation {
            has_passed: false,
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

/// Returns the names of the opened elements, in order.
fn list_elements(page: &str) -> Vec<&str> {
    let opened = page.split('<').skip(1);
    opened
        .filter_map(|piece| piece.split(|c: char| !c.is_ascii_alphanumeric()).next())
        .filter(|name| !name.is_empty())
        .collect()
}

#[test]
fn text_from_input_files_is_escaped() {
    let hostile = "</pre></title>\"'><script>alert(\"1\")</script>&<img src=x onerror='a'>";
    let pages = [
        (discovery(hostile).to_html(), discovery("plain").to_html()),
        (comparison(hostile).to_html(), comparison("plain").to_html()),
    ];
    for (page, plain) in pages {
        for forbidden in ["<script", "<img", "alert(\"1", "&<"] {
            assert!(!page.contains(forbidden), "{forbidden}");
        }
        assert!(page.matches("&lt;script&gt;").count() >= 8, "{page}");
        assert_eq!(list_elements(&page), list_elements(&plain));
    }
}

#[test]
fn hidden_characters_are_escaped_and_the_policy_forbids_scripts() {
    let hostile = "\u{1b}[31m\u{202e}x";
    for page in [discovery(hostile).to_html(), comparison(hostile).to_html()] {
        let is_hidden = eomgen_model_spec::hidden_characters::is_hidden;
        assert!(!page.contains(is_hidden), "{page}");
        assert!(page.matches("\\u{1b}[31m\\u{202e}x").count() >= 8, "{page}");
        let policy = "http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'";
        assert!(
            page.contains(policy) && !page.contains("script-src"),
            "{page}"
        );
    }
}

#[test]
fn large_remaining_gap_makes_summary_uncertain() {
    let mut found = discovery("x");
    found.effects[0].status = EffectStatus::Named;
    found.closure.test = Some(0.6);
    found.compared.nuisances[0].estimate.value = 1.0;
    let summary = |found: &Discovery| found.to_json()["summary"].as_str().unwrap_or("").to_owned();
    assert!(
        summary(&found).starts_with("Found: x on x"),
        "{}",
        summary(&found)
    );
    let gap = found
        .compared
        .gap
        .get_mut("x")
        .and_then(|gap| gap.after.as_mut());
    gap.expect("a gap").test = 41e-6;
    let first = "The named effects may be substitutes for others: the extended model closes 60 % of the gap between model \
                 and measurement on held-out records and leaves 41.0 noise floors.";
    assert!(summary(&found).starts_with(first), "{}", summary(&found));
    // A percent sign follows a non-breaking space.
    let first = first.replace(" %", "\u{a0}%");
    assert!(found.to_html().contains(&first), "{}", found.to_html());
}

#[test]
fn nuisance_at_bound_makes_effects_uncertain() {
    let mut found = discovery("x");
    found.compared.nuisances[0].estimate.value = 1.03;
    found.compared.nuisances[0].estimate.unit = "1".to_owned();
    let json = found.to_json();
    let summary = json["summary"].as_str().unwrap_or("");
    assert!(
        summary.contains("with the gain of x at the bound of the fit"),
        "{summary}"
    );
    let notes = crate::report::discovery::describe_deviations(&found.compared.nuisances);
    assert_eq!(notes.len(), 1, "{notes:?}");
    assert!(
        notes[0].starts_with("the gain of x is 1.030, 3.0 standard deviations"),
        "{notes:?}"
    );
}

#[test]
fn nuisance_at_bound_is_reported_without_effects() {
    let mut found = discovery("x");
    found.verdict = Verdict::NoSignificantGap;
    found.effects.clear();
    let summary = |found: &Discovery| found.to_json()["summary"].as_str().unwrap_or("").to_owned();
    found.compared.nuisances[0].estimate.value = 1.0;
    let text = summary(&found);
    assert!(text.contains("no missing effect"), "{text}");
    found.compared.nuisances[0].estimate.value = 1.03;
    let text = summary(&found);
    let first = "The model explains the records only with the gain of x at the bound of the fit";
    assert!(text.starts_with(first), "{text}");
    assert!(!text.contains("no missing effect"), "{text}");
}

#[test]
fn page_has_no_external_reference() {
    let page = discovery("x").to_html();
    for forbidden in [
        "http:", "https:", "//", "<script", "<link", "src=", "url(", "href",
    ] {
        assert!(!page.contains(forbidden), "{forbidden}");
    }
}

#[test]
fn reports_name_their_kind() {
    let kinds = [
        "Search for missing effects of the model",
        "Comparison of model and measurement",
    ];
    let pages = [discovery("x").to_html(), comparison("x").to_html()];
    for (index, page) in pages.iter().enumerate() {
        assert!(
            page.contains(kinds[index]) && !page.contains(kinds[1 - index]),
            "{page}"
        );
        assert!(page.contains("<th scope=\"col\">training"), "{page}");
    }
}

#[test]
fn names_of_quantities_are_symbols() {
    for page in [discovery("theta").to_html(), comparison("theta").to_html()] {
        let table = page.split("<tbody>").nth(1).unwrap_or_default();
        assert!(
            table.starts_with("<tr><th scope=\"row\"><math><mi>θ</mi></math></th>"),
            "{table}"
        );
        assert!(page.contains("<p><math><mi>θ</mi></math></p>"), "{page}");
    }
}
