//! Tests of the classification of models as linear, piecewise linear or nonlinear.

use eomgen_codegen::mechanics::equations::derive;
use eomgen_codegen::mechanics::linearity::{Linearity, linearity};
use eomgen_codegen::symbolic::formula::write_full_formula;
use eomgen_model_spec::check;
use eomgen_model_spec::model::Model;
use eomgen_model_spec::source::Source;
use eomgen_tests::models::{load, shipped_specifications};

fn kind_of(text: &str) -> String {
    let source = Source::new("test.toml", text);
    kind(&check(source).expect("a valid specification").model)
}

fn kind(model: &Model) -> String {
    let orders = model.orders(None).expect("valid orders");
    let equations = derive(model, &orders).expect("the model can be derived");
    match linearity(&equations) {
        Linearity::Linear => "linear".to_owned(),
        Linearity::PiecewiseLinear => "piecewise linear".to_owned(),
        Linearity::Constrained => "with constraints".to_owned(),
        Linearity::Impacts => "with impacts".to_owned(),
        Linearity::Corners(node) => {
            format!(
                "corner at {}",
                write_full_formula(&equations.graph, model, node)
            )
        }
        Linearity::Nonlinear(node) => write_full_formula(&equations.graph, model, node).to_string(),
    }
}

fn with_force(force: &str) -> String {
    format!(
        "[model]\nname = \"mass\"\ntitle = \"A mass\"\n\
         [parameters]\nm = {{ value = 2, unit = \"kg\" }}\nk = {{ value = 3, unit = \"N/m\" }}\n\
         F = {{ value = 1, unit = \"N\" }}\nv = {{ value = 1, unit = \"m/s\" }}\n\
         omega = {{ value = 5, unit = \"rad/s\" }}\n\
         [coordinates]\nx = {{ unit = \"m\" }}\n[kinetic]\nmass = \"1/2*m*dot(x)^2\"\n\
         [potential]\nspring = \"1/2*k*x^2\"\n\
         [forces]\nextra = {{ on = \"x\", value = \"{force}\" }}\n"
    )
}

#[test]
fn jump_of_energy_is_a_corner() {
    let text = with_force("F").replace("1/2*k*x^2", "1/2*k*x^2 + k*above(x)*x_0^2");
    let text = text.replace(
        "[coordinates]",
        "x_0 = { value = 1, unit = \"m\" }\n[coordinates]",
    );
    assert_eq!(kind_of(&text), "corner at x");
}

#[test]
fn shipped_models_are_classified_correctly() {
    for path in shipped_specifications() {
        let name = path
            .file_stem()
            .and_then(|name| name.to_str())
            .expect("a name");
        let expected = match name {
            "planetary_arm" | "planetary_arm_rig" => Some("piecewise linear"),
            // The inertia depends on the length of the rope.
            "crane" => Some("m*l^2"),
            "chaplygin_sleigh" | "quadrotor_slung_load" => Some("with constraints"),
            "emps" | "hub_beam_tip_mass" | "loudspeaker" | "shaft_and_disc" => Some("linear"),
            _ => None,
        };
        let kind = kind(&load(name));
        match expected {
            Some(expected) => assert_eq!(kind, expected, "{name}"),
            None => assert!(
                kind.contains("sin") || kind.contains("cos"),
                "{name}: {kind}"
            ),
        }
    }
}

#[test]
fn dry_friction_and_sinusoidal_force_keep_model_piecewise_linear() {
    assert_eq!(kind_of(&with_force("-F*sign(dot(x))")), "piecewise linear");
    assert_eq!(kind_of(&with_force("F*sin(omega*t + 1)")), "linear");
    assert_eq!(
        kind_of(&with_force("F*max(x*omega/v, 1)")),
        "piecewise linear"
    );
}

#[test]
fn nonlinear_term_is_named() {
    for (force, culprit) in [
        ("-F*dot(x)*abs(dot(x))/v^2", "abs(dot(x))"),
        ("F*x*omega/v*sin(omega*t)", "sin(omega*t)"),
        ("F*omega*t", "t"),
        ("F*tanh(dot(x)/v)", "tanh"),
        ("F*sin(omega*t^2*omega)", "sin("),
    ] {
        let kind = kind_of(&with_force(force));
        assert!(kind.contains(culprit), "{force}: {kind}");
    }
}
