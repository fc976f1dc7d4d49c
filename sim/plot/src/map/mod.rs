//! Pictures over parameters as PNG: maps of two parameters, and points over one.
//!
//! [`map_png`] and [`scatter_png`] draw them. `frame` computes the axes, `shades` maps values to
//! colours and draws their bar, `raster` contains the pixels and `typeface` writes text. Pixels are
//! used because a map can have tens of thousands of cells and a diagram a million points. The font
//! is part of the program, so a picture has the same bytes on every machine.

mod frame;
mod raster;
mod shades;
mod typeface;
mod types;

#[cfg(test)]
mod tests;

use super::axis::{Range, Scale};
use super::error::PlotError;
use frame::{Frame, Side};
use raster::Raster;
use shades::Bar;
use typeface::Typeface;
pub use types::{Coordinate, Map, Scatter, Shades, Spacing};
use types::{GREY, INK, OPACITY, WHITE, empty_error};

/// Draws a quantity over two parameters as a PNG of 1000 by 760 px. Each cell extends halfway to
/// its neighbours on the axis.
///
/// # Errors
///
/// [`PlotError`] if the numbers of values and cells differ, if no value is finite, or if parameters
/// do not ascend or cannot be drawn on their axis.
pub fn map_png(map: &Map<'_>) -> Result<Vec<u8>, PlotError> {
    let (columns, rows) = (map.horizontal.values.len(), map.vertical.values.len());
    if columns.checked_mul(rows) != Some(map.values.len()) {
        return Err(PlotError::Cells {
            columns,
            rows,
            values: map.values.len(),
        });
    }
    let bar = Bar::new(map)?;
    let cells = (
        frame::cell_edges(&map.horizontal)?,
        frame::cell_edges(&map.vertical)?,
    );
    let ranges = (edge_range(&cells.0, map)?, edge_range(&cells.1, map)?);
    let typeface = Typeface::new()?;
    let mut raster = Raster::new(WHITE);
    let beside = bar.width(&typeface);
    let frame = Frame::new(&map.horizontal, &map.vertical, ranges, beside, &typeface);
    let colour_at = |x: f64, y: f64| {
        let (column, row) = (find_cell(&cells.0, x)?, find_cell(&cells.1, y)?);
        let value = map.values.get(row * columns + column)?;
        Some(bar.colour(*value).unwrap_or(GREY))
    };
    for (column, row) in frame.pixels() {
        let (x, y) = frame.place(column, row);
        if let Some(colour) = colour_at(x, y) {
            raster.set(column, row, colour);
        }
    }
    frame.draw(&mut raster, &typeface, &map.title, Side::Outside);
    bar.draw(&mut raster, &typeface, &frame);
    raster.png(&map.title)
}

/// Draws points over a parameter as a PNG of 1000 by 760 px, darker where they overlap.
///
/// # Errors
///
/// [`PlotError`] if the numbers of ordinates and abscissae differ, or if no point can be drawn.
pub fn scatter_png(scatter: &Scatter<'_>) -> Result<Vec<u8>, PlotError> {
    let (horizontal, vertical) = (&scatter.horizontal, &scatter.vertical);
    if horizontal.values.len() != vertical.values.len() {
        return Err(PlotError::Lengths {
            panel: 0,
            series: vertical.name.clone(),
            abscissae: horizontal.values.len(),
            values: vertical.values.len(),
        });
    }
    let scales = (
        frame::coordinate_units(horizontal),
        frame::coordinate_units(vertical),
    );
    let pairs = horizontal.values.iter().zip(vertical.values);
    let points: Vec<(f64, f64)> = pairs
        .map(|(x, y)| (scales.0.place(*x), scales.1.place(*y)))
        .filter(|(x, y)| x.is_finite() && y.is_finite())
        .collect();
    let range = |values: Vec<f64>| Range::from_places(values.into_iter());
    let spans = (
        range(points.iter().map(|point| point.0).collect()),
        range(points.iter().map(|point| point.1).collect()),
    );
    let (Some(along), Some(up)) = spans else {
        return Err(empty_error(&vertical.name));
    };
    let ranges = (along.widen_point().pad(0.01), up.widen_point().pad(0.03));
    let typeface = Typeface::new()?;
    let mut raster = Raster::new(WHITE);
    let frame = Frame::new(horizontal, vertical, ranges, 0.0, &typeface);
    frame.draw_grid(&mut raster);
    draw_points(&mut raster, &frame, &points);
    frame.draw(&mut raster, &typeface, &scatter.title, Side::Inside);
    raster.png(&scatter.title)
}

/// Draws translucent dots, so that density is visible.
fn draw_points(raster: &mut Raster, frame: &Frame, points: &[(f64, f64)]) {
    let room = frame.pixels().count() as f64;
    // All dots together would cover a tenth of the frame, with limits on the radius.
    let radius = (0.1 * room / (points.len() as f64 * std::f64::consts::PI)).sqrt();
    let radius = radius.clamp(0.7, 3.0);
    let mut paper = vec![1.0; raster::WIDTH * raster::HEIGHT];
    for (x, y) in points {
        let (x, y) = frame.pixel(*x, *y);
        raster::disc(x, y, radius, |column, row, share| {
            if let Some(left) = paper.get_mut(row * raster::WIDTH + column) {
                *left *= 1.0 - OPACITY * share;
            }
        });
    }
    for (column, row) in frame.pixels() {
        if let Some(left) = paper.get(row * raster::WIDTH + column) {
            raster.blend(column, row, INK, 1.0 - left);
        }
    }
}

fn edge_range(edges: &[f64], map: &Map<'_>) -> Result<Range, PlotError> {
    match edges {
        [low, .., high] => Ok(Range {
            low: *low,
            high: *high,
        }
        .widen_point()),
        _ => Err(empty_error(&map.quantity)),
    }
}

fn find_cell(edges: &[f64], place: f64) -> Option<usize> {
    let cell = edges
        .partition_point(|edge| *edge <= place)
        .checked_sub(1)?;
    (cell + 1 < edges.len()).then_some(cell)
}

impl Spacing {
    fn scale(self) -> Scale {
        match self {
            Self::Linear => Scale::Linear,
            Self::Logarithmic => Scale::Logarithmic,
        }
    }
}
