//! Versions of the standard.

/// Version of the Functional Mock-up Interface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Version {
    /// 2.0
    Two,
    /// 3.0
    Three,
}
