//! A candidate's response: what it does to the windows' outputs, to first order.

use nalgebra::DMatrix;

use crate::catalogue::candidate_unknown::CandidateUnknown;

/// What a candidate does.
#[derive(Clone, Debug)]
pub struct CandidateResponse {
    /// Its parameters.
    pub candidate_unknowns: Vec<CandidateUnknown>,
    /// For each window a column per parameter that scales it, in standard deviations of the noise
    /// per SI unit.
    pub blocks: Vec<DMatrix<f64>>,
}
