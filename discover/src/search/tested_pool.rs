//! Tested candidates of a pool.

use crate::catalogue::candidate::Candidate;
use crate::ids::ResponseId;
use crate::search::hypothesis_fits::{FittedHypothesis, PreliminaryOutcome};
use crate::search::screening::Screening;

/// Candidates, their screening, and the fully fitted hypotheses.
pub struct TestedPool {
    /// The candidates.
    pub candidates: Vec<Candidate>,
    /// Screening results.
    pub screening: Screening,
    /// Fully fitted hypotheses.
    pub fitted_hypotheses: Vec<FittedHypothesis>,
    /// Results of the preliminary fits of single candidates.
    pub preliminary_outcomes: Vec<(ResponseId, PreliminaryOutcome)>,
}

impl TestedPool {
    /// Returns the candidate of a response.
    pub fn candidate(&self, response: ResponseId) -> &Candidate {
        &self.candidates[self.screening.responses[response].candidate]
    }

    /// Returns the result of the preliminary fit of a single candidate, if it was fitted.
    pub fn preliminary_outcome(&self, response: ResponseId) -> Option<&PreliminaryOutcome> {
        let mut outcomes = self.preliminary_outcomes.iter();
        let found = outcomes.find(|(fitted, _)| *fitted == response);
        found.map(|(_, outcome)| outcome)
    }
}
