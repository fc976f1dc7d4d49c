//! Rates, observables and Jacobians of arrays of states, one row per state. The functions use the memory of the arrays
//! and release the interpreter for other threads.

use eomgen_codegen::program::evaluator::Point;
use eomgen_compiled_model::Jacobian;
use numpy::{PyReadonlyArray1, PyReadonlyArray2, PyReadwriteArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::error;
use crate::model::Model;

/// Times, states and inputs of many evaluations. A single time or a single row of inputs applies to all states.
struct Rows<'a> {
    t: &'a [f64],
    x: &'a [f64],
    u: &'a [f64],
    states: usize,
    inputs: usize,
}

impl<'a> Rows<'a> {
    /// Creates rows from contiguous arrays. Returns an error if a shape does not match the model.
    fn new(
        model: &Model,
        t: &'a PyReadonlyArray1<'_, f64>,
        x: &'a PyReadonlyArray2<'_, f64>,
        u: &'a PyReadonlyArray2<'_, f64>,
    ) -> PyResult<Self> {
        let program = model.compiled().program();
        let (states, inputs) = (program.states(), program.inputs.len());
        let count = x.as_array().nrows();
        let of_one = |rows: usize| rows == 1 || rows == count;
        let fits = x.as_array().ncols() == states
            && of_one(t.as_array().len())
            && u.as_array().ncols() == inputs
            && of_one(u.as_array().nrows());
        if !fits {
            return Err(PyValueError::new_err(format!(
                "the shapes of t, {:?}, x, {:?}, and u, {:?}, do not match {states} states and {inputs} inputs",
                t.as_array().shape(),
                x.as_array().shape(),
                u.as_array().shape()
            )));
        }
        Ok(Self {
            t: t.as_slice()?,
            x: x.as_slice()?,
            u: u.as_slice()?,
            states,
            inputs,
        })
    }

    /// Calls `compute` for every point, with its row of `width` numbers in `out`.
    #[inline]
    fn for_each(
        &self,
        out: &mut [f64],
        width: usize,
        mut compute: impl FnMut(Point<'_>, &mut [f64]),
    ) {
        let rows = self
            .x
            .chunks_exact(self.states)
            .zip(out.chunks_exact_mut(width));
        if let ([t], true) = (self.t, self.u.len() == self.inputs) {
            // Fast path for a single time and a single row of inputs.
            let (t, inputs) = (*t, self.u);
            rows.for_each(|(state, out)| compute(Point { t, state, inputs }, out));
            return;
        }
        let last = (self.t.len() - 1, self.u.len() - self.inputs);
        for (row, (state, out)) in rows.enumerate() {
            let from = (row * self.inputs).min(last.1);
            let point = Point {
                t: self.t[row.min(last.0)],
                state,
                inputs: &self.u[from..from + self.inputs],
            };
            compute(point, out);
        }
    }
}

/// Returns the memory of an output array that has `width` numbers per row.
fn output<'a>(
    out: &'a mut PyReadwriteArray2<'_, f64>,
    rows: &Rows<'_>,
    width: usize,
) -> PyResult<&'a mut [f64]> {
    let expected = [rows.x.len() / rows.states, width];
    if out.as_array().shape() != expected {
        return Err(PyValueError::new_err(format!(
            "the results have the shape {:?}, expected {expected:?}",
            out.as_array().shape()
        )));
    }
    Ok(out.as_slice_mut()?)
}

/// Computes the rates of every state.
#[pyfunction]
pub fn rates(
    py: Python<'_>,
    model: &Model,
    t: PyReadonlyArray1<'_, f64>,
    x: PyReadonlyArray2<'_, f64>,
    u: PyReadonlyArray2<'_, f64>,
    mut out: PyReadwriteArray2<'_, f64>,
) -> PyResult<()> {
    let rows = Rows::new(model, &t, &x, &u)?;
    let width = rows.states;
    let out = output(&mut out, &rows, width)?;
    let compute = || {
        model.evaluate(|evaluator| {
            rows.for_each(out, width, |point, out| evaluator.rates(point, out));
        })
    };
    py.detach(compute).map_err(error::model)
}

/// Computes the observables at every state; `energy` and `power` are last.
#[pyfunction]
pub fn observables(
    py: Python<'_>,
    model: &Model,
    t: PyReadonlyArray1<'_, f64>,
    x: PyReadonlyArray2<'_, f64>,
    u: PyReadonlyArray2<'_, f64>,
    mut out: PyReadwriteArray2<'_, f64>,
) -> PyResult<()> {
    let rows = Rows::new(model, &t, &x, &u)?;
    let width = model.compiled().program().observables.len();
    let out = output(&mut out, &rows, width)?;
    let compute = || {
        model.evaluate(|evaluator| {
            rows.for_each(out, width, |point, out| evaluator.observables(point, out));
        })
    };
    py.detach(compute).map_err(error::model)
}

/// Computes the mass matrix at every state, row-major.
#[pyfunction]
pub fn mass_matrix(
    py: Python<'_>,
    model: &Model,
    t: PyReadonlyArray1<'_, f64>,
    x: PyReadonlyArray2<'_, f64>,
    u: PyReadonlyArray2<'_, f64>,
    mut out: PyReadwriteArray2<'_, f64>,
) -> PyResult<()> {
    let rows = Rows::new(model, &t, &x, &u)?;
    let width = model.compiled().program().degrees_of_freedom().pow(2);
    let out = output(&mut out, &rows, width)?;
    if out.is_empty() {
        return Ok(());
    }
    let compute = || {
        model.evaluate(|evaluator| {
            rows.for_each(out, width, |point, out| evaluator.mass_matrix(point, out));
        })
    };
    py.detach(compute).map_err(error::model)
}

/// Computes a Jacobian at every state, row-major.
#[pyfunction]
pub fn jacobian(
    py: Python<'_>,
    model: &Model,
    name: &str,
    t: PyReadonlyArray1<'_, f64>,
    x: PyReadonlyArray2<'_, f64>,
    u: PyReadonlyArray2<'_, f64>,
    mut out: PyReadwriteArray2<'_, f64>,
) -> PyResult<()> {
    let known = Jacobian::ALL.into_iter().find(|of| of.name() == name);
    let of = known.ok_or_else(|| PyValueError::new_err(format!("no Jacobian `{name}`")))?;
    let rows = Rows::new(model, &t, &x, &u)?;
    let shape = py.detach(|| model.differentiate(|jacobians| jacobians.shape(of)));
    let (height, columns) = shape.map_err(error::model)?;
    let out = output(&mut out, &rows, height * columns)?;
    if out.is_empty() {
        return Ok(());
    }
    let compute = || {
        model.differentiate(|jacobians| {
            rows.for_each(out, height * columns, |point, out| {
                jacobians.evaluate(of, point, out);
            });
        })
    };
    py.detach(compute).map_err(error::model)
}
