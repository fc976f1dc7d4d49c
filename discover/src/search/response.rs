//! A candidate's response: what it does to the windows' outputs, to first order.

use nalgebra::DMatrix;

use crate::catalogue::candidate_unknown::CandidateUnknown;

/// A candidate's parameters, and for each window a column per parameter that scales it.
pub type Columns = (Vec<CandidateUnknown>, Vec<DMatrix<f64>>);
