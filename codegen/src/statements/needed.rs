//! Which functions the statements of a file call.

use std::collections::BTreeSet;

use eomgen_elementary::Function as Elementary;

/// What a file needs besides the operators.
#[derive(Clone, Debug, Default)]
pub struct Needed {
    /// Elementary functions.
    pub elementary: BTreeSet<Elementary>,
    /// f_k of Eq. (7).
    pub deadzone: bool,
    /// The indicator of Eq. (8).
    pub contact: bool,
    /// The indicator of one side.
    pub above: bool,
    /// f_k where the side is known.
    pub deadzone_on_side: bool,
    /// Whether there is contact where the side is known.
    pub touching: bool,
    /// Whether a function is on either side of where it rests.
    pub either: bool,
    /// One of two by what is known.
    pub chosen: bool,
    /// Reciprocals of pivots.
    pub pivot_reciprocal: bool,
    /// Cholesky factors and their solutions.
    pub cholesky: bool,
    /// Solutions for the columns of a matrix.
    pub cholesky_of_matrix: bool,
    /// Sums of more elements than there are partial sums.
    pub sum: bool,
    /// Sums of no more.
    pub sum_of_few: bool,
}
