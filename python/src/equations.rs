//! Equations of motion in notebooks.

use eomgen_codegen::report::Report;
use pyo3::prelude::*;

use crate::error;
use crate::model::Model;

/// Returns the equations as an HTML fragment, with formulas in MathML and coefficients at the model's parameter
/// values.
#[pyfunction]
pub fn equations(py: Python<'_>, model: &Model) -> PyResult<String> {
    let compiled = model.compiled();
    let report = py.detach(|| {
        model.evaluate(|evaluator| Report::new(compiled.model(), compiled.equations(), evaluator))
    });
    let report = report.map_err(error::model)?;
    Ok(eomgen_page::equations(&report).into_string())
}
