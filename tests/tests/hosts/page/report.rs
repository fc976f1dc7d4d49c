//! Tests of the report of `discover`. Residuals match the search, and the report opens without an error in a browser
//! and reacts to its slider. Texts of a dataset are escaped. A report without effects says so in a sentence.

use std::process::Command;

use eomgen_tests::measured::{DESCRIPTION, Measured};
use eomgen_tests::models::project;
use serde_json::Value;

use super::bits::node;
use super::browser::{BrowserSettings, WIDE_WINDOW, browser, run_probe_script};

/// Text that would end or begin a script.
const HOSTILE: &str = "</script></title><img src=x onerror=alert(1)><!--";

/// Dry friction of the stage, in N.
const FRICTION: f64 = 3.0;

/// Runs `command` on a stage with hidden friction and a hostile title; returns the document.
fn run_report(friction: f64, command: &str) -> (Measured, Value) {
    let measured = Measured::stage(friction);
    let description = format!("title = '{HOSTILE}'\n{DESCRIPTION}");
    measured.write("dataset.toml", description.as_bytes());
    let (document, _) = measured.run_command(command, "out");
    (measured, document)
}

fn residual_on_page(measured: &Measured, parameter: &str) -> f64 {
    let file = |name: &str| project().join(name);
    let output = Command::new("node")
        .arg(file("tests/tests/hosts/page/playback.mjs"))
        .arg(measured.file("out/report.html"))
        .arg(file("sim/page/src/play/engine.js"))
        .arg(file("discover/src/report/playback/playback.js"))
        .arg(parameter)
        .output()
        .expect("node can be run");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    let left: Vec<f64> = serde_json::from_slice(&output.stdout).expect("JSON");
    left[0]
}

#[test]
fn report_slider_moves_found_friction() {
    let (measured, document) = run_report(FRICTION, "discover");
    let page = measured.read("out/report.html");
    assert_eq!(page.matches("<script").count(), 2);
    assert_eq!(page.matches("</script").count(), 2);
    for forbidden in [
        "<img",
        "onerror=\"",
        "href=",
        "@import",
        "fetch(",
        "import(",
    ] {
        assert!(!page.contains(forbidden), "{forbidden}");
    }
    assert!(page.contains("default-src 'none'"));
    assert!(
        page.contains("Found: Coulomb friction on <span class=\"word\"><math><mi>q</mi></math>,</span> <math><msub><mi>T</mi><mi>c</mi></msub></math> = "),
        "the page does not print the verdict"
    );
    // The engine alone is about 350 kB.
    assert!(page.len() < 900_000, "{} bytes", page.len());
    let gap = |when: &str| {
        let gap = &document["gap"]["q"][when]["test"];
        gap.as_f64().expect("a number")
    };
    if node() {
        // The fit and the page integrate with different steps. The errors of the steps are small compared with the
        // noise and hardly change the RMS.
        let found = residual_on_page(&measured, "found");
        assert!(
            (found / gap("after") - 1.0).abs() < 0.02,
            "{found} {}",
            gap("after")
        );
        // Without friction the residual is larger, but smaller than before the search, because the other parameters
        // were fitted together with the friction.
        let without = residual_on_page(&measured, "0");
        assert!(without > 5.0 * found, "{without} {found}");
    }
    let page = std::fs::read_to_string(measured.file("out/report.html")).expect("a report");
    assert!(
        page.contains("data-left=\"now\">") && !page.contains("data-left=\"now\"></td>"),
        "without JavaScript the table has no residuals"
    );
    let Some(browser) = browser() else { return };
    for (width, dark) in [(1280, false), (400, true)] {
        let look = BrowserSettings {
            width,
            dark,
            ..WIDE_WINDOW
        };
        let seen = run_probe_script(
            "report.js",
            browser,
            &measured.file("out/report.html"),
            look,
        );
        assert_eq!(seen["errors"], serde_json::json!([]), "{seen}");
        assert_eq!(seen["excess"], 0, "wider than its window: {seen}");
        assert_eq!(seen["dark"], dark, "{seen}");
        assert_eq!(seen["unlabelled"], 0, "{seen}");
        for key in ["computed", "reacted", "drawn", "restored"] {
            assert_eq!(seen[key], true, "{key}: {seen}");
        }
        let shown = seen["left"].as_f64().expect("a number");
        assert!((shown / gap("after") - 1.0).abs() < 0.02, "{seen}");
    }
}

#[test]
fn report_without_effects_states_it() {
    let (measured, document) = run_report(0.0, "discover");
    assert_eq!(document["verdict"], "no_significant_gap");
    let page = measured.read("out/report.html");
    assert!(page.contains("they show no missing effect"));
    assert!(
        !page.contains("<script"),
        "a report without effects has no slider"
    );
    for empty in [
        "<tbody></tbody>",
        "<dl class=\"values\"></dl>",
        "<ul></ul>",
        "NaN",
        "inf ",
    ] {
        assert!(!page.contains(empty), "{empty}");
    }
    let Some(browser) = browser() else { return };
    for (width, dark) in [(1280, true), (400, false)] {
        let look = BrowserSettings {
            width,
            dark,
            ..WIDE_WINDOW
        };
        let seen = run_probe_script(
            "report.js",
            browser,
            &measured.file("out/report.html"),
            look,
        );
        assert_eq!(seen["errors"], serde_json::json!([]), "{seen}");
        assert_eq!(seen["excess"], 0, "wider than its window: {seen}");
    }
}
