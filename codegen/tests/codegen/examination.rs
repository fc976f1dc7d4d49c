//! Examination of a model: rejections that need no derived equations, and the growth of the number of graph nodes.

use eomgen_codegen::examination::{Examination, examine};
use eomgen_codegen::variant::Variant;
use eomgen_model_spec::source::Source;

use crate::support::model;

/// Returns the head of a model with `count` coordinates of a unit.
fn coordinates(count: usize, unit: &str, gravity: &str) -> String {
    let head = format!(
        "[model]\nname = \"grown\"\n{gravity}[parameters]\nm = {{ value = 1, unit = \"kg\" }}\n\
         l = {{ value = 1, unit = \"m\" }}\nk = {{ value = 1, unit = \"N/m\" }}\n\
         g = {{ value = 9.81, unit = \"m/s^2\" }}\nJ = {{ value = 0.1, unit = \"kg m^2\" }}\n[coordinates]\n"
    );
    let names = (0..count).map(|place| format!("q{place} = {{ unit = \"{unit}\" }}\n"));
    head + &names.collect::<String>()
}

/// Returns `count` lines; the first line is `first`.
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

/// Returns a chain of bodies whose joints rotate about these axes in turn.
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

/// Returns a chain of points in the plane, each relative to the one before.
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

/// Returns points in space with accumulated rotations.
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

/// Returns masses that fall on a floor.
fn falling_masses(count: usize) -> String {
    let impact =
        |place: usize| format!("i{place} = {{ when = \"q{place}\", restitution = \"1/2\" }}");
    independent_masses(count) + "[impacts]\n" + &lines(count, &impact(0), &impact)
}

/// Returns 2 `count` masses between springs, coupled in pairs by constraints.
fn masses_held_together(count: usize) -> String {
    let constraint = |place: usize| {
        format!(
            "c{place} = {{ zero = \"q{} - q{}\" }}",
            2 * place,
            2 * place + 1
        )
    };
    masses_between_springs(2 * count)
        + "[constraints]\n"
        + &lines(count, &constraint(0), &constraint)
}

/// Returns a chain of points in the plane on rods, each point with two coordinates.
fn points_on_rods(count: usize) -> String {
    let text = independent_masses(2 * count);
    let begins = (0..count).map(|place| {
        let declared = format!("q{} = {{ unit = \"m\"", 2 * place);
        (
            format!("{declared} }}"),
            format!("{declared}, initial = {} }}", place + 1),
        )
    });
    let text = begins.fold(text, |text, (declared, begun)| {
        text.replace(&declared, &begun)
    });
    let rod = |place: usize| {
        let (x, y) = (2 * place, 2 * place + 1);
        format!(
            "c{place} = {{ zero = \"(q{x} - q{})^2 + (q{y} - q{})^2 - l^2\" }}",
            x - 2,
            y - 2
        )
    };
    text + "[constraints]\n" + &lines(count, "c0 = { zero = \"q0^2 + q1^2 - l^2\" }", &rod)
}

/// Returns rolling wheels, each with a nonholonomic constraint.
fn rolling_wheels(count: usize) -> String {
    let constraint = |place: usize| {
        format!(
            "c{place} = {{ zero = \"dot(q{}) - 2*dot(q{})\" }}",
            2 * place,
            2 * place + 1
        )
    };
    independent_masses(2 * count) + "[constraints]\n" + &lines(count, &constraint(0), &constraint)
}

/// Returns a chain of springs with a named coefficient for each mass.
fn named_coefficients(count: usize) -> String {
    let named = |place: usize| format!("a{place} = {{ of = \"q{place}\", by = \"q{place}\" }}");
    masses_between_springs(count) + "[coefficients]\n" + &lines(count, &named(0), &named)
}

/// Returns masses with forces that each follow an input through a first-order state.
fn masses_with_states(count: usize) -> String {
    let input = |place: usize| format!("u{place} = {{ unit = \"N\" }}");
    let state = |place: usize| {
        format!(
            "z{place} = {{ unit = \"N\", rate = \"(u{place} - z{place})*k/m/(k/m)^(1/2)\", initial = 0 }}"
        )
    };
    let force = |place: usize| format!("f{place} = {{ on = \"q{place}\", value = \"-z{place}\" }}");
    independent_masses(count)
        + "[inputs]\n"
        + &lines(count, &input(0), &input)
        + "[states]\n"
        + &lines(count, &state(0), &state)
        + "[forces]\n"
        + &lines(count, &force(0), &force)
}

type TextOfSize<'a> = &'a dyn Fn(usize) -> String;

/// Examines a model that needs no equations.
fn examine_text(name: &str, text: &str) -> Examination {
    let examined =
        examine(&model(text)).unwrap_or_else(|found| panic!("{name}: {}", found.message));
    examined.unwrap_or_else(|| panic!("{name} is derived"))
}

#[test]
fn examination_grows_linearly_with_specification() {
    let cases: [(&str, usize, TextOfSize<'_>); 13] = [
        ("masses", 1000, &independent_masses),
        ("springs", 1000, &masses_between_springs),
        ("carried", 1000, &masses_that_carry_each_other),
        ("bodies in the plane", 50, &|count| bodies(count, "z")),
        ("bodies in space", 50, &|count| bodies(count, "xyz")),
        ("points", 50, &points),
        ("turned points", 50, &turned_points),
        ("falling", 50, &falling_masses),
        ("held together", 50, &masses_held_together),
        ("on rods", 50, &points_on_rods),
        ("rolling", 50, &rolling_wheels),
        ("coefficients", 500, &named_coefficients),
        ("states", 500, &masses_with_states),
    ];
    for (name, count, text) in cases {
        let [single, double] = [count, 2 * count].map(|count| examine_text(name, &text(count)));
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

#[test]
fn section_limits_are_enforced_and_named() {
    let cases: [(&str, usize, TextOfSize<'_>); 4] = [
        (
            "[coordinates] has more than 2000 entries",
            2000,
            &independent_masses,
        ),
        ("the chain of frames is longer than 100", 100, &|count| {
            bodies(count, "xyz")
        }),
        (
            "the model has too many constraints: 101",
            100,
            &rolling_wheels,
        ),
        ("the model has too many impacts: 101", 100, &falling_masses),
    ];
    for (rejection, most, text) in cases {
        let found = examine_text(rejection, &text(most));
        // About a hundred nodes for each frame.
        assert!(found.nodes <= 300 * most, "{rejection}: {found:?}");
        let beyond = eomgen_model_spec::check(Source::new("grown.toml", text(most + 1)));
        let said = beyond.expect_err(rejection).render(false);
        assert!(said.contains(rejection), "{said}");
    }
}

/// Returns a bead with the constraint `zero`.
fn constrained(zero: &str) -> String {
    coordinates(2, "m", "")
        + "[kinetic]\nT = \"1/2*m*(dot(q0)^2 + dot(q1)^2)\"\n"
        + "[constraints]\nrod = { zero = \""
        + zero
        + "\" }\n"
}

#[test]
fn constraints_that_are_never_zero_are_rejected_with_their_bound() {
    for (zero, bound) in [
        ("q0^2 + l^2", "at least 1.000e0 m^2"),
        ("q0^2 + (q1 - l)^2 + l^2/4", "at least 2.500e-1 m^2"),
        ("-l - (q0^2 + l^2)^(1/2) - q1^2/l", "at most -2.000e0 m"),
        ("cos(q0/l) + cosh(q1/l) + 1/2", "at least 5.000e-1 1"),
        ("1/(1 + (q0/l)^2) + 1/4", "at least 2.500e-1 1"),
        ("sin(t*(k/m)^(1/2)) - 2 - (q0/l)^2", "at most -1.000e0 1"),
    ] {
        let model = model(&constrained(zero));
        let found = examine(&model).expect_err(zero);
        assert_eq!(found.message, "the constraint `rod` is never zero");
        let said = Variant::derive(&model, &[])
            .map(drop)
            .expect_err(zero)
            .render(false);
        assert!(
            said.contains("the constraint `rod` is never zero"),
            "{said}"
        );
        assert!(said.contains(bound), "{zero}: {said}");
    }
    for zero in [
        "q0^2 - l^2",
        "q0^2 + q1^2 - l^2 + (q1 - q1)^2",
        "exp(q0/l) - 1",
        "q0*q1 + l^2",
    ] {
        assert!(examine(&model(&constrained(zero))).is_ok(), "{zero}");
    }
}

/// Returns three joints that rotate one body about one point, the first and the last about the same axis.
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
fn examination_rejects_missing_inertia_only() {
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
