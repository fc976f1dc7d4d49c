//! First-order response of the outputs of the windows to a candidate.

use nalgebra::DMatrix;

use crate::catalogue::candidate_unknown::CandidateUnknown;

/// Response of a candidate.
#[derive(Clone, Debug)]
pub struct CandidateResponse {
    /// Parameters of the candidate as unknowns.
    pub candidate_unknowns: Vec<CandidateUnknown>,
    /// For each window one column per scaling parameter, in standard deviations of the noise per SI
    /// unit.
    pub window_columns: Vec<DMatrix<f64>>,
}
