//! The files that a comparison and a discovery leave, and how a specification that was extended
//! is validated. What is compared and what is found is the library's.

use std::path::Path;
use std::time::{Duration, Instant};

use eomgen_discover::report::result::Validation;
use eomgen_discover::{Specification, Stop, catalogue, discover_until};
use eomgen_model_spec::source::Source;
use eomgen_paper::certification::certify;
use eomgen_records::dataset::Dataset;
use eomgen_records::read_dataset;
use eomgen_validate::certificate::{Check, Verdict};
use serde_json::{Value, json};

use crate::arguments;
use crate::error::{Error, Result, warn};
use crate::model::{load, orders};
use crate::output::write_file;

/// Compares; the document that is left beside the page.
pub fn compared(options: &arguments::Compare) -> Result<Value> {
    let begin = Instant::now();
    let (text, order, dataset) = inputs(&options.spec, &options.dataset, options.order.as_deref())?;
    let path = options.spec.display().to_string();
    let specification = Specification {
        path: &path,
        text: &text,
        order,
    };
    let found = eomgen_discover::compare(specification, &dataset, options.seed, &warn);
    let found = found.map_err(Error::discovery)?;
    let mut document = found.to_json();
    document["seconds"] = json!(begin.elapsed().as_secs_f64());
    write_json(&options.out.join("comparison.json"), &document)?;
    write_file(&options.out.join("report.html"), found.page().as_bytes())?;
    Ok(document)
}

/// Discovers; the document that is left beside the page and the specification.
pub fn discovered(options: &arguments::Discover) -> Result<Value> {
    let begin = Instant::now();
    let (text, order, dataset) = inputs(&options.spec, &options.dataset, options.order.as_deref())?;
    let effects = catalogue::effects(options.effects.as_deref()).map_err(Error::Specification)?;
    let path = options.spec.display().to_string();
    let specification = Specification {
        path: &path,
        text: &text,
        order,
    };
    let stop = match options.limit {
        Some(limit) => Stop::after(seconds(limit)?),
        None => Stop::default(),
    };
    let found = discover_until(specification, dataset, &effects, options.seed, &warn, &stop);
    let mut found = found.map_err(Error::discovery)?;
    found.validation = validated(&path, &found.extended, order)?;
    let mut document = found.to_json();
    document["seconds"] = json!(begin.elapsed().as_secs_f64());
    let out = &options.out;
    write_file(&out.join("extended.toml"), found.extended.as_bytes())?;
    write_file(&out.join("report.html"), found.page().as_bytes())?;
    for experiment in &found.experiments {
        write_file(&out.join(&experiment.name), experiment.text.as_bytes())?;
    }
    write_json(&out.join("discovery.json"), &document)?;
    Ok(document)
}

/// A time to be spent.
fn seconds(limit: f64) -> Result<Duration> {
    Duration::try_from_secs_f64(limit)
        .ok()
        .filter(|limit| !limit.is_zero())
        .ok_or_else(|| Error::input(format!("--limit {limit:?}: expected a time in s above 0")))
}

/// What the checks of `validate` say of the specification that was written: its equations are
/// derived anew and set beside the independent oracle and the emitted source. None where fields
/// have different orders, for which there are no such checks.
fn validated(path: &str, text: &str, order: Option<usize>) -> Result<Option<Validation>> {
    let checked = eomgen_model_spec::check(Source::new(path, text));
    let model = checked.map_err(Error::Specification)?.model;
    let orders = model.orders(order);
    let orders = orders.map_err(|error| Error::model(&model.source, error))?;
    if orders.iter().any(|other| *other != orders[0]) {
        return Ok(None);
    }
    let certificate = certify(&model, &orders, &[])?;
    let names = |wanted: fn(&Check) -> bool| -> Vec<String> {
        let checks = certificate.checks.iter().filter(|check| wanted(check));
        checks.map(|check| check.name.clone()).collect()
    };
    Ok(Some(Validation {
        passed: certificate.verdict != Verdict::Failed,
        checks: names(|check| check.skipped.is_none()),
        failed: names(|check| !check.passed && check.skipped.is_none()),
    }))
}

/// The specification's text, the order asked for, and the dataset.
fn inputs(
    spec: &Path,
    dataset: &Path,
    order: Option<&str>,
) -> Result<(String, Option<usize>, Dataset)> {
    let model = load(spec)?.model;
    let text = model.source.text.to_string();
    orders(&model, order)?;
    let order = order.and_then(|order| order.trim().parse().ok());
    let dataset = read_dataset(dataset, &model).map_err(Error::records)?;
    for note in &dataset.notes {
        warn(&format!("note: {note}"));
    }
    Ok((text, order, dataset))
}

fn write_json(path: &Path, document: &Value) -> Result {
    write_file(path, format!("{document:#}\n").as_bytes())
}
