//! Tested candidates of a pool.

use crate::catalogue::candidate::Candidate;
use crate::ids::ResponseId;
use crate::search::hypothesis_fits::FittedHypothesis;
use crate::search::screening::Screening;

/// Candidates, their screening, and the fully fitted hypotheses.
pub struct TestedPool {
    /// The candidates.
    pub candidates: Vec<Candidate>,
    /// Screening results.
    pub screening: Screening,
    /// Fully fitted hypotheses.
    pub fitted_hypotheses: Vec<FittedHypothesis>,
}

impl TestedPool {
    /// Returns the candidate of a response.
    pub fn candidate(&self, response: ResponseId) -> &Candidate {
        &self.candidates[self.screening.responses[response].candidate]
    }
}
