//! Evaluators that wait for the next call: making one copies the program, and each call needs one
//! for itself, because threads may call at once.

use std::sync::{Mutex, PoisonError};

use eomgen_compiled_model::Error;

/// Evaluators of one kind that no call uses at present.
pub struct Waiting<E>(Mutex<Vec<E>>);

impl<E> Default for Waiting<E> {
    fn default() -> Self {
        Self(Mutex::new(Vec::new()))
    }
}

impl<E> Waiting<E> {
    /// Computes with a waiting evaluator, or with a new one, which then waits.
    pub fn with<T>(
        &self,
        new: impl FnOnce() -> Result<E, Error>,
        compute: impl FnOnce(&mut E) -> T,
    ) -> Result<T, Error> {
        let waiting = self.list().pop();
        let mut evaluator = waiting.map_or_else(new, Ok)?;
        let found = compute(&mut evaluator);
        self.list().push(evaluator);
        Ok(found)
    }

    fn list(&self) -> std::sync::MutexGuard<'_, Vec<E>> {
        // Nothing that can panic is done while it is locked.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
