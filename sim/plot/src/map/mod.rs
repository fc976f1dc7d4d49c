//! Maps of two parameters, and scatter plots over one, as SVG.
//!
//! [`draw_map`] and [`draw_scatter`] draw them. `frame` computes the axes, `shades` maps values to colours and
//! draws the colour bar, `points` draws the points. Cells, and points if there are many, are an image in the
//! SVG, so its size is bounded for any number of them. [`crate::render_png`] returns the PNG of the figure.

mod frame;
mod points;
mod shades;
mod types;

#[cfg(test)]
mod tests;

use super::axis::{Range, Scale};
use super::canvas::Canvas;
use super::decimate::Point;
use super::error::PlotError;
use super::rendering::encode_png;
use frame::{Frame, HEIGHT_PX, Side, WIDTH_PX};
use shades::Bar;
pub use types::{Coordinate, Map, Scatter, Shades, Spacing};
use types::{GREY, WHITE, empty_error};

/// Draws a quantity over two parameters as an SVG document of 1000 by 760 px. Each cell extends
/// halfway to its neighbours on the axis.
///
/// # Errors
///
/// [`PlotError`] if the numbers of values and cells differ, if no value is finite, or if parameters
/// do not ascend or cannot be drawn on their axis.
pub fn draw_map(map: &Map<'_>) -> Result<String, PlotError> {
    let (columns, rows) = (map.horizontal.values.len(), map.vertical.values.len());
    if columns.checked_mul(rows) != Some(map.values.len()) {
        return Err(PlotError::Cells {
            columns,
            rows,
            values: map.values.len(),
        });
    }
    let bar = Bar::new(map)?;
    let edges = (
        frame::cell_edges(&map.horizontal)?,
        frame::cell_edges(&map.vertical)?,
    );
    let ranges = (edge_range(&edges.0, map)?, edge_range(&edges.1, map)?);
    let frame = Frame::new(&map.horizontal, &map.vertical, ranges, bar.width());
    let (across, down) = frame.cells((&edges.0, &edges.1));
    let colour = |row: Option<usize>, column: Option<usize>| match (row, column) {
        (Some(row), Some(column)) => {
            let value = map.values.get(row * columns + column);
            value.and_then(|value| bar.colour(*value)).unwrap_or(GREY)
        }
        _ => WHITE,
    };
    let pixels = down
        .iter()
        .flat_map(|row| across.iter().map(|column| colour(*row, *column)));
    let bytes: Vec<u8> = pixels.flatten().collect();
    let size = (across.len() as u32, down.len() as u32);
    let mut canvas = Canvas::default();
    frame.draw_image(&mut canvas, &encode_png(size, png::ColorType::Rgb, &bytes)?);
    frame.draw(&mut canvas, &map.title, Side::Outside);
    bar.draw(&mut canvas, &frame)?;
    Ok(canvas.document(&map.title, WIDTH_PX, HEIGHT_PX))
}

/// Draws points over a parameter as an SVG document of 1000 by 760 px, darker where they overlap.
///
/// # Errors
///
/// [`PlotError`] if the numbers of ordinates and abscissae differ, or if no point can be drawn.
pub fn draw_scatter(scatter: &Scatter<'_>) -> Result<String, PlotError> {
    let (horizontal, vertical) = (&scatter.horizontal, &scatter.vertical);
    if horizontal.values.len() != vertical.values.len() {
        return Err(PlotError::Lengths {
            panel: 0,
            series: vertical.name.clone(),
            abscissae: horizontal.values.len(),
            values: vertical.values.len(),
        });
    }
    let units = (
        frame::coordinate_units(horizontal),
        frame::coordinate_units(vertical),
    );
    let pairs = horizontal.values.iter().zip(vertical.values);
    let points: Vec<Point> = pairs
        .map(|(x, y)| (units.0.to_position(*x), units.1.to_position(*y)))
        .filter(|(x, y)| x.is_finite() && y.is_finite())
        .collect();
    let spans = (
        Range::from_positions(points.iter().map(|point| point.0)),
        Range::from_positions(points.iter().map(|point| point.1)),
    );
    let (Some(x), Some(y)) = spans else {
        return Err(empty_error(&vertical.name));
    };
    let ranges = (x.widen_point().pad(0.01), y.widen_point().pad(0.03));
    let frame = Frame::new(horizontal, vertical, ranges, 0.0);
    let mut canvas = Canvas::default();
    frame.draw_grid(&mut canvas);
    points::draw_points(&mut canvas, &frame, &points)?;
    frame.draw(&mut canvas, &scatter.title, Side::Inside);
    Ok(canvas.document(&scatter.title, WIDTH_PX, HEIGHT_PX))
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

impl Spacing {
    fn scale(self) -> Scale {
        match self {
            Self::Linear => Scale::Linear,
            Self::Logarithmic => Scale::Logarithmic,
        }
    }
}
