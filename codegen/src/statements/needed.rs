//! Functions called by the statements of a file.

use std::collections::BTreeSet;

use eomgen_elementary::Function as Elementary;

/// Function that each language writes in its own way.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Helper {
    /// Dead-zone function f_k of Eq. (7) on a given side of the play.
    DeadzoneOnSide,
    /// Contact on a given side of the play.
    Touching,
    /// Indicator for a function on either side of its zero interval.
    Either,
    /// Selection by a condition known at compile time.
    Chosen,
    /// Cholesky factorisation and solution.
    Cholesky,
    /// Cholesky solution for the columns of a matrix.
    CholeskyOfMatrix,
    /// Sum of more than eight elements.
    Sum,
    /// Sum of at most eight elements.
    SumOfFew,
}

/// Functions that a file must define.
#[derive(Clone, Debug, Default)]
pub struct RequiredFunctions {
    /// Functions written from their kernels.
    pub kernels: BTreeSet<Elementary>,
    helpers: BTreeSet<Helper>,
}

impl RequiredFunctions {
    /// Adds a function with a kernel and returns its name.
    pub fn name(&mut self, function: Elementary) -> &'static str {
        self.kernels.insert(function);
        function.name()
    }

    /// Adds a helper and the functions that it calls.
    pub fn add(&mut self, helper: Helper) {
        self.helpers.insert(helper);
        match helper {
            Helper::CholeskyOfMatrix => self.add(Helper::Cholesky),
            Helper::Cholesky => {
                self.kernels.insert(Elementary::Sqrt);
            }
            _ => {}
        }
    }

    /// Returns true if the file must define one of these helpers.
    pub fn has_any(&self, helpers: &[Helper]) -> bool {
        helpers.iter().any(|helper| self.helpers.contains(helper))
    }
}
