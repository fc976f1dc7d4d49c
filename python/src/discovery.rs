//! Discovery of effects that a model lacks.

use std::path::Path;

use eomgen_discover::{Discovery, Specification, catalogue, discover_until};
use eomgen_model_spec::hidden_characters::escape_hidden;
use eomgen_records::read_dataset;
use pyo3::prelude::*;

use crate::error;
use crate::interruption::{Connection, interruptible};
use crate::model::Model;

/// Document `discovery.json`, extended specification, report page, and names and texts of proposed experiments.
type DiscoveryTuple = (String, String, String, Vec<(String, String)>);

/// Searches for effects that the model lacks. `progress` is called with each progress message.
#[pyfunction]
pub fn discover(
    py: Python<'_>,
    model: &Model,
    dataset: &str,
    seed: u64,
    progress: Py<PyAny>,
) -> PyResult<DiscoveryTuple> {
    let hear = |py: Python<'_>, line: String| progress.call1(py, (line,)).map(drop);
    let found = interruptible(py, hear, |line| {
        search(model, Path::new(dataset), seed, line)
    })??;
    Ok((
        found.to_json().to_string(),
        found.extended.clone(),
        found.to_html(),
        found
            .experiments
            .iter()
            .map(|experiment| (experiment.name.clone(), experiment.text.clone()))
            .collect(),
    ))
}

fn search(
    model: &Model,
    dataset: &Path,
    seed: u64,
    line: &Connection<'_, String>,
) -> PyResult<Discovery> {
    let (declared, open_loop) = model.open_loop(dataset)?;
    let dataset = read_dataset(dataset, &declared).map_err(error::records)?;
    let say = |text: &str| line.report(escape_hidden(text).into_owned());
    for note in open_loop.iter().chain(&dataset.notes) {
        say(&format!("note: {note}"));
    }
    let effects = catalogue::load_effects(None).map_err(|found| error::specification(&found))?;
    let specification = Specification {
        path: &declared.source.path,
        text: &declared.source.text,
        order: model.order(),
    };
    let found = discover_until(specification, dataset, &effects, seed, &say, line.stop);
    let mut found = found.map_err(error::discovery)?;
    line.check();
    found
        .certify(&declared.source.path, model.order())
        .map_err(error::model)?;
    Ok(found)
}
