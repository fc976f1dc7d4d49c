//! What is judged.

use crate::oracle::Oracle;
use eomgen_model_spec::model::Model;

/// What is judged.
pub(crate) struct Judged<'j> {
    /// The oracle.
    pub oracle: &'j Oracle,
    /// The model it was made of, its order and all parameters in SI.
    pub model: &'j Model,
    /// The order.
    pub order: usize,
    /// All parameters in SI.
    pub parameters: &'j [f64],
}
