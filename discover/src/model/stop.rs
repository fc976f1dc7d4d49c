//! How a search is told to stop.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::error::DiscoverError;

/// A request to stop, made on any thread. What is computed between it and the end of the search is
/// worth nothing: no motion can be followed any more.
#[derive(Clone, Debug, Default)]
pub struct Stop(Arc<AtomicBool>);

impl Stop {
    /// Asks to stop.
    pub fn request(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether somebody asked.
    pub fn is_requested(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// Goes on unless somebody asked to stop.
    ///
    /// # Errors
    /// [`DiscoverError::Stopped`].
    pub(crate) fn check(&self) -> Result<(), DiscoverError> {
        match self.is_requested() {
            true => Err(DiscoverError::Stopped),
            false => Ok(()),
        }
    }
}
