//! Natural modes of a model.

use eomgen_analysis::natural_modes::NaturalMode;
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;

use crate::error;
use crate::model::Model;
use crate::operating_point::point;

/// Frequency (Hz), damping ratio, eigenvalue (1/s), shape, and for a rigid motion the largest frequency that rounding
/// can hide (Hz). Complex numbers are pairs of real and imaginary part.
type ModeTuple = (f64, f64, (f64, f64), Vec<(f64, f64)>, Option<f64>);

/// Name and unit of an amplitude.
type NameAndUnit = (String, String);

/// Computes the natural modes about a time, state and inputs. Also returns names and units of the amplitudes.
#[pyfunction]
pub fn modes(
    py: Python<'_>,
    model: &Model,
    t: f64,
    x: PyReadonlyArray1<'_, f64>,
    u: PyReadonlyArray1<'_, f64>,
) -> PyResult<(Vec<NameAndUnit>, Vec<ModeTuple>)> {
    let point = point(model, t, &x, &u)?;
    let found = py.detach(|| {
        let run = model.instance()?;
        run.natural_modes(&run.linearise(point)?, point)
    });
    let found = found.map_err(error::model)?;
    let modes = found.iter().map(describe_mode).collect();
    Ok((model.compiled().amplitudes(), modes))
}

fn describe_mode(mode: &NaturalMode) -> ModeTuple {
    let shape = mode.shape.iter().map(|value| (value.re, value.im));
    let eigenvalue = (mode.eigenvalue.re, mode.eigenvalue.im);
    (
        mode.frequency(),
        mode.damping(),
        eigenvalue,
        shape.collect(),
        mode.frequency_limit(),
    )
}
