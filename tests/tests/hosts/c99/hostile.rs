//! Names that are words of C, and texts that would end a comment.

use eomgen_codegen::c::{self, EmitError};

use super::{compare, compilers, program, requested};

/// A pendulum with this for its names and texts.
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
fn texts_do_not_leave_their_comments() {
    if !compilers() {
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
            &requested(),
        ));
    }
}

/// Names that are fields of structures are kept as they are, those of variables give way.
#[test]
fn names_of_the_emitted_code_do_not_collide() {
    if !compilers() {
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
            &requested(),
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
fn words_of_c_are_no_names() {
    for word in [
        "new", "class", "bool", "NULL", "template", "errno", "stdout",
    ] {
        let program = program(&pendulum("words", "t", "d", word, "u", "theta"), 0, &[]);
        let error = c::emit(&program).expect_err("a word of C");
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

/// Words of C that are words of Rust as well, or nearly, are refused before anything is emitted.
#[test]
fn words_of_c_are_refused_with_their_line() {
    for word in ["double", "int", "register", "restrict"] {
        let text = pendulum("words", "t", "d", word, "u", "theta");
        let source = eomgen_model_spec::source::Source::new("model.toml", text.as_str());
        let Err(found) = eomgen_model_spec::check(source) else {
            panic!("`{word}` was taken")
        };
        let said = found.to_string();
        assert!(
            said.contains(&format!("`{word}` cannot be a name")),
            "{said}"
        );
    }
}
