//! Tests of the output and the rejected options of `eomgen page`.

use eomgen_tests::models::path;
use eomgen_tests::program::{run_accepted, run_rejected};

use super::{drawn_example, write_page};

#[test]
fn page_is_self_contained() {
    let folder = tempfile::tempdir().expect("a folder");
    for spec in [path("pendulum"), drawn_example("double_pendulum")] {
        let text = std::fs::read_to_string(write_page(&spec, &[], folder.path())).expect("a page");
        for forbidden in [
            " src=", "http:", "https:", "url(", "@import", "fetch(", "import(",
        ] {
            assert!(!text.contains(forbidden), "{forbidden}");
        }
        assert!(text.contains("default-src 'none'"));
        assert!(text.contains("<math>"), "no equations");
        assert_eq!(text.matches("<script").count(), 2);
    }
}

#[test]
fn page_has_units_and_ranges_of_specification() {
    let text = run_accepted(&[
        "page",
        &drawn_example("double_pendulum").display().to_string(),
        "--out",
        "-",
    ]);
    let control = text
        .split("<div class=\"control\"")
        .find(|part| part.contains("upper rod</small>"));
    let control = control.expect("the control of l_1");
    for part in [
        "data-factor=\"0.001\"",
        ">mm<",
        "min=\"100\"",
        "max=\"1000\"",
        "value=\"600\"",
    ] {
        assert!(control.contains(part), "{part}: {control}");
    }
}

#[test]
fn pages_are_reproducible() {
    let spec = path("planetary_arm").display().to_string();
    let page = || run_accepted(&["page", &spec, "--order", "1", "--out", "-"]);
    assert_eq!(page(), page());
}

#[test]
fn invalid_options_are_rejected() {
    let spec = path("planetary_arm").display().to_string();
    let page = |options: &[&str]| run_rejected(&[&["page", &spec], options].concat());
    assert!(page(&[]).contains("--out"));
    assert!(page(&["--out", "-", "--order", "129"]).contains("128"));
    assert!(page(&["--out", "-", "--order", "x"]).contains("whole number"));
    let folder = tempfile::tempdir().expect("a folder");
    assert!(page(&["--out", &folder.path().display().to_string()]).contains("not a file"));
    let file = folder.path().join("file");
    std::fs::write(&file, "kept").expect("written");
    let below = file.join("page.html").display().to_string();
    assert!(page(&["--out", &below]).contains("error"));
    assert_eq!(std::fs::read_to_string(&file).expect("a file"), "kept");
}
