//! Frame of a map or a scatter plot: axes, ticks, grid and labels.

use super::types::{Coordinate, largest};
use crate::axis::{Axis, Range, Scale, Tick, ticks};
use crate::bars::{draw_label, draw_outline, write_text};
use crate::canvas::{Anchor, Canvas, FRAME_STROKE, GRID_STROKE, Text};
use crate::decimate::Point;
use crate::error::{PlotError, is_drawable};
use crate::layout::{LABEL_SIZE_PX, TICK_SIZE_PX, TITLE_SIZE_PX};
use crate::lettering::{text_width, truncate_to_width};
use crate::quantity::Quantity;

/// Size of every map and scatter plot, in px.
pub const WIDTH_PX: f64 = 1000.0;
pub const HEIGHT_PX: f64 = 760.0;
pub const TICK_LENGTH_PX: f64 = 5.0;

/// Upper and lower edge of every frame, in px.
const TOP: f64 = 48.0;
const BOTTOM: f64 = 696.0;
const RIGHT_MARGIN: f64 = 28.0;
/// Space for the name of the vertical axis, in px.
const LABEL_SPACE_PX: f64 = 36.0;
const TICK_LABEL_GAP: f64 = TICK_LENGTH_PX + 6.0;
/// Width of regular text relative to bold text.
const REGULAR_OVER_BOLD_WIDTH: f64 = 0.9;
/// Maximum distance between the edges of evenly spaced cells and of the cells of a map, in px.
const MAX_CELL_SHIFT_PX: f64 = 0.25;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Ticks outside the frame, so that they cover no cell.
    Outside,
    Inside,
}

#[derive(Debug)]
pub struct Units {
    quantity: Quantity,
    scale: Scale,
}

/// Two axes around an area of whole pixels.
#[derive(Debug)]
pub struct Frame {
    horizontal: FrameEdge,
    vertical: FrameEdge,
}

#[derive(Debug)]
struct FrameEdge {
    axis: Axis,
    label: String,
    ticks: Vec<Tick>,
}

pub fn coordinate_units(coordinate: &Coordinate<'_>) -> Units {
    let scale = coordinate.spacing.scale();
    let (name, unit) = (&coordinate.name, &coordinate.unit);
    let quantity = match scale {
        Scale::Linear => Quantity::with_prefix(name, unit, largest(coordinate.values)),
        Scale::Logarithmic => Quantity::without_prefix(name, unit),
    };
    Units { quantity, scale }
}

impl Units {
    /// Returns the coordinate of an SI value along the axis; NaN if it cannot be drawn.
    pub fn to_position(&self, value: f64) -> f64 {
        if is_drawable(value) {
            self.scale.to_position(value / self.quantity.scale)
        } else {
            f64::NAN
        }
    }
}

/// Returns the edges of a coordinate's cells as coordinates along the axis; one more than the number of values.
pub fn cell_edges(coordinate: &Coordinate<'_>) -> Result<Vec<f64>, PlotError> {
    let units = coordinate_units(coordinate);
    let values = coordinate.values.iter();
    let positions: Vec<f64> = values.map(|value| units.to_position(*value)).collect();
    let mut before = f64::NEG_INFINITY;
    for (index, position) in positions.iter().enumerate() {
        if !(*position > before && position.is_finite()) {
            return Err(PlotError::Grid {
                axis: coordinate.name.clone(),
                index,
            });
        }
        before = *position;
    }
    let middles: Vec<f64> = positions
        .windows(2)
        .filter_map(|pair| match *pair {
            [low, high] => Some(low + (high - low) / 2.0),
            _ => None,
        })
        .collect();
    let Some(around) = Range::from_positions(positions.into_iter()) else {
        return Ok(Vec::new());
    };
    // The outer cells are symmetric; a single cell has an arbitrary width.
    let (first, last) = match middles.as_slice() {
        [] => (around.widen_point().low, around.widen_point().high),
        [first, .., last] => (2.0 * around.low - first, 2.0 * around.high - last),
        [only] => (2.0 * around.low - only, 2.0 * around.high - only),
    };
    let inner = std::iter::once(first).chain(middles);
    Ok(inner.chain(std::iter::once(last)).collect())
}

impl Frame {
    /// Creates two axes with `beside` px of space to the right of the frame.
    pub fn new(
        horizontal: &Coordinate<'_>,
        vertical: &Coordinate<'_>,
        ranges: (Range, Range),
        beside: f64,
    ) -> Self {
        let vertical = FrameEdge::new(vertical, ranges.1, (BOTTOM, TOP), 8);
        let left = LABEL_SPACE_PX + widest_label(&vertical.ticks) + TICK_LABEL_GAP;
        let right = WIDTH_PX - beside.min(400.0) - RIGHT_MARGIN;
        let pixels = (left.ceil().min(300.0), right.floor());
        Self {
            horizontal: FrameEdge::new(horizontal, ranges.0, pixels, 8),
            vertical,
        }
    }

    /// Returns the left and the right edge, in px.
    pub fn horizontal_pixels(&self) -> (f64, f64) {
        self.horizontal.axis.pixels
    }

    /// Returns the lower and the upper edge, in px.
    pub fn vertical_pixels(&self) -> (f64, f64) {
        self.vertical.axis.pixels
    }

    /// Returns the point of a position along the axes, in px.
    pub fn pixel(&self, (x, y): Point) -> Point {
        (self.horizontal.axis.pixel(x), self.vertical.axis.pixel(y))
    }

    /// Returns for each pixel column of an image over the frame its column of cells, and for each pixel row
    /// from the top its row of cells. The image has at most one pixel per px.
    pub fn cells(&self, edges: (&[f64], &[f64])) -> (Vec<Option<usize>>, Vec<Option<usize>>) {
        let columns = self.horizontal.cells(edges.0);
        let mut rows = self.vertical.cells(edges.1);
        rows.reverse();
        (columns, rows)
    }

    /// Draws an image over the whole frame.
    pub fn draw_image(&self, canvas: &mut Canvas, png: &[u8]) {
        let ((left, right), (bottom, top)) = (self.horizontal_pixels(), self.vertical_pixels());
        canvas.image((left, top), (right - left, bottom - top), png);
    }

    /// Draws faint lines at the ticks.
    pub fn draw_grid(&self, canvas: &mut Canvas) {
        let ((left, right), (bottom, top)) = (self.horizontal_pixels(), self.vertical_pixels());
        let upright = self.horizontal.tick_pixels();
        let upright = upright.map(|x| ((x, bottom), (x, top)));
        let level = self.vertical.tick_pixels();
        let level = level.map(|y| ((left, y), (right, y)));
        canvas.segments(&upright.chain(level).collect::<Vec<_>>(), GRID_STROKE);
    }

    /// Draws the frame with its ticks, the labels and the title.
    pub fn draw(&self, canvas: &mut Canvas, title: &str, side: Side) {
        let ((left, right), (bottom, top)) = (self.horizontal_pixels(), self.vertical_pixels());
        draw_cell_outline(canvas, (left, right), (bottom, top));
        self.draw_tick_marks(canvas, side);
        for tick in &self.horizontal.ticks {
            let at = (self.horizontal.axis.pixel(tick.position), bottom + 23.0);
            write_text(canvas, &tick.label, at, Anchor::Middle);
        }
        for tick in &self.vertical.ticks {
            let y = self.vertical.axis.pixel(tick.position) + 0.35 * TICK_SIZE_PX;
            write_text(canvas, &tick.label, (left - TICK_LABEL_GAP, y), Anchor::End);
        }
        let name = truncate_to_width(&self.horizontal.label, LABEL_SIZE_PX, right - left);
        draw_label(canvas, &name, ((left + right) / 2.0, bottom + 47.0), 0.0);
        let name = truncate_to_width(&self.vertical.label, LABEL_SIZE_PX, bottom - top);
        draw_label(canvas, &name, (20.0, (bottom + top) / 2.0), -90.0);
        let room = REGULAR_OVER_BOLD_WIDTH * (WIDTH_PX - RIGHT_MARGIN - left);
        canvas.verbatim_text(Text {
            text: &truncate_to_width(title, TITLE_SIZE_PX, room),
            position: (left, top - 18.0),
            size: TITLE_SIZE_PX,
            anchor: Anchor::Start,
            is_bold: true,
        });
    }

    fn draw_tick_marks(&self, canvas: &mut Canvas, side: Side) {
        let (left, bottom) = (self.horizontal_pixels().0, self.vertical_pixels().0);
        let length = match side {
            Side::Outside => -TICK_LENGTH_PX,
            Side::Inside => TICK_LENGTH_PX,
        };
        let below = self.horizontal.tick_pixels();
        let below = below.map(|x| ((x, bottom), (x, bottom - length)));
        let beside = self.vertical.tick_pixels();
        let beside = beside.map(|y| ((left, y), (left + length, y)));
        canvas.segments(&below.chain(beside).collect::<Vec<_>>(), FRAME_STROKE);
    }
}

impl FrameEdge {
    fn new(coordinate: &Coordinate<'_>, range: Range, pixels: (f64, f64), count: usize) -> Self {
        let Units { quantity, scale } = coordinate_units(coordinate);
        Self {
            axis: Axis {
                scale,
                range,
                pixels,
            },
            label: quantity.label,
            ticks: ticks(scale, range, count),
        }
    }

    /// Returns the ticks at pixel centres, so that lines of 1 px are sharp.
    fn tick_pixels(&self) -> impl Iterator<Item = f64> + '_ {
        let pixels = self.ticks.iter().map(|tick| self.axis.pixel(tick.position));
        pixels.map(|pixel| pixel.floor() + 0.5)
    }

    /// Returns the cells along the axis: each cell once if all have the same width of at least 1 px, otherwise
    /// the cell at each pixel.
    fn cells(&self, edges: &[f64]) -> Vec<Option<usize>> {
        let (start, end) = self.axis.pixels;
        let (cells, pixels) = (edges.len().saturating_sub(1), (end - start).abs());
        let is_even = |(index, edge): (usize, &f64)| {
            let even = start + (end - start) * index as f64 / cells as f64;
            (self.axis.pixel(*edge) - even).abs() < MAX_CELL_SHIFT_PX
        };
        if cells as f64 <= pixels && edges.iter().enumerate().all(is_even) {
            return (0..cells).map(Some).collect();
        }
        let Range { low, high } = self.axis.range;
        (0..pixels as usize)
            .map(|pixel| find_cell(edges, low + (pixel as f64 + 0.5) / pixels * (high - low)))
            .collect()
    }
}

fn find_cell(edges: &[f64], position: f64) -> Option<usize> {
    let cell = edges
        .partition_point(|edge| *edge <= position)
        .checked_sub(1)?;
    (cell + 1 < edges.len()).then_some(cell)
}

pub fn widest_label(ticks: &[Tick]) -> f64 {
    let widths = ticks
        .iter()
        .map(|tick| text_width(&tick.label, TICK_SIZE_PX));
    widths.fold(0.0, f64::max)
}

/// Draws a rectangle with lines of 1 px just outside an area of whole pixels.
pub fn draw_cell_outline(canvas: &mut Canvas, (left, right): Point, (bottom, top): Point) {
    draw_outline(canvas, (left - 0.5, right + 0.5), (bottom + 0.5, top - 0.5));
}
