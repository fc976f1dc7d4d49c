//! Tests with several records: contradictory records, and a search that its time limit stops.

use eomgen_tests::measured::{DESCRIPTION, Measured, Moment, record_with_force};
use eomgen_tests::program;
use serde_json::Value;

fn notes(document: &Value) -> String {
    document["notes"].to_string()
}

#[test]
fn contradictory_records_are_named_with_their_separate_fits() {
    let more = |at: Moment| -150.0 * at.v;
    let measured = Measured::stage(0.0);
    measured.write("other.csv", record_with_force(&more, 0.4).as_bytes());
    let both = DESCRIPTION
        .replace("[\"train.csv\"]", "[\"train.csv\", \"other.csv\"]")
        .replace("relative = 0.05", "relative = 0.2");
    measured.write("dataset.toml", both.as_bytes());
    let (result, warned) = measured.run_command("compare", "both");
    let found = notes(&result);
    assert!(found.contains("contradict each other"), "{found}");
    assert!(
        found.contains("train[1]") && found.contains("`F_v`") && found.contains("e2 ± "),
        "{found}"
    );
    assert!(warned.contains("contradict each other"), "{warned}");
    // Records of one machine with a missing effect do not contradict each other.
    let dry = |at: Moment| -3.0 * (at.v / 1e-4).tanh();
    let sound = Measured::stage(3.0);
    sound.write("other.csv", record_with_force(&dry, 0.4).as_bytes());
    sound.write("dataset.toml", both.as_bytes());
    let (result, _) = sound.run_command("compare", "sound");
    assert_eq!(result["verdict"], "gap_found", "{result:#}");
    assert!(!notes(&result).contains("contradict"), "{result:#}");
}

#[test]
fn different_payload_in_one_record_is_reported() {
    // The mass is 95 kg, plus 24 kg in one record.
    let payload = |at: Moment| (at.force - 210.0 * at.v) * (95.0 / 119.0 - 1.0);
    let measured = Measured::stage(0.0);
    measured.write("other.csv", record_with_force(&payload, 0.4).as_bytes());
    let both = DESCRIPTION.replace("[\"train.csv\"]", "[\"train.csv\", \"other.csv\"]");
    measured.write("dataset.toml", both.as_bytes());
    let (result, _) = measured.run_command("discover", "both");
    let found = notes(&result);
    let said = "train[1] does not agree with train[0], test[0]";
    assert!(found.contains(said), "{result:#}");
    assert!(found.contains("`M` = 1.1"), "{found}");
}

#[test]
fn effect_not_confirmed_by_held_out_record_is_reported() {
    // Two records have dry friction of 3 N; the third is from a vibrating bench.
    let dry = |at: Moment| -3.0 * (at.v / 1e-4).tanh();
    let shaken = |at: Moment| -3.0 * (at.v / 1e-4).tanh() + 90.0 * (61.0 * at.force).sin();
    let measured = Measured::stage(3.0);
    measured.write("other.csv", record_with_force(&dry, 0.4).as_bytes());
    measured.write("test.csv", record_with_force(&shaken, 0.7).as_bytes());
    let three = DESCRIPTION.replace("[\"train.csv\"]", "[\"train.csv\", \"other.csv\"]");
    measured.write("dataset.toml", three.as_bytes());
    let (result, _) = measured.run_command("discover", "shaken");
    assert_eq!(result["verdict"], "unexplained", "{result:#}");
    let found = notes(&result);
    for said in [
        "with coulomb_friction on q",
        "do not confirm it",
        "test[0] does not agree with train[0], train[1]",
    ] {
        assert!(found.contains(said), "{said}: {found}");
    }
}

#[test]
fn search_stopped_by_time_limit_writes_partial_results() {
    let measured = Measured::stage(3.0);
    let arguments = measured.arguments("discover", "cut");
    let mut arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    arguments.extend(["--limit", "1e-6"]);
    program::run_accepted(&arguments);
    let found: Value = serde_json::from_str(&measured.read("cut/discovery.json")).expect("JSON");
    assert_eq!(found["verdict"], "unexplained");
    assert_eq!(
        found["unfinished"],
        "no fit of an effect was complete at the limit"
    );
    let summary = found["summary"].as_str().expect("a sentence");
    assert!(summary.contains("reached its time limit"), "{summary}");
    assert!(
        notes(&found).contains("reached its time limit of 0.000001 s"),
        "{found:#}"
    );
    assert!(measured.read("cut/extended.toml").contains("[model]"));
    for wrong in ["0", "-1", "nan"] {
        let mut arguments = arguments.clone();
        arguments.pop();
        arguments.push(wrong);
        assert!(
            program::run_rejected(&arguments).contains("--limit"),
            "{wrong}"
        );
    }
    let (whole, warned) = measured.run_command("discover", "whole");
    assert_eq!(whole["unfinished"], Value::Null);
    assert_eq!(whole["effects"][0]["effect"], "coulomb_friction");
    assert!(warned.contains("effect 1 of at most 4: "), "{warned}");
}
