//! Tests of `modes` for models with one stiffness so large that the others are lost by rounding.

use std::f64::consts::TAU;

use eomgen_tests::program::run_rejected;

use super::{run_json, write_model};

/// Returns a model of two masses of 1 kg. The terms `springs` use the stiffnesses k = `stiff` and c = 25 N/m.
fn masses(stiff: &str, springs: &str) -> String {
    format!(
        "[model]\nname = \"masses\"\n[parameters]\nm = {{ value = 1, unit = \"kg\" }}\n\
         k = {{ value = {stiff}, unit = \"N/m\" }}\nc = {{ value = 25, unit = \"N/m\" }}\n\
         [coordinates]\nx = {{ unit = \"m\" }}\ny = {{ unit = \"m\" }}\n\
         [kinetic]\nT = \"1/2*m*(dot(x)^2 + dot(y)^2)\"\n[potential]\nV = \"{springs}\"\n"
    )
}

#[test]
fn lost_stiffness_is_rejected_with_its_name() {
    let folder = tempfile::tempdir().expect("a folder");
    // The stiff spring k joins the masses: omega^2 = c/(2 m) = 25/2 1/s^2, which is lost in the sum k + c.
    for stiff in ["1e16", "1e20", "1e30", "1e120", "1e200", "1e300"] {
        let text = masses(stiff, "1/2*k*(x - y)^2 + 1/2*c*y^2");
        let message = run_rejected(&["modes", &write_model(folder.path(), &text)]);
        assert!(
            message.contains("the term with `c` is below the rounding"),
            "{message}"
        );
    }
}

#[test]
fn frequency_zero_reports_its_accuracy() {
    let folder = tempfile::tempdir().expect("a folder");
    let right = f64::sqrt(12.5) / TAU;
    for stiff in ["1e10", "1e11", "1e12", "1e13", "1e14", "1e15"] {
        let spec = write_model(folder.path(), &masses(stiff, "1/2*k*(x - y)^2 + 1/2*c*y^2"));
        let found = run_json(&["modes", &spec, "--json"]);
        let number = |key: &str| found["modes"][0][key].as_f64();
        let frequency = number("frequency").expect("a number");
        match number("frequency_limit") {
            Some(limit) => assert!(frequency == 0.0 && limit > right, "{stiff}: {limit}"),
            None => assert!(
                (frequency / right - 1.0).abs() < 1e-3,
                "{stiff}: {frequency}"
            ),
        }
    }
}

#[test]
fn visible_stiffness_and_rigid_motions_keep_their_frequencies() {
    let folder = tempfile::tempdir().expect("a folder");
    let lowest = |stiff: &str, springs: &str| {
        let spec = write_model(folder.path(), &masses(stiff, springs));
        let found = run_json(&["modes", &spec, "--json"]);
        found["modes"][0]["frequency"].as_f64().expect("a number")
    };
    // The soft spring is in series with the stiff one, or it acts on both masses.
    for (stiff, springs, square) in [
        ("1e30", "1/2*k*x^2 + 1/2*c*(y - x)^2", 25.0),
        ("1e9", "1/2*k*(x - y)^2 + 1/2*c*y^2", 12.5),
    ] {
        let right = f64::sqrt(square) / TAU;
        let found = lowest(stiff, springs);
        assert!((found / right - 1.0).abs() < 1e-5, "{stiff}: {found}");
    }
    // A free pair of masses has the exact frequency 0; no term is lost.
    assert_eq!(lowest("1e30", "1/2*k*(x - y)^2 + 0*c*x^2"), 0.0);
}
