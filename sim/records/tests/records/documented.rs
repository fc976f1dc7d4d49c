//! Tests of the dataset files in docs/discovery.md and of the records in examples/measured.

use std::path::{Path, PathBuf};
use std::process::Command;

use eomgen_model_spec::source::Source;
use eomgen_records::description::keys;
use eomgen_records::read_dataset;

/// Returns the path of a file in the repository.
fn project(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../..")
        .join(path)
}

fn text(path: &str) -> String {
    std::fs::read_to_string(project(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

#[test]
fn reference_lists_every_table_and_key() {
    let page = text("docs/discovery.md");
    let (_, reference) = page
        .split_once("### Tables and keys")
        .expect("the reference");
    let reference = reference.split("\n### ").next().unwrap_or_default();
    let table: Vec<&str> = reference
        .lines()
        .filter(|line| line.starts_with('|'))
        .collect();
    let mut section = "";
    let mut documented = std::collections::BTreeSet::new();
    for line in table.iter().skip(2) {
        let cells: Vec<&str> = line.split(" | ").collect();
        let name = cells[0].trim_start_matches('|').trim();
        if !name.is_empty() {
            section = name
                .trim_matches('`')
                .trim_matches(['[', ']'])
                .trim_end_matches(".NAME");
        }
        let names = cells[1].split('`').skip(1).step_by(2);
        documented.extend(names.map(|key| (section, key)));
    }
    for (table, known) in keys::TABLES {
        for key in known {
            let entry = if table == "uncertain" { "NAME" } else { key };
            assert!(documented.contains(&(table, entry)), "[{table}] {key}");
        }
    }
    for key in keys::STRETCH {
        assert!(documented.contains(&("records", key)), "{key}");
    }
    for key in keys::EXPERIMENT_INPUT {
        assert!(documented.contains(&("experiment", key)), "{key}");
    }
    for key in keys::TEXTS {
        assert!(documented.contains(&("(none)", key)), "{key}");
    }
    let known = |(table, key): &(&str, &str)| match *table {
        "(none)" => keys::TEXTS.contains(key),
        "records" => keys::RECORDS.contains(key) || keys::STRETCH.contains(key),
        "uncertain" => *key == "NAME",
        "experiment" => keys::EXPERIMENT.contains(key) || keys::EXPERIMENT_INPUT.contains(key),
        table => keys::TABLES
            .iter()
            .any(|(name, keys)| *name == table && keys.contains(key)),
    };
    let unknown: Vec<_> = documented.iter().filter(|entry| !known(entry)).collect();
    assert!(unknown.is_empty(), "{unknown:?}");
}

#[test]
fn dataset_file_of_page_matches_example_and_is_read() {
    let file = text("examples/measured/dataset.toml");
    assert!(text("docs/discovery.md").contains(&file));
    let source = Source::new("stage.toml", text("examples/measured/stage.toml"));
    let model = eomgen_model_spec::check(source).expect("a model").model;
    let dataset = read_dataset(&project("examples/measured/dataset.toml"), &model);
    let dataset = dataset.unwrap_or_else(|refusal| panic!("{refusal}"));
    assert!(dataset.notes.is_empty(), "{:?}", dataset.notes);
    assert_eq!(dataset.train[0].times.len(), 800);
    assert_eq!(dataset.channels[0].noise, 2e-5);
}

#[test]
fn example_records_match_their_script() {
    let folder = tempfile::tempdir().expect("a folder");
    let made = Command::new("python3")
        .arg(project("examples/measured/make.py"))
        .arg(folder.path())
        .output();
    let Some(made) = made.ok().filter(|output| output.status.code() != Some(127)) else {
        skips::skip("the records of examples/measured were not regenerated: python3 is missing");
        return;
    };
    assert!(
        made.status.success(),
        "{}",
        String::from_utf8_lossy(&made.stderr)
    );
    for name in ["first.csv", "second.csv"] {
        let anew = std::fs::read_to_string(folder.path().join(name)).expect("a record");
        let shipped = text(&format!("examples/measured/{name}"));
        let numbers = |text: &str| -> Vec<f64> {
            let cells = text.lines().skip(4).flat_map(|line| line.split(';'));
            let number = |cell: &str| cell.replace(',', ".").parse().expect("a number");
            cells.map(number).collect()
        };
        let (anew, shipped) = (numbers(&anew), numbers(&shipped));
        assert_eq!(anew.len(), shipped.len());
        // The last digit can differ between implementations of the cosine.
        let pairs = anew.iter().zip(&shipped);
        assert!(
            pairs.into_iter().all(|(a, b)| (a - b).abs() < 2e-3),
            "{name}"
        );
    }
}
