//! Inputs given as Python functions, which are called at the times that a solver needs.

use std::fmt;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use eomgen_model_spec::model::Input;
use eomgen_sim::cubic_spline::CubicSpline;
use eomgen_sim::inputs::{HeldInputs, InputFunction};
use pyo3::exceptions::{PyException, PyTypeError, PyValueError};
use pyo3::prelude::*;

use crate::error::SimulationError;

/// Largest number of values that a function returns: the input, its rate and its second derivative.
const MAX_VALUES: usize = 3;

/// Name, index and Python function of an input.
pub type InputEntry = (String, usize, Py<PyAny>);

/// Number of points of the spline through prescribed motion, if its function does not return rates.
const SPLINE_POINTS: usize = 16_385;

/// Failed call of a function.
struct Failure {
    /// Description of the function, for messages.
    what: String,
    t: f64,
    error: PyErr,
    /// True for a `BaseException` such as `KeyboardInterrupt`, which ends the motion at once.
    is_interrupt: bool,
}

/// Failure at the earliest time among the functions of a motion. After a failure solvers shorten their steps, so that
/// the motion ends at the time of the failure.
#[derive(Clone, Default)]
pub struct Failures(Arc<Mutex<Option<Failure>>>);

impl Failures {
    fn lock(&self) -> MutexGuard<'_, Option<Failure>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Records a failed call at a time (s), unless another call failed at an earlier time. `what` describes the
    /// function.
    pub fn note(&self, what: &str, t: f64, error: PyErr) {
        if self.prevents_call(t) {
            return;
        }
        let is_interrupt = Python::attach(|py| !error.is_instance_of::<PyException>(py));
        *self.lock() = Some(Failure {
            what: what.to_owned(),
            t,
            error,
            is_interrupt,
        });
    }

    /// Returns true if the motion ends at or before a time (s).
    fn prevents_call(&self, t: f64) -> bool {
        let failure = self.lock();
        failure
            .as_ref()
            .is_some_and(|failure| failure.is_interrupt || t >= failure.t)
    }

    /// Returns the exception of the earliest failure, if any. It names the function and the time; its cause is the
    /// exception of the function. A `BaseException` that is not an `Exception`, such as `KeyboardInterrupt`, is
    /// returned unchanged.
    pub fn take(&self, py: Python<'_>) -> Option<PyErr> {
        let Failure {
            what,
            t,
            error,
            is_interrupt,
        } = self.lock().take()?;
        if is_interrupt {
            return Some(error);
        }
        let message = format!("{what} at t = {t}: {}", error.value(py));
        let raised = match is_rejection(py, &error) {
            Some(true) => PyValueError::new_err(message),
            Some(false) => PyTypeError::new_err(message),
            None => SimulationError::new_err(format!("{what} at t = {t} raised {error}")),
        };
        if is_rejection(py, &error).is_none() {
            raised.set_cause(py, Some(error));
        }
        Some(raised)
    }
}

/// Returns true for a rejected value and false for a rejected type; `None` if the function raised the error.
fn is_rejection(py: Python<'_>, error: &PyErr) -> Option<bool> {
    if error.is_instance_of::<RefusedValue>(py) {
        return Some(true);
    }
    error.is_instance_of::<RefusedType>(py).then_some(false)
}

pyo3::create_exception!(
    eomgen,
    RefusedValue,
    PyException,
    "Rejected value that a function returned."
);
pyo3::create_exception!(
    eomgen,
    RefusedType,
    PyException,
    "Rejected type that a function returned."
);

/// Python function of time that returns an input.
struct PythonFunction {
    input: String,
    function: Py<PyAny>,
    /// Last time with its inputs. Solvers evaluate the same time repeatedly.
    last: Mutex<Option<(f64, [f64; MAX_VALUES])>>,
    failures: Failures,
}

impl fmt::Debug for PythonFunction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "PythonFunction({})", self.input)
    }
}

impl InputFunction for PythonFunction {
    fn write(&self, t: f64, out: &mut [f64]) {
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((time, values)) = &*last
            && *time == t
        {
            return out.copy_from_slice(&values[..out.len()]);
        }
        out.fill(f64::NAN);
        if self.failures.prevents_call(t) {
            return;
        }
        match Python::attach(|py| self.call(py, t, out)) {
            Ok(()) => {
                let mut values = [0.0; MAX_VALUES];
                values[..out.len()].copy_from_slice(out);
                *last = Some((t, values));
            }
            Err(error) => {
                out.fill(f64::NAN);
                self.failures
                    .note(&format!("the input {}", self.input), t, error);
            }
        }
    }
}

/// Largest change of a continuous position between neighbouring floating-point numbers, relative to the position.
const MAX_CONTINUOUS_CHANGE: f64 = 1e-9;

/// Number of bisections of an interval between samples, after which its ends are neighbouring floating-point numbers.
const BISECTIONS: usize = 64;

/// Returns the exception for prescribed motion that jumps at a time, s.
fn jump_error(input: &str, t: f64, (before, after): (f64, f64)) -> PyErr {
    PyValueError::new_err(format!(
        "the input {input} at t = {t}: the prescribed motion jumps from {before} to {after}, so that its rate is \
         infinite: give a continuous motion, or an expression such as \"{after}*above(t - {t})\" if no force of the \
         model depends on the rate"
    ))
}

impl PythonFunction {
    /// Returns the first of `count` values at a time, s. After a failure, which is recorded, returns NaN.
    fn first_value(&self, t: f64, count: usize) -> f64 {
        let mut values = [0.0; MAX_VALUES];
        self.write(t, &mut values[..count]);
        values[0]
    }

    /// Returns the time (s) of a jump between samples, and the values before and after the jump. Only the interval with
    /// the largest deviation from its neighbours is bisected.
    fn find_jump(&self, times: &[f64], values: &[f64]) -> Option<(f64, f64, f64)> {
        let changes: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let neighbours = |k: usize| match k {
            0 => changes[1],
            k if k + 1 == changes.len() => changes[k - 1],
            k => 0.5 * (changes[k - 1] + changes[k + 1]),
        };
        let deviation = |k: &usize| (changes[*k] - neighbours(*k)).abs();
        let largest = (0..changes.len()).max_by(|a, b| deviation(a).total_cmp(&deviation(b)))?;
        let size = values
            .iter()
            .fold(0.0_f64, |size, value| size.max(value.abs()));
        if deviation(&largest) <= MAX_CONTINUOUS_CHANGE * size {
            return None;
        }
        let slope = neighbours(largest) / (times[largest + 1] - times[largest]);
        let mut before = (times[largest], values[largest]);
        let mut after = (times[largest + 1], values[largest + 1]);
        for _ in 0..BISECTIONS {
            let t = 0.5 * (before.0 + after.0);
            if t <= before.0 || t >= after.0 {
                break;
            }
            let middle = (t, self.first_value(t, 1));
            let part = |a: (f64, f64), b: (f64, f64)| (b.1 - a.1 - slope * (b.0 - a.0)).abs();
            match part(before, middle) > part(middle, after) {
                true => after = middle,
                false => before = middle,
            }
        }
        let is_jump = (after.1 - before.1).abs() > 0.5 * deviation(&largest);
        is_jump.then_some((after.0, before.1, after.1))
    }

    /// Returns true if the function returns several numbers. An exception is ignored, because the next call raises it
    /// again.
    fn is_several(&self, py: Python<'_>, t: f64) -> bool {
        let found = self.function.bind(py).call1((t,));
        found.is_ok_and(|found| found.extract::<f64>().is_err())
    }

    fn call(&self, py: Python<'_>, t: f64, out: &mut [f64]) -> PyResult<()> {
        let found = self.function.bind(py).call1((t,))?;
        match &mut *out {
            [only] => *only = number(&found)?,
            several => {
                let numbers = found.try_iter().map_err(|_| not_rates(several.len()))?;
                let numbers = numbers.collect::<PyResult<Vec<_>>>()?;
                if numbers.len() != several.len() {
                    return Err(not_rates(several.len()));
                }
                for (slot, found) in several.iter_mut().zip(&numbers) {
                    *slot = number(found)?;
                }
            }
        }
        require_finite(out)
    }
}

/// Rejects results that are not finite.
pub fn require_finite(values: &[f64]) -> PyResult<()> {
    match values.iter().find(|value| !value.is_finite()) {
        Some(value) => Err(RefusedValue::new_err(format!(
            "{value}: expected a finite number"
        ))),
        None => Ok(()),
    }
}

/// Converts a result to a number.
pub fn number(found: &Bound<'_, PyAny>) -> PyResult<f64> {
    let wrong = |_| {
        let kind = found.get_type();
        RefusedType::new_err(format!("expected a number, not {kind}"))
    };
    found.extract::<f64>().map_err(wrong)
}

fn not_rates(count: usize) -> PyErr {
    RefusedType::new_err(format!(
        "expected {count} numbers: the input, its rate and its second derivative"
    ))
}

/// Adds functions to the inputs. The functions jump at the times `breaks` (s). Returns the inputs and the store of
/// later failures.
///
/// A function for prescribed motion returns (s, s', s''). If it returns s only, the motion follows a cubic spline
/// through [`SPLINE_POINTS`] points of the span.
///
/// # Errors
/// An exception or a rejected result at these points.
pub fn with_functions(
    py: Python<'_>,
    (mut inputs, known): (HeldInputs, &[Input]),
    (functions, breaks): (Vec<InputEntry>, Vec<f64>),
    (begin, end): (f64, f64),
) -> PyResult<(HeldInputs, Failures)> {
    let failures = Failures::default();
    for (input, place, function) in functions {
        let is_prescribed = known
            .get(place)
            .is_some_and(|input| input.rate.is_some() && input.rate_of.is_none());
        let given = PythonFunction {
            input,
            function,
            last: Mutex::new(None),
            failures: failures.clone(),
        };
        let has_rates = is_prescribed && given.is_several(py, begin);
        if is_prescribed && !has_rates {
            let part = |point: usize| point as f64 / (SPLINE_POINTS - 1) as f64;
            let times = (0..SPLINE_POINTS).map(|point| begin + part(point) * (end - begin));
            let times: Vec<f64> = times.collect();
            let mut values = vec![0.0; times.len()];
            for (t, value) in times.iter().zip(&mut values) {
                given.write(*t, std::slice::from_mut(value));
            }
            if let Some(raised) = failures.take(py) {
                return Err(raised);
            }
            if let Some((t, before, after)) = given.find_jump(&times, &values) {
                return Err(jump_error(&given.input, t, (before, after)));
            }
            if let Some(spline) = CubicSpline::fit(times, values) {
                inputs = inputs.with_prescribed(place, spline);
            }
            continue;
        }
        let count = if has_rates { MAX_VALUES } else { 1 };
        if has_rates {
            let inside = breaks.iter().filter(|t| (begin..=end).contains(*t));
            for t in inside {
                let [before, after] =
                    [t.next_down(), t.next_up()].map(|t| given.first_value(t, count));
                if let Some(raised) = failures.take(py) {
                    return Err(raised);
                }
                if (after - before).abs() > MAX_CONTINUOUS_CHANGE * before.abs().max(after.abs()) {
                    return Err(jump_error(&given.input, *t, (before, after)));
                }
            }
        }
        inputs = inputs.with_function(place, count, Arc::new(given));
    }
    Ok((inputs.with_jump_times(breaks), failures))
}
