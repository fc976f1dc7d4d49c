//! Observables that need no declaration.

/// Observables that every simulation computes.
pub(crate) const COMPUTED_OBSERVABLES: [&str; 2] = ["energy", "power"];
