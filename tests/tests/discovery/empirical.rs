//! Tests with forces outside the catalogue on a stage. A function of rate and position is found as an empirical
//! expression; any other force remains unexplained.

use std::f64::consts::TAU;

use eomgen_tests::measured::Measured;
use eomgen_tests::program;
use serde_json::Value;

const SEARCH_MESSAGE: &str = "searching for a force that is an expression";

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

fn parameter(text: &str, name: &str) -> f64 {
    let lines = text.lines().map(str::trim_start);
    let mut own = lines.filter(|line| line.starts_with(&format!("{name} = {{")));
    let line = own.next().expect("the parameter");
    let (_, rest) = line.split_once("value = ").expect("a value");
    let (value, _) = rest.split_once(',').expect("text after the value");
    value.parse().expect("a number")
}

#[test]
fn force_outside_catalogue_becomes_an_expression() {
    // Increase of the guides' viscous friction towards one side, in N s/m^2.
    let tighter = 60.0;
    let measured = Measured::stage_with_force(&|at| -tighter * at.q * at.v);
    let (found, _) = measured.run_command("discover", "found");
    assert_eq!(found["verdict"], "effects_found", "{found:#}");
    let effects = found["effects"].as_array().expect("a list");
    assert_eq!(effects.len(), 1, "{effects:#?}");
    let effect = &effects[0];
    for (key, value) in [
        ("effect", "empirical"),
        ("on", "q"),
        ("status", "empirical"),
    ] {
        assert_eq!(effect[key], value, "{effect:#}");
    }
    assert_eq!(effect["term"], "e_1*(dot(q)/e_rate)*(q/e_place)");

    let extended = measured.read("found/extended.toml");
    let size = &effect["parameters"]["e_1"];
    let scale = parameter(&extended, "e_rate") * parameter(&extended, "e_place");
    let (value, sd) = (number(&size["value"]) / scale, number(&size["sd"]) / scale);
    assert_eq!(size["unit"], "N");
    // The deviation exceeds 4 standard deviations in one of fifteen thousand records.
    assert!((value + tighter).abs() < 4.0 * sd, "{value} +- {sd}");
    assert!(sd < 0.05 * tighter, "{value} +- {sd}");

    let gap = &found["gap"]["q"];
    let (before, after) = (
        number(&gap["before"]["test"]),
        number(&gap["after"]["test"]),
    );
    // A correct model reaches the noise floor; each effect must close at least half of the gap.
    assert!(
        after < 1.2 * number(&gap["floor"]) && before > 3.0 * after,
        "{gap:#}"
    );
    assert!(
        number(&found["closure"]["test"]) > 0.9,
        "{}",
        found["closure"]
    );
    let steps = found["steps"].as_array().expect("a list");
    assert_eq!(steps[1]["added"][0], "empirical on q");
    assert!(number(&steps[1]["test_rms_over_noise"]) < number(&steps[0]["test_rms_over_noise"]));

    // The extended specification must be valid and explain both records.
    assert_eq!(
        found["validation"]["passed"], true,
        "{}",
        found["validation"]
    );
    assert_eq!(steps[1]["validated"], true);
    // The extended specification must reach the noise floor within ten percent. Refitted values that changed by less
    // than half of their uncertainty are not written.
    for set in ["train_rms_over_noise", "test_rms_over_noise"] {
        let left = number(&found["validation"][set]);
        assert!(left < 1.1, "{set}: {left}");
    }
    assert!(extended.contains("source = \"fitted to "), "{extended}");
    let [specification, dataset, out] = ["found/extended.toml", "dataset.toml", "again"]
        .map(|name| measured.file(name).display().to_string());
    let again = program::run(&["compare", &specification, &dataset, "--out", &out]);
    assert_eq!(
        again.status.code(),
        Some(0),
        "{}",
        program::text(&again.stderr)
    );
    let again: Value = serde_json::from_str(&measured.read("again/comparison.json")).expect("JSON");
    assert_eq!(again["verdict"], "no_significant_gap", "{again:#}");
}

#[test]
fn force_with_threshold_becomes_expression_with_kink() {
    // Cable that is taut beyond 60 mm, with a stiffness in N/m; the model has no spring.
    let (from, stiffness) = (0.06, 2e3);
    let measured = Measured::stage_with_force(&|at| -stiffness * (at.q - from).max(0.0));
    let (found, _) = measured.run_command("discover", "found");
    let effects = found["effects"].as_array().expect("a list");
    assert_eq!(effects.len(), 1, "{effects:#?}");
    let effect = &effects[0];
    assert_eq!(effect["effect"], "empirical", "{effect:#}");
    assert_eq!(effect["term"], "e_1*max(q/e_place - e_kink, 0)");
    let scale = parameter(&measured.read("found/extended.toml"), "e_place");
    for (name, wanted) in [("e_1", -stiffness * scale), ("e_kink", from / scale)] {
        let found = &effect["parameters"][name];
        let (value, sd) = (number(&found["value"]), number(&found["sd"]));
        assert!((value - wanted).abs() < 4.0 * sd, "{name}: {value} +- {sd}");
        assert!(sd < 0.01 * wanted.abs(), "{name}: {value} +- {sd}");
    }
    let closure = number(&found["closure"]["test"]);
    assert!(closure > 0.99, "{closure}");
    assert_eq!(found["validation"]["passed"], true, "{found:#}");
}

#[test]
fn external_force_stays_unexplained() {
    let measured = Measured::stage_with_force(&|at| 6.0 * (TAU * 17.3 * at.t).sin());
    let (found, message) = measured.run_command("discover", "found");
    assert_eq!(found["verdict"], "unexplained", "{found:#}");
    assert_eq!(found["effects"], serde_json::json!([]));
    assert!(message.contains(SEARCH_MESSAGE), "{message}");
    assert!(!measured.read("found/extended.toml").contains("empirical"));
    let gap = &found["gap"]["q"];
    assert!(
        number(&gap["after"]["test"]) > 3.0 * number(&gap["floor"]),
        "{gap:#}"
    );
}

#[test]
fn no_expression_is_searched_if_nothing_is_missing_or_effect_is_named() {
    for (friction, verdict) in [(0.0, "no_significant_gap"), (3.0, "effects_found")] {
        let measured = Measured::stage(friction);
        let (found, message) = measured.run_command("discover", "found");
        assert_eq!(found["verdict"], verdict, "{found:#}");
        assert!(!message.contains(SEARCH_MESSAGE), "{message}");
    }
}
