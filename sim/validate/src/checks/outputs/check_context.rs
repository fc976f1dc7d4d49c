//! Model and oracle for the checks of outputs.

use crate::oracle::Oracle;
use eomgen_model_spec::model::Model;

pub(crate) struct CheckContext<'j> {
    pub oracle: &'j Oracle,
    pub model: &'j Model,
    pub order: usize,
    /// All parameters, in SI.
    pub parameters: &'j [f64],
}
