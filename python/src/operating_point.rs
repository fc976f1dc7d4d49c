//! Operating points of linearisations and modes.

use eomgen_codegen::program::evaluator::Point;
use eomgen_compiled_model::InitialChange;
use eomgen_sim::inputs::HeldInputs;
use numpy::PyReadonlyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::error;
use crate::model::Model;

/// Returns the point at a time (s) with a state and inputs of a model, SI.
///
/// # Errors
/// A `ValueError` for arrays of wrong length, or that are not contiguous.
pub fn point<'a>(
    model: &Model,
    t: f64,
    x: &'a PyReadonlyArray1<'_, f64>,
    u: &'a PyReadonlyArray1<'_, f64>,
) -> PyResult<Point<'a>> {
    let (state, inputs) = (x.as_slice()?, u.as_slice()?);
    let program = model.compiled().program();
    let (states, count) = (program.states(), program.inputs.len());
    if state.len() != states || inputs.len() != count {
        return Err(PyValueError::new_err(format!(
            "x has {} numbers and u has {}: expected {states} and {count}",
            state.len(),
            inputs.len()
        )));
    }
    Ok(Point { t, state, inputs })
}

/// Projects a state onto the constraints of a model. Also returns a sentence about the changes.
#[pyfunction]
pub fn move_onto_constraints(
    py: Python<'_>,
    model: &Model,
    t: f64,
    x: PyReadonlyArray1<'_, f64>,
    u: PyReadonlyArray1<'_, f64>,
) -> PyResult<(Vec<f64>, Option<String>)> {
    let point = point(model, t, &x, &u)?;
    let moved = py.detach(|| {
        let inputs = HeldInputs::constant(point.inputs.to_vec());
        let instance = model.instance()?;
        instance.find_consistent_state(point.state, point.t, &inputs)
    });
    let (state, changes) = moved.map_err(error::model)?;
    Ok((state, InitialChange::describe_all("state", &changes)))
}
