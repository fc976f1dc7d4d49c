//! JSON schema of the language, for completion and checks in editors. It covers sections, keys
//! and kinds of values; only [`crate::check`] checks names, expressions and units.

use serde_json::{Map, Value, json};

use crate::bases;
use crate::document::MAX_ENTRIES;
use crate::keys::{Key, Keys, Kind};
use crate::model::MAX_ORDER;
use crate::names::MAX_NAME;
use crate::sections::{SAMPLE_TIME, SECTIONS};

/// Returns the schema, in draft 2020-12 of JSON Schema. Many TOML editors support only older drafts. The schema
/// therefore uses only keywords whose meaning has not changed since draft 6, and no constraints next to a `$ref`,
/// because older drafts ignore them.
pub fn schema() -> Value {
    let mut schema = table(&SECTIONS);
    let has_entries = |section: &str| json!({ "required": [section], "properties": { section: { "minProperties": 1 } } });
    schema["$schema"] = json!("https://json-schema.org/draft/2020-12/schema");
    schema["title"] = json!("A specification of eomgen");
    schema["description"] =
        json!("Mechanical system, described by its energies, forces and geometry.");
    schema["anyOf"] = json!([has_entries("coordinates"), has_entries("fields")]);
    schema["allOf"] = json!([{ "anyOf": [has_entries("kinetic"), { "required": ["bodies"] }] }]);
    schema["$defs"] = kinds();
    schema
}

/// Returns the schemas of the kinds of values by name, with descriptions.
pub fn kinds() -> Value {
    let expression = || reference("expression");
    let bases = bases::BASES.iter().map(|(name, _)| *name);
    let bases: Vec<&str> = bases.chain([bases::TABLE]).collect();
    let line = json!({ "type": "array", "minItems": 2, "items": { "type": "string" } });
    let mut kinds = json!({
        "basis": { "description": "mode shapes of a beam, a rod or a string, or \"table\"", "enum": bases },
        "coherent_unit": { "description": "SI unit without a prefix, such as \"N m\"", "type": "string", "maxLength": MAX_NAME },
        "components": { "description": "expressions along x, y and z", "type": "array", "items": expression(), "minItems": 3, "maxItems": 3 },
        "expression": { "description": "number, or expression in quotes", "type": ["number", "string"] },
        "fraction": { "description": "number between 0 and 1", "type": "number", "exclusiveMinimum": 0, "exclusiveMaximum": 1 },
        "inertia": { "description": "I_xx, I_yy, I_zz, or also I_xy, I_yz, I_xz", "type": "array", "items": expression(), "minItems": 3, "maxItems": 6 },
        "mode_count": { "description": "whole number", "type": "integer", "minimum": 0, "maximum": MAX_ORDER },
        "name": { "description": "letter, then letters, digits and underscores", "type": "string", "pattern": "^[A-Za-z][A-Za-z0-9_]*$", "maxLength": MAX_NAME },
        "number": { "description": "number", "type": "number" },
        "ordinate": { "description": "number in m, or name of an observable or a coordinate in m", "type": ["number", "string"] },
        "pair_of_numbers": { "description": "two numbers", "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2 },
        "positive_number": { "description": "number greater than 0", "type": "number", "exclusiveMinimum": 0 },
        "range": { "description": "lower and upper end, in SI, as expressions of parameters", "type": "array", "items": expression(), "minItems": 2, "maxItems": 2 },
        "rate_count": { "description": "2", "const": 2 },
        "sample_time": { "description": "time in s, expression of parameters, or table with `value` and `unit`", "anyOf": [expression(), table(&SAMPLE_TIME)] },
        "scalar_or_vector": { "description": "expression, or components of a vector", "anyOf": [expression(), { "type": "array", "items": expression(), "minItems": 2, "maxItems": 3 }] },
        "text": { "description": "string", "type": "string" },
        "unit": { "description": "unit, such as \"kg m^2\" or \"N s/mm\"", "type": "string", "maxLength": MAX_NAME },
        "vector": { "description": "expressions along x, y and z, or one expression of a vector", "anyOf": [reference("components"), { "type": "string" }] },
    });
    kinds["lines"] = describe(entries(line), "table of lists of names");
    kinds
}

/// Returns the schema of a table.
fn table(keys: &Keys) -> Value {
    let properties = keys
        .list
        .iter()
        .map(|key| (key.name.to_owned(), value(key)));
    let properties: Map<String, Value> = properties.collect();
    let required = keys.list.iter().filter(|key| key.is_required);
    let required: Vec<&str> = required.map(|key| key.name).collect();
    let mut schema = json!({
        "type": "object",
        "additionalProperties": false,
        "required": required,
        "properties": properties
    });
    let require = |names: &[&str]| json!({ "required": names });
    if !keys.one_of.is_empty() {
        let sets = keys.one_of.iter().map(|names| require(names));
        schema["oneOf"] = sets.collect();
    }
    if !keys.any_of.is_empty() {
        schema["anyOf"] = keys.any_of.iter().map(|name| require(&[name])).collect();
    }
    match keys.shorthand {
        Some(kind) => json!({ "anyOf": [reference(kind), schema] }),
        None => schema,
    }
}

fn value(key: &Key) -> Value {
    let schema = match key.kind {
        Kind::Value(kind) => reference(kind),
        Kind::Table(keys) => table(keys),
        Kind::Entries(keys) => entries(table(keys)),
    };
    describe(
        schema,
        &format!("{}. Example: {}", key.doc, key.assignment()),
    )
}

fn entries(entry: Value) -> Value {
    json!({
        "type": "object",
        "propertyNames": reference("name"),
        "maxProperties": MAX_ENTRIES,
        "additionalProperties": entry
    })
}

fn reference(kind: &str) -> Value {
    json!({ "$ref": format!("#/$defs/{kind}") })
}

/// Adds a description that begins with a capital letter.
fn describe(mut schema: Value, text: &str) -> Value {
    let (first, rest) = text.split_at(text.len().min(1));
    schema["description"] = json!(first.to_uppercase() + rest);
    schema
}
