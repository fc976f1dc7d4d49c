//! Unknowns of a search for an equilibrium.

use crate::operating_point::Setting;

/// Unknown of a search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unknown {
    /// Coordinate, first-order state or input.
    Setting(Setting),
    /// Speed along a cyclic direction, by its index.
    Speed(usize),
}
