//! Long work on a separate thread. The calling thread reports progress to Python and checks for signals such as
//! Ctrl-C.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread::Builder;
use std::time::Duration;

use eomgen_discover::StopRequest;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

/// Longest time between two checks for signals.
const SIGNAL_INTERVAL: Duration = Duration::from_millis(50);

/// Stack size of the worker thread, which derives nested formulas: that of a main thread, twice the usual limit.
const STACK_BYTES: usize = 16 << 20;

/// Connection of the work to Python.
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

/// Payload of the silent panic that ends the work on a request to stop.
struct Interrupted;

impl<M> Connection<'_, M> {
    /// Reports progress.
    pub fn report(&self, message: M) {
        (self.send)(message);
    }

    /// Ends the work by unwinding if a stop is requested. The progress callbacks of solvers have no other way to
    /// stop; the partial state is dropped.
    pub fn check(&self) {
        if self.stop.is_requested() {
            resume_unwind(Box::new(Interrupted));
        }
    }
}

/// Runs work with the interpreter released. `hear` receives progress messages, between checks for signals.
///
/// # Errors
/// An exception of a signal handler or of `hear`, after the work has stopped.
pub fn interruptible<M: Send, T: Send>(
    py: Python<'_>,
    hear: impl Fn(Python<'_>, M) -> PyResult<()> + Send,
    work: impl FnOnce(&Connection<'_, M>) -> T + Send,
) -> PyResult<T> {
    let stop = &StopRequest::default();
    py.detach(move || {
        std::thread::scope(|scope| {
            let (said, heard) = channel();
            let working = Builder::new().stack_size(STACK_BYTES);
            let working = working.spawn_scoped(scope, move || {
                // A closed channel is ignored: the caller has stopped waiting.
                let send = |message| drop(said.send(Reply::Progress(message)));
                let connection = Connection { stop, send: &send };
                let found = catch_unwind(AssertUnwindSafe(|| work(&connection)));
                drop(said.send(Reply::Result(found)));
            });
            working.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
            let answer = wait(&heard, &hear);
            stop.request_stop();
            match answer? {
                Ok(found) => Ok(found),
                Err(panic) => resume_unwind(panic),
            }
        })
    })
}

/// Waits for the result. Returns an earlier exception of Python as an error.
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
            // The worker sends its result in any case.
            Err(RecvTimeoutError::Disconnected) => {
                return Err(PyRuntimeError::new_err(
                    "the worker thread ended without a result",
                ));
            }
        }
    }
}
