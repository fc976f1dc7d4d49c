//! Tests of undeclared parameters of a stage: a parameter is listed as equivalent to an effect only if the records
//! cannot separate them.

use eomgen_tests::measured::{DESCRIPTION, Measured, Moment};
use serde_json::{Value, json};

/// Returns the only effect found in records of a stage. No uncertain parameter is related to the effect.
fn only_effect(other: &dyn Fn(Moment) -> f64) -> Value {
    let measured = Measured::stage_with_force(other);
    let declared = "[uncertain]\nF_v = { relative = 0.05 }\n";
    let description = DESCRIPTION.replace(declared, "");
    assert_ne!(description, DESCRIPTION);
    measured.write("dataset.toml", description.as_bytes());
    let (document, _) = measured.run_command("discover", "found");
    let effects = document["effects"].as_array().expect("a list");
    assert_eq!(effects.len(), 1, "{effects:#?}");
    effects[0].clone()
}

#[test]
fn viscous_friction_is_reported_with_equivalent_parameter() {
    // The additional friction of 30 N s/m is a seventh of the stage's own viscous friction.
    let effect = only_effect(&|at| -30.0 * at.v);
    assert_eq!(effect["effect"], "viscous_friction", "{effect:#}");
    assert_eq!(effect["status"], "class", "{effect:#}");
    let others = effect["equivalent"].as_array().expect("a list");
    let names: Vec<[&Value; 2]> = others.iter().map(|o| [&o["effect"], &o["on"]]).collect();
    assert_eq!(names, [[&json!("parameter_shift"), &json!("F_v")]]);
}

#[test]
fn dry_friction_is_reported_without_equivalent_parameter() {
    let effect = only_effect(&|at| -3.0 * (at.v / 1e-4).tanh());
    assert_eq!(effect["effect"], "coulomb_friction", "{effect:#}");
    assert_eq!(effect["status"], "named", "{effect:#}");
}

#[test]
fn noise_declared_too_small_is_noted() {
    let note_of = |declared: &str| {
        let measured = Measured::stage_with_force(&|_| 0.0);
        let description = DESCRIPTION.replace("noise = 1e-6", declared);
        measured.write("dataset.toml", description.as_bytes());
        let (document, _) = measured.run_command("compare", "compared");
        let notes = document["notes"].to_string();
        notes.contains("declared noise is 500 nm")
    };
    assert!(note_of("noise = 5e-7"));
    assert!(!note_of("noise = 1e-6"));
}
