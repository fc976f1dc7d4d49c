//! Points of a scatter plot.

use super::frame::Frame;
use super::types::{INK, OPACITY, hexadecimal};
use crate::canvas::Canvas;
use crate::decimate::Point;
use crate::error::PlotError;
use crate::rendering::encode_png;

/// Number of points above which an image replaces them, so that the size of the figure is bounded.
const MAX_DRAWN_DISCS: usize = 2000;

/// Draws translucent discs at positions along the axes, darker where they overlap.
pub fn draw_points(canvas: &mut Canvas, frame: &Frame, points: &[Point]) -> Result<(), PlotError> {
    let ((left, right), (bottom, top)) = (frame.horizontal_pixels(), frame.vertical_pixels());
    // The total area of the discs is a tenth of the frame, within limits on the radius.
    let area = 0.1 * (right - left) * (bottom - top) / points.len() as f64;
    let radius = (area / std::f64::consts::PI).sqrt().clamp(0.7, 3.0);
    let pixels = points.iter().map(|point| frame.pixel(*point));
    if points.len() <= MAX_DRAWN_DISCS {
        canvas.dots(pixels, radius, &hexadecimal(INK), OPACITY);
        return Ok(());
    }
    let size = ((right - left) as usize, (bottom - top) as usize);
    let inside = pixels.map(|(x, y)| (x - left, y - top));
    let bytes = disc_image(size, inside, radius);
    let png = encode_png((size.0 as u32, size.1 as u32), png::ColorType::Rgba, &bytes)?;
    frame.draw_image(canvas, &png);
    Ok(())
}

/// Returns an image with discs of `width` by `height` px, as red, green, blue and opacity. Fractions of pixels
/// that a disc covers at its edge are accurate to a tenth.
fn disc_image(
    (width, height): (usize, usize),
    centres: impl Iterator<Item = Point>,
    radius: f64,
) -> Vec<u8> {
    let reach = radius + 1.0;
    let span = |centre: f64, count: usize| {
        let end = (centre + reach).max(0.0) as usize + 1;
        (centre - reach).max(0.0) as usize..end.min(count)
    };
    let mut transmission = vec![1.0; width * height];
    for (x, y) in centres {
        for row in span(y, height) {
            for column in span(x, width) {
                let distance = f64::hypot(column as f64 + 0.5 - x, row as f64 + 0.5 - y);
                let covered = (radius + 0.5 - distance).clamp(0.0, 1.0);
                if let Some(pixel) = transmission.get_mut(row * width + column) {
                    *pixel *= 1.0 - OPACITY * covered;
                }
            }
        }
    }
    let [red, green, blue] = INK;
    let opacities = transmission.iter().map(|left| 255.0 * (1.0 - left));
    opacities
        .flat_map(|opacity: f64| [red, green, blue, opacity.round() as u8])
        .collect()
}
