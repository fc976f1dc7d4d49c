//! Long computations on a worker thread. The calling thread reports progress to Python and checks for signals such as
//! Ctrl-C. After a signal it also ends a Python function that the worker thread calls.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::OnceLock;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread::Builder;
use std::time::Duration;

use eomgen_discover::StopRequest;
use pyo3::exceptions::{PyKeyboardInterrupt, PyRuntimeError};
use pyo3::prelude::*;

/// Longest time between two checks for signals.
pub const SIGNAL_INTERVAL: Duration = Duration::from_millis(50);

/// Stack size of the worker thread, which derives nested expressions: twice the usual limit of a main thread.
const STACK_BYTES: usize = 16 << 20;

/// Channel from the worker thread to the Python thread: messages out, stop request in.
pub struct Connection<'w, M> {
    /// Request to stop.
    pub stop: &'w StopRequest,
    send: &'w (dyn Fn(M) + Sync),
}

/// Message of the worker thread.
enum Reply<M, T> {
    Progress(M),
    Result(std::thread::Result<T>),
}

/// Payload of the silent panic that ends a computation when a stop is requested.
pub struct Interrupted;

impl<M> Connection<'_, M> {
    /// Sends a progress message to the Python thread.
    pub fn report(&self, message: M) {
        (self.send)(message);
    }

    /// Ends the computation by unwinding if a stop is requested. The progress callbacks of solvers have no other way to
    /// stop; the partial state is dropped.
    pub fn check(&self) {
        if self.stop.is_requested() {
            resume_unwind(Box::new(Interrupted));
        }
    }
}

/// Runs a computation with the interpreter released. `hear` receives progress messages, between checks for signals.
///
/// # Errors
/// An exception of a signal handler or of `hear`, after the computation has stopped.
pub fn interruptible<M: Send, T: Send>(
    py: Python<'_>,
    hear: impl Fn(Python<'_>, M) -> PyResult<()> + Send,
    work: impl FnOnce(&Connection<'_, M>) -> T + Send,
) -> PyResult<T> {
    let stop = &StopRequest::default();
    let thread = &OnceLock::new();
    py.detach(move || {
        std::thread::scope(|scope| {
            let (said, heard) = channel();
            let working = Builder::new().stack_size(STACK_BYTES);
            let working = working.spawn_scoped(scope, move || {
                // A closed channel is ignored, because the caller no longer waits.
                let send = |message| drop(said.send(Reply::Progress(message)));
                let connection = Connection { stop, send: &send };
                if let Ok(own) = Python::attach(current_thread) {
                    thread.get_or_init(|| own);
                }
                let found = catch_unwind(AssertUnwindSafe(|| work(&connection)));
                drop(said.send(Reply::Result(found)));
            });
            working.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
            let answer = wait(&heard, &hear);
            stop.request_stop();
            if answer.is_err() {
                end_worker(&heard, thread);
            }
            match answer? {
                Ok(found) => Ok(found),
                Err(panic) => resume_unwind(panic),
            }
        })
    })
}

/// Waits for the result. If Python raised an exception before, returns it as an error.
fn wait<M, T>(
    heard: &Receiver<Reply<M, T>>,
    hear: &impl Fn(Python<'_>, M) -> PyResult<()>,
) -> PyResult<std::thread::Result<T>> {
    loop {
        match heard.recv_timeout(SIGNAL_INTERVAL) {
            Ok(Reply::Result(answer)) => return Ok(answer),
            Ok(Reply::Progress(message)) => Python::attach(|py| {
                hear(py, message)?;
                py.check_signals()
            })?,
            Err(RecvTimeoutError::Timeout) => Python::attach(|py| py.check_signals())?,
            // The worker always sends its result before it ends.
            Err(RecvTimeoutError::Disconnected) => {
                return Err(PyRuntimeError::new_err(
                    "the worker thread ended without a result",
                ));
            }
        }
    }
}

/// Returns Python's identifier of the current thread.
fn current_thread(py: Python<'_>) -> PyResult<u64> {
    let identify = py.import("threading")?.getattr("get_ident")?;
    identify.call0()?.extract()
}

/// Waits for the end of the worker thread. Raises `KeyboardInterrupt` in the Python function that the thread calls, if
/// any: once, so that the function can clean up, and again after each further signal.
fn end_worker<M, T>(heard: &Receiver<Reply<M, T>>, thread: &OnceLock<u64>) {
    let mut is_raised = false;
    loop {
        if !is_raised && let Some(thread) = thread.get() {
            // A failure leaves the stop request, which ends the computation after the function.
            is_raised = Python::attach(|py| raise_interrupt(py, *thread)).unwrap_or(true);
        }
        match heard.recv_timeout(SIGNAL_INTERVAL) {
            Ok(Reply::Progress(_)) => {}
            Ok(Reply::Result(_)) | Err(RecvTimeoutError::Disconnected) => return,
            Err(RecvTimeoutError::Timeout) => {
                is_raised &= Python::attach(|py| py.check_signals()).is_ok();
            }
        }
    }
}

/// Raises `KeyboardInterrupt` in a thread. Returns false if the thread runs no Python function.
fn raise_interrupt(py: Python<'_>, thread: u64) -> PyResult<bool> {
    let ctypes = py.import("ctypes")?;
    let raise = ctypes
        .getattr("pythonapi")?
        .getattr("PyThreadState_SetAsyncExc")?;
    let thread = ctypes.getattr("c_ulong")?.call1((thread,))?;
    let interrupt = py.get_type::<PyKeyboardInterrupt>();
    let interrupt = ctypes.getattr("py_object")?.call1((interrupt,))?;
    let changed: i32 = raise.call1((thread, interrupt))?.extract()?;
    Ok(changed > 0)
}
