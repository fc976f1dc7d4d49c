//! Colours and lines of drawn modes.

use crate::canvas::Stroke;

/// Colours at the largest amplitude, and a quarter of a period later.
pub(super) const IN_PHASE_COLOUR: &str = "#0072b2";
pub(super) const OUT_OF_PHASE_COLOUR: &str = "#d55e00";
pub(super) const GRID_STROKE: Stroke = stroke("#e6e6e6", 0.8, "");
pub(super) const FRAME_STROKE: Stroke = stroke("#444444", 1.0, "");

pub(super) const fn stroke(colour: &'static str, width: f64, dashes: &'static str) -> Stroke {
    Stroke {
        colour,
        width,
        dashes,
    }
}
