//! Inline specifications compared with files, and the tokens at which errors are reported.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use eomgen_model_spec::diagnostic::Diagnostics;
use eomgen_model_spec::source::Source;
use proc_macro2::TokenStream;
use toml_edit::{DocumentMut, TableLike};

use crate::expand::model;
use crate::places::PlacedText;
use crate::tables::parse_sections;
use crate::write::write_specification;

fn placed(text: &str) -> syn::Result<PlacedText> {
    let stream: TokenStream = text.parse().expect("tokens");
    write_specification(&parse_sections(stream)?)
}

fn expect_rejection(text: &str) -> (Diagnostics, PlacedText) {
    let placed = placed(text).expect("sections");
    let source = Source::new("model!", placed.text.as_str());
    let found = eomgen_model_spec::check(source).expect_err("refused");
    (found, placed)
}

/// Returns the first message and the text of the tokens at which it is reported.
fn first_error_location(text: &str) -> (String, String) {
    let (found, placed) = expect_rejection(text);
    let first = &found.list()[0];
    let span = first.primary.as_ref().expect("a place").span;
    let shown = placed.token_text(span).expect("tokens");
    (first.message.clone(), shown.to_owned())
}

fn grammar_error(text: &str) -> String {
    match placed(text) {
        Err(error) => error.to_string(),
        Ok(placed) => panic!("accepted:\n{}", placed.text),
    }
}

#[test]
fn inline_text_is_independent_of_token_spacing() {
    let text = "model { name: one, title : \"A \\\"mass\\\"\" }
        parameters { m: { value: 2.5e-3, unit: kg m^2, min: -1 }, k = { value = - 4.0 }, }
        kinetic { a: 1/2 * m*dot( x )^2, }
        observables { b: atan2(x,.5) + 2. }";
    let expected = "[model]\nname = \"one\"\ntitle = \"A \\\"mass\\\"\"\n\
        \n[parameters]\nm = { value = 2.5e-3, unit = \"kg m^2\", min = -1 }\nk = { value = -4.0 }\n\
        \n[kinetic]\na = \"1/2*m*dot(x)^2\"\n\
        \n[observables]\nb = \"atan2(x, .5)+2.\"\n";
    assert_eq!(placed(text).expect("sections").text, expected);
}

#[test]
fn range_keeps_its_two_ends() {
    let text = "coordinates { x: { unit: m, range: [ -0.005, 2*b ] } } inputs { u: { range: [min(a, b),3,] } }";
    let expected = "[coordinates]\nx = { unit = \"m\", range = [-0.005, \"2*b\"] }\n\
        \n[inputs]\nu = { range = [\"min(a, b)\", 3] }\n";
    assert_eq!(placed(text).expect("sections").text, expected);
}

/// Writes the specification of a file in the inline form. Only prose keeps its quotes, and the string `1`, which
/// would become a number.
fn write_inline(table: &dyn TableLike) -> String {
    let mut text = String::new();
    for (key, item) in table.iter() {
        let prose = ["title", "doc", "source"].contains(&key);
        let value = match (item.as_table_like(), item.as_str()) {
            (Some(table), _) => format!("{{ {} }}", write_inline(table)),
            (None, Some(string)) if !prose && string != "1" => string.to_owned(),
            _ => match item.as_array() {
                Some(array) => {
                    let elements = array.iter().map(|element| match element.as_str() {
                        Some(string) => string.to_owned(),
                        None => element.to_string(),
                    });
                    format!("[{}]", elements.collect::<Vec<_>>().join(", "))
                }
                None => item.to_string(),
            },
        };
        write!(text, "{key}: {value}, ").expect("written");
    }
    text
}

fn shipped() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../model-spec/models");
    let entries = std::fs::read_dir(folder).expect("the shipped specifications");
    let mut paths: Vec<_> = entries
        .map(|entry| entry.expect("readable").path())
        .collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
    assert!(!paths.is_empty());
    paths
}

/// Returns the emitted items without the hash of the specification and without the identity, which contains the hash
/// of the source.
fn emit_items(source: Source) -> String {
    let hash = source.hash();
    let model = eomgen_model_spec::check(source).expect("sound").model;
    let orders = model.orders(None).expect("orders");
    let variant = eomgen_codegen::variant::Variant::derive(&model, &orders).expect("derived");
    let text = eomgen_codegen::rust::emit(&variant.program, eomgen_codegen::rust::Packaging::Crate);
    let text = text.expect("emitted").replace(&hash, "");
    let lines = text.lines().filter(|line| !line.contains("IDENTITY"));
    lines.collect::<Vec<_>>().join("\n")
}

#[test]
fn shipped_specifications_give_the_same_items_inline() {
    for path in shipped() {
        let text = std::fs::read_to_string(&path).expect("readable");
        let document: DocumentMut = text.parse().expect("TOML");
        let mut sections = String::new();
        for (section, item) in document.iter() {
            let table = item.as_table_like().expect("a section");
            writeln!(sections, "{section} {{ {} }}", write_inline(table)).expect("written");
        }
        let quoted = sections.contains("\"1/2*") || sections.contains("\"rotation_");
        assert!(!quoted, "quotes are left out\n{sections}");
        let placed = placed(&sections).unwrap_or_else(|error| panic!("{error}\n{sections}"));
        let here = emit_items(Source::new("model!", placed.text.as_str()));
        let there = emit_items(Source::new("file", text));
        assert!(here == there, "{}\n{}", path.display(), placed.text);
    }
}

const SOUND: &str = "model { name: a } parameters { m: { value: 1, unit: kg } }
    coordinates { x: { unit: m } } kinetic { k: 1/2*m*dot(x)^2 } ";

#[test]
fn findings_point_at_their_tokens() {
    for (more, message, shown) in [
        ("potential { p: m*sin(y) }", "unknown name `y`", "y"),
        (
            "potential { p: m * x^2 }",
            "this term of the potential energy is in kg m^2, expected J",
            "m*x^2",
        ),
        (
            "potential { p: m*x 2 }",
            "an operator is missing before `2`",
            "2",
        ),
        (
            "potential { p: m*x + }",
            "the expression is not finished",
            "+",
        ),
        ("potential { p: x**2 }", "`**` is not an operator", "**"),
        (
            "potential { p: \"sin(y)\" }",
            "unknown name `y`",
            "\"sin(y)\"",
        ),
        (
            "potentials { p: x }",
            "unknown section `potentials`",
            "potentials",
        ),
        (
            "observables { o: { value: x, units: m } }",
            "unknown key `units`",
            "units",
        ),
        (
            "observables { o: { value: x, unit: N } }",
            "the observable `o` is in m, declared in N",
            "x",
        ),
        (
            "observables { o: sum(i, w, q[i]) }",
            "expected the name of a field",
            "w",
        ),
        ("observables { o: atan2(x, .5, ) }", "unexpected `)`", ")"),
        ("observables { o: x > 1 }", "`>` is not an operator", ">"),
        ("observables { θ: x }", "`θ` cannot be a name", "\"θ\""),
        (
            "inputs { r#type: { unit: m } }",
            "`r#type` cannot be a name",
            "\"r#type\"",
        ),
        ("inputs { u: { unit: [m] } }", "unknown unit `[m]`", "[m]"),
        ("inputs { u: m }", "`u` is not a table", "m"),
        (
            "sensors { x: { delay: t } }",
            "`delay` is not a number",
            "t",
        ),
    ] {
        let found = first_error_location(&format!("{SOUND}{more}"));
        assert_eq!(found, (message.to_owned(), shown.to_owned()), "{more}");
    }
}

#[test]
fn grammar_errors_are_rejected() {
    for (text, message) in [
        ("kinetic: { a: 1 }", "expected braces after `kinetic`"),
        ("kinetic", "expected braces after `kinetic`"),
        ("[kinetic] a = 1", "expected a section"),
        (
            "kinetic { a: 1 }, potential { b: 1 }",
            "unexpected separator between sections",
        ),
        (
            "kinetic { a: 1 } kinetic { b: 1 }",
            "`kinetic` is given twice",
        ),
        ("kinetic { a: 1, a: 2 }", "`a` is given twice"),
        ("kinetic { a 1 }", "expected `:` after `a`"),
        ("kinetic { a: }", "`a` has no value"),
        ("kinetic { a: 1; b: 2 }", "entries are separated by commas"),
        ("kinetic { a: x b: 2 }", "a comma is missing before `b`"),
        ("kinetic { 1: 2 }", "expected a name"),
        ("kinetic { #[doc = \"x\"] a: 2 }", "expected a name"),
    ] {
        let found = grammar_error(text);
        assert!(found.starts_with(message), "{text}: {found}");
    }
}

#[test]
fn deep_nesting_is_rejected() {
    let nested = |open: &str, close: &str| {
        let (open, close) = (open.repeat(300), close.repeat(300));
        grammar_error(&format!("kinetic {{ a: {open} x {close} }}"))
    };
    assert!(nested("(", ")").contains("more than 200 nested levels"));
    assert!(nested("{ a: ", "}").contains("nested more than 200 deep"));
}

/// Returns the first error message of an expansion, or all its tokens if there is no error.
fn expand(text: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../model-spec");
    let tokens = model(text.parse().expect("tokens"), Some(&root)).to_string();
    match tokens.split_once("compile_error ! { \"") {
        Some((_, message)) => message.split("\" }").next().expect("a literal").to_owned(),
        None => tokens,
    }
}

#[test]
fn wrong_arguments_are_rejected() {
    let arm = "spec = \"models/planetary_arm.toml\"";
    for (text, message) in [
        ("", "expected a specification"),
        (
            "\"models/planetary_arm.toml\"",
            "expected `spec = ` before the path",
        ),
        ("spec = models", "expected a path in quotes"),
        ("spec =", "expected a path in quotes"),
        (
            "spec = \"models/arm.toml\"",
            "the specification cannot be read",
        ),
        ("spec = \"models\"", "the specification is not a file"),
        ("order = 4", "`spec` is missing"),
        (
            &format!("{arm}, order = 129"),
            "the order 129 is above the limit",
        ),
        (
            &format!("{arm}, order = -1"),
            "the order is not a whole number",
        ),
        (
            &format!("{arm}, order = 4u8"),
            "the order is not a whole number",
        ),
        (
            &format!("{arm}, order = 4.0"),
            "the order is not a whole number",
        ),
        (&format!("{arm} order = 4"), "expected a comma"),
        (&format!("{arm}, {arm}"), "`spec` is given twice"),
        (&format!("{arm}, orders = 4"), "unknown argument `orders`"),
        (
            &format!("{arm}, kinetic {{ }}"),
            "expected `spec = ...` or `order = ...`",
        ),
        (
            "spec = \"models/pendulum.toml\", order = 1",
            "the model `pendulum` has no field",
        ),
    ] {
        let found = expand(text);
        assert!(found.starts_with(message), "{text}: {found}");
    }
}

#[test]
fn file_is_a_dependency_and_inline_text_is_a_constant() {
    let file = expand("spec = \"models/pendulum.toml\"");
    assert!(
        file.contains("include_bytes") && file.contains("models/pendulum.toml"),
        "{file}"
    );
    let here = expand(SOUND);
    assert!(
        here.contains("pub const SPECIFICATION") && !here.contains("include_bytes"),
        "{here}"
    );
}

#[test]
fn path_without_cargo_is_rejected() {
    let stream = "spec = \"models/pendulum.toml\"".parse().expect("tokens");
    let tokens = model(stream, None).to_string();
    assert!(tokens.contains("CARGO_MANIFEST_DIR is not set"), "{tokens}");
}

#[test]
fn unused_input_gives_a_warning() {
    let text = format!("{SOUND} inputs {{ u: {{ unit: N }} }}");
    let tokens = expand(&text);
    assert!(
        tokens.contains("deprecated")
            && tokens.contains("the specification does not use the input `u`"),
        "{tokens}"
    );
    assert!(!expand(SOUND).contains("deprecated"));
}

const PENDULUM: &str = "model { name : pendulum } parameters { m : { value : 1 , unit : kg } , \
    l : { value : 300 , unit : mm , min : 0 } , g : { value : 9.81 , unit : m / s ^ 2 } } \
    coordinates { theta : { unit : rad , initial : pi / 2 } } \
    definitions { y : - l * cos ( theta ) } kinetic { bob : 1 / 2 * m * ( l * dot ( theta ) ) ^ 2 } \
    potential { gravity : m * g * y } forces { motor : { on : theta , value : \"-0\" } }";

/// Returns all mutations of the text `words`: one word is removed, doubled, or replaced by the next word or by a
/// foreign token.
fn mutations(words: &[&str]) -> Vec<String> {
    let slip = |index: usize, with: &[&str]| {
        let behind = &words[index + 1..];
        [&words[..index], with, behind].concat().join(" ")
    };
    let mut texts = Vec::new();
    for (index, word) in words.iter().enumerate() {
        texts.push(slip(index, &[]));
        texts.push(slip(index, &[word, word]));
        texts.push(slip(index, &[words.get(index + 1).unwrap_or(&"")]));
        for foreign in [
            "#",
            "\"\\\"\\n\"",
            "'a'",
            "..",
            "{ }",
            "1e999",
            "theta",
            "θ",
            "r#fn",
        ] {
            texts.push(slip(index, &[foreign]));
        }
    }
    texts
}

#[test]
fn every_mutation_gives_items_or_errors() {
    let words: Vec<&str> = PENDULUM.split_whitespace().collect();
    let (mut errors, mut items) = (0, 0);
    for text in mutations(&words) {
        // The compiler passes only valid Rust tokens to a macro.
        let Ok(stream) = text.parse() else { continue };
        let tokens = model(stream, None).to_string();
        let refused = tokens.contains("compile_error !");
        assert!(
            refused || tokens.contains("pub const SPECIFICATION"),
            "{text}"
        );
        *if refused { &mut errors } else { &mut items } += 1;
    }
    assert!(
        errors > 500 && items > 10,
        "{errors} refused, {items} accepted"
    );
}
