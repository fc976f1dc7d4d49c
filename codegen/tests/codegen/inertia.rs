//! Inertia at the initial state: a coordinate without inertia is rejected at its declaration, and correct models are
//! accepted.

use eomgen_codegen::variant::Variant;
use eomgen_model_spec::diagnostic::Record;

use crate::support::{model, models};

/// Returns two coordinates with this kinetic energy and these properties of the second.
fn spec(kinetic: &str, second: &str) -> String {
    format!(
        "[model]\nname = \"mass\"\ntitle = \"Mass\"\n[parameters]\nm = {{ value = 2, unit = \"kg\" }}\n\
         l = {{ value = 1, unit = \"m\" }}\nv = {{ value = 1, unit = \"m/s\" }}\n[coordinates]\nx = {{ unit = \"m\" }}\ny = {{ unit = \"m\"{second} }}\n\
         [kinetic]\nall = \"{kinetic}\"\n"
    )
}

fn found(text: &str) -> Option<Record> {
    let model = model(text);
    let orders = model.orders(None).unwrap();
    let found = Variant::derive(&model, &orders).err()?;
    assert!(Variant::derive_for_report(&model, &orders, &[]).is_ok());
    Some(found.records().remove(0))
}

#[test]
fn missing_or_negative_inertia_is_rejected_at_its_coordinate() {
    for (kinetic, line, message) in [
        (
            "1/2*m*(dot(x) + dot(y))^2",
            9,
            "`x`, `y` together have no inertia",
        ),
        (
            "1/2*m*dot(x)^2 + 0*m*dot(y)^2",
            10,
            "the coordinate `y` has no inertia",
        ),
        (
            "1/2*m*dot(x)^2 - 1/2*m*dot(y)^2",
            10,
            "the coordinate `y` has the negative inertia -2e0",
        ),
        (
            "1/2*m*(dot(x)^2 + dot(y)^2 + 4*dot(x)*dot(y))",
            9,
            "`x`, `y` together have a negative inertia",
        ),
        (
            "1/2*m*dot(x)^2 + 1/2*m*(y/l)^2*dot(y)^2",
            10,
            "the coordinate `y` has no inertia",
        ),
        (
            "1/2*m*dot(x)^2 + 1/2*m*ln(y/l)*dot(y)^2",
            10,
            "has the inertia -inf",
        ),
        (
            "1/2*m*dot(x)^2 + m*v*dot(y)",
            10,
            "the coordinate `y` has no inertia",
        ),
    ] {
        let found = found(&spec(kinetic, "")).unwrap_or_else(|| panic!("{kinetic} passes"));
        assert!(
            found.message.contains(message),
            "{kinetic}: {}",
            found.message
        );
        assert!(
            found.message.contains("not positive definite"),
            "{}",
            found.message
        );
        assert_eq!(
            (found.line, found.column),
            (Some(line), Some(1)),
            "{kinetic}"
        );
    }
}

#[test]
fn infinite_inertia_is_explained_by_a_large_parameter() {
    let text = spec(
        "1/2*m*dot(x)^2 + 1/2*m*(l/y)^2*dot(y)^2",
        ", initial = 1e-200",
    );
    let found = found(&text).unwrap();
    assert!(
        found.message.contains("`y` has the inertia inf"),
        "{}",
        found.message
    );
    let help = found.help.unwrap();
    assert!(
        help.contains("exceeds 1.8e308") && help.contains("too large"),
        "{help}"
    );
}

#[test]
fn inertia_that_vanishes_elsewhere_is_accepted() {
    for (kinetic, second) in [
        ("1/2*m*dot(x)^2 + 1/2*m*(y/l)^2*dot(y)^2", ", initial = 1"),
        ("1/2*m*dot(x)^2 + 1/2*m*cos(y/l)^2*dot(y)^2", ""),
        ("1/2*m*(dot(x) + dot(y))^2 + 1e-9*m*dot(y)^2", ""),
        ("1/2*m*(dot(x)*1e6 + dot(y))^2 + 1/2*m*dot(y)^2", ""),
    ] {
        assert_eq!(found(&spec(kinetic, second)), None, "{kinetic}");
    }
}

#[test]
fn shipped_specifications_and_features_have_inertia() {
    for folder in [models(), models().join("../../tests/features")] {
        for entry in std::fs::read_dir(folder).unwrap() {
            let text = std::fs::read_to_string(entry.unwrap().path()).unwrap();
            assert_eq!(found(&text), None);
        }
    }
}

#[test]
fn modes_without_inertia_are_named_by_their_field() {
    let path = models().join("../../tests/features/massless_beam.toml");
    let text = std::fs::read_to_string(path)
        .unwrap()
        .replace("order = 1", "order = 3");
    let found = found(&text).unwrap();
    assert!(
        found.message.contains("`q_2`") && found.message.contains("together"),
        "{}",
        found.message
    );
    assert!(
        text.lines()
            .nth(found.line.unwrap() - 1)
            .unwrap()
            .starts_with("[fields.w]")
    );
}
