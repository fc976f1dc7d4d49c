//! Dependent constraints are distinguished from singular configurations, independently of the units.

use eomgen_codegen::variant::{Variant, examine};

/// Platform on three parallel rods of equal length. The third rod is redundant.
const THREE_RODS: &str = r#"
[model]
name = "three_rods"
[parameters]
m = { value = 2, unit = "kg" }
J = { value = 0.1, unit = "kg m^2" }
g = { value = 9.81, unit = "m/s^2" }
l = { value = 1, unit = "m" }
a = { value = 0.5, unit = "m" }
[coordinates]
x = { unit = "m", initial = "l*sin(0.4)" }
y = { unit = "m", initial = "-l*cos(0.4)" }
phi = { unit = "rad" }
[kinetic]
body = "1/2*m*(dot(x)^2 + dot(y)^2) + 1/2*J*dot(phi)^2"
[potential]
g = "m*g*y"
[constraints]
left   = { zero = "((x - a*cos(phi) + a)^2 + (y - a*sin(phi))^2 - l^2)/l" }
middle = { zero = "(x^2 + y^2 - l^2)/l" }
right  = { zero = "((x + a*cos(phi) - a)^2 + (y + a*sin(phi))^2 - l^2)/l" }
"#;

/// Returns a bead in space with these constraints.
fn bead(initial: &str, constraints: &str) -> String {
    format!(
        r#"
[model]
name = "bead"
[parameters]
m = {{ value = 1, unit = "kg" }}
l = {{ value = 1, unit = "m" }}
[coordinates]
{initial}
[kinetic]
bead = "1/2*m*(dot(x)^2 + dot(y)^2 + dot(z)^2)"
[constraints]
{constraints}
"#
    )
}

const AWAY: &str = "x = { unit = \"m\", initial = 0.6 }\ny = { unit = \"m\", initial = 0.8 }\nz = { unit = \"m\" }";

/// Returns the error of a model that is rejected.
fn rejection(text: &str) -> Option<String> {
    let model = crate::support::model(text);
    let orders = vec![2; model.fields.len()];
    let found = Variant::derive_for_report(&model, &orders, &[]).err()?;
    let said = found.render(false);
    let examined = examine(&model, &orders).expect_err("an examination reports the same");
    assert_eq!(examined.render(false), said);
    Some(said)
}

/// Returns the groups of dependent constraints, with their ranks.
fn redundant(text: &str) -> Vec<(Vec<usize>, usize)> {
    let model = crate::support::model(text);
    let variant = Variant::derive_for_report(&model, &[], &[])
        .unwrap_or_else(|error| panic!("{}", error.render(false)));
    let found = variant.equations.redundancy;
    assert_eq!(examine(&model, &[]).expect("the same"), found);
    let groups = found.groups.into_iter();
    groups
        .map(|group| (group.constraints, group.rank))
        .collect()
}

#[test]
fn third_parallel_rod_is_redundant_for_every_start() {
    let starts = [
        ("l*sin(0.4)", "-l*cos(0.4)"),
        // The initial state violates the constraints, and the rows are independent.
        ("l*sin(0.4) + 0.03*l", "-l*cos(0.4)"),
        ("0*l", "-l"),
    ];
    for (x, y) in starts {
        let text = THREE_RODS
            .replace("\"l*sin(0.4)\"", &format!("\"{x}\""))
            .replace("\"-l*cos(0.4)\"", &format!("\"{y}\""));
        for text in [
            text.clone(),
            text.replace("value = 1, unit = \"m\"", "value = 1000, unit = \"m\""),
        ] {
            assert_eq!(redundant(&text), [(vec![0, 1, 2], 2)], "{x} {y}");
        }
    }
}

#[test]
fn two_rods_are_accepted_also_at_a_singular_start() {
    let two = THREE_RODS
        .lines()
        .filter(|line| !line.starts_with("middle"));
    let two: Vec<&str> = two.collect();
    assert_eq!(rejection(&two.join("\n")), None);
    // The rods and the platform lie on one line.
    let flat = two
        .join("\n")
        .replace("\"l*sin(0.4)\"", "\"l\"")
        .replace("\"-l*cos(0.4)\"", "\"0*l\"");
    assert_eq!(rejection(&flat), None);
    let at_the_centre = bead(
        "x = { unit = \"m\" }\ny = { unit = \"m\" }\nz = { unit = \"m\" }",
        "sphere = { zero = \"x^2 + y^2 + z^2 - l^2\" }",
    );
    assert_eq!(rejection(&at_the_centre), None);
}

#[test]
fn constraints_without_a_solution_or_effect_are_rejected_in_every_unit() {
    for (constraints, said) in [
        (
            "a = { zero = \"x^2 + y^2 - l^2\" }\nb = { zero = \"x*dot(x) + y*dot(y)\" }",
            "`b` is redundant",
        ),
        ("a = { zero = \"0*x\" }", "`a` has no effect"),
        ("a = { zero = \"z\" }\nb = { zero = \"z^2\" }", "`b`"),
        (
            "a = { zero = \"(x - 0.6*l)^2 + z^2\" }",
            "`a` has no effect",
        ),
        (
            "a = { zero = \"x - l\" }\nb = { zero = \"2*x - 3*l\" }",
            "`b` contradicts `a`",
        ),
        (
            "a = { zero = \"x + y - l\" }\nb = { zero = \"y + z - l\" }\nc = { zero = \"x - z - l\" }",
            "`c` contradicts `a`, `b`",
        ),
        // More constraints than coordinates.
        (
            "a = { zero = \"x^2 + y^2 - l^2\" }\nb = { zero = \"x\" }\nc = { zero = \"y\" }\nd = { zero = \"z\" }",
            "the residual of the constraint `a` stays",
        ),
    ] {
        let text = bead(AWAY, constraints);
        for text in [
            text.clone(),
            text.replace("value = 1, unit = \"kg\"", "value = 1e12, unit = \"kg\""),
        ] {
            let found = rejection(&text).unwrap_or_else(|| panic!("{constraints}: derived"));
            assert!(found.contains(said), "{constraints}: {found}");
        }
    }
}

/// Circles of radius l in a plane have a common point if their centres are nearer than 2 l.
#[test]
fn circles_without_a_common_point_contradict_each_other() {
    for (distance, angle) in [
        (2.2, 0.3),
        (2.5, -0.9273),
        (3.0, 0.0),
        (5.0, 2.0),
        (20.0, 1.0),
    ] {
        for scale in ["1", "1e6", "1e-6"] {
            let (x, y) = (distance * f64::cos(angle), distance * f64::sin(angle));
            let circles = |x: f64, y: f64| {
                format!(
                    "a = {{ zero = \"x^2 + y^2 - l^2\" }}\n\
                     b = {{ zero = \"{scale}*((x - {x}*l)^2 + (y - {y}*l)^2 - l^2)/l\" }}"
                )
            };
            let on_the_first =
                "x = { unit = \"m\", initial = \"l\" }\ny = { unit = \"m\" }\nz = { unit = \"m\" }";
            for start in [AWAY, on_the_first] {
                let found = rejection(&bead(start, &circles(x, y)));
                let found = found.unwrap_or_else(|| panic!("{distance} {angle} {scale}: derived"));
                assert!(found.contains("`b` contradicts `a`"), "{found}");
                let part = 1.9 / distance;
                assert_eq!(rejection(&bead(start, &circles(part * x, part * y))), None);
            }
        }
    }
}

#[test]
fn independent_constraints_of_any_scale_are_accepted() {
    for constraints in [
        "a = { zero = \"x^2 + y^2 - l^2\" }\nb = { zero = \"1e-9*z\" }",
        "a = { zero = \"x^2 + y^2 - l^2\" }\nb = { zero = \"1e9*(x - y)\" }",
        "a = { zero = \"x*dot(y) - y*dot(x)\" }\nb = { zero = \"dot(z)\" }",
        "a = { zero = \"x^2 + y^2 - l^2\" }\nb = { zero = \"x*dot(y) - y*dot(x)\" }",
    ] {
        assert_eq!(rejection(&bead(AWAY, constraints)), None, "{constraints}");
    }
}

#[test]
fn dependent_constraints_are_found_in_every_unit() {
    for (constraints, groups) in [
        (
            "a = { zero = \"x^2 + y^2 - l^2\" }\nb = { zero = \"1e9*(x^2 + y^2 - l^2)\" }",
            vec![(vec![0, 1], 1)],
        ),
        (
            "a = { zero = \"x*dot(y) - y*dot(x)\" }\nb = { zero = \"1e-7*(y*dot(x) - x*dot(y))\" }",
            vec![(vec![0, 1], 1)],
        ),
        (
            "a = { zero = \"x + y - l\" }\nb = { zero = \"y + z - l\" }\nc = { zero = \"x - z\" }",
            vec![(vec![0, 1, 2], 2)],
        ),
        // Two groups, and three constraints of which two are redundant.
        (
            "a = { zero = \"z\" }\nb = { zero = \"x^2 + y^2 - l^2\" }\nc = { zero = \"2*z\" }\n\
             d = { zero = \"(l^2 - x^2 - y^2)/l\" }\ne = { zero = \"-z\" }",
            vec![(vec![0, 2, 4], 1), (vec![1, 3], 1)],
        ),
    ] {
        let text = bead(AWAY, constraints);
        for text in [
            text.clone(),
            text.replace("value = 1, unit = \"kg\"", "value = 1e12, unit = \"kg\""),
        ] {
            assert_eq!(redundant(&text), groups, "{constraints}");
        }
    }
}
