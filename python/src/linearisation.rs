//! Linearisation of a model.

use eomgen_compiled_model::Linearisation;
use numpy::PyReadonlyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::error;
use crate::model::Model;
use crate::operating_point::point;

/// A, B, C, D (row-major), then rates and observables at the operating point.
type LinearisationTuple = (Vec<f64>, Vec<f64>, Vec<f64>, Vec<f64>, Vec<f64>, Vec<f64>);

/// Returns A_d and B_d for the matrices A and B and inputs held over a period; all are row-major.
#[pyfunction]
pub fn discretise(
    model: &Model,
    a: PyReadonlyArray1<'_, f64>,
    b: PyReadonlyArray1<'_, f64>,
    period: f64,
) -> PyResult<(Vec<f64>, Vec<f64>)> {
    let found = (model.compiled()).discretise(a.as_slice()?, b.as_slice()?, period);
    let found = found.map_err(|error| PyValueError::new_err(error.to_string()))?;
    Ok((found.a, found.b))
}

/// Linearises a model at a time, state and inputs.
#[pyfunction]
pub fn linearise(
    py: Python<'_>,
    model: &Model,
    t: f64,
    x: PyReadonlyArray1<'_, f64>,
    u: PyReadonlyArray1<'_, f64>,
) -> PyResult<LinearisationTuple> {
    let point = point(model, t, &x, &u)?;
    let found = py.detach(|| model.instance()?.linearise(point));
    let Linearisation {
        a,
        b,
        c,
        d,
        rates,
        observables,
        ..
    } = found.map_err(error::model)?;
    Ok((a, b, c, d, rates, observables))
}
