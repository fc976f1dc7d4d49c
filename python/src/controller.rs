//! Controllers given as Python functions, called at each sample.

use eomgen_compiled_model::{Sample, SampledController};
use eomgen_model_spec::control::Schedule;
use numpy::ToPyArray;
use pyo3::prelude::*;

use crate::inputs::{Failures, number, require_finite};

/// Function, indices of the driven inputs, and the times period, offset and delay (s).
pub type ControllerEntry = (Py<PyAny>, Vec<usize>, (f64, f64, f64));

/// Python function of time, state and observables that returns input values.
pub struct PythonController<'w> {
    function: Py<PyAny>,
    driven: Vec<usize>,
    schedule: Schedule,
    failures: Failures,
    /// Stops the simulation if a stop was requested.
    check: &'w (dyn Fn() + Sync),
}

impl<'w> PythonController<'w> {
    /// Creates a controller. `check` is called before each sample.
    pub fn new(
        (function, driven, (period, offset, delay)): ControllerEntry,
        failures: Failures,
        check: &'w (dyn Fn() + Sync),
    ) -> Self {
        Self {
            function,
            driven,
            schedule: Schedule {
                period,
                offset,
                delay,
            },
            failures,
            check,
        }
    }

    fn call(&self, py: Python<'_>, at: &Sample<'_>, outputs: &mut [f64]) -> PyResult<()> {
        let arrays = (at.state.to_pyarray(py), at.observables.to_pyarray(py));
        let found = self.function.bind(py).call1((at.t, arrays.0, arrays.1))?;
        for (slot, value) in outputs.iter_mut().zip(found.try_iter()?) {
            *slot = number(&value?)?;
        }
        require_finite(outputs)
    }
}

impl SampledController for PythonController<'_> {
    fn schedule(&self) -> Schedule {
        self.schedule
    }

    fn driven_inputs(&self) -> &[usize] {
        &self.driven
    }

    fn sample(&mut self, at: &Sample<'_>, outputs: &mut [f64]) -> Result<(), String> {
        (self.check)();
        Python::attach(|py| self.call(py, at, outputs)).map_err(|error| {
            self.failures.note("the controller", at.t, error);
            "the controller failed".to_owned()
        })
    }
}
