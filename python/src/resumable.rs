//! Simulations that continue over several calls, as a Python class.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::time::Instant;

use eomgen_compiled_model::{InitialChange, LoggedEvent, Simulation as Continued, SolverOptions};
use eomgen_sim::inputs::HeldInputs;
use numpy::{PyArray1, PyReadonlyArray1, ToPyArray};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::error::{self, SimulationError};
use crate::interruption::{Interrupted, SIGNAL_INTERVAL};
use crate::model::Model;
use crate::simulation::{EventTuple, describe_event, parse_solver};

/// Simulation that continues over several calls. Only the thread that created it may use it.
#[pyclass(unsendable, module = "eomgen._native")]
pub struct Simulation {
    continued: Continued<'static>,
    observables: Vec<f64>,
    /// True after a signal stopped the solver within [`Simulation::advance`]: its state is then incomplete.
    is_interrupted: bool,
}

impl Simulation {
    /// Rejects an interrupted simulation.
    fn check(&self) -> PyResult<()> {
        match self.is_interrupted {
            true => Err(SimulationError::new_err(
                "the simulation was interrupted and cannot continue: start another one with `simulation`",
            )),
            false => Ok(()),
        }
    }
}

#[pymethods]
impl Simulation {
    #[new]
    fn new(
        model: &Model,
        start: f64,
        state: PyReadonlyArray1<'_, f64>,
        inputs: PyReadonlyArray1<'_, f64>,
        settings: (String, f64, f64),
    ) -> PyResult<Self> {
        let (solver, tolerance, max_step) = settings;
        let instance = model.shared_instance().map_err(error::model)?;
        let options = SolverOptions {
            solver: parse_solver(&solver)?,
            tolerance,
            max_step,
        };
        let program = model.compiled().program();
        let (state, inputs) = (state.as_slice()?, inputs.as_slice()?);
        if state.len() != program.states() || inputs.len() != program.inputs.len() {
            return Err(PyValueError::new_err("a state or inputs of another model"));
        }
        let inputs = HeldInputs::constant(inputs.to_vec());
        let continued = instance.start_simulation((start, state), inputs, options);
        Ok(Self {
            continued: continued.map_err(error::model)?,
            observables: vec![0.0; program.observables.len()],
            is_interrupted: false,
        })
    }

    /// Sentence about the projection of the initial state, or of the state set last, onto the constraints.
    #[getter]
    fn initial_changes(&self) -> Option<String> {
        InitialChange::describe_all("state", self.continued.initial_changes())
    }

    /// Continues to a time, s. Checks for signals between steps.
    fn advance(&mut self, py: Python<'_>, until: f64) -> PyResult<()> {
        self.check()?;
        let mut raised = None;
        let mut checked = Instant::now();
        let mut check = |_: f64| {
            if checked.elapsed() < SIGNAL_INTERVAL {
                return;
            }
            checked = Instant::now();
            // Other threads run here.
            py.detach(std::thread::yield_now);
            if let Err(error) = py.check_signals() {
                raised = Some(error);
                resume_unwind(Box::new(Interrupted));
            }
        };
        let continued = &mut self.continued;
        let ended = catch_unwind(AssertUnwindSafe(|| {
            continued.advance_with_progress(until, &mut check)
        }));
        match (ended, raised) {
            (Ok(ended), _) => ended.map_err(error::model),
            (Err(_), Some(raised)) => {
                self.is_interrupted = true;
                Err(raised)
            }
            (Err(panic), None) => resume_unwind(panic),
        }
    }

    /// Changes the inputs from the current time on.
    fn set_inputs(&mut self, inputs: PyReadonlyArray1<'_, f64>) -> PyResult<()> {
        self.check()?;
        let set = self.continued.set_inputs(inputs.as_slice()?);
        set.map_err(error::model)
    }

    /// Continues from another state.
    fn set_state(&mut self, state: PyReadonlyArray1<'_, f64>) -> PyResult<()> {
        self.check()?;
        let set = self.continued.set_state(state.as_slice()?);
        set.map_err(error::model)
    }

    #[getter]
    fn t(&self) -> f64 {
        self.continued.time()
    }

    #[getter]
    fn state<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.continued.state().to_pyarray(py)
    }

    #[getter]
    fn inputs<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.continued.inputs().to_pyarray(py)
    }

    #[getter]
    fn solver(&self) -> &'static str {
        self.continued.solver().name()
    }

    /// Returns the observables at the current time.
    fn observables<'py>(&mut self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.continued.write_observables(&mut self.observables);
        self.observables.to_pyarray(py)
    }

    /// Names of the states of the controllers.
    #[getter]
    fn controller_state_names(&self) -> Vec<String> {
        self.continued.controller_state_names()
    }

    /// States of the controllers after the samples so far.
    #[getter]
    fn controller_states<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.continued.controller_states().to_pyarray(py)
    }

    /// Returns the events since the last call.
    fn take_events(&mut self) -> Vec<EventTuple> {
        let log: Vec<LoggedEvent<'_>> = self.continued.events();
        let events = log.iter().map(describe_event).collect();
        self.continued.clear_events();
        events
    }
}
