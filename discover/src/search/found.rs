//! What the search found, and what it rejected.

use crate::catalogue::candidate::Candidate;
use crate::fit::fitted::Fit;
use crate::ids::UnknownId;
use crate::search::acceptance::TestStatistics;
use crate::search::unconfirmed::Unconfirmed;

/// An effect that was accepted.
#[derive(Clone, Debug)]
pub struct Accepted {
    /// The effect at its place.
    pub candidate: Candidate,
    /// Which of the unknowns of the last fit are its own.
    pub unknowns: Vec<UnknownId>,
    /// Those that were indistinguishable from it.
    pub equivalent: Vec<Candidate>,
    /// What spoke for it when it was added.
    pub statistics: TestStatistics,
    /// The gap on the test records.
    pub test_gap: TestGap,
}

/// The root mean square of the test records' residuals, in standard deviations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TestGap {
    /// Before an effect was added.
    pub before: f64,
    /// With it.
    pub after: f64,
}

/// A candidate that was not accepted, and why.
#[derive(Clone, Debug)]
pub struct Rejected {
    /// The effect at its place.
    pub candidate: Candidate,
    /// Why.
    pub reason: String,
    /// Whether the record could not have shown it.
    pub not_testable: bool,
    /// The probability that noise alone lets the test records speak for it as much; none where it was not
    /// fitted.
    pub p_value: Option<f64>,
}

/// What the search found.
pub struct Found {
    /// The model with its declared unknowns alone.
    pub null: Fit,
    /// The model with everything that was accepted; none if that is nothing.
    pub last: Option<Fit>,
    /// What was accepted, in the order in which it was.
    pub accepted: Vec<Accepted>,
    /// What was not.
    pub rejected: Vec<Rejected>,
    /// What explains the training records further, where held-out ones do not confirm it.
    pub unconfirmed: Option<Unconfirmed>,
    /// What is known of a round that the time did not suffice for, in a sentence.
    pub unfinished: Option<String>,
}

impl Found {
    /// The fit with everything that was accepted.
    pub fn best(&self) -> &Fit {
        self.last.as_ref().unwrap_or(&self.null)
    }
}
