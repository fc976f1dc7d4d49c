//! Equilibria of a model.

use eomgen_compiled_model::{EquilibriumRequest, Error, Instance};
use pyo3::prelude::*;

use crate::error;
use crate::model::Model;

/// Names and values in SI units.
type NamedValues = Vec<(String, f64)>;

/// Result of `trim`: time, state, inputs and residual of an equilibrium, names of its steady rates and of the unknowns,
/// stability, and true if forces depend on time.
type EquilibriumTuple = (
    f64,
    Vec<f64>,
    Vec<f64>,
    Vec<f64>,
    Vec<String>,
    Vec<String>,
    String,
    bool,
);

/// Searches for the equilibrium nearest to a start, with some values fixed.
#[pyfunction]
pub fn trim(
    py: Python<'_>,
    model: &Model,
    start: NamedValues,
    fixed: NamedValues,
) -> PyResult<EquilibriumTuple> {
    let (start, fixed) = (borrowed(&start), borrowed(&fixed));
    let request = EquilibriumRequest {
        start_values: &start,
        fixed_values: &fixed,
    };
    py.detach(|| search(&model.instance()?, request))
        .map_err(error::model)
}

fn search(run: &Instance<'_>, request: EquilibriumRequest<'_>) -> Result<EquilibriumTuple, Error> {
    let found = run.find_equilibrium(request)?;
    let stability = run.classify_stability(&found.point)?.to_string();
    Ok((
        found.point.t,
        found.point.state,
        found.point.inputs,
        found.residual,
        found.nonzero_rates,
        found.unknowns,
        stability,
        found.depends_on_time,
    ))
}

fn borrowed(values: &[(String, f64)]) -> Vec<(&str, f64)> {
    let pairs = values.iter();
    pairs.map(|(name, value)| (name.as_str(), *value)).collect()
}
