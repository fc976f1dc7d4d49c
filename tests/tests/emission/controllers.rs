//! Test that the checks of a certificate detect edits of emitted controllers and of `step`.

use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::rust::Packaging;
use eomgen_codegen::variant::Variant;
use eomgen_codegen::{c, rust};
use eomgen_model_spec::model::Model;
use eomgen_model_spec::source::Source;
use eomgen_validate::certify::{CCompiler, CSource};
use eomgen_validate::model_certificate::{Sources, check_sources};

const OUTPUTS: [Output; 1] = [Output::Step];

/// Edits: a text after which the replacement begins, the replaced text, and the new text; `->` stands for the access to
/// a field.
const EDITS: [(&str, &str, &str); 7] = [
    ("controller_position", "parameters->k_p", "parameters->k_i"),
    (
        "controller_position",
        "parameters->F_max",
        "parameters->k_p",
    ),
    (
        "controller_position",
        "parameters->resolution",
        "parameters->target",
    ),
    ("controller_position", "= memory->last", "= memory->sum_F"),
    ("controller_position", "0.002", "0.003"),
    ("step", "k3[i]", "k2[i]"),
    ("sixth", "6.0)", "5.0)"),
];

fn model() -> (Model, Variant) {
    let text = include_str!("../../studies/src/mutations/sampled_position.toml");
    let source = Source::new("sampled_position.toml", text);
    let model = eomgen_model_spec::check(source).expect("a model").model;
    let variant = Variant::derive_with(&model, &[], &OUTPUTS).expect("equations");
    (model, variant)
}

fn passes(model: &Model, sources: &Sources) -> bool {
    let checks = check_sources(model, &[], &OUTPUTS, sources).expect("checks");
    assert!(checks.iter().any(|check| check.skipped.is_none()));
    let mut compared = checks.iter().filter(|check| check.skipped.is_none());
    compared.all(|check| check.passed)
}

/// Replaces the first `before` after the last occurrence of `from`; returns `None` if there is none.
fn edit(text: &str, (from, before, after): (&str, &str, &str)) -> Option<String> {
    let mut starts = text.match_indices(from).map(|(place, _)| place);
    let place = starts.find_map(|start| Some(start + text[start..].find(before)?))?;
    let (head, tail) = text.split_at(place);
    Some(head.to_owned() + &tail.replacen(before, after, 1))
}

#[test]
fn edits_of_emitted_rust_controllers_and_step_fail() {
    let (model, variant) = model();
    let text = rust::emit(&variant.program, Packaging::Crate).expect("Rust");
    let sources = |text: String| Sources {
        rust: Some(text),
        ..Sources::default()
    };
    assert!(passes(&model, &sources(text.clone())));
    for (from, before, after) in EDITS {
        let [before, after] = [before, after].map(|text| text.replace("->", "."));
        let edited = edit(&text, (from, &before, &after));
        let edited = edited.unwrap_or_else(|| panic!("no `{before}` after `{from}`"));
        assert!(!passes(&model, &sources(edited)), "{before}: {after}");
    }
}

#[test]
fn edits_of_emitted_c_controllers_and_step_fail() {
    let (model, variant) = model();
    let c::Files { source, header } = c::emit(&variant.program).expect("C");
    let name = &variant.program.name;
    let sources = |source: String| Sources {
        c: vec![CSource {
            name: name.clone(),
            file: format!("{name}.c"),
            source,
            header: header.clone(),
            outputs: OUTPUTS.map(|output| output.name().to_owned()).to_vec(),
            compiler: CCompiler::default(),
        }],
        ..Sources::default()
    };
    assert!(passes(&model, &sources(source.clone())));
    for (from, before, after) in EDITS {
        let edited = edit(&source, (from, before, after));
        let edited = edited.unwrap_or_else(|| panic!("no `{before}` after `{from}`"));
        assert!(!passes(&model, &sources(edited)), "{before}: {after}");
    }
}

/// Controller whose quantised and clamped outputs hide moderate changes of the gains.
const HIDDEN_GAINS: &str = r#"
[model]
name = "hidden"
[parameters]
J = { value = 2, unit = "kg m^2" }
r = { value = 1, unit = "N m" }
limit = { value = 0.5, unit = "N m" }
resolution = { value = 0.1, unit = "N m" }
T = { value = 1, unit = "s" }
[coordinates]
y = { unit = "rad" }
[inputs]
u = { unit = "N m" }
v = { unit = "N m" }
w = { unit = "N m" }
[kinetic]
wheel = "1/2*J*dot(y)^2"
[forces]
all = { on = "y", value = "u + v + w" }
[controllers.one]
period = 0.01
states = { e = { unit = "rad", next = "e + y*(period/T)" } }
[controllers.one.outputs]
u = "quantise(clamp(r*(1.375*(0.3 - y) - 0.625*dot(y)*T + 10.25*e), -limit, limit), resolution)"
v = "r*sign(3.125*y + dot(y)*T) - clamp(r*4.875*e, -1e-6*limit, 1e-6*limit)"
w = "r*above(y - 7.75*e)"
"#;

#[test]
fn edits_of_gains_inside_limits_and_quantisation_fail() {
    let source = Source::new("hidden.toml", HIDDEN_GAINS);
    let model = eomgen_model_spec::check(source).expect("a model").model;
    let variant = Variant::derive_with(&model, &[], &OUTPUTS).expect("equations");
    let text = rust::emit(&variant.program, Packaging::Crate).expect("Rust");
    let sources = |text: String| Sources {
        rust: Some(text),
        ..Sources::default()
    };
    assert!(passes(&model, &sources(text.clone())));
    for (before, after) in [
        ("10.25", "10.35"),
        ("1.375", "1.376"),
        ("0.625", "0.624"),
        ("3.125", "3.126"),
        ("4.875", "4.925"),
        ("7.75", "7.751"),
    ] {
        let edited = edit(&text, ("controller_one", before, after));
        let edited = edited.unwrap_or_else(|| panic!("no `{before}`"));
        assert!(!passes(&model, &sources(edited)), "{before}: {after}");
    }
}
