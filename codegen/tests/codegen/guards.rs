//! Switching surfaces: every change of the equations has one.

use eomgen_codegen::program::evaluator::Point;

use crate::support::{evaluator, model, shipped};

fn particle(potential: &str, forces: &str) -> String {
    format!(
        r#"
[model]
name = "particle"
title = "A particle in a plane"

[parameters]
m = {{ value = 0.7, unit = "kg" }}
F = {{ value = 3.0, unit = "N" }}
b = {{ value = 0.5, unit = "m" }}

[coordinates]
x = {{ unit = "m" }}
y = {{ unit = "m" }}

[kinetic]
all = "1/2*m*(dot(x)^2 + dot(y)^2)"

[potential]
one = "{potential}"

[forces]
two = {{ on = "y", value = "{forces}" }}
"#
    )
}

/// Returns the values of the guards at a position.
fn guards(text: &str, x: f64, y: f64) -> Vec<f64> {
    let mut evaluator = evaluator(&model(text), 0);
    let mut values = vec![f64::NAN; evaluator.guard_count()];
    let state = [x, y, 0.25, -0.75];
    evaluator.guards(
        Point {
            t: 0.0,
            state: &state,
            inputs: &[],
        },
        &mut values,
    );
    values
}

#[test]
fn each_function_has_its_surfaces() {
    let none = "0*F";
    assert_eq!(guards(&particle("F*b*(x/b)^2", none), 1.0, 2.0), [0.0; 0]);
    assert_eq!(
        guards(&particle("F/b*deadzone(x, b)^2", none), 1.0, 2.0),
        [0.5, 1.5]
    );
    assert_eq!(
        guards(&particle("F*b", "F*contact(y, b)"), 1.0, 2.0),
        [1.5, 2.5]
    );
    assert_eq!(guards(&particle("F*b", "F*sign(dot(x))"), 1.0, 2.0), [0.25]);
    assert_eq!(guards(&particle("F*b", "F*abs(x)/b"), 1.0, 2.0), [1.0]);
    assert_eq!(guards(&particle("F*b", "F*above(-x)"), 1.0, 2.0), [1.0]);
    assert_eq!(guards(&particle("F*b", "F*above(b - x)"), 1.0, 2.0), [0.5]);
    assert_eq!(guards(&particle("F*b", "F/b*min(x, y)"), 1.0, 2.0), [-1.0]);
}

// The derivative of max(x, y) is 1 or 0. The force contains only this derivative, not the function.
#[test]
fn jumping_slope_has_a_surface() {
    assert_eq!(guards(&particle("F*max(x, y)", "0*F"), 1.0, 2.0), [-1.0]);
    assert_eq!(guards(&particle("F*min(x, 0)", "0*F"), 1.0, 2.0).len(), 1);
    assert_eq!(guards(&particle("F*abs(x)", "0*F"), 1.0, 2.0), [1.0]);
    assert_eq!(
        guards(&particle("F*deadzone(x, b)", "0*F"), 1.0, 2.0),
        [0.5, 1.5]
    );
}

// A function that jumps where another function is zero on an interval has a surface at both ends of the interval.
// Inside the interval, neither surface is crossed.
#[test]
fn jump_at_zero_interval_has_a_surface_at_either_end() {
    let sign = particle("F*b", "F*sign(deadzone(x, b))");
    assert_eq!(guards(&sign, 1.0, 2.0), [0.5, 1.5, 0.5, -0.5]);
    assert_eq!(guards(&sign, 0.25, 2.0), [-0.25, 0.75, 0.0, 0.0]);
    let contact = particle("F*b", "F*contact(max(x, 0), b)");
    assert_eq!(guards(&contact, 2.0, 2.0), [2.0, 1.5, -2.5]);
    assert_eq!(guards(&contact, -1.0, 2.0), [-1.0, -0.5, -0.5]);
    let smooth = particle("F*b", "F*abs(max(x, 0))/b");
    assert_eq!(guards(&smooth, 2.0, 2.0), [2.0, 2.0]);
}

#[test]
fn shared_surfaces_occur_once() {
    assert_eq!(
        guards(
            &particle("F*max(x, y) - F*min(x, y)", "F*max(x, y)/b"),
            1.0,
            2.0
        )
        .len(),
        1
    );
    assert_eq!(
        guards(
            &particle("F/b*deadzone(x, b)^2", "F*contact(x, b)"),
            1.0,
            2.0
        )
        .len(),
        2
    );
}

#[test]
fn parameter_only_switches_have_no_surface() {
    assert_eq!(
        guards(&particle("F*max(b, 2*b)*x/b", "F*sign(b)"), 1.0, 2.0),
        [0.0; 0]
    );
}

#[test]
fn planetary_arm_has_four_guards() {
    assert_eq!(evaluator(&shipped("planetary_arm"), 2).guard_count(), 4);
}
