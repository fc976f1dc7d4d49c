//! Content of maps and scatter plots, and their colours.

use crate::error::{PlotError, is_drawable};

/// Quantity over two parameters.
#[derive(Clone, Debug, Default)]
pub struct Map<'a> {
    /// Title above the frame, drawn without changes.
    pub title: String,
    /// Parameter of the columns, with ascending values.
    pub horizontal: Coordinate<'a>,
    /// Parameter of the rows, with values that ascend upwards.
    pub vertical: Coordinate<'a>,
    /// Name of the quantity.
    pub quantity: String,
    /// SI unit as in specifications; empty for a dimensionless number.
    pub unit: String,
    /// Colour scale.
    pub shades: Shades,
    /// Values row by row, `values[j * columns + i]`. A cell is grey if its value is not finite.
    pub values: &'a [f64],
}

/// Points in a plane.
#[derive(Clone, Debug, Default)]
pub struct Scatter<'a> {
    /// Title above the frame, drawn without changes.
    pub title: String,
    /// Abscissae, in any order.
    pub horizontal: Coordinate<'a>,
    /// Ordinates, one per abscissa. Points that cannot be drawn on the axes are omitted.
    pub vertical: Coordinate<'a>,
}

/// Values along an axis.
#[derive(Clone, Debug, Default)]
pub struct Coordinate<'a> {
    /// Name of the quantity, for example `b_sp`.
    pub name: String,
    /// SI unit as in specifications; empty for a dimensionless number.
    pub unit: String,
    /// Scale of the axis.
    pub spacing: Spacing,
    /// Values in SI units.
    pub values: &'a [f64],
}

/// Scale of an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Spacing {
    /// Linear scale.
    #[default]
    Linear,
    /// Logarithmic scale.
    Logarithmic,
}

/// Colour scale of values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shades {
    /// From dark blue over green to yellow (viridis), from the smallest value to the largest.
    #[default]
    Sequential,
    /// Blue below zero, white at zero, red above, for example for an exponent. Equal magnitudes have equal
    /// shades. If one side is more than three times as large as the other, each side has a separate scale, so
    /// that both are readable.
    Signed,
}

/// Red, green and blue.
pub(super) type Colour = [u8; 3];

pub(super) const WHITE: Colour = [255; 3];
pub(super) const GREY: Colour = [158; 3];
pub(super) const INK: Colour = [0, 60, 110];
pub(super) const OPACITY: f64 = 0.6;

pub(super) fn hexadecimal([red, green, blue]: Colour) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

pub(super) fn empty_error(name: &str) -> PlotError {
    PlotError::Empty {
        panel: 0,
        series: name.to_owned(),
    }
}

pub(super) fn largest(values: &[f64]) -> f64 {
    let drawable = values.iter().filter(|value| is_drawable(**value));
    drawable.fold(0.0, |largest: f64, value| largest.max(value.abs()))
}
