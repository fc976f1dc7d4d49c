//! Colours of drawn modes.

/// Colours at the largest amplitude, and a quarter of a period later.
pub(super) const IN_PHASE_COLOUR: &str = "#0072b2";
pub(super) const OUT_OF_PHASE_COLOUR: &str = "#d55e00";
