//! Inertia at the initial state: what lacks it is refused where it is declared, and right models
//! are not.

use eomgen_codegen::mechanics::examination::examine;
use eomgen_codegen::variant::Variant;
use eomgen_model_spec::diagnostic::Record;

use crate::support::{model, models};

/// Two coordinates with this kinetic energy and these properties of the second.
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
    assert!(Variant::derive_to_read(&model, &orders, &[]).is_ok());
    Some(found.records().remove(0))
}

#[test]
fn inertia_that_is_missing_or_negative_is_refused_at_its_coordinate() {
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
            "comes out as -inf",
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
fn inertia_that_vanishes_elsewhere_is_no_fault() {
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
fn no_shipped_specification_and_no_feature_lacks_inertia() {
    for folder in [models(), models().join("../../tests/tests/features")] {
        for entry in std::fs::read_dir(folder).unwrap() {
            let text = std::fs::read_to_string(entry.unwrap().path()).unwrap();
            assert_eq!(found(&text), None);
        }
    }
}

#[test]
fn modes_without_inertia_are_named_by_their_field() {
    let path = models().join("../../tests/tests/features/massless_beam.toml");
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

/// The head of a model with so many coordinates of a unit.
fn coordinates(count: usize, unit: &str, gravity: &str) -> String {
    let head = format!(
        "[model]\nname = \"grown\"\n{gravity}[parameters]\nm = {{ value = 1, unit = \"kg\" }}\n\
         l = {{ value = 1, unit = \"m\" }}\nk = {{ value = 1, unit = \"N/m\" }}\n\
         g = {{ value = 9.81, unit = \"m/s^2\" }}\nJ = {{ value = 0.1, unit = \"kg m^2\" }}\n[coordinates]\n"
    );
    let names = (0..count).map(|place| format!("q{place} = {{ unit = \"{unit}\" }}\n"));
    head + &names.collect::<String>()
}

/// One line for each of so many places, the first by itself.
fn lines(count: usize, first: &str, line: &dyn Fn(usize) -> String) -> String {
    let others = (1..count).map(|place| line(place) + "\n");
    format!("{first}\n{}", others.collect::<String>())
}

fn independent_masses(count: usize) -> String {
    let mass = |place: usize| format!("T{place} = \"1/2*m*dot(q{place})^2\"");
    coordinates(count, "m", "") + "[kinetic]\n" + &lines(count, &mass(0), &mass)
}

fn masses_between_springs(count: usize) -> String {
    let spring = |place: usize| format!("V{place} = \"1/2*k*(q{place} - q{})^2\"", place - 1);
    independent_masses(count) + "[potential]\n" + &lines(count, "V0 = \"1/2*k*q0^2\"", &spring)
}

fn masses_that_carry_each_other(count: usize) -> String {
    let mass = |place: usize| {
        format!(
            "T{place} = \"1/2*m*(dot(q{place}) - dot(q{}))^2\"",
            place - 1
        )
    };
    coordinates(count, "m", "") + "[kinetic]\n" + &lines(count, "T0 = \"1/2*m*dot(q0)^2\"", &mass)
}

/// A chain of bodies whose joints turn about these axes in turn.
fn bodies(count: usize, axes: &str) -> String {
    let axis = |place: usize| axes.as_bytes()[place % axes.len()] as char;
    let frame = |place: usize| {
        format!(
            "F{place} = {{ in = \"F{}\", origin = [\"l\", 0, 0], rotation = \"rotation_{}(q{place})\" }}",
            place - 1,
            axis(place)
        )
    };
    let first = format!("F0 = {{ rotation = \"rotation_{}(q0)\" }}", axis(0));
    let body = |place: usize| {
        format!(
            "B{place} = {{ frame = \"F{place}\", mass = \"m\", centre = [\"l\", 0, 0], inertia = [\"J\", \"J\", \"J\"] }}"
        )
    };
    coordinates(count, "rad", "gravity = [0, \"-g\", 0]\n")
        + "[frames]\n"
        + &lines(count, &first, &frame)
        + "[bodies]\n"
        + &lines(count, &body(0), &body)
}

/// A chain of points in the plane, each by the one before.
fn points(count: usize) -> String {
    let point = |place: usize| {
        format!(
            "r{place} = \"r{} + l*[cos(q{place}), sin(q{place})]\"",
            place - 1
        )
    };
    let energy = |place: usize| format!("T{place} = \"1/2*m*dot(dot(r{place}), dot(r{place}))\"");
    coordinates(count, "rad", "")
        + "[definitions]\n"
        + &lines(count, "r0 = \"l*[cos(q0), sin(q0)]\"", &point)
        + "[kinetic]\n"
        + &lines(count, &energy(0), &energy)
}

/// Points in space, each turned further by a rotation that the one before has made.
fn turned_points(count: usize) -> String {
    let axis = |place: usize| ["x", "y", "z"][place % 3];
    let point = |place: usize| {
        let (before, axis) = (place - 1, axis(place));
        format!(
            "R{place} = \"R{before}*rotation_{axis}(q{place})\"\nr{place} = \"r{before} + R{place}*[l, l, 0]\""
        )
    };
    let energy = |place: usize| {
        format!("T{place} = \"1/2*m*dot(dot(r{place}), dot(r{place})) + 1/2*J*dot(q{place})^2\"")
    };
    coordinates(count, "rad", "")
        + "[definitions]\n"
        + &lines(
            count,
            "R0 = \"rotation_x(q0)\"\nr0 = \"R0*[l, l, 0]\"",
            &point,
        )
        + "[kinetic]\n"
        + &lines(count, &energy(0), &energy)
}

/// A specification of a given size.
type TextOfSize<'a> = &'a dyn Fn(usize) -> String;

#[test]
fn an_examination_grows_as_its_specification_does() {
    let cases: [(&str, usize, TextOfSize<'_>); 7] = [
        ("masses", 1000, &independent_masses),
        ("springs", 1000, &masses_between_springs),
        ("carried", 1000, &masses_that_carry_each_other),
        ("bodies in the plane", 50, &|count| bodies(count, "z")),
        ("bodies in space", 50, &|count| bodies(count, "xyz")),
        ("points", 50, &points),
        ("turned points", 50, &turned_points),
    ];
    for (name, count, text) in cases {
        let [single, double] = [count, 2 * count].map(|count| {
            let examined = examine(&model(&text(count))).expect(name);
            examined.unwrap_or_else(|| panic!("{name} is derived"))
        });
        assert!(
            2 * double.nodes <= 5 * single.nodes,
            "{name}: {single:?} {double:?}"
        );
        assert!(
            2 * double.updates <= 5 * single.updates,
            "{name}: {single:?} {double:?}"
        );
    }
}

/// Three joints that turn one body about one point, the first and the last about one axis.
fn gimbal(initial: f64) -> String {
    let text = bodies(3, "zxz").replace("[\"l\", 0, 0]", "[0, 0, 0]");
    let turned = format!("q1 = {{ unit = \"rad\", initial = {initial}");
    let text = text.replace("q1 = { unit = \"rad\"", &turned);
    let kept = text
        .lines()
        .filter(|line| !line.starts_with("B0") && !line.starts_with("B1"));
    kept.map(|line| line.to_owned() + "\n").collect()
}

#[test]
fn an_examination_refuses_what_lacks_inertia_and_nothing_else() {
    let masses = independent_masses(30);
    let carried = masses_that_carry_each_other(40);
    let own = "*m*dot(q7)^2";
    for (text, lack) in [
        (
            masses.replace(own, "*(m - m)*dot(q7)^2"),
            Some("`q7` has no inertia"),
        ),
        (
            masses.replace(own, "*(m - 3*m)*dot(q7)^2"),
            Some("`q7` has the negative inertia -2e0"),
        ),
        (
            masses.replace(own, "*m*(dot(q7) + dot(q8))^2 - 1/2*m*dot(q8)^2"),
            Some("`q7`, `q8` together have no inertia"),
        ),
        (carried.replace("1/2*m*dot(q0)^2", "m/1e9*dot(q0)^2"), None),
        (
            carried.replace("1/2*m*dot(q0)^2", "0*m*dot(q0)^2"),
            Some("`q0`, `q1`"),
        ),
        (gimbal(0.0), Some("`q0`, `q2` together have no inertia")),
        (gimbal(1e-3), None),
    ] {
        let model = model(&text);
        let examined = examine(&model).map_err(|found| found.message);
        match (examined, lack) {
            (Ok(Some(_)), None) => {}
            (Err(message), Some(lack)) => assert!(message.contains(lack), "{message}"),
            (examined, lack) => panic!("{examined:?} {lack:?}"),
        }
        assert_eq!(Variant::derive(&model, &[]).is_err(), lack.is_some());
    }
}
