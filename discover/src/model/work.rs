//! Work of simulations, measured in evaluations of the rates. Unlike a time limit, its limit does
//! not depend on the load of the computer.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use crate::error::DiscoverError;

/// Number of evaluations of the rates in all simulations of a model, with a limit. Simulations
/// beyond the limit fail, so that their results are invalid.
#[derive(Clone, Debug)]
pub(crate) struct WorkLimit {
    done: Arc<AtomicU64>,
    most: u64,
}

impl Default for WorkLimit {
    fn default() -> Self {
        Self::new(u64::MAX)
    }
}

impl WorkLimit {
    /// Creates a limit with no evaluations so far.
    pub fn new(most: u64) -> Self {
        Self {
            done: Arc::default(),
            most,
        }
    }

    /// Adds evaluations.
    pub fn add(&self, evaluations: u64) {
        self.done.fetch_add(evaluations, Ordering::Relaxed);
    }

    /// Returns the number of evaluations so far.
    pub fn done(&self) -> u64 {
        self.done.load(Ordering::Relaxed)
    }

    /// Returns the number of remaining evaluations.
    pub fn left(&self) -> u64 {
        self.most.saturating_sub(self.done())
    }

    /// Returns true if the limit is exceeded.
    pub fn is_exceeded(&self) -> bool {
        self.done() > self.most
    }

    /// Returns an error if the limit is exceeded.
    ///
    /// # Errors
    ///
    /// [`DiscoverError::TooMuchWork`].
    pub fn check(&self) -> Result<(), DiscoverError> {
        match self.is_exceeded() {
            true => Err(DiscoverError::TooMuchWork(self.most)),
            false => Ok(()),
        }
    }
}
