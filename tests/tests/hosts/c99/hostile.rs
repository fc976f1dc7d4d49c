//! Names that are C keywords, and texts that would end a comment.

use eomgen_codegen::c::{self, EmitError};

use super::{compare, has_compilers, program, supported_outputs};

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
