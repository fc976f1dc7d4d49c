//! Parameters of a stage that nobody called uncertain: another name for what is found where the
//! records cannot tell them from it, and none where they can.

use eomgen_tests::measured::{DESCRIPTION, Measured, Moment};
use serde_json::{Value, json};

/// The only effect found in records of a stage of which no parameter is called uncertain.
fn found(other: &dyn Fn(Moment) -> f64) -> Value {
    let measured = Measured::stage_with(other);
    let declared = "[uncertain]\nF_v = { relative = 0.05 }\n";
    let description = DESCRIPTION.replace(declared, "");
    assert_ne!(description, DESCRIPTION);
    measured.write("dataset.toml", description.as_bytes());
    let (document, _) = measured.answered("discover", "found");
    let effects = document["effects"].as_array().expect("a list");
    assert_eq!(effects.len(), 1, "{effects:#?}");
    effects[0].clone()
}

#[test]
fn friction_that_may_be_a_parameter_is_reported_with_it() {
    // N s/m, a seventh of what the stage has.
    let effect = found(&|at| -30.0 * at.v);
    assert_eq!(effect["effect"], "viscous_friction", "{effect:#}");
    assert_eq!(effect["status"], "class", "{effect:#}");
    let others = effect["equivalent"].as_array().expect("a list");
    let names: Vec<[&Value; 2]> = others.iter().map(|o| [&o["effect"], &o["on"]]).collect();
    assert_eq!(names, [[&json!("parameter_shift"), &json!("F_v")]]);
}

#[test]
fn friction_that_is_no_parameter_is_named() {
    let effect = found(&|at| -3.0 * (at.v / 1e-4).tanh());
    assert_eq!(effect["effect"], "coulomb_friction", "{effect:#}");
    assert_eq!(effect["status"], "named", "{effect:#}");
}
