//! Tests of names that are C keywords or collide, and of texts that would end a comment.

use std::process::Command;

use eomgen_codegen::c::{self, EmitError};
use eomgen_codegen::rust::{self, Packaging};

use super::{compare, has_compilers, program, run, supported_outputs};

pub fn pendulum(
    model: &str,
    title: &str,
    doc: &str,
    length: &str,
    input: &str,
    angle: &str,
) -> String {
    format!(
        "[model]\nname = \"{model}\"\ntitle = \"{title}\"\n\
         [parameters]\n\
         m = {{ value = 0.15, unit = \"kg\", doc = \"{doc}\", source = \"{doc}\" }}\n\
         {length} = {{ value = 0.3, unit = \"m\" }}\n\
         g = {{ value = 9.81, unit = \"m/s^2\" }}\n\
         [coordinates]\n{angle} = {{ unit = \"rad\" }}\n\
         [inputs]\n{input} = {{ unit = \"N m\", doc = \"{doc}\" }}\n\
         [kinetic]\nbob = \"1/2*m*({length}*dot({angle}))^2\"\n\
         [potential]\ngravity = \"-m*g*{length}*cos({angle})\"\n\
         [forces]\nmotor = {{ on = \"{angle}\", value = \"{input}*abs({angle})\" }}\n"
    )
}

#[test]
fn texts_cannot_end_comments() {
    if !has_compilers() {
        return;
    }
    for doc in [
        "*/ int x; /* ??/ /*/ \\\\ \\u202e [`STATE_NAMES`] \u{e9}",
        "*//* //\\\\",
        "??/??/",
        "*??/",
    ] {
        compare(&program(
            &pendulum("texts", doc, doc, "l", "u", "theta"),
            0,
            &supported_outputs(),
        ));
    }
}

/// Names that are fields of structures stay unchanged; clashing variables are renamed.
#[test]
fn names_of_the_emitted_code_do_not_collide() {
    if !has_compilers() {
        return;
    }
    for (length, input, angle) in [
        ("R", "real", "bits"),
        ("t_", "numbers", "regime"),
        ("sin_", "block", "guards_"),
        ("y0", "gamma", "j1"),
        ("M_PI", "signal", "I"),
        ("lambda", "None", "def"),
        ("main", "printf", "NAN"),
    ] {
        compare(&program(
            &pendulum("names", "t", "d", length, input, angle),
            0,
            &supported_outputs(),
        ));
    }
    for model in ["new", "main_", "class", "std"] {
        compare(&program(
            &pendulum(model, "t", "d", "l", "u", "theta"),
            0,
            &[],
        ));
    }
}

#[test]
fn c_keywords_are_rejected_as_names() {
    for word in [
        "new", "class", "bool", "NULL", "template", "errno", "stdout",
    ] {
        let program = program(&pendulum("words", "t", "d", word, "u", "theta"), 0, &[]);
        let error = c::emit(&program).expect_err("a C keyword");
        let EmitError::Name { name, language } = &error else {
            panic!("{error}")
        };
        assert_eq!((name.as_str(), *language), (word, "C or C++"));
        assert_eq!(
            error.to_string(),
            format!("`{word}` is not a valid C or C++ identifier: rename it in the specification")
        );
    }
}

/// Keywords common to C and Rust are rejected before emission.
#[test]
fn keywords_of_c_and_rust_are_rejected_with_line() {
    for word in ["double", "int", "register", "restrict"] {
        let text = pendulum("words", "t", "d", word, "u", "theta");
        let source = eomgen_model_spec::source::Source::new("model.toml", text.as_str());
        let Err(found) = eomgen_model_spec::check(source) else {
            panic!("`{word}` was accepted")
        };
        let said = found.to_string();
        assert!(
            said.contains(&format!("`{word}` cannot be a name")),
            "{said}"
        );
    }
}

/// Returns two controllers with these names, each of which integrates an input.
fn controllers(first: &str, second: &str) -> String {
    let controller = |name: &str, input: &str| {
        format!(
            "[controllers.{name}]\nperiod = 0.01\n\
             states = {{ {input}_i = {{ unit = \"rad\", next = \"{input}_i + phi\" }} }}\n\
             outputs = {{ {input} = \"-k*{input}_i\" }}\n"
        )
    };
    "[model]\nname = \"pair\"\n[parameters]\nm = { value = 2, unit = \"kg m^2\" }\nk = { value = 1, unit = \"N m\" }\n\
     [coordinates]\nphi = { unit = \"rad\" }\n[inputs]\nu = { unit = \"N m\" }\nv = { unit = \"N m\" }\n\
     [kinetic]\nwheel = \"1/2*m*dot(phi)^2\"\n[forces]\nboth = { on = \"phi\", value = \"u + v\" }\n"
        .to_owned()
        + &controller(first, "u")
        + &controller(second, "v")
}

#[test]
fn controllers_with_a_common_name_in_c_are_rejected() {
    for end in ["measured", "outputs", "start", "update"] {
        let text = controllers("a", &format!("a_{end}"));
        let error = c::emit(&program(&text, 0, &[])).expect_err("a collision");
        assert_eq!(
            error.to_string(),
            format!(
                "[controllers.a] and [controllers.a_{end}] would both have the item `pair_controller_a_{end}`: \
                 rename one of them in the specification"
            )
        );
    }
}

/// In Rust, each controller has a separate module, so that names cannot collide.
#[test]
fn controllers_with_similar_names_compile() {
    if !has_compilers() {
        return;
    }
    compare(&program(&controllers("a", "a_out"), 0, &[]));
    let folder = tempfile::tempdir().expect("a folder");
    let source = folder.path().join("lib.rs");
    let text = controllers("a", "a_outputs");
    let text = rust::emit(&program(&text, 0, &[]), Packaging::Crate).expect("emitted");
    std::fs::write(&source, text).expect("written");
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    run(Command::new(rustc)
        .args([
            "--edition",
            "2021",
            "--crate-type",
            "lib",
            "--emit",
            "metadata",
        ])
        .arg("--out-dir")
        .arg(folder.path())
        .arg(source));
}
