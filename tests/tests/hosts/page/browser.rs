//! Tests of pages in an offline browser: pages open without an error, move, react to a slider and fit the window, in
//! light and dark colours. A small script controls the browser.

use std::path::Path;
use std::process::Command;

use eomgen_tests::models::{path, project, shipped_specifications};
use serde_json::Value;

use super::{drawn_example, write_page};

/// Returns the command of the browser if the browser and node are installed; otherwise reports the skip.
pub fn browser() -> Option<&'static str> {
    let runs = |name: &str| {
        let found = Command::new(name).arg("--version").output();
        found.is_ok_and(|output| output.status.success())
    };
    let names = ["chromium", "chromium-browser", "google-chrome"];
    let found = names.into_iter().find(|name| runs("node") && runs(name));
    if found.is_none() {
        skips::skip("no page was opened: node or a browser is missing (Debian: nodejs, chromium)");
    }
    found
}

/// Window size and preferences of the browser.
#[derive(Clone, Copy)]
pub struct BrowserSettings {
    pub width: u32,
    pub dark: bool,
    pub still: bool,
    /// True if the browser runs scripts of the page.
    pub scripts: bool,
}

pub const WIDE_WINDOW: BrowserSettings = BrowserSettings {
    width: 1280,
    dark: false,
    still: false,
    scripts: true,
};

/// Opens a page in the browser and returns the observations of the script.
pub fn run_probe(browser: &str, page: &Path, look: BrowserSettings) -> Value {
    run_probe_script("probe.js", browser, page, look)
}

pub fn run_probe_script(probe: &str, browser: &str, page: &Path, look: BrowserSettings) -> Value {
    let script = |name: &str| project().join("tests/tests/hosts/page").join(name);
    let BrowserSettings {
        width,
        dark,
        still,
        scripts,
    } = look;
    let look =
        serde_json::json!({ "width": width, "dark": dark, "still": still, "scripts": scripts });
    let profile = tempfile::tempdir().expect("a folder");
    let output = Command::new("node")
        .arg(script("look.mjs"))
        .arg(browser)
        .arg(page)
        .arg(script(probe))
        .arg(profile.path())
        .arg(look.to_string())
        .output()
        .expect("node can be run");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{}: {said}", page.display());
    serde_json::from_slice(&output.stdout).expect("JSON")
}

/// Asserts the properties that all animated pages have.
fn assert_moves(seen: &Value) {
    assert_eq!(seen["errors"], serde_json::json!([]), "{seen}");
    assert_eq!(seen["excess"], 0, "wider than its window: {seen}");
    assert_eq!(
        seen["moved"],
        serde_json::json!([true, true, true]),
        "{seen}"
    );
    assert_eq!(seen["unlabelled"], 0, "{seen}");
    for key in [
        "paused",
        "number",
        "reacted",
        "refused",
        "restored",
        "focusable",
    ] {
        assert_eq!(seen[key], true, "{key}: {seen}");
    }
    assert_eq!(seen["reset"], 0.0, "{seen}");
}

#[test]
fn drawn_model_moves_and_reacts_in_every_size_and_colour() {
    let Some(browser) = browser() else { return };
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["double_pendulum", "crane", "flexible_arm"] {
        let page = write_page(&drawn_example(name), &[], folder.path());
        for (width, dark) in [(1280, false), (400, true)] {
            let seen = run_probe(
                browser,
                &page,
                BrowserSettings {
                    width,
                    dark,
                    ..WIDE_WINDOW
                },
            );
            assert_moves(&seen);
            assert_eq!(seen["dark"], dark, "{seen}");
        }
    }
}

#[test]
fn page_does_not_move_with_reduced_motion() {
    let Some(browser) = browser() else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let page = write_page(&path("double_pendulum"), &[], folder.path());
    let seen = run_probe(
        browser,
        &page,
        BrowserSettings {
            still: true,
            ..WIDE_WINDOW
        },
    );
    assert_eq!(seen["errors"], serde_json::json!([]), "{seen}");
    assert_eq!(
        seen["moved"],
        serde_json::json!([false, false, false]),
        "{seen}"
    );
    assert_eq!(seen["label"], "Play");
    assert_eq!(seen["reacted"], true, "{seen}");
}

#[test]
fn pages_of_shipped_models_open_without_error() {
    let Some(browser) = browser() else { return };
    let folder = tempfile::tempdir().expect("a folder");
    for spec in shipped_specifications() {
        let seen = run_probe(browser, &write_page(&spec, &[], folder.path()), WIDE_WINDOW);
        assert_eq!(
            seen["errors"],
            serde_json::json!([]),
            "{}: {seen}",
            spec.display()
        );
        assert_eq!(seen["moved"][0], true, "{}: {seen}", spec.display());
        assert_eq!(seen["excess"], 0, "{}: {seen}", spec.display());
    }
}
