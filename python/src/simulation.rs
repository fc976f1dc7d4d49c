//! Simulation of a motion over a time span.

use std::time::{Duration, Instant};

use eomgen_compiled_model::{
    Audit, Error, FunctionInputs, InitialChange, InputRole, Instance, LoggedEvent, Motion, Overlap,
    RecordedMotion as Recorded, Request, SampledController, Solver, SolverChoice,
    split_assignments,
};
use eomgen_sim::cubic_spline::CubicSpline;
use eomgen_sim::inputs::HeldInputs;
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, ToPyArray};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::controller::{ControllerEntry, PythonController};
use crate::error::{self, SimulationError};
use crate::gradient::RecordedMotion;
use crate::inputs::{Failures, InputEntry, with_functions};
use crate::interruption::{Connection, interruptible};
use crate::model::Model;

/// Time between progress reports.
const REPORT_INTERVAL: Duration = Duration::from_millis(100);

/// Result of `simulate`, in this order: solver and the reason for its choice; time and reason of an early stop; times,
/// states and observables, one row per sample; events; warnings; names and values of controller states; the recorded
/// motion, if gradients are requested; the exception of a function that stopped the motion.
type SimulationTuple<'py> = (
    &'static str,
    Option<String>,
    Option<(Option<f64>, String)>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray2<f64>>,
    Vec<EventTuple>,
    Vec<String>,
    Vec<String>,
    Bound<'py, PyArray2<f64>>,
    Option<RecordedMotion>,
    Option<Py<PyAny>>,
);

/// Time (s), surface, kind, modes before and after, and the jump of each rate, which is empty without a jump.
pub type EventTuple = (
    f64,
    String,
    &'static str,
    &'static str,
    &'static str,
    Vec<f64>,
);

/// Simulates from an initial state over ascending times (s). Inputs are held from each of their times to the next.
/// Other inputs are `functions`, which jump at `breaks` (s), or `expressions` of time, by the names of the inputs.
/// `progress` is called with the simulated time, s.
#[pyfunction]
#[pyo3(signature = (
    model, initial, times, input_times, input_values, functions, expressions, breaks, solver,
    tolerance, max_step, controller, gradients, progress
))]
#[expect(clippy::too_many_arguments, reason = "arguments of a Python function")]
pub fn simulate<'py>(
    py: Python<'py>,
    model: &Model,
    initial: PyReadonlyArray1<'py, f64>,
    times: PyReadonlyArray1<'py, f64>,
    input_times: PyReadonlyArray1<'py, f64>,
    input_values: PyReadonlyArray2<'py, f64>,
    functions: Vec<InputEntry>,
    expressions: Vec<(String, String)>,
    breaks: Vec<f64>,
    solver: &str,
    tolerance: f64,
    max_step: f64,
    controller: Option<ControllerEntry>,
    gradients: bool,
    progress: Option<Py<PyAny>>,
) -> PyResult<SimulationTuple<'py>> {
    let count = model.compiled().model().inputs.len();
    let inputs = (input_values.as_array().ncols() == count).then(|| {
        let values = input_values.as_slice().ok()?.to_vec();
        HeldInputs::new(input_times.as_slice().ok()?.to_vec(), values, count)
    });
    let inputs = inputs.flatten();
    let inputs = inputs.ok_or_else(|| PyValueError::new_err("inputs of another model"))?;
    let inputs = with_splines(
        model,
        inputs,
        input_times.as_slice()?,
        input_values.as_slice()?,
    );
    let sample_times = times.as_slice()?;
    let span = match sample_times {
        [first, .., last] => (*first, *last),
        _ => return Err(PyValueError::new_err("expected two samples or more")),
    };
    let known = &model.compiled().model().inputs;
    let (inputs, failures) = with_functions(py, (inputs, known), (functions, breaks), span)?;
    let solver = parse_solver(solver)?;
    let role = match solver {
        Solver::Fixed => InputRole::Held,
        _ => InputRole::Measured,
    };
    let inputs = with_expressions(model, inputs, &expressions, role)?;
    let request = Request {
        initial: initial.as_slice()?,
        times: sample_times,
        inputs: &inputs,
        solver,
        tolerance,
        max_step,
        audit: true,
    };
    if request.initial.len() != model.compiled().program().states() {
        return Err(PyValueError::new_err("an initial state of another model"));
    }
    let hear = |py: Python<'_>, t: f64| {
        let told = progress.as_ref().map(|progress| progress.call1(py, (t,)));
        told.transpose().map(drop)
    };
    let controller = controller.map(|entry| (entry, failures.clone()));
    let found = interruptible(py, hear, |line| match gradients {
        true => record_motion(model, &request, line),
        false => simulate_motion(model, &request, controller, line),
    })?;
    let raised = failures.take(py);
    // If a function stopped the motion, its samples are kept, unless the value or its type was rejected.
    let raised = match (raised, &found) {
        (Some(raised), Ok(found))
            if found.motion.early_stop.is_some()
                && raised.is_instance_of::<SimulationError>(py) =>
        {
            Some(raised.into_value(py).into_any())
        }
        (Some(raised), _) => return Err(raised),
        (None, _) => None,
    };
    let SimulationResult {
        motion,
        observables,
        warnings,
        recorded,
    } = found.map_err(error::model)?;
    let trajectory = &motion.trajectory;
    let rows = trajectory.times.len();
    let states: Vec<f64> = trajectory.states.concat();
    let width = observables.len() / rows.max(1);
    let choice = motion.solver_choice.as_ref().map(describe_choice);
    let events = list_events(model, &motion);
    let controlled = &motion.controller_states;
    let controller_states = controlled.rows.concat().to_pyarray(py);
    let controller_states = controller_states.reshape([rows, controlled.names.len()])?;
    let stopped = motion.early_stop.map(|stopped| (stopped.t, stopped.reason));
    Ok((
        motion.solver.name(),
        choice,
        stopped,
        trajectory.times.to_pyarray(py),
        states
            .to_pyarray(py)
            .reshape([rows, request.initial.len()])?,
        observables.to_pyarray(py).reshape([rows, width])?,
        events,
        warnings,
        motion.controller_states.names,
        controller_states,
        recorded.map(RecordedMotion::new),
        raised,
    ))
}

/// Adds inputs that are expressions of time.
fn with_expressions(
    model: &Model,
    inputs: HeldInputs,
    expressions: &[(String, String)],
    role: InputRole,
) -> PyResult<HeldInputs> {
    let texts = expressions
        .iter()
        .map(|(name, value)| format!("{name}={value}"));
    let texts: Vec<String> = texts.collect();
    let given = split_assignments("inputs", &texts).map_err(error::model)?;
    let settings = model
        .settings()
        .iter()
        .map(|(name, value)| (&**name, *value));
    let settings: Vec<(&str, f64)> = settings.collect();
    let given = FunctionInputs::new(model.compiled().model(), &given, role);
    let added = given.and_then(|given| given.add_to(inputs, &settings));
    added.map_err(error::model)
}

/// Returns the solver with the given name.
pub fn parse_solver(name: &str) -> PyResult<Solver> {
    let known = Solver::ALL.into_iter().find(|known| known.name() == name);
    known.ok_or_else(|| {
        let names = Solver::ALL.map(|known| format!("\"{}\"", known.name()));
        PyValueError::new_err(format!(
            "solver = \"{name}\": expected one of {}",
            names.join(", ")
        ))
    })
}

/// Motion with its observables (row-major) and warnings.
struct SimulationResult {
    motion: Motion,
    observables: Vec<f64>,
    warnings: Vec<String>,
    recorded: Option<Recorded<'static>>,
}

/// Returns a progress callback that sends the simulated time to the Python thread.
fn report_progress(line: &Connection<'_, f64>) -> impl FnMut(f64) {
    let mut told = Instant::now();
    move |t: f64| {
        line.check();
        if told.elapsed() > REPORT_INTERVAL {
            told = Instant::now();
            line.report(t);
        }
    }
}

/// Simulates a motion.
fn simulate_motion(
    model: &Model,
    request: &Request<'_>,
    controller: Option<(ControllerEntry, Failures)>,
    line: &Connection<'_, f64>,
) -> Result<SimulationResult, Error> {
    let instance = model.instance()?;
    let mut progress = report_progress(line);
    let motion = match controller {
        None => instance.simulate_until_stop(request, &mut progress)?,
        Some((entry, failures)) => {
            let check = || line.check();
            let mut own = PythonController::new(entry, failures, &check);
            let mut declared = instance.controllers()?;
            let all = declared.iter_mut();
            let mut all: Vec<_> = all.map(|one| one as &mut dyn SampledController).collect();
            all.push(&mut own);
            instance.simulate_controlled(request, &mut all, &mut progress)?
        }
    };
    observe(&instance, motion, request)
}

/// Simulates a motion and records it for gradients.
fn record_motion(
    model: &Model,
    request: &Request<'_>,
    line: &Connection<'_, f64>,
) -> Result<SimulationResult, Error> {
    let instance = model.shared_instance()?;
    let recorded = instance.record_motion(request, &mut report_progress(line))?;
    let found = observe(&instance, recorded.motion().clone(), request)?;
    Ok(SimulationResult {
        recorded: Some(recorded),
        ..found
    })
}

fn observe(
    instance: &Instance<'_>,
    motion: Motion,
    request: &Request<'_>,
) -> Result<SimulationResult, Error> {
    let mut observables = Vec::new();
    instance.observe(&motion, |_, _, row| observables.extend_from_slice(row))?;
    let overlap = instance.find_first_overlap(&motion, request.tolerance)?;
    let energy = motion.audit.as_ref().and_then(Audit::warning_message);
    let moved = InitialChange::describe_all("initial state", &motion.initial_changes);
    let warnings = moved.into_iter().chain(energy);
    let warnings = warnings.chain(overlap.as_ref().map(Overlap::warning_message));
    let integral = instance.find_unresolved_integral(&motion)?;
    let warnings = warnings.chain(integral.map(|found| found.warning_message()));
    Ok(SimulationResult {
        warnings: warnings.collect(),
        motion,
        observables,
        recorded: None,
    })
}

/// Returns the event log of a motion.
fn list_events(model: &Model, motion: &Motion) -> Vec<EventTuple> {
    let degrees = model.compiled().program().degrees_of_freedom();
    let log = motion.event_log(degrees);
    log.iter().map(describe_event).collect()
}

/// Returns an event as numbers and names.
pub fn describe_event(event: &LoggedEvent<'_>) -> EventTuple {
    let (before, after) = event
        .modes
        .map_or(("", ""), |(from, to)| (from.name(), to.name()));
    let (surface, kind) = (event.surface.to_owned(), event.kind.name());
    (event.t, surface, kind, before, after, event.jump.to_vec())
}

/// Describes the reason for the choice of a solver.
fn describe_choice(choice: &SolverChoice) -> String {
    match choice {
        SolverChoice::PiecewiseLinear => "the model is piecewise linear".to_owned(),
        SolverChoice::NotPiecewiseLinear(reason) => reason.clone(),
        SolverChoice::NotSupportedByExact(reason) => {
            format!("the exact solver does not support this motion: {reason}")
        }
        SolverChoice::Stiff(reason) => reason.clone(),
    }
}

/// Replaces prescribed motion by a spline through its samples, which also gives its rates.
fn with_splines(
    model: &Model,
    mut inputs: HeldInputs,
    times: &[f64],
    values: &[f64],
) -> HeldInputs {
    let known = &model.compiled().model().inputs;
    for (place, input) in known.iter().enumerate() {
        if input.rate.is_none() || input.rate_of.is_some() {
            continue;
        }
        let column = |place: usize| values.iter().skip(place).step_by(known.len());
        let moves = column(place).any(|value| *value != values[place]);
        if !moves {
            continue;
        }
        let samples = column(place).copied().collect();
        if let Some(spline) = CubicSpline::fit(times.to_vec(), samples) {
            inputs = inputs.with_prescribed(place, spline);
        }
    }
    inputs
}
