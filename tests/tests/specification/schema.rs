//! `eomgen schema` against the reader of specifications: what the reader takes, the schema takes,
//! and misspelt keys, values of the wrong kind and missing keys are refused by both.

use std::path::{Path, PathBuf};

use eomgen_model_spec::source::Source;
use eomgen_tests::models::{project, shipped};
use eomgen_tests::program::accepted;
use jsonschema::Validator;
use serde_json::Value;

fn validator() -> Validator {
    let schema: Value = serde_json::from_str(&accepted(&["schema"])).expect("a JSON document");
    jsonschema::meta::validate(&schema).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(
        schema["$schema"],
        "https://json-schema.org/draft/2020-12/schema"
    );
    jsonschema::validator_for(&schema).unwrap_or_else(|error| panic!("{error}"))
}

/// The specifications in a folder of the project.
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

/// Those that are shipped and those with one feature of the language each.
fn sound() -> Vec<PathBuf> {
    let mut paths = shipped();
    paths.extend(specifications("tests/features"));
    paths
}

/// A specification as JSON; none if it is not TOML.
fn json(path: &Path) -> Option<Value> {
    let text = std::fs::read_to_string(path).ok()?;
    toml_edit::de::from_str(&text).ok()
}

/// What the reader says of a specification; nothing if it is sound.
fn reader(document: &Value) -> String {
    let text = toml_edit::ser::to_string(document).expect("TOML");
    match eomgen_model_spec::check(Source::new("a.toml", text)) {
        Ok(_) => String::new(),
        Err(found) => found.render(false),
    }
}

/// The document once for every key in it, changed there by `change`, with where that is.
fn changed(document: &Value, change: impl Fn(&mut Value, &str)) -> Vec<(String, Value)> {
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
fn every_sound_specification_fits() {
    let validator = validator();
    for path in sound() {
        let document = json(&path).expect("TOML");
        let errors: Vec<String> = validator
            .iter_errors(&document)
            .map(|error| format!("{}: {error}", error.instance_path()))
            .collect();
        assert!(errors.is_empty(), "{}: {errors:#?}", path.display());
    }
}

#[test]
fn a_misspelt_key_fits_nowhere() {
    let validator = validator();
    for path in sound() {
        let misspelt = changed(&json(&path).expect("TOML"), |table, key| {
            let table = table.as_object_mut().expect("a table");
            let value = table.remove(key).expect("the key");
            table.insert(format!("{key}x"), value);
        });
        for (place, document) in misspelt {
            let shown = format!("{} {place}", path.display());
            assert!(!validator.is_valid(&document), "{shown}");
            assert!(reader(&document).contains("unknown "), "{shown}");
        }
    }
}

#[test]
fn a_value_of_the_wrong_kind_fits_nowhere() {
    let validator = validator();
    for wrong in [Value::Bool(true), serde_json::json!([[1]])] {
        for path in sound() {
            let replaced = changed(&json(&path).expect("TOML"), |table, key| {
                table[key] = wrong.clone();
            });
            for (place, document) in replaced {
                let shown = format!("{} {place} = {wrong}", path.display());
                assert!(!validator.is_valid(&document), "{shown}");
                assert_ne!(reader(&document), "", "{shown}");
            }
        }
    }
}

#[test]
fn a_key_is_needed_where_the_reader_needs_it() {
    let validator = validator();
    let (mut needed, mut free) = (0, 0);
    for path in sound() {
        let without = changed(&json(&path).expect("TOML"), |table, key| {
            table.as_object_mut().expect("a table").remove(key);
        });
        for (place, document) in without {
            let said = reader(&document);
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
fn what_breaks_the_grammar_of_sections_and_keys_does_not_fit() {
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
