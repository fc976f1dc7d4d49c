//! Equations of motion for display.

use eomgen_codegen::report::Report;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::error;
use crate::model::Model;

/// Returns the equations of motion as plain text, as a LaTeX document or as JSON.
#[pyfunction]
pub fn derive(py: Python<'_>, model: &Model, format: &str) -> PyResult<String> {
    let report = report(py, model)?;
    match format {
        "text" => Ok(report.text()),
        "latex" => Ok(report.latex()),
        "json" => {
            serde_json::to_string(&report).map_err(|error| PyValueError::new_err(error.to_string()))
        }
        _ => Err(PyValueError::new_err(format!(
            "format = \"{format}\": expected \"text\", \"latex\" or \"json\""
        ))),
    }
}

fn report(py: Python<'_>, model: &Model) -> PyResult<Report> {
    let compiled = model.compiled();
    let report = py.detach(|| {
        model.evaluate(|evaluator| Report::new(compiled.model(), compiled.equations(), evaluator))
    });
    report.map_err(error::model)
}

/// Returns the equations as an HTML fragment, with formulas in MathML. Coefficients have the model's parameter values.
#[pyfunction]
pub fn equations(py: Python<'_>, model: &Model) -> PyResult<String> {
    Ok(eomgen_page::equations(&report(py, model)?).into_string())
}
