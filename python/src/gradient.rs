//! Gradients of recorded motions.

use eomgen_compiled_model::{RecordedMotion as Recorded, SampleWeights};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2, ToPyArray};
use pyo3::prelude::*;

use crate::error;
use crate::model::Model;

/// Derivatives with respect to the initial state, the independent parameters (names; declared units) and the inputs.
/// The gradients with respect to the inputs have one row per sample of the inputs.
type GradientTuple<'py> = (
    Option<Bound<'py, PyArray1<f64>>>,
    Vec<(String, f64)>,
    Bound<'py, PyArray2<f64>>,
);

/// Motion with its steps and events.
#[pyclass(frozen, module = "eomgen._native")]
pub struct RecordedMotion {
    recorded: Recorded<'static>,
}

impl RecordedMotion {
    pub fn new(recorded: Recorded<'static>) -> Self {
        Self { recorded }
    }
}

#[pymethods]
impl RecordedMotion {
    /// Returns the gradient of a number L. The arguments are the derivatives of L with respect to states and
    /// observables, one row per sample.
    fn gradient<'py>(
        &self,
        py: Python<'py>,
        model: &Model,
        states: PyReadonlyArray2<'py, f64>,
        observables: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<GradientTuple<'py>> {
        let rows = |given: &PyReadonlyArray2<'py, f64>| -> Vec<Vec<f64>> {
            let rows = given.as_array();
            rows.rows().into_iter().map(|row| row.to_vec()).collect()
        };
        let weights = SampleWeights {
            states: rows(&states),
            observables: rows(&observables),
        };
        let found = py.detach(|| self.recorded.gradient(&weights));
        let found = found.map_err(error::model)?;
        let declared = &model.compiled().model().parameters;
        let names = model.compiled().parameter_names().into_iter();
        let parameters = names.zip(found.parameters).map(|(name, by_value)| {
            let known = declared.iter().find(|known| known.name == name);
            let unit = known.map_or(1.0, |known| known.unit.to_si(1.0) - known.unit.to_si(0.0));
            (name, unit * by_value)
        });
        let inputs = found.inputs;
        let shape = [inputs.len(), inputs.first().map_or(0, Vec::len)];
        Ok((
            found.initial_state.map(|by_state| by_state.to_pyarray(py)),
            parameters.collect(),
            inputs.concat().to_pyarray(py).reshape(shape)?,
        ))
    }
}
