//! Response of a candidate: its influence on the outputs of the windows, to first order.

use nalgebra::DMatrix;

use crate::catalogue::candidate_unknown::CandidateUnknown;

/// Response of a candidate.
#[derive(Clone, Debug)]
pub struct CandidateResponse {
    /// Parameters of the candidate.
    pub candidate_unknowns: Vec<CandidateUnknown>,
    /// For each window one column per scaling parameter, in standard deviations of the noise per SI
    /// unit.
    pub window_columns: Vec<DMatrix<f64>>,
}
