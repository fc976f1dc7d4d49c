//! What the pictures show, as their callers state it, and their colours.

use super::raster::Colour;
use crate::error::{PlotError, is_drawable};

/// A quantity over two parameters.
#[derive(Clone, Debug, Default)]
pub struct Map<'a> {
    /// Written above the frame, as it stands.
    pub title: String,
    /// The parameter of the columns, its values ascending.
    pub horizontal: Coordinate<'a>,
    /// The parameter of the rows, its values ascending upwards.
    pub vertical: Coordinate<'a>,
    /// The name of the quantity.
    pub quantity: String,
    /// Its SI unit as specifications write it; empty for a number.
    pub unit: String,
    /// Which colours it has.
    pub shades: Shades,
    /// Row by row: the value at column i and row j is `values[j * columns + i]`. One that is
    /// not finite leaves its cell grey.
    pub values: &'a [f64],
}

/// Points in a plane.
#[derive(Clone, Debug, Default)]
pub struct Scatter<'a> {
    /// Written above the frame, as it stands.
    pub title: String,
    /// The abscissae, in any order.
    pub horizontal: Coordinate<'a>,
    /// As many ordinates. A point that has no place on the axes is left out.
    pub vertical: Coordinate<'a>,
}

/// Values along an axis.
#[derive(Clone, Debug, Default)]
pub struct Coordinate<'a> {
    /// The name of the quantity, `b_sp` say.
    pub name: String,
    /// Its SI unit as specifications write it; empty for a number.
    pub unit: String,
    /// How values are spaced along the axis.
    pub spacing: Spacing,
    /// The values, in SI units.
    pub values: &'a [f64],
}

/// How values are spaced along an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Spacing {
    /// Equal differences look equal.
    #[default]
    Linear,
    /// Equal ratios look equal.
    Logarithmic,
}

/// Which colours values have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shades {
    /// Dark blue over green to yellow (viridis), from the least value to the greatest.
    #[default]
    Sequential,
    /// Blue below zero, white at zero, red above: for an exponent, say. The two sides have
    /// the same shades for the same magnitudes unless one reaches more than three times as
    /// far as the other; then each side has shades of its own, so that both can be read.
    Signed,
}

pub(super) const WHITE: Colour = [255; 3];
/// Of cells without a value.
pub(super) const GREY: Colour = [158; 3];
/// Of the points of a diagram.
pub(super) const INK: Colour = [0, 60, 110];
/// What one point hides of the paper.
pub(super) const OPACITY: f64 = 0.6;

pub(super) fn empty(name: &str) -> PlotError {
    PlotError::Empty {
        panel: 0,
        series: name.to_owned(),
    }
}

/// The greatest magnitude of what can be drawn.
pub(super) fn largest(values: &[f64]) -> f64 {
    let drawable = values.iter().filter(|value| is_drawable(**value));
    drawable.fold(0.0, |largest: f64, value| largest.max(value.abs()))
}
