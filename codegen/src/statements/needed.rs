//! Functions called by the statements of a file.

use std::collections::BTreeSet;

use eomgen_elementary::Function as Elementary;

use crate::program::evaluator::PiecewiseFunction;

/// Functions that a file must define.
#[derive(Clone, Debug, Default)]
pub struct RequiredFunctions {
    /// Elementary functions.
    pub elementary: BTreeSet<Elementary>,
    /// f_k of Eq. (7).
    pub deadzone: bool,
    /// Indicator of Eq. (8).
    pub contact: bool,
    /// Indicator of one side.
    pub above: bool,
    /// f_k on a given side.
    pub deadzone_on_side: bool,
    /// Contact on a given side.
    pub contact_on_side: bool,
    /// Indicator for a function on either side of its zero interval.
    pub outside_zero_interval: bool,
    /// Selection by a given condition.
    pub selection: bool,
    /// Reciprocals of pivots.
    pub pivot_reciprocal: bool,
    /// Cholesky factorisation and solution.
    pub cholesky: bool,
    /// Cholesky solution for the columns of a matrix.
    pub cholesky_of_matrix: bool,
    /// Sums of more elements than there are partial sums.
    pub sum: bool,
    /// Sums of at most as many elements as there are partial sums.
    pub sum_of_few: bool,
}

impl RequiredFunctions {
    /// Adds a function and returns its name.
    pub fn name(&mut self, function: PiecewiseFunction) -> &'static str {
        match function {
            PiecewiseFunction::Elementary(elementary) => {
                self.elementary.insert(elementary);
                elementary.name()
            }
            PiecewiseFunction::Deadzone => {
                self.deadzone = true;
                "deadzone"
            }
            PiecewiseFunction::Contact => {
                self.contact = true;
                "contact"
            }
            PiecewiseFunction::Above => {
                self.above = true;
                "above"
            }
        }
    }
}
