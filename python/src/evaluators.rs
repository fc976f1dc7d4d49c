//! Pool of evaluators. The creation of an evaluator copies the program, and each concurrent call needs one.

use std::sync::{Mutex, PoisonError};

use eomgen_compiled_model::Error;

/// Idle evaluators of one kind.
pub struct Pool<E>(Mutex<Vec<E>>);

impl<E> Default for Pool<E> {
    fn default() -> Self {
        Self(Mutex::new(Vec::new()))
    }
}

impl<E> Pool<E> {
    /// Computes with an idle evaluator or a new one, and returns it to the pool.
    pub fn with<T>(
        &self,
        new: impl FnOnce() -> Result<E, Error>,
        compute: impl FnOnce(&mut E) -> T,
    ) -> Result<T, Error> {
        let idle = self.list().pop();
        let mut evaluator = idle.map_or_else(new, Ok)?;
        let found = compute(&mut evaluator);
        self.list().push(evaluator);
        Ok(found)
    }

    fn list(&self) -> std::sync::MutexGuard<'_, Vec<E>> {
        // No code that can panic runs while the pool is locked.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
