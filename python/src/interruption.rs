//! Long computations on a worker thread. The calling thread reports progress to Python and checks for signals such as
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
struct Interrupted;

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
    py.detach(move || {
        std::thread::scope(|scope| {
            let (said, heard) = channel();
            let working = Builder::new().stack_size(STACK_BYTES);
            let working = working.spawn_scoped(scope, move || {
                // A closed channel is ignored, because the caller no longer waits.
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
