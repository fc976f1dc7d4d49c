//! Comparison of `eomgen schema` with the parser of specifications: both accept the same files, and both reject
//! misspelt keys, values of the wrong type and missing keys.

use std::path::{Path, PathBuf};

use eomgen_model_spec::source::Source;
use eomgen_tests::models::{project, shipped_specifications};
use eomgen_tests::program::run_accepted;
use jsonschema::Validator;
use serde_json::Value;

fn validator() -> Validator {
    let schema: Value = serde_json::from_str(&run_accepted(&["schema"])).expect("a JSON document");
    jsonschema::meta::validate(&schema).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(
        schema["$schema"],
        "https://json-schema.org/draft/2020-12/schema"
    );
    jsonschema::validator_for(&schema).unwrap_or_else(|error| panic!("{error}"))
}

fn specifications(folder: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(project().join(folder)).expect("a folder");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let mut paths: Vec<PathBuf> = paths
        .filter(|path| path.extension().is_some_and(|end| end == "toml"))
        .collect();
    paths.sort();
    assert!(paths.len() > 20, "{folder}");
    paths
}

fn valid_specifications() -> Vec<PathBuf> {
    let mut paths = shipped_specifications();
    paths.extend(specifications("tests/features"));
    paths
}

/// Converts a specification to JSON; `None` if it is not TOML.
fn json(path: &Path) -> Option<Value> {
    let text = std::fs::read_to_string(path).ok()?;
    toml_edit::de::from_str(&text).ok()
}

/// Returns the parser's diagnostics; empty if the specification is valid.
fn diagnose(document: &Value) -> String {
    let text = toml_edit::ser::to_string(document).expect("TOML");
    match eomgen_model_spec::check(Source::new("a.toml", text)) {
        Ok(_) => String::new(),
        Err(found) => found.render(false),
    }
}

/// Returns, for each key, its path and a copy of the document in which `change` was applied to the key's value.
fn change_each_key(document: &Value, change: impl Fn(&mut Value, &str)) -> Vec<(String, Value)> {
    let mut all = Vec::new();
    let tables = document.as_object().expect("a table");
    let mut at = |place: &str, key: &str| {
        let mut other = document.clone();
        let table = other.pointer_mut(place).expect("a table");
        change(table, key);
        all.push((format!("{place}/{key}"), other));
    };
    for (section, entries) in tables {
        at("", section);
        let entries = entries.as_object().expect("a table");
        for (name, entry) in entries {
            if section == "model" {
                at("/model", name);
            }
            for key in entry.as_object().into_iter().flat_map(|entry| entry.keys()) {
                at(&format!("/{section}/{name}"), key);
            }
        }
    }
    all
}

#[test]
fn schema_accepts_valid_specifications() {
    let validator = validator();
    for path in valid_specifications() {
        let document = json(&path).expect("TOML");
        let errors: Vec<String> = validator
            .iter_errors(&document)
            .map(|error| format!("{}: {error}", error.instance_path()))
            .collect();
        assert!(errors.is_empty(), "{}: {errors:#?}", path.display());
    }
}

#[test]
fn schema_rejects_misspelt_keys() {
    let validator = validator();
    for path in valid_specifications() {
        let misspelt = change_each_key(&json(&path).expect("TOML"), |table, key| {
            let table = table.as_object_mut().expect("a table");
            let value = table.remove(key).expect("the key");
            table.insert(format!("{key}x"), value);
        });
        for (place, document) in misspelt {
            let shown = format!("{} {place}", path.display());
            assert!(!validator.is_valid(&document), "{shown}");
            assert!(diagnose(&document).contains("unknown "), "{shown}");
        }
    }
}

#[test]
fn schema_rejects_values_of_wrong_type() {
    let validator = validator();
    for wrong in [Value::Bool(true), serde_json::json!([[1]])] {
        for path in valid_specifications() {
            let replaced = change_each_key(&json(&path).expect("TOML"), |table, key| {
                table[key] = wrong.clone();
            });
            for (place, document) in replaced {
                let shown = format!("{} {place} = {wrong}", path.display());
                assert!(!validator.is_valid(&document), "{shown}");
                assert_ne!(diagnose(&document), "", "{shown}");
            }
        }
    }
}

#[test]
fn schema_requires_the_keys_that_the_parser_requires() {
    let validator = validator();
    let (mut needed, mut free) = (0, 0);
    for path in valid_specifications() {
        let without = change_each_key(&json(&path).expect("TOML"), |table, key| {
            table.as_object_mut().expect("a table").remove(key);
        });
        for (place, document) in without {
            let said = diagnose(&document);
            let missing = [" has no `", "is missing", "a model needs "];
            let missing = missing.iter().any(|words| said.contains(words));
            let shown = format!("{} without {place}: {said}", path.display());
            assert_eq!(validator.is_valid(&document), !missing, "{shown}");
            *if missing { &mut needed } else { &mut free } += 1;
        }
    }
    assert!(needed > 100 && free > 100, "{needed}, {free}");
}

#[test]
fn schema_rejects_structures_that_the_parser_rejects() {
    let validator = validator();
    let mut refused = 0;
    for path in specifications("model-spec/tests/corpus/broken") {
        let Some(document) = json(&path) else {
            continue;
        };
        let said = std::fs::read_to_string(path.with_extension("txt")).expect("its message");
        let first = said.lines().next().unwrap_or_default();
        let grammar = [
            "unknown key",
            "unknown section",
            "unknown basis",
            "` has no `",
        ];
        let kinds = [
            "is not a table",
            "is not a number or",
            "is not a whole number",
        ];
        if grammar
            .iter()
            .chain(&kinds)
            .any(|words| first.contains(words))
        {
            assert!(!validator.is_valid(&document), "{}", path.display());
            refused += 1;
        }
    }
    assert!(refused >= 10, "{refused}");
}
