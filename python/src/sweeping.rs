//! Sweeps over parameters.

use std::path::{Path, PathBuf};

use eomgen_compiled_model::Error;
use eomgen_sweep::{
    Folder, MissingNumbers, Shard, Span, Sweep, SweepError, SweepRequest, Table, merge,
    run_with_check,
};
use pyo3::prelude::*;

use crate::error;
use crate::interruption::{Connection, interruptible};
use crate::model::Model;

/// Names and units of the columns, the columns, and warnings about inputs and points without numbers.
type SweepTuple = (Vec<NameAndUnit>, Vec<Vec<f64>>, Vec<String>);

/// Name and unit of a column.
type NameAndUnit = (String, String);

/// Computes measures over a grid or over random samples, in the folder `out`. Resumes an interrupted sweep. `progress`
/// is called with the number of computed points and the number of points to compute.
#[pyfunction]
#[pyo3(signature = (
    model, vary, samples, seed, measures, frequency, span, until, section, inputs, record, state, out, threads,
    progress
))]
#[expect(clippy::too_many_arguments, reason = "arguments of a Python function")]
pub fn sweep(
    py: Python<'_>,
    model: &Model,
    vary: Vec<String>,
    samples: Option<usize>,
    seed: u64,
    measures: Vec<String>,
    frequency: String,
    span: (usize, usize),
    until: Option<f64>,
    section: Option<String>,
    inputs: Vec<String>,
    record: Option<(PathBuf, String)>,
    state: Vec<String>,
    out: PathBuf,
    threads: usize,
    progress: Py<PyAny>,
) -> PyResult<SweepTuple> {
    let request = SweepRequest {
        vary,
        samples,
        seed,
        measures,
        set: model.settings().to_vec(),
        order: model.order(),
        frequency,
        span: Span {
            transient: span.0,
            periods: span.1,
        },
        until,
        section,
        inputs,
        record,
        state,
    };
    let hear = |py: Python<'_>, counts: (usize, usize)| progress.call1(py, counts).map(drop);
    let found = interruptible(py, hear, |line| {
        compute(model, request, &out, threads, line)
    })?;
    let (units, Table { columns, .. }, warnings) = found.map_err(error::model)?;
    Ok((units, columns, warnings))
}

fn compute(
    model: &Model,
    request: SweepRequest,
    out: &Path,
    threads: usize,
    line: &Connection<'_, (usize, usize)>,
) -> Result<(Vec<NameAndUnit>, Table, Vec<String>), Error> {
    let sweep = Sweep::new(model.compiled().model(), request)?;
    let measures = sweep.measures()?;
    let folder = Folder::open(out, sweep.job(&measures)?)?;
    let columns = folder.job().columns().into_iter();
    let units = columns.map(|column| (column.name, column.unit)).collect();
    let mut report = |computed: usize, whole: usize| line.report((computed, whole));
    let check = || line.check();
    run_with_check(
        (&folder, &measures),
        Shard::WHOLE,
        threads,
        &mut report,
        &check,
    )?;
    let table = merge(&folder).map_err(|error: SweepError| Error::from(error))?;
    let missing = MissingNumbers::find(folder.job(), &table);
    if missing.is_without_crossings {
        return Err(Error::Request(missing.messages.join("\n")));
    }
    let warnings = [&sweep.warnings[..], &missing.messages].concat();
    Ok((units, table, warnings))
}
