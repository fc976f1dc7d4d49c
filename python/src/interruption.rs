//! Work that takes long: done on a thread of its own, while the calling one tells Python how far it
//! is and hears whether it is to stop, as after Ctrl-C.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread::Builder;
use std::time::Duration;

use eomgen_discover::Stop;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

/// How long Python waits at most until it hears of a signal.
const PATIENCE: Duration = Duration::from_millis(50);

/// The room for the working thread's calls, which derive formulas of some depth: as much as the
/// first thread of a process has.
const STACK: usize = 16 << 20;

/// The way from the work to Python and back.
pub struct Line<'w, M> {
    /// Whether the work is to stop.
    pub stop: &'w Stop,
    say: &'w (dyn Fn(M) + Sync),
}

/// What comes from the working thread.
enum Said<M, T> {
    Message(M),
    Answer(std::thread::Result<T>),
}

/// The panic, without a message, of work that is to stop.
struct Interrupted;

impl<M> Line<'_, M> {
    /// Says something.
    pub fn say(&self, message: M) {
        (self.say)(message);
    }

    /// Ends the work here if it is to stop. The hooks of solvers cannot refuse to go on; unwinding
    /// drops what was begun, and nothing of it is used again.
    pub fn check(&self) {
        if self.stop.is_requested() {
            resume_unwind(Box::new(Interrupted));
        }
    }
}

/// Does work with the interpreter free for other threads. `hear` is called with what the work
/// says, between looks at Python's signals.
///
/// # Errors
/// What a signal or `hear` raises, once the work has stopped.
pub fn interruptible<M: Send, T: Send>(
    py: Python<'_>,
    hear: impl Fn(Python<'_>, M) -> PyResult<()> + Send,
    work: impl FnOnce(&Line<'_, M>) -> T + Send,
) -> PyResult<T> {
    let stop = &Stop::default();
    py.detach(move || {
        std::thread::scope(|scope| {
            let (said, heard) = channel();
            let working = Builder::new().stack_size(STACK);
            let working = working.spawn_scoped(scope, move || {
                // That nobody listens any more is no concern of the work.
                let say = |message| drop(said.send(Said::Message(message)));
                let line = Line { stop, say: &say };
                let found = catch_unwind(AssertUnwindSafe(|| work(&line)));
                drop(said.send(Said::Answer(found)));
            });
            working.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
            let answer = answered(&heard, &hear);
            stop.request();
            match answer? {
                Ok(found) => Ok(found),
                Err(panic) => resume_unwind(panic),
            }
        })
    })
}

/// The answer, or what Python raises before there is one.
fn answered<M, T>(
    heard: &Receiver<Said<M, T>>,
    hear: &impl Fn(Python<'_>, M) -> PyResult<()>,
) -> PyResult<std::thread::Result<T>> {
    loop {
        match heard.recv_timeout(PATIENCE) {
            Ok(Said::Answer(answer)) => return Ok(answer),
            Ok(Said::Message(message)) => Python::attach(|py| {
                hear(py, message)?;
                py.check_signals()
            })?,
            Err(RecvTimeoutError::Timeout) => Python::attach(|py| py.check_signals())?,
            // The answer is sent whatever happens.
            Err(RecvTimeoutError::Disconnected) => {
                return Err(PyRuntimeError::new_err("the work ended without an answer"));
            }
        }
    }
}
