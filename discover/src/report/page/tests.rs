use std::collections::BTreeMap;

use super::*;
use crate::report::origin::{HashedFile, Origin};
use crate::report::playback::Playback;
use crate::report::resimulation::Resimulation;
use crate::report::result::{
    ChannelGap, EffectAt, Estimated, FoundEffect, Nuisance, OnRecords, Pictures, RejectedEffect,
    Sensor, Status, Step, Validation, Verdict,
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
            says: name(),
            status: Status::Class,
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
            refitted: BTreeMap::from([(name(), estimated.clone())]),
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
            nuisances: vec![Nuisance {
                of: name(),
                fault: Some("gain"),
                declared: (1.0, 0.01),
                fitted: estimated.clone(),
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
            pictures: Pictures {
                playback: Playback::None,
                overlay: html! {},
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
