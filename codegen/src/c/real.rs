//! Number type of emitted C.

/// Number type of the emitted C if the including code defines none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Real {
    /// `double`.
    Double,
    /// `float`.
    Single,
}
