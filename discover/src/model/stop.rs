//! Stop request of a search.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use crate::error::DiscoverError;

/// Request to stop a search from any thread. All simulations after the request fail, so that their
/// results are invalid.
#[derive(Clone, Debug)]
pub struct StopRequest {
    is_requested: Arc<AtomicBool>,
    begin: Instant,
    /// Time limit of the search.
    most: Option<Duration>,
    /// End of the search in ns after its beginning; `u64::MAX` without a running time limit.
    limit: Arc<AtomicU64>,
}

impl Default for StopRequest {
    fn default() -> Self {
        Self {
            is_requested: Arc::default(),
            begin: Instant::now(),
            most: None,
            limit: Arc::new(AtomicU64::new(u64::MAX)),
        }
    }
}

impl StopRequest {
    /// Requests a stop.
    pub fn request_stop(&self) {
        self.is_requested.store(true, Ordering::Relaxed);
    }

    /// Returns true if a stop was requested or the time limit has passed.
    pub fn is_requested(&self) -> bool {
        self.is_requested.load(Ordering::Relaxed) || self.is_time_over()
    }

    /// Creates a request with a time limit. After this time the search returns the results found
    /// until then.
    pub fn with_time_limit(most: Duration) -> Self {
        Self {
            most: Some(most),
            ..Self::default()
        }
    }

    /// Returns the time limit of the search.
    pub(crate) fn time_limit(&self) -> Option<Duration> {
        self.most
    }

    /// Starts the time limit, if there is one.
    pub(crate) fn start_timer(&self) {
        if let Some(most) = self.most {
            let limit = u64::try_from(most.as_nanos()).unwrap_or(u64::MAX - 1);
            self.limit.store(limit.min(u64::MAX - 1), Ordering::Relaxed);
        }
    }

    /// Removes the time limit for the remaining work.
    pub(crate) fn remove_time_limit(&self) {
        self.limit.store(u64::MAX, Ordering::Relaxed);
    }

    /// Returns true if the time limit has passed.
    pub(crate) fn is_time_over(&self) -> bool {
        let limit = self.limit.load(Ordering::Relaxed);
        limit != u64::MAX && self.begin.elapsed() >= Duration::from_nanos(limit)
    }

    /// Returns an error if a stop was requested or the time limit has passed.
    ///
    /// # Errors
    ///
    /// [`DiscoverError::Stopped`].
    pub(crate) fn check_not_stopped(&self) -> Result<(), DiscoverError> {
        match self.is_requested() {
            true => Err(DiscoverError::Stopped),
            false => Ok(()),
        }
    }
}
