//! Tests of the dataset files in docs/discovery.md and of the records in examples/measured.

use std::path::{Path, PathBuf};
use std::process::Command;

use eomgen_model_spec::source::Source;
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
        // The last digit may depend on the implementation of the cosine.
        let pairs = anew.iter().zip(&shipped);
        assert!(
            pairs.into_iter().all(|(a, b)| (a - b).abs() < 2e-3),
            "{name}"
        );
    }
}
