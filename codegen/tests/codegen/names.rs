//! Names and prose of a specification that also have a meaning in the emitted source. The source must compile without
//! a warning.

use crate::support::{compile, emitted, model};

/// Returns a model that needs every emitted helper, with these names for its quantities.
fn spec(
    parameter: &str,
    coordinate: &str,
    input: &str,
    definition: &str,
    observable: &str,
) -> String {
    format!(
        r#"
[model]
name = "names"
title = "Names"

[parameters]
{parameter} = {{ value = 0.7, unit = "kg m^2" }}
mu = {{ value = 0.25, unit = "kg/m" }}
B  = {{ value = 4.5, unit = "N m^2" }}
l  = {{ value = 0.8, unit = "m" }}

[coordinates]
{coordinate} = {{ unit = "rad" }}

[inputs]
{input} = {{ unit = "N m" }}

[fields.w]
along = "y"
from = 0
to = "l"
basis = "clamped_free_printed"
coordinates = "q"
order = 2
unit = "m"

[definitions]
{definition} = "{parameter}*(2 + sin({coordinate}))^1.3"

[kinetic]
hub  = "1/2*{definition}*dot({coordinate})^2"
beam = "1/2*integral(mu*exp(-y/l)*(y*dot({coordinate}) + dot(w))^2, w)"

[potential]
bending = "1/2*integral(B*diff(w, y, 2)^2, w)"
stop    = "1/2*B/l*deadzone({coordinate}, 0.1)^2 + sum(i, w, B*deadzone(q[i], l)^2/l^3)"

[forces]
motor = {{ on = "{coordinate}", value = "{input}*contact({coordinate}, 0.2)" }}

[observables]
{observable} = {{ value = "{definition}", unit = "kg m^2" }}
"#
    )
}

fn assert_compiles(folder: &str, text: &str) {
    for edition in ["2015", "2024"] {
        compile(
            folder,
            &emitted(&model(text), 2),
            &["--edition", edition, "--emit=metadata"],
        );
    }
}

// Every name used by the generator, the emitted file or Rust's prelude, in every role.
#[test]
fn names_used_by_emitted_code_compile() {
    let names = [
        "pow",
        "cholesky",
        "cholesky_solve",
        "pivot_reciprocal",
        "deadzone_1",
        "rates",
        "state",
        "inputs",
        "coefficients",
        "parameters",
        "values",
        "total",
        "rest",
        "row",
        "column",
        "j",
        "k",
        "r",
        "v1",
        "STATES",
        "GUARDS",
        "ORDERS",
        "OBSERVABLES",
        "STATE_NAMES",
        "DEGREES_OF_FREEDOM",
        "OBSERVABLE_NAMES",
        "SPECIFICATION_SHA256",
        "GENERATOR_VERSION",
        "IDENTITY",
        "identity",
        "INPUTS",
        "INPUT_NAMES",
        "PARAMETERS",
        "PARAMETER_NAMES",
        "numbers",
        "From",
        "Parameters",
        "Inputs",
        "Coefficients",
        "Default",
        "Some",
        "None",
        "Ok",
        "Err",
        "f64",
        "usize",
        "str",
        "core",
        "std",
        "positive_definite",
        "positive_1",
        "positive_2",
        "s_1",
        "c_1",
        "s_2",
        "M_x_x",
        "M_theta_q",
        "pivot_x",
        "T_hub",
        "observables",
        "guards",
        "mass_matrix",
        "prepare",
        "factor",
        "magnitude_of",
        "copy_sign",
        "power_of_two",
        "exponent_of",
        "significand_of",
        "E",
        "I",
        "W_NODES",
        "Q_ddot",
        "q_ddot",
        "phi_1",
        "main",
        "panic",
        "Clone",
        "Copy",
        "Debug",
    ];
    let mut source = String::new();
    for count in 0..names.len() {
        // Every name is used once in every role.
        let [parameter, coordinate, input, definition, observable] =
            std::array::from_fn(|role| names[(count + role) % names.len()]);
        let model = model(&spec(parameter, coordinate, input, definition, observable));
        let module = emitted(&model, 1)
            .replace("#![", "// #![")
            .replace("//!", "//");
        source.push_str(&format!("pub mod m_{count} {{\n{module}\n}}\n"));
    }
    let head = "#![no_std]\n#![allow(non_snake_case)]\n#![forbid(unsafe_code)]\n";
    compile(
        "names",
        &format!("{head}{source}"),
        &["--edition", "2015", "--emit=metadata"],
    );
}

// Terms and forces can have names with another meaning in Rust or in a formula.
#[test]
fn names_of_terms_with_other_meanings_compile() {
    for name in [
        "loop", "t", "energy", "fn", "sin", "pi", "state", "self", "rates",
    ] {
        let text = spec("kappa", "chi", "zeta", "eta", "xi")
            .replace("hub  =", &format!("{name} ="))
            .replace("stop    =", &format!("{name} ="))
            .replace("motor =", &format!("{name} ="))
            .replace(
                "zeta*contact(chi, 0.2)",
                "zeta*contact(chi, 0.2) - 0.1*zeta",
            );
        assert_compiles("terms", &text);
    }
}

// Quantities have the names of tables.
#[test]
fn names_of_tables_compile() {
    let first = emitted(&model(&spec("kappa", "chi", "zeta", "eta", "xi")), 2);
    let tables: Vec<&str> = first
        .lines()
        .filter_map(|line| line.strip_prefix("static ")?.split(':').next())
        .collect();
    assert!(tables.len() > 3, "{tables:?}");
    for name in tables {
        assert_compiles("table_names", &spec(name, "chi", "zeta", "eta", "xi"));
        assert_compiles("table_names", &spec("kappa", name, "zeta", "eta", "xi"));
        assert_compiles("table_names", &spec("kappa", "chi", "zeta", name, "xi"));
    }
}

// The name of a table is the name of the field in capitals. It can be equal for two fields.
#[test]
fn names_of_fields_that_differ_in_case_compile() {
    let text = spec("kappa", "chi", "zeta", "eta", "xi");
    let (start, end) = (
        text.find("[fields.w]").unwrap(),
        text.find("[definitions]").unwrap(),
    );
    let field = &text[start..end];
    let second = field
        .replace("fields.w", "fields.W")
        .replace("\"y\"", "\"Y\"")
        .replace("\"q\"", "\"Q\"");
    let inertia = "beam_2 = \"1/2*integral(mu*exp(-Y/l)*dot(W)^2, W)\"\n\n[potential]";
    let both = text.replace(field, &format!("{field}{second}"));
    assert_compiles("fields", &both.replace("[potential]", inertia));
}

// Prose can contain characters with a meaning in a comment, a string or a page.
#[test]
fn prose_with_special_characters_compiles() {
    let texts = [
        r#"a "quoted" word"#,
        r"back\slash \n \u{41}",
        "end */ of a comment /* or start",
        "// and /// and //!",
        "</script><b>",
        "`code",
        "[link](",
        "{braces} {0} #[attribute]",
        "line\nbreak\r\nand\ttab",
        "\u{202e}turned",
        "emoji \u{1f9f0} and \u{0}null",
        "trailing \\",
        "%s $x r#\"raw\"#",
        "",
    ];
    for text in texts {
        let mut spec = spec("kappa", "chi", "zeta", "eta", "xi");
        let quoted = toml_string(text);
        for (from, to) in [
            (
                "unit = \"rad\" }",
                format!("unit = \"rad\", doc = {quoted} }}"),
            ),
            (
                "unit = \"kg/m\" }",
                format!("unit = \"kg/m\", doc = {quoted}, source = {quoted} }}"),
            ),
            ("title = \"Names\"", format!("title = {quoted}")),
            (
                "value = \"eta\", unit = \"kg m^2\" }",
                format!("value = \"eta\", unit = \"kg m^2\", doc = {quoted} }}"),
            ),
        ] {
            assert!(spec.contains(from));
            spec = spec.replace(from, &to);
        }
        // `check` may also reject the text.
        if eomgen_model_spec::check(eomgen_model_spec::source::Source::new("p", spec.clone()))
            .is_ok()
        {
            assert_compiles("prose", &spec);
        }
    }
}

fn toml_string(text: &str) -> String {
    let escaped: String = text
        .chars()
        .map(|c| match c {
            '"' => "\\\"".to_owned(),
            '\\' => "\\\\".to_owned(),
            c if c.is_control() => format!("\\u{:04x}", c as u32),
            c => c.to_string(),
        })
        .collect();
    format!("\"{escaped}\"")
}
