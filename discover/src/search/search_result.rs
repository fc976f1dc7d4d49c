//! Result of the search: accepted and rejected effects.

use crate::catalogue::candidate::Candidate;
use crate::fit::fit_result::Fit;
use crate::free_function::curves::Curve;
use crate::ids::UnknownId;
use crate::search::acceptance::TestStatistics;
use crate::search::unconfirmed_hypothesis::UnconfirmedHypothesis;

/// Accepted effect.
#[derive(Clone, Debug)]
pub struct AcceptedEffect {
    /// Effect at its site.
    pub candidate: Candidate,
    /// Unknowns of the effect in the last fit.
    pub unknowns: Vec<UnknownId>,
    /// Candidates that are inseparable from the effect.
    pub equivalents: Vec<Candidate>,
    /// Test statistics at the time of acceptance.
    pub statistics: TestStatistics,
    /// Residual of the test records without and with the effect.
    pub test_gap: TestGap,
}

/// RMS residual of the test records, in standard deviations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TestGap {
    /// Residual without the effect.
    pub before: f64,
    /// Residual with the effect.
    pub after: f64,
}

/// Best candidate of a round, for comparison with rejected candidates.
#[derive(Clone, Debug, PartialEq)]
pub struct BestOfRound {
    /// Effect and site, as in [`Candidate::label`].
    pub label: String,
    /// Its reduction of the residual, in words.
    pub reduction: String,
}

/// Rejected candidate.
#[derive(Clone, Debug)]
pub struct RejectedCandidate {
    /// Effect at its site.
    pub candidate: Candidate,
    /// Reason for the rejection.
    pub reason: String,
    /// Best candidate of the same round, for comparison with a reduction in the reason.
    pub best_of_round: Option<BestOfRound>,
    /// True if the candidate was fitted, at least to the initial segments of windows.
    pub is_fitted: bool,
    /// True if the records cannot show the effect.
    pub is_untestable: bool,
    /// P-value of the test records; `None` if the candidate was not fitted.
    pub p_value: Option<f64>,
}

/// Result of the search.
pub struct SearchResult {
    /// Fit of the model with its declared unknowns only.
    pub null_fit: Fit,
    /// Fit with all accepted effects; `None` without accepted effects.
    pub extended_fit: Option<Fit>,
    /// Accepted effects in order of acceptance.
    pub accepted: Vec<AcceptedEffect>,
    /// Rejected candidates.
    pub rejected: Vec<RejectedCandidate>,
    /// Hypothesis that explains the training records but not the held-out records.
    pub unconfirmed: Option<UnconfirmedHypothesis>,
    /// Free function that explains the residual of the null model best, if it is adequate.
    pub curve: Option<Curve>,
    /// State of the round that reached the time limit, as a sentence.
    pub unfinished: Option<String>,
}

impl SearchResult {
    /// Returns the fit with all accepted effects.
    pub fn best_fit(&self) -> &Fit {
        self.extended_fit.as_ref().unwrap_or(&self.null_fit)
    }
}
