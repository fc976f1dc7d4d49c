//! Linearisation of a model.

use eomgen_codegen::program::evaluator::Point;
use eomgen_compiled_model::{InitialChange, Linearisation};
use eomgen_sim::inputs::HeldInputs;
use numpy::PyReadonlyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::error;
use crate::model::Model;

/// A, B, C, D, each row by row, then rates and observables at the operating point.
type LinearisationTuple = (Vec<f64>, Vec<f64>, Vec<f64>, Vec<f64>, Vec<f64>, Vec<f64>);

/// Returns A_d and B_d of matrices A and B, all row by row, for inputs held over a period.
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

/// Moves a state onto the constraints of a model. Returns a sentence about the changes too.
#[pyfunction]
pub fn move_onto_constraints(
    py: Python<'_>,
    model: &Model,
    t: f64,
    x: PyReadonlyArray1<'_, f64>,
    u: PyReadonlyArray1<'_, f64>,
) -> PyResult<(Vec<f64>, Option<String>)> {
    let (state, inputs) = (x.as_slice()?, u.as_slice()?);
    let moved = py.detach(|| {
        let inputs = HeldInputs::constant(inputs.to_vec());
        model.instance()?.find_consistent_state(state, t, &inputs)
    });
    let (state, changes) = moved.map_err(error::model)?;
    Ok((state, InitialChange::describe_all("state", &changes)))
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
    let point = Point {
        t,
        state: x.as_slice()?,
        inputs: u.as_slice()?,
    };
    let program = model.compiled().program();
    if point.state.len() != program.states() || point.inputs.len() != program.inputs.len() {
        return Err(PyValueError::new_err("state or inputs of another model"));
    }
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
