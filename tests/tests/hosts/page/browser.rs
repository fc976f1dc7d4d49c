//! The pages in a browser, with its network off: they open without an error, move, react to a slider
//! and fit their window, light and dark. A small script speaks with the browser.

use std::path::Path;
use std::process::Command;

use eomgen_tests::models::{path, project, shipped};
use serde_json::Value;

use super::{drawn, page};

/// The browser, if there is one and node, which speaks with it; says so if not.
pub fn browser() -> Option<&'static str> {
    let runs = |name: &str| {
        let found = Command::new(name).arg("--version").output();
        found.is_ok_and(|output| output.status.success())
    };
    let names = ["chromium", "chromium-browser", "google-chrome"];
    let found = names.into_iter().find(|name| runs("node") && runs(name));
    if found.is_none() {
        skips::skip(
            "no page was opened, for want of node and a browser (Debian: nodejs, chromium)",
        );
    }
    found
}

/// How a page is looked at.
#[derive(Clone, Copy)]
pub struct Look {
    pub width: u32,
    pub dark: bool,
    pub still: bool,
}

/// An ordinary look.
pub const WIDE: Look = Look {
    width: 1280,
    dark: false,
    still: false,
};

/// What the probe saw in a page to play with.
pub fn probed(browser: &str, page: &Path, look: Look) -> Value {
    probed_by("probe.js", browser, page, look)
}

/// What a probe saw in a page.
pub fn probed_by(probe: &str, browser: &str, page: &Path, look: Look) -> Value {
    let script = |name: &str| project().join("tests/tests/hosts/page").join(name);
    let Look { width, dark, still } = look;
    let look = serde_json::json!({ "width": width, "dark": dark, "still": still });
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

/// Asserts what holds of every page that moves by itself.
fn moves(seen: &Value) {
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
fn a_drawn_model_moves_and_reacts_at_every_size_and_colour() {
    let Some(browser) = browser() else { return };
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["double_pendulum", "crane", "flexible_arm"] {
        let page = page(&drawn(name), &[], folder.path());
        for (width, dark) in [(1280, false), (400, true)] {
            let seen = probed(
                browser,
                &page,
                Look {
                    width,
                    dark,
                    ..WIDE
                },
            );
            moves(&seen);
            assert_eq!(seen["dark"], dark, "{seen}");
        }
    }
}

#[test]
fn nothing_moves_by_itself_for_who_wants_less_motion() {
    let Some(browser) = browser() else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let page = page(&path("double_pendulum"), &[], folder.path());
    let seen = probed(
        browser,
        &page,
        Look {
            still: true,
            ..WIDE
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
fn shipped_models_open_without_an_error() {
    let Some(browser) = browser() else { return };
    let folder = tempfile::tempdir().expect("a folder");
    for spec in shipped() {
        let seen = probed(browser, &page(&spec, &[], folder.path()), WIDE);
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
