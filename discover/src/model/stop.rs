//! How a search is told to stop.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use crate::error::DiscoverError;

/// A request to stop, made on any thread. What is computed between it and the end of the search is
/// worth nothing: no motion can be followed any more.
#[derive(Clone, Debug)]
pub struct Stop {
    is_requested: Arc<AtomicBool>,
    begin: Instant,
    /// How long the search may take.
    most: Option<Duration>,
    /// When the search is over, ns after the beginning; the largest number where it is not.
    limit: Arc<AtomicU64>,
}

impl Default for Stop {
    fn default() -> Self {
        Self {
            is_requested: Arc::default(),
            begin: Instant::now(),
            most: None,
            limit: Arc::new(AtomicU64::new(u64::MAX)),
        }
    }
}

impl Stop {
    /// Asks to stop.
    pub fn request(&self) {
        self.is_requested.store(true, Ordering::Relaxed);
    }

    /// Whether somebody asked, or the time is over.
    pub fn is_requested(&self) -> bool {
        self.is_requested.load(Ordering::Relaxed) || self.is_late()
    }

    /// One that ends the search so long from now, with what is known by then.
    pub fn after(most: Duration) -> Self {
        Self {
            most: Some(most),
            ..Self::default()
        }
    }

    /// How long the search may take.
    pub(crate) fn most(&self) -> Option<Duration> {
        self.most
    }

    /// From now on the time may be over, if it is limited.
    pub(crate) fn arm(&self) {
        if let Some(most) = self.most {
            let limit = u64::try_from(most.as_nanos()).unwrap_or(u64::MAX - 1);
            self.limit.store(limit.min(u64::MAX - 1), Ordering::Relaxed);
        }
    }

    /// Ends what a limit made of it: what is left to do has all the time it takes.
    pub(crate) fn lift(&self) {
        self.limit.store(u64::MAX, Ordering::Relaxed);
    }

    /// Whether the time is over.
    pub(crate) fn is_late(&self) -> bool {
        let limit = self.limit.load(Ordering::Relaxed);
        limit != u64::MAX && self.begin.elapsed() >= Duration::from_nanos(limit)
    }

    /// Goes on unless somebody asked to stop, or the time is over.
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
