//! Comparison of a model with records and discovery of missing effects, including the output files.

use std::path::Path;
use std::time::{Duration, Instant};

use eomgen_discover::{Specification, StopRequest, catalogue, discover_until};
use eomgen_model_spec::model::Model;
use eomgen_records::dataset::Dataset;
use eomgen_records::feedback::open_loop;
use eomgen_records::read_dataset;
use serde_json::{Value, json};

use crate::error::{Error, Result, warn};
use crate::model::{load, orders};
use crate::output::{file_place, write_file};

/// Files, options and seed of a comparison or a discovery.
pub struct Task<'a> {
    pub spec: &'a Path,
    pub order: Option<&'a str>,
    pub dataset: &'a Path,
    pub out: &'a Path,
    /// Seed of the noise in the simulated record that gives the noise floor.
    pub seed: u64,
}

/// Compares a model with records and writes `comparison.json` and `report.html`. Returns the document.
pub fn compare(task: &Task<'_>) -> Result<Value> {
    let begin = Instant::now();
    let (model, order, dataset) = read_inputs(task)?;
    check_outputs(task, &["comparison.json", "report.html"])?;
    let path = task.spec.display().to_string();
    let specification = Specification {
        path: &path,
        text: &model.source.text,
        order,
    };
    let found = eomgen_discover::compare(specification, &dataset, task.seed, &warn);
    let found = found.map_err(Error::discovery)?;
    let mut document = found.to_json();
    document["seconds"] = json!(begin.elapsed().as_secs_f64());
    write_json(&task.out.join("comparison.json"), &document)?;
    write_file(&task.out.join("report.html"), found.to_html().as_bytes())?;
    Ok(document)
}

/// Finds missing effects and writes `discovery.json`, `extended.toml`, `report.html` and proposed experiments.
/// `limit` is in s; `effects` is a file with additional effects. Returns the document.
pub fn discover(task: &Task<'_>, limit: Option<f64>, effects: Option<&Path>) -> Result<Value> {
    let begin = Instant::now();
    let (model, order, dataset) = read_inputs(task)?;
    check_outputs(task, &["extended.toml", "report.html", "discovery.json"])?;
    let effects = catalogue::load_effects(effects).map_err(Error::Specification)?;
    let path = task.spec.display().to_string();
    let specification = Specification {
        path: &path,
        text: &model.source.text,
        order,
    };
    let stop = match limit {
        Some(limit) => StopRequest::with_time_limit(seconds(limit)?),
        None => StopRequest::default(),
    };
    let found = discover_until(specification, dataset, &effects, task.seed, &warn, &stop);
    let mut found = found.map_err(Error::discovery)?;
    found.certify(&path, order)?;
    let mut document = found.to_json();
    document["seconds"] = json!(begin.elapsed().as_secs_f64());
    let out = task.out;
    write_file(&out.join("extended.toml"), found.extended.as_bytes())?;
    copy_tables(&model, task)?;
    write_file(&out.join("report.html"), found.to_html().as_bytes())?;
    for experiment in &found.experiments {
        write_file(&out.join(&experiment.name), experiment.text.as_bytes())?;
    }
    write_json(&out.join("discovery.json"), &document)?;
    Ok(document)
}

/// Copies the tables of mode shapes to the folder of the extended specification, unless both specifications are in the
/// same folder.
fn copy_tables(model: &Model, task: &Task<'_>) -> Result {
    let folder = task.spec.parent().unwrap_or(Path::new(""));
    let tables = model.fields.iter().filter_map(|field| field.basis.table());
    for table in tables {
        let [from, to] = [folder, task.out].map(|folder| folder.join(&table.file));
        let read = |path: &Path| std::fs::read(path);
        let text = read(&from).map_err(|error| Error::file("read", &from, &error))?;
        if read(&to).ok().as_ref() != Some(&text) {
            write_file(&to, &text)?;
        }
    }
    Ok(())
}

/// Checks that the output files can be written. It is called before the computation.
fn check_outputs(task: &Task<'_>, names: &[&str]) -> Result {
    for name in names {
        file_place(&task.out.join(name))?;
    }
    Ok(())
}

/// Parses a time limit in s.
fn seconds(limit: f64) -> Result<Duration> {
    Duration::try_from_secs_f64(limit)
        .ok()
        .filter(|limit| !limit.is_zero())
        .ok_or_else(|| Error::input(format!("--limit {limit:?}: expected a time in s above 0")))
}

/// Reads the specification, the truncation order and the dataset.
fn read_inputs(task: &Task<'_>) -> Result<(Model, Option<usize>, Dataset)> {
    let model = load(task.spec)?.model;
    let (model, open_loop) = open_loop(model, task.dataset).map_err(Error::records)?;
    orders(&model, task.order)?;
    let order = task.order.and_then(|order| order.trim().parse().ok());
    let dataset = read_dataset(task.dataset, &model).map_err(Error::records)?;
    for note in open_loop.iter().chain(&dataset.notes) {
        warn(&format!("note: {note}"));
    }
    Ok((model, order, dataset))
}

fn write_json(path: &Path, document: &Value) -> Result {
    write_file(path, format!("{document:#}\n").as_bytes())
}
