//! Comparison of a model with records.

use std::path::Path;

use eomgen_discover::Specification;
use eomgen_model_spec::hidden_characters::escape_hidden;
use eomgen_records::read_dataset;
use pyo3::prelude::*;

use crate::error;
use crate::interruption::interruptible;
use crate::model::Model;

/// Compares a model with records. Returns the document `comparison.json` and the report page. `progress` is called with
/// each progress message.
#[pyfunction]
pub fn compare(
    py: Python<'_>,
    model: &Model,
    dataset: &str,
    seed: u64,
    progress: Py<PyAny>,
) -> PyResult<(String, String)> {
    let hear = |py: Python<'_>, line: String| progress.call1(py, (line,)).map(drop);
    interruptible(py, hear, |line| -> PyResult<(String, String)> {
        let dataset = Path::new(dataset);
        let (declared, open_loop) = model.open_loop(dataset)?;
        let dataset = read_dataset(dataset, &declared).map_err(error::records)?;
        let say = |text: &str| {
            line.check();
            line.report(escape_hidden(text).into_owned());
        };
        for note in open_loop.iter().chain(&dataset.notes) {
            say(&format!("note: {note}"));
        }
        let specification = Specification {
            path: &declared.source.path,
            text: &declared.source.text,
            order: model.order(),
        };
        let found = eomgen_discover::compare(specification, &dataset, seed, &say);
        let found = found.map_err(error::discovery)?;
        Ok((found.to_json().to_string(), found.to_html()))
    })?
}
