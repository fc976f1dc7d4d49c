//! The equations of motion, for notebooks.

use eomgen_codegen::report::Report;
use pyo3::prelude::*;

use crate::error;
use crate::model::Model;

/// The derived equations as a part of a page in HTML, formulas as MathML; coefficients at the
/// model's parameter values.
#[pyfunction]
pub fn equations(py: Python<'_>, model: &Model) -> PyResult<String> {
    let compiled = model.compiled();
    let report = py.detach(|| {
        model.evaluate(|evaluator| Report::new(compiled.model(), compiled.equations(), evaluator))
    });
    let report = report.map_err(error::model)?;
    Ok(eomgen_page::equations(&report).into_string())
}
