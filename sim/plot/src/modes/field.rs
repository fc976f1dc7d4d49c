//! Shape of a field over its length.

use super::styles::{IN_PHASE_COLOUR, OUT_OF_PHASE_COLOUR};
use super::types::Shape;
use crate::axis::{Axis, Range, Scale, ticks};
use crate::bars::{draw_label, draw_outline, write_text};
use crate::canvas::{Anchor, Canvas, FRAME_STROKE, GRID_STROKE, Stroke};
use crate::decimate::Point;
use crate::layout::TICK_SIZE_PX;
use crate::quantity::Quantity;

/// Width of a frame with its labels, in px.
pub(super) const FIELD_WIDTH_PX: f64 = 400.0;
/// Margins to the left and right of a field's frame, in px.
const MARGINS_PX: (f64, f64) = (80.0, 24.0);
/// Amplitude below which a field is at rest; relative to amplitudes of 1 it is rounding.
const MIN_FIELD_AMPLITUDE: f64 = 1e-12;

struct Axes {
    x: Axis,
    y: Axis,
    horizontal_quantity: Quantity,
    vertical_quantity: Quantity,
}

pub(super) fn draw_field(canvas: &mut Canvas, shape: &Shape, later: bool, place: (f64, f64, f64)) {
    let axes = field_axes(shape, place);
    draw_frame(canvas, &axes, place.0);
    let curve = |of: fn(&[f64; 2]) -> f64| -> Vec<Point> {
        let samples = shape.positions.iter().zip(&shape.amplitudes);
        let pixel = |(at, value): (&f64, &[f64; 2])| {
            let (x, y) = (
                at / axes.horizontal_quantity.scale,
                of(value) / axes.vertical_quantity.scale,
            );
            (axes.x.pixel(x), axes.y.pixel(y))
        };
        samples.map(pixel).collect()
    };
    // A quarter period later the motion is the real part of i times the amplitude.
    if later {
        canvas.lines(
            &[curve(|[_, im]| -im)],
            Stroke::new(OUT_OF_PHASE_COLOUR, 1.6, "6 4"),
        );
    }
    canvas.lines(
        &[curve(|[re, _]| *re)],
        Stroke::new(IN_PHASE_COLOUR, 2.0, ""),
    );
}

fn field_axes(shape: &Shape, (left, top, height): (f64, f64, f64)) -> Axes {
    let size =
        |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, |most, v| v.abs().max(most));
    let largest = size(&mut shape.amplitudes.iter().flatten().copied());
    let moves = largest > MIN_FIELD_AMPLITUDE;
    let up = Quantity::with_prefix(&shape.name, &shape.unit, if moves { largest } else { 1.0 });
    let reach = if moves {
        1.08 * largest / up.scale
    } else {
        1.0
    };
    let furthest = size(&mut shape.positions.iter().copied());
    let along = Quantity::with_prefix(&shape.position_name, "m", furthest);
    let positions = shape.positions.iter().map(|x| x / along.scale);
    let range = Range::from_positions(positions).unwrap_or(Range {
        low: 0.0,
        high: 1.0,
    });
    let axis = |range, pixels| Axis {
        scale: Scale::Linear,
        range,
        pixels,
    };
    let both = Range {
        low: -reach,
        high: reach,
    };
    Axes {
        x: axis(
            range.widen_point(),
            (left + MARGINS_PX.0, left + FIELD_WIDTH_PX - MARGINS_PX.1),
        ),
        y: axis(both, (top + height, top)),
        horizontal_quantity: along,
        vertical_quantity: up,
    }
}

fn draw_frame(
    canvas: &mut Canvas,
    Axes {
        x,
        y,
        horizontal_quantity: along,
        vertical_quantity: up,
    }: &Axes,
    left: f64,
) {
    let (edges, (bottom, top)) = (x.pixels, y.pixels);
    for tick in ticks(x.scale, x.range, 5) {
        let at = x.pixel(tick.position);
        canvas.segments(&[((at, bottom), (at, top))], GRID_STROKE);
        write_text(canvas, &tick.label, (at, bottom + 18.0), Anchor::Middle);
    }
    for tick in ticks(y.scale, y.range, 4) {
        let at = y.pixel(tick.position);
        canvas.segments(&[((edges.0, at), (edges.1, at))], GRID_STROKE);
        let base = (edges.0 - 7.0, at + 0.35 * TICK_SIZE_PX);
        write_text(canvas, &tick.label, base, Anchor::End);
    }
    let middle = y.pixel(0.0);
    canvas.segments(&[((edges.0, middle), (edges.1, middle))], FRAME_STROKE);
    draw_outline(canvas, edges, y.pixels);
    let below = ((edges.0 + edges.1) / 2.0, bottom + 38.0);
    draw_label(canvas, &along.label, below, 0.0);
    draw_label(
        canvas,
        &up.label,
        (left + 20.0, (top + bottom) / 2.0),
        -90.0,
    );
}
