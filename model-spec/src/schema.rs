//! The language's JSON schema, by which editors complete and check a specification while it is
//! written. It knows sections, keys and kinds of values; names, expressions and units are for
//! [`crate::check`] alone.

/// The schema, in draft 2020-12 of JSON Schema. Editors for TOML often know an older draft alone:
/// the keywords are those that all drafts since 6 read alike, and nothing that counts stands
/// beside a `$ref`, where they overlook it.
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

    /// What a `$ref` leads to, or the schema itself.
    fn followed<'s>(whole: &'s Value, part: &'s Value) -> &'s Value {
        match part["$ref"].as_str() {
            Some(place) => whole
                .pointer(place.trim_start_matches('#'))
                .unwrap_or_else(|| panic!("{place} leads nowhere")),
            None => part,
        }
    }

    /// The keys of all tables that a value may be.
    fn keys_of<'s>(whole: &'s Value, part: &'s Value) -> BTreeSet<&'s str> {
        let part = followed(whole, part);
        let own = part["properties"].as_object();
        let own = own.into_iter().flat_map(|keys| keys.keys());
        let kinds = part["anyOf"].as_array().into_iter().flatten();
        let of_kinds = kinds.flat_map(|kind| keys_of(whole, kind));
        own.map(String::as_str).chain(of_kinds).collect()
    }

    #[test]
    fn the_schema_lists_the_sections_and_keys_that_the_reader_knows() {
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
    fn every_table_of_the_schema_refuses_other_keys() {
        fn look(part: &Value, place: &str) {
            if let Some(keys) = part.as_object() {
                // The alternatives at the top only ask for one of two sections.
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
    fn only_words_stand_beside_a_reference() {
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
    fn the_schema_has_the_readers_limits_and_words() {
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
