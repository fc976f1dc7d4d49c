//! Frame of a picture: axes, ticks, grid and labels.

use super::super::axis::{Axis, Range, Scale, Tick, ticks};
use super::super::error::{PlotError, is_drawable};
use super::super::quantity::Quantity;
use super::raster::{Colour, HEIGHT, Raster, WIDTH};
use super::typeface::{Align, Direction, Line, TICK_SIZE, Typeface};
use super::types::{Coordinate, largest};

pub const LABEL_SIZE: f64 = 17.0;
const TITLE_SIZE: f64 = 18.0;
pub const TICK_LENGTH: f64 = 5.0;
pub const FRAME: Colour = [51; 3];
const GRID: Colour = [226; 3];

const TOP: f64 = 52.0;
const BOTTOM: f64 = 690.0;
const RIGHT_MARGIN: f64 = 28.0;
const LABEL_ROOM: f64 = 46.0;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Outside of the frame, so that they cover no cell.
    Outside,
    Inside,
}

#[derive(Debug)]
pub struct Units {
    quantity: Quantity,
    scale: Scale,
}

/// Two axes around an area of pixels.
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
    /// Returns the position of an SI value along the axis; NaN if it cannot be drawn.
    pub fn place(&self, value: f64) -> f64 {
        if is_drawable(value) {
            self.scale.place(value / self.quantity.scale)
        } else {
            f64::NAN
        }
    }
}

/// Returns the edges of a coordinate's cells, one more than values, as positions on the axis.
pub fn cell_edges(coordinate: &Coordinate<'_>) -> Result<Vec<f64>, PlotError> {
    let units = coordinate_units(coordinate);
    let values = coordinate.values.iter();
    let places: Vec<f64> = values.map(|value| units.place(*value)).collect();
    let mut before = f64::NEG_INFINITY;
    for (index, place) in places.iter().enumerate() {
        if !(*place > before && place.is_finite()) {
            return Err(PlotError::Grid {
                axis: coordinate.name.clone(),
                index,
            });
        }
        before = *place;
    }
    let middles: Vec<f64> = places
        .windows(2)
        .filter_map(|pair| match *pair {
            [low, high] => Some(low + (high - low) / 2.0),
            _ => None,
        })
        .collect();
    let Some(around) = Range::from_places(places.into_iter()) else {
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
        typeface: &Typeface,
    ) -> Self {
        let vertical = FrameEdge::new(vertical, ranges.1, (BOTTOM, TOP), 8);
        let widest = typeface.widest(&vertical.ticks);
        let left = (LABEL_ROOM + widest + TICK_LENGTH + 6.0).ceil().min(300.0);
        let right = WIDTH as f64 - beside.min(400.0) - RIGHT_MARGIN;
        let pixels = (left, right.floor());
        Self {
            horizontal: FrameEdge::new(horizontal, ranges.0, pixels, 8),
            vertical,
        }
    }

    /// Returns the right edge, in px.
    pub fn right(&self) -> f64 {
        self.horizontal.axis.pixels.1
    }

    /// Returns the lower and the upper edge, in px.
    pub fn vertical_pixels(&self) -> (f64, f64) {
        self.vertical.axis.pixels
    }

    /// Returns the pixels inside, as columns and rows.
    pub fn pixels(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let (left, right) = self.horizontal.axis.pixels;
        let (bottom, top) = self.vertical.axis.pixels;
        (top as usize..bottom as usize)
            .flat_map(move |row| (left as usize..right as usize).map(move |column| (column, row)))
    }

    /// Returns the position along the axes of the middle of a pixel.
    pub fn place(&self, column: usize, row: usize) -> (f64, f64) {
        (
            self.horizontal.place(column as f64 + 0.5),
            self.vertical.place(row as f64 + 0.5),
        )
    }

    /// Returns the point of a position along the axes, in px.
    pub fn pixel(&self, along: f64, up: f64) -> (f64, f64) {
        (
            self.horizontal.axis.pixel(along),
            self.vertical.axis.pixel(up),
        )
    }

    /// Draws faint lines at the ticks.
    pub fn draw_grid(&self, raster: &mut Raster) {
        let (left, right) = self.horizontal.axis.pixels;
        let (bottom, top) = self.vertical.axis.pixels;
        let (width, height) = ((right - left) as usize, (bottom - top) as usize);
        for x in self.horizontal.marks() {
            raster.fill((x, top as usize), (1, height), GRID);
        }
        for y in self.vertical.marks() {
            raster.fill((left as usize, y), (width, 1), GRID);
        }
    }

    /// Draws the frame with its ticks, the labels and the title.
    pub fn draw(&self, raster: &mut Raster, typeface: &Typeface, title: &str, side: Side) {
        let (across, up) = (self.horizontal.axis.pixels, self.vertical.axis.pixels);
        outline(raster, across, up);
        self.draw_marks(raster, side);
        self.draw_tick_labels(raster, typeface);
        let name = Line {
            size: LABEL_SIZE,
            ..Line::level(&self.horizontal.label, Align::Middle)
        };
        let at = ((across.0 + across.1) / 2.0, HEIGHT as f64 - 18.0);
        typeface.write_within(raster, name, at, across.1 - across.0);
        let name = Line {
            text: &self.vertical.label,
            direction: Direction::Up,
            ..name
        };
        let at = (26.0, (up.0 + up.1) / 2.0);
        typeface.write_within(raster, name, at, up.0 - up.1);
        let heading = Line {
            size: TITLE_SIZE,
            heading: true,
            ..Line::level(title, Align::Start)
        };
        let room = WIDTH as f64 - RIGHT_MARGIN - across.0;
        typeface.write_within(raster, heading, (across.0, TOP - 18.0), room);
    }

    fn draw_marks(&self, raster: &mut Raster, side: Side) {
        let (left, _) = self.horizontal.axis.pixels;
        let (bottom, _) = self.vertical.axis.pixels;
        let length = TICK_LENGTH as usize;
        let (from_left, from_bottom) = match side {
            Side::Outside => (left as usize - 1 - length, bottom as usize + 1),
            Side::Inside => (left as usize, bottom as usize - length),
        };
        for x in self.horizontal.marks() {
            raster.fill((x, from_bottom), (1, length), FRAME);
        }
        for y in self.vertical.marks() {
            raster.fill((from_left, y), (length, 1), FRAME);
        }
    }

    fn draw_tick_labels(&self, raster: &mut Raster, typeface: &Typeface) {
        let (left, _) = self.horizontal.axis.pixels;
        let (bottom, _) = self.vertical.axis.pixels;
        for tick in &self.horizontal.ticks {
            let at = (self.horizontal.axis.pixel(tick.place), bottom + 24.0);
            typeface.write(raster, Line::level(&tick.label, Align::Middle), at);
        }
        for tick in &self.vertical.ticks {
            let y = self.vertical.axis.pixel(tick.place) + 0.36 * TICK_SIZE;
            let at = (left - TICK_LENGTH - 6.0, y);
            typeface.write(raster, Line::level(&tick.label, Align::End), at);
        }
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

    fn marks(&self) -> impl Iterator<Item = usize> + '_ {
        let pixels = self.ticks.iter().map(|tick| self.axis.pixel(tick.place));
        pixels.map(|pixel| pixel.round().max(0.0) as usize)
    }

    fn place(&self, pixel: f64) -> f64 {
        let (start, end) = self.axis.pixels;
        let Range { low, high } = self.axis.range;
        low + (pixel - start) / (end - start) * (high - low)
    }
}

/// Draws a rectangle with lines of one pixel just outside an area of pixels.
pub fn outline(raster: &mut Raster, (left, right): (f64, f64), (bottom, top): (f64, f64)) {
    let corner = (left as usize - 1, top as usize - 1);
    let (width, height) = ((right - left) as usize + 2, (bottom - top) as usize + 2);
    raster.fill(corner, (width, 1), FRAME);
    raster.fill(corner, (1, height), FRAME);
    raster.fill((corner.0, bottom as usize), (width, 1), FRAME);
    raster.fill((right as usize, corner.1), (1, height), FRAME);
}
