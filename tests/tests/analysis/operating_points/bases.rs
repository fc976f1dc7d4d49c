//! Tests of all bases of mode shapes: textbook frequencies, certificates, and rejected names.

use std::f64::consts::{PI, TAU};
use std::fmt::Write;

use eomgen_tests::certified::{certify, check_model};
use eomgen_tests::models::load;
use eomgen_tests::program::{run_accepted, run_rejected};
use serde_json::Value;

use super::{run_json, shipped, write_model};

/// Stiffness, mass per length and length. The frequency of a beam is (beta l/l)^2 sqrt(B/mu)/(2 pi); of a rod or
/// string, (beta l/l) sqrt(B/mu)/(2 pi).
const B: f64 = 3.0;
const MU: f64 = 2.0;
const LENGTH: f64 = 0.7;

fn uniform(basis: &str, order: usize) -> String {
    let derivative = if is_rod(basis) { 1 } else { 2 };
    let unit = if is_rod(basis) { "N" } else { "N m^2" };
    format!(
        r#"
[model]
name = "uniform"
[parameters]
mu = {{ value = {MU}, unit = "kg/m" }}
B = {{ value = {B}, unit = "{unit}" }}
x_0 = {{ value = 0.25, unit = "m" }}
l = {{ value = {LENGTH}, unit = "m" }}
[fields.w]
along = "x"
from = "x_0"
to = "x_0 + l"
basis = "{basis}"
coordinates = "q"
order = {order}
unit = "m"
[kinetic]
inertia = "1/2*integral(mu*dot(w)^2, w)"
[potential]
elastic = "1/2*integral(B*diff(w, x, {derivative})^2, w)"
"#
    )
}

fn is_rod(basis: &str) -> bool {
    basis.starts_with("rod") || basis == "string"
}

/// Returns the names of the bases with beta_r l of the first modes: R. D. Blevins, "Formulas for Natural Frequency and
/// Mode Shape" (1979), Table 8-1; S. S. Rao, "Mechanical Vibrations", 8.2 to 8.5.
fn published_wavenumbers() -> Vec<(String, [f64; 3])> {
    let equal = [4.73004074, 7.85320462, 10.9956079];
    let pinned = [3.92660231, 7.06858275, 10.21017612];
    let guided = [2.36502037, 5.49780392, 8.63937983];
    let whole = [PI, 2.0 * PI, 3.0 * PI];
    let half = [0.5 * PI, 1.5 * PI, 2.5 * PI];
    let pairs = [
        ("clamped", "clamped", equal),
        ("clamped", "pinned", pinned),
        ("clamped", "free", [1.87510407, 4.69409113, 7.85475744]),
        ("clamped", "guided", guided),
        ("pinned", "pinned", whole),
        ("pinned", "free", pinned),
        ("pinned", "guided", half),
        ("free", "free", equal),
        ("free", "guided", guided),
        ("guided", "guided", whole),
    ];
    let mut all = Vec::new();
    for (one, other, roots) in pairs {
        all.push((format!("{one}_{other}"), roots));
        if one != other {
            all.push((format!("{other}_{one}"), roots));
        }
    }
    for (name, roots) in [
        ("rod_fixed_free", half),
        ("rod_fixed_fixed", whole),
        ("rod_free_free", whole),
        ("string", whole),
    ] {
        all.push((name.to_owned(), roots));
    }
    assert_eq!(all.len(), 20);
    all
}

#[test]
fn frequencies_of_all_bases_match_textbooks() {
    let folder = tempfile::tempdir().expect("a folder");
    for (basis, roots) in published_wavenumbers() {
        let model = write_model(folder.path(), &uniform(&basis, 3));
        let found = run_json(&["modes", &model, "--json"]);
        let modes = found["modes"].as_array().expect("modes");
        assert_eq!(modes.len(), 3);
        let power = if is_rod(&basis) { 1 } else { 2 };
        for (mode, root) in modes.iter().zip(roots) {
            let right = (root / LENGTH).powi(power) * (B / MU).sqrt() / TAU;
            let frequency = mode["frequency"].as_f64().expect("Hz");
            // The published roots have nine digits.
            assert!(
                (frequency / right - 1.0).abs() < 2e-8,
                "{basis}: {frequency} {right}"
            );
        }
    }
}

/// Returns a model whose terms contain the field in every kind of expression: squared, times the position, times a
/// weight, to the fourth power, at both ends and between them.
fn all_expressions(basis: &str, order: usize) -> String {
    let mut text = uniform(basis, order).replace("\"N\"", "\"N m^2\"");
    text = text.replace(
        "\"1/2*integral(B*diff(w, x, 1)^2, w)\"",
        "\"1/2*integral(B*diff(w, x, 1)^2, w)/l^2\"",
    );
    let added = r#"
bed = "1/2*integral(B*exp(-x/l)*diff(w, x, 1)^2, w)/l^2 + 1/4*integral(B*w^4, w)/l^6"
load = "-B*(2*integral(x*w, w)/l^4 + integral(w, w)/l^3)"
between = "1/2*B/l*at(diff(w, x, 1), x_0 + l/3)^2 + 1/2*B/l^3*at(w, x_0 + l/7)^2"
ends = "1/2*B/l*at(diff(w, x, 1), x_0)^2 + 1/2*B/l^3*at(w, x_0 + l)^2"
mixed = "B*integral(x^2*w*diff(w, x, 2), w)/l^4 + B*integral(diff(w, x, 1)*diff(w, x, 2), w)/l"
[observables]
moment = { value = "B*at(diff(w, x, 2), x_0)", unit = "N m" }
shear = { value = "B*at(diff(w, x, 3), x_0 + l)", unit = "N" }
inner_shear = { value = "B*at(diff(w, x, 3), x_0 + l/5)", unit = "N" }
"#;
    text.push_str(added);
    text
}

#[test]
fn certificates_of_all_bases_pass() {
    for (basis, _) in published_wavenumbers() {
        for order in [1, 4] {
            let model = check_model(&all_expressions(&basis, order));
            let certificate = certify(&model, &model);
            let failures: Vec<_> = certificate.failures().collect();
            assert!(certificate.passed, "{basis}, order {order}: {failures:#?}");
        }
    }
}

/// String that hangs from the end of a beam; a stiff spring couples the ends.
const BEAM_AND_STRING: &str = r#"
[model]
name = "beam_and_string"
[parameters]
mu = { value = 2, unit = "kg/m" }
B = { value = 3, unit = "N m^2" }
F = { value = 40, unit = "N" }
l = { value = 0.7, unit = "m" }
[fields.w]
along = "x"
from = 0
to = "l"
basis = "guided_free"
coordinates = "q"
order = 3
unit = "m"
[fields.v]
along = "y"
from = "l"
to = "3*l"
basis = "string"
coordinates = "p"
order = 3
unit = "m"
[kinetic]
beam = "1/2*integral(mu*dot(w)^2, w)"
string = "1/2*integral(0.1*mu*(dot(v) + (3*l - y)/(2*l)*at(dot(w), l))^2, v)"
[potential]
bending = "1/2*integral(B*diff(w, x, 2)^2, w)"
tension = "1/2*integral(F*(diff(v, y, 1) - at(w, l)/(2*l))^2, v)"
"#;

#[test]
fn coupled_fields_of_different_bases_pass() {
    for order in [0, 1, 5] {
        let text = BEAM_AND_STRING.replace("order = 3", &format!("order = {order}"));
        let model = check_model(&text);
        let certificate = certify(&model, &model);
        let failures: Vec<_> = certificate.failures().collect();
        assert!(certificate.passed, "order {order}: {failures:#?}");
    }
}

#[test]
fn certificate_fails_for_another_basis() {
    for (one, other) in [
        ("pinned_clamped", "clamped_pinned"),
        ("free_free", "clamped_clamped"),
        ("pinned_guided", "pinned_pinned"),
        ("free_guided", "guided_free"),
    ] {
        let (model, subject) = (
            check_model(&all_expressions(one, 2)),
            check_model(&all_expressions(other, 2)),
        );
        assert!(!certify(&model, &subject).passed, "{one}, {other}");
    }
}

/// At the highest order the frequencies still match the roots, and the sine shapes are exact.
#[test]
fn highest_order_frequencies_are_accurate() {
    let folder = tempfile::tempdir().expect("a folder");
    for (basis, quarters) in [("free_free", 2.0), ("pinned_clamped", 1.0), ("string", 0.0)] {
        let model = write_model(folder.path(), &uniform(basis, 128));
        let found = run_json(&["modes", &model, "--json"]);
        let last = found["modes"].as_array().expect("modes")[127].clone();
        let root = PI * (128.0 + 0.25 * quarters);
        let power = if is_rod(basis) { 1 } else { 2 };
        let right = (root / LENGTH).powi(power) * (B / MU).sqrt() / TAU;
        let frequency = last["frequency"].as_f64().expect("Hz");
        assert!(
            (frequency / right - 1.0).abs() < 1e-9,
            "{basis}: {frequency} {right}"
        );
    }
}

/// Rigid-body motions are separate coordinates, so a free beam has two zero frequencies and the elastic frequencies.
#[test]
fn free_beam_with_rigid_coordinates_has_two_zero_frequencies() {
    let text = uniform("free_free", 3)
        .replace(
            "[fields.w]",
            "[coordinates]\ny = { unit = \"m\" }\npsi = { unit = \"rad\" }\n[fields.w]",
        )
        .replace(
            "mu*dot(w)^2",
            "mu*(dot(y) + (x - x_0 - l/2)*dot(psi) + dot(w))^2",
        );
    let folder = tempfile::tempdir().expect("a folder");
    let model = write_model(folder.path(), &text);
    let found = run_json(&["modes", &model, "--json"]);
    let frequencies: Vec<f64> = found["modes"]
        .as_array()
        .expect("modes")
        .iter()
        .map(|mode| mode["frequency"].as_f64().expect("Hz"))
        .collect();
    assert_eq!(frequencies[..2], [0.0, 0.0]);
    let right = (4.73004074_f64 / LENGTH).powi(2) * (B / MU).sqrt() / TAU;
    assert!(
        (frequencies[2] / right - 1.0).abs() < 2e-8,
        "{frequencies:?}"
    );
}

/// Two discs on a shaft: tan b = b (m + d)/(b^2 m d - 1) with the inertias m and d of the discs relative to the shaft
/// (Rao, 8.3). With few modes the frequencies are too high.
#[test]
fn shaft_and_disc_match_closed_form_frequencies() {
    let model = load("shaft_and_disc");
    let values = model.parameter_values().expect("values");
    let value = |name: &str| {
        let index = model.parameters.iter().position(|p| p.name == name);
        values[index.expect("a parameter")]
    };
    let shaft = value("rho") * value("J_p") * value("l");
    let (m, d) = (value("J_m") / shaft, value("J_d") / shaft);
    let condition = |b: f64| b.sin() * (b * b * m * d - 1.0) - b * (m + d) * b.cos();
    let speed = (value("G") / value("rho")).sqrt() / value("l");
    let first = |order: &str| {
        let spec = shipped("shaft_and_disc");
        let set = ["--set", "c_b=0", "--set", "c_i=0"];
        let found = run_json(&[&["modes", &spec, "--order", order, "--json"], &set[..]].concat());
        found["modes"][1]["frequency"].as_f64().expect("Hz") * TAU / speed
    };
    let (mut low, mut high) = (1e-3, 0.5 * PI);
    while high - low > 1e-12 {
        let middle = 0.5 * (low + high);
        if condition(middle) * condition(1e-3) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    let [few, many] = ["3", "60"].map(first);
    assert!(low < many && many < few, "{low} {many} {few}");
    assert!(few / low < 1.05 && many / low < 1.005, "{low} {many} {few}");
}

#[test]
fn unknown_basis_is_rejected_with_suggestion() {
    let folder = tempfile::tempdir().expect("a folder");
    for (wrong, said) in [
        ("pined_pinned", "did you mean `pinned_pinned`?"),
        ("clamped_fre", "did you mean `clamped_free`?"),
        ("strings", "did you mean `string`?"),
        ("hinged", "clamped, pinned, free or guided"),
    ] {
        let model = write_model(folder.path(), &uniform(wrong, 2));
        let message = run_rejected(&["check", &model]);
        assert!(message.contains("model.toml:13:9"), "{message}");
        assert!(message.contains(said), "{message}");
    }
    let schema: Value = serde_json::from_str(&run_accepted(&["schema"])).expect("JSON");
    let mut known = String::new();
    for name in schema["$defs"]["basis"]["enum"].as_array().expect("names") {
        write!(known, "{} ", name.as_str().expect("a name")).expect("written");
    }
    for (basis, _) in published_wavenumbers() {
        assert!(known.contains(&format!("{basis} ")), "{basis}: {known}");
    }
}
