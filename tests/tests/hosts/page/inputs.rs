//! Tests of the inputs of interactive pages: each input has one control, and its rates are computed from its signal.

use eomgen_tests::models::{path, project};
use eomgen_tests::program::run_accepted;

#[test]
fn prescribed_input_has_one_control() {
    let spec = path("crane").display().to_string();
    let page = run_accepted(&["page", &spec, "--out", "-"]);
    let model = eomgen_model_spec::load(&path("crane"))
        .expect("it loads")
        .model;
    let own = model
        .inputs
        .iter()
        .filter(|input| input.rate_of.is_none())
        .count();
    assert!(own < model.inputs.len(), "the model has rates of inputs");
    assert_eq!(
        page.matches("data-signal").count() - script_mentions(&page),
        own
    );
    assert!(!page.contains("ddot</mi>"));
    for form in ["constant", "sine", "step"] {
        assert!(
            page.contains(&format!("<option value=\"{form}\"")),
            "{form}"
        );
    }
}

#[test]
fn machine_at_rest_starts_with_a_sine() {
    let page = |name: &str| {
        let spec = path(name).display().to_string();
        run_accepted(&["page", &spec, "--out", "-"])
    };
    let resting = page("emps");
    assert!(resting.contains("Without inputs this machine stays at rest."));
    assert!(resting.contains("<option value=\"sine\" selected>"));
    let moving = page("crane");
    assert!(!moving.contains("stays at rest"));
    assert!(!moving.contains("<option value=\"sine\" selected>"));
}

/// The page of a crane opens with a slow rotation of the jib, not with several turns per second.
#[test]
fn prescribed_motion_starts_slowly() {
    let spec = project().join("examples/recipes/slewing_crane.toml");
    let page = run_accepted(&["page", &spec.display().to_string(), "--out", "-"]);
    let field = |name: &str| {
        let end = format!("\" aria-label=\"{name} of gamma in ");
        let before = page.split(&end).next().expect("a field");
        let value = before.rsplit("value=\"").next().expect("a value");
        value.parse::<f64>().expect("a number")
    };
    assert_eq!([field("change"), field("period")], [0.314159, 10.0]);
}

/// Returns the number of occurrences in the script.
fn script_mentions(page: &str) -> usize {
    let script = page.rsplit("<script>").next().unwrap_or_default();
    script.matches("data-signal").count()
}
