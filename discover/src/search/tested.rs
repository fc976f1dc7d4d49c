//! What was tested of a pool.

use crate::catalogue::candidate::Candidate;
use crate::search::fitted::FittedHypothesis;
use crate::search::screening::Screening;

/// Candidates, what they promise, and the hypotheses that were fitted in full.
pub struct TestedPool {
    /// The candidates.
    pub candidates: Vec<Candidate>,
    /// What they promise.
    pub screening: Screening,
    /// The fitted hypotheses.
    pub fitted_hypotheses: Vec<FittedHypothesis>,
}
