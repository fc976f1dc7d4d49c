//! Tests of specifications with a drawing: they match the schema, and the drawing does not affect derivation or emitted
//! code.

use eomgen_codegen::rust::{Packaging, emit};
use eomgen_codegen::variant::Variant;
use eomgen_codegen::{c, wasm};
use eomgen_model_spec::model::Model;
use eomgen_model_spec::source::Source;
use serde_json::Value;

use super::drawn_example;

fn examples() -> Vec<String> {
    let names = ["double_pendulum", "crane", "flexible_arm"];
    let text = |name: &str| std::fs::read_to_string(drawn_example(name)).expect("a specification");
    names.map(text).to_vec()
}

fn model(text: &str) -> Model {
    let checked = eomgen_model_spec::check(Source::new("drawn.toml", text));
    let checked = checked.unwrap_or_else(|found| panic!("{}", found.render(false)));
    assert!(checked.warnings.is_empty());
    checked.model
}

#[test]
fn drawings_match_the_schema() {
    let schema = eomgen_model_spec::schema::schema();
    let validator = jsonschema::validator_for(&schema).expect("a schema");
    for text in examples() {
        let document: Value = toml_edit::de::from_str(&text).expect("TOML");
        assert!(validator.is_valid(&document), "{text}");
        for (place, wrong) in [
            ("/drawing/points/extra", serde_json::json!({ "x": 0 })),
            ("/drawing/lines/extra", serde_json::json!(["origin"])),
            ("/drawing/shapes", serde_json::json!({})),
        ] {
            let mut other = document.clone();
            let (table, key) = place.rsplit_once('/').expect("a place");
            other.pointer_mut(table).expect("a table")[key] = wrong;
            assert!(!validator.is_valid(&other), "{place}");
        }
    }
}

/// Returns all emitted code without the hash of the specification.
fn emit_all(model: &Model) -> (String, c::Files, Vec<u8>) {
    let orders = model.orders(None).expect("orders");
    let mut program = Variant::derive(model, &orders).expect("derived").program;
    program.spec_hash.clear();
    let rust = emit(&program, Packaging::Crate).expect("emitted");
    let module = wasm::emit(&program).expect("emitted").bytes;
    (rust, c::emit(&program).expect("emitted"), module)
}

#[test]
fn drawing_does_not_change_emitted_code() {
    for text in examples() {
        let (without, _) = text.split_once("[drawing.points]").expect("a drawing");
        let (with, without) = (model(&text), model(without));
        assert!(with.drawing.is_some() && without.drawing.is_none());
        assert_eq!(emit_all(&with), emit_all(&without));
    }
}
