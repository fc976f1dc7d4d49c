//! JSON schema of the language, for completion and checks in editors. It covers sections, keys
//! and kinds of values; only [`crate::check`] checks names, expressions and units.

use serde_json::{Map, Value, json};

use crate::bases;
use crate::document::MAX_ENTRIES;
use crate::keys::{Key, Keys, Kind};
use crate::model::MAX_ORDER;
use crate::names::MAX_NAME;
use crate::sections::SECTIONS;

/// Returns the schema, in draft 2020-12 of JSON Schema. Many TOML editors support only older
/// drafts: it uses only keywords with one meaning in all drafts since 6, and no constraints next to
/// a `$ref`, which older drafts ignore.
pub fn schema() -> Value {
    let mut schema = table(&SECTIONS);
    let has_entries = |section: &str| json!({ "required": [section], "properties": { section: { "minProperties": 1 } } });
    schema["$schema"] = json!("https://json-schema.org/draft/2020-12/schema");
    schema["title"] = json!("A specification of eomgen");
    schema["description"] =
        json!("Mechanical system, described by its energies, forces and geometry.");
    schema["anyOf"] = json!([has_entries("coordinates"), has_entries("fields")]);
    schema["allOf"] = json!([{ "anyOf": [has_entries("kinetic"), { "required": ["bodies"] }] }]);
    schema["$defs"] = json!(kinds());
    schema
}

/// Returns the kinds of values by name, with a description.
pub fn kinds() -> Map<String, Value> {
    let expression = || reference("expression");
    let number = || json!({ "type": "number" });
    let list = |element, least: usize, most: usize| json!({ "type": "array", "items": element, "minItems": least, "maxItems": most });
    let unit = || json!({ "type": "string", "maxLength": MAX_NAME });
    let bases = bases::BASES.iter().map(|(name, _)| *name);
    let bases: Vec<&str> = bases.chain([bases::TABLE]).collect();
    let kinds = [
        (
            "name",
            "a letter, then letters, digits and underscores",
            json!({
                "type": "string",
                "pattern": "^[A-Za-z][A-Za-z0-9_]*$",
                "maxLength": MAX_NAME
            }),
        ),
        ("text", "a string", json!({ "type": "string" })),
        ("number", "a number", number()),
        (
            "positive_number",
            "a number greater than 0",
            json!({ "type": "number", "exclusiveMinimum": 0 }),
        ),
        (
            "fraction",
            "a number between 0 and 1",
            json!({ "type": "number", "exclusiveMinimum": 0, "exclusiveMaximum": 1 }),
        ),
        ("pair_of_numbers", "two numbers", list(number(), 2, 2)),
        (
            "expression",
            "a number, or an expression in quotes",
            json!({ "type": ["number", "string"] }),
        ),
        (
            "scalar_or_vector",
            "an expression, or the components of a vector",
            json!({ "anyOf": [expression(), list(expression(), 2, 3)] }),
        ),
        (
            "components",
            "expressions along x, y and z",
            list(expression(), 3, 3),
        ),
        (
            "vector",
            "expressions along x, y and z, or one expression of a vector",
            json!({ "anyOf": [reference("components"), { "type": "string" }] }),
        ),
        (
            "inertia",
            "I_xx, I_yy, I_zz, or also I_xy, I_yz, I_xz",
            list(expression(), 3, 6),
        ),
        (
            "range",
            "lower and upper end, in SI, as expressions of parameters",
            list(expression(), 2, 2),
        ),
        ("unit", "a unit, such as \"kg m^2\" or \"N s/mm\"", unit()),
        (
            "coherent_unit",
            "an SI unit without a prefix, such as \"N m\"",
            unit(),
        ),
        ("rate_count", "2", json!({ "const": 2 })),
        (
            "basis",
            "mode shapes of a beam, a rod or a string, or \"table\"",
            json!({ "enum": bases }),
        ),
        (
            "mode_count",
            "a whole number",
            json!({ "type": "integer", "minimum": 0, "maximum": MAX_ORDER }),
        ),
        (
            "ordinate",
            "a number in m, or the name of an observable or a coordinate in m",
            json!({ "type": ["number", "string"] }),
        ),
        (
            "lines",
            "a table of lists of names",
            entries(json!({ "type": "array", "minItems": 2, "items": { "type": "string" } })),
        ),
    ];
    let described = |(name, text, schema)| (String::from(name), describe(schema, text));
    kinds.into_iter().map(described).collect()
}

/// Returns the schema of a table.
fn table(keys: &Keys) -> Value {
    let properties = keys.list.iter().map(|key| (key.name, value(key)));
    let properties: Map<String, Value> = properties
        .map(|(name, schema)| (name.to_owned(), schema))
        .collect();
    let required = keys.list.iter().filter(|key| key.is_required);
    let required: Vec<&str> = required.map(|key| key.name).collect();
    let mut schema = json!({
        "type": "object",
        "additionalProperties": false,
        "required": required,
        "properties": properties
    });
    let demand = |names: &[&str]| json!({ "required": names });
    if !keys.one_of.is_empty() {
        let sets = keys.one_of.iter().map(|names| demand(names));
        schema["oneOf"] = sets.collect();
    }
    if !keys.any_of.is_empty() {
        schema["anyOf"] = keys.any_of.iter().map(|name| demand(&[name])).collect();
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

/// Adds a description, with a capital letter.
fn describe(mut schema: Value, text: &str) -> Value {
    let (first, rest) = text.split_at(text.len().min(1));
    schema["description"] = json!(first.to_uppercase() + rest);
    schema
}
