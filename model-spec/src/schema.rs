//! JSON schema of the language, for completion and checks in editors. It covers sections, keys
//! and kinds of values; only [`crate::check`] checks names, expressions and units.

/// The schema, in draft 2020-12 of JSON Schema. Many TOML editors support only older drafts: it
/// uses only keywords with one meaning in all drafts since 6, and no constraints next to a
/// `$ref`, which older drafts ignore.
pub const SCHEMA: &str = include_str!("schema.json");

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use serde_json::Value;

    use super::SCHEMA;
    use crate::document::MAX_ENTRIES;
    use crate::keys;
    use crate::model::MAX_ORDER;
    use crate::names::MAX_NAME;

    fn schema() -> Value {
        serde_json::from_str(SCHEMA).expect("a JSON document")
    }

    /// Returns the target of a `$ref`, or the schema itself.
    fn followed<'s>(whole: &'s Value, part: &'s Value) -> &'s Value {
        match part["$ref"].as_str() {
            Some(place) => whole
                .pointer(place.trim_start_matches('#'))
                .unwrap_or_else(|| panic!("no schema at {place}")),
            None => part,
        }
    }

    /// Returns the keys of all tables that a value may be.
    fn keys_of<'s>(whole: &'s Value, part: &'s Value) -> BTreeSet<&'s str> {
        let part = followed(whole, part);
        let own = part["properties"].as_object();
        let own = own.into_iter().flat_map(|keys| keys.keys());
        let kinds = part["anyOf"].as_array().into_iter().flatten();
        let of_kinds = kinds.flat_map(|kind| keys_of(whole, kind));
        own.map(String::as_str).chain(of_kinds).collect()
    }

    #[test]
    fn schema_lists_the_sections_and_keys_of_the_reader() {
        let schema = schema();
        let sections = schema["properties"].as_object().expect("sections");
        assert_eq!(
            sections.keys().map(String::as_str).collect::<BTreeSet<_>>(),
            keys::sections().collect()
        );
        for (name, known) in keys::SECTIONS {
            let section = &sections[name];
            let entry = match name {
                "model" | "drawing" => section,
                _ => &section["additionalProperties"],
            };
            let known: BTreeSet<&str> = known.iter().copied().collect();
            assert_eq!(keys_of(&schema, entry), known, "{name}");
        }
    }

    #[test]
    fn tables_of_the_schema_reject_unknown_keys() {
        fn look(part: &Value, place: &str) {
            if let Some(keys) = part.as_object() {
                // The alternatives at the top only require one of two sections.
                if keys.contains_key("properties") && !place.starts_with("/anyOf") {
                    assert_eq!(keys["additionalProperties"], false, "{place}");
                }
                for (key, value) in keys.iter().filter(|(key, _)| *key != "properties") {
                    look(value, &format!("{place}/{key}"));
                }
                let inner = keys.get("properties").and_then(Value::as_object);
                for (key, value) in inner.into_iter().flatten() {
                    look(value, &format!("{place}/{key}"));
                }
            }
            for (index, value) in part.as_array().into_iter().flatten().enumerate() {
                look(value, &format!("{place}/{index}"));
            }
        }
        look(&schema(), "");
    }

    #[test]
    fn references_have_only_descriptions_next_to_them() {
        fn look(part: &Value) {
            if let Some(keys) = part.as_object() {
                let words = ["$ref", "description", "default"];
                let beside = |key: &String| !words.contains(&key.as_str());
                assert!(
                    !(keys.contains_key("$ref") && keys.keys().any(beside)),
                    "{part}"
                );
                keys.values().for_each(look);
            }
            part.as_array().into_iter().flatten().for_each(look);
        }
        look(&schema());
    }

    #[test]
    fn schema_has_the_limits_of_the_reader() {
        let schema = schema();
        let defined = &schema["$defs"];
        assert_eq!(defined["name"]["maxLength"], MAX_NAME);
        let of_entries = keys::sections().filter(|name| !["model", "drawing"].contains(name));
        for section in of_entries {
            assert_eq!(schema["properties"][section]["maxProperties"], MAX_ENTRIES);
        }
        let drawing = &schema["properties"]["drawing"]["properties"];
        for part in keys::DRAWING {
            assert_eq!(drawing[part]["maxProperties"], MAX_ENTRIES);
        }
        let point = keys_of(&schema, &drawing["points"]["additionalProperties"]);
        assert_eq!(point, BTreeSet::from(keys::POINT));
        let field = &defined["field"]["properties"];
        assert_eq!(field["order"]["maximum"], MAX_ORDER);
        let mut bases: Vec<&str> = keys::BASES.iter().map(|(name, _)| *name).collect();
        bases.push(keys::TABLE);
        assert_eq!(field["basis"]["enum"], serde_json::json!(bases));
    }
}
