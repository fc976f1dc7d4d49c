//! Colours of mode shapes.

/// Colour of the shape at its largest amplitude, and colour of the shape a quarter period later.
pub(super) const IN_PHASE_COLOUR: &str = "#0072b2";
pub(super) const OUT_OF_PHASE_COLOUR: &str = "#d55e00";
