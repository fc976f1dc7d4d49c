//! Colours of values, and the colour bar.

use super::frame::{Frame, TICK_LENGTH_PX, draw_cell_outline, widest_label};
use super::types::{Colour, GREY, Map, Shades, WHITE, empty_error, hexadecimal};
use crate::axis::{Range, Scale, Tick, ticks};
use crate::bars::{draw_label, write_text};
use crate::canvas::{Anchor, Canvas, FRAME_STROKE};
use crate::error::{PlotError, is_drawable};
use crate::layout::{LABEL_SIZE_PX, TICK_SIZE_PX};
use crate::lettering::truncate_to_width;
use crate::quantity::Quantity;
use crate::rendering::encode_png;

/// Viridis by S. van der Walt and N. Smith, at steps of a tenth.
const VIRIDIS: [Colour; 11] = [
    [0x44, 0x01, 0x54],
    [0x48, 0x24, 0x75],
    [0x41, 0x44, 0x87],
    [0x35, 0x5f, 0x8d],
    [0x2a, 0x78, 0x8e],
    [0x21, 0x91, 0x8c],
    [0x22, 0xa8, 0x84],
    [0x44, 0xbf, 0x70],
    [0x7a, 0xd1, 0x51],
    [0xbd, 0xdf, 0x26],
    [0xfd, 0xe7, 0x25],
];
/// C. Brewer's RdBu, from blue over white to red.
const BLUE_TO_RED: [Colour; 11] = [
    [0x05, 0x30, 0x61],
    [0x21, 0x66, 0xac],
    [0x43, 0x93, 0xc3],
    [0x92, 0xc5, 0xde],
    [0xd1, 0xe5, 0xf0],
    WHITE,
    [0xfd, 0xdb, 0xc7],
    [0xf4, 0xa5, 0x82],
    [0xd6, 0x60, 0x4d],
    [0xb2, 0x18, 0x2b],
    [0x67, 0x00, 0x1f],
];
/// Ratio of the largest magnitudes on the two sides of zero below which the smaller side is rounding noise.
const MAX_NOISE_RATIO: f64 = 1e-6;
/// Ratio of the largest magnitudes on the two sides of zero above which each side has a separate scale.
const MIN_LOPSIDED_RATIO: f64 = 3.0;

/// Distances from the frame to the bar and from the bar to its labels, in px.
const BAR_GAP_PX: f64 = 28.0;
const LABEL_GAP: f64 = TICK_LENGTH_PX + 6.0;
/// Width of the colour bar, in px.
const BAR_WIDTH_PX: f64 = 24.0;
/// Space for the name of the quantity next to the labels, in px.
const LABEL_SPACE_PX: f64 = 34.0;

/// Colour scale of a map with its colour bar.
#[derive(Debug)]
pub struct Bar {
    shades: Shades,
    quantity: Quantity,
    /// Values at the ends, in the unit of the quantity. Zero is in the middle of a signed scale.
    range: Range,
    ticks: Vec<Tick>,
    has_gaps: bool,
}

impl Bar {
    /// Creates the colour scale for the values of a map. Returns an error if no value can be drawn.
    pub fn new(map: &Map<'_>) -> Result<Self, PlotError> {
        let drawable = map.values.iter().filter(|value| is_drawable(**value));
        let found =
            Range::from_positions(drawable.copied()).ok_or_else(|| empty_error(&map.quantity))?;
        let range = match map.shades {
            Shades::Sequential => found.widen_point(),
            Shades::Signed => widen_around_zero(found),
        };
        // Both sides of zero must be readable in the same unit, even if their magnitudes differ.
        let magnitude = match map.shades {
            Shades::Sequential => found.high.abs().max(found.low.abs()),
            Shades::Signed => (-range.low).sqrt() * range.high.sqrt(),
        };
        let quantity = Quantity::with_prefix(&map.quantity, &map.unit, magnitude);
        let range = Range {
            low: range.low / quantity.scale,
            high: range.high / quantity.scale,
        };
        let ticks = match map.shades {
            Shades::Sequential => ticks(Scale::Linear, range, 7),
            Shades::Signed => signed_ticks(range),
        };
        Ok(Self {
            shades: map.shades,
            quantity,
            range,
            ticks,
            has_gaps: map.values.iter().any(|value| !is_drawable(*value)),
        })
    }

    /// Returns the colour of a value in SI units; `None` if it cannot be drawn.
    pub fn colour(&self, value: f64) -> Option<Colour> {
        let share = self.position_on_bar(value / self.quantity.scale);
        is_drawable(value).then(|| self.colour_at(share))
    }

    /// Returns the width of the colour bar with its labels, in px.
    pub fn width(&self) -> f64 {
        BAR_GAP_PX + BAR_WIDTH_PX + LABEL_GAP + widest_label(&self.ticks) + LABEL_SPACE_PX
    }

    /// Returns the position of a value on the colour bar, from 0 at its lower end to 1.
    fn position_on_bar(&self, value: f64) -> f64 {
        let Range { low, high } = self.range;
        match self.shades {
            Shades::Sequential => (value - low) / (high - low),
            Shades::Signed if value < 0.0 => 0.5 - 0.5 * value / low,
            Shades::Signed => 0.5 + 0.5 * value / high,
        }
    }

    fn colour_at(&self, share: f64) -> Colour {
        match self.shades {
            Shades::Sequential => interpolate_colour(&VIRIDIS, share),
            Shades::Signed => interpolate_colour(&BLUE_TO_RED, share),
        }
    }

    /// Draws the colour bar to the right of a frame.
    pub fn draw(&self, canvas: &mut Canvas, frame: &Frame) -> Result<(), PlotError> {
        let (left, (bottom, top)) = (
            frame.horizontal_pixels().1 + BAR_GAP_PX,
            frame.vertical_pixels(),
        );
        let (right, height) = (left + BAR_WIDTH_PX, bottom - top);
        let colours = (0..height as u32).map(|row| {
            let from_top = (f64::from(row) + 0.5) / height;
            self.colour_at(1.0 - from_top)
        });
        let bytes: Vec<u8> = colours.flatten().collect();
        let png = encode_png((1, height as u32), png::ColorType::Rgb, &bytes)?;
        canvas.image((left, top), (BAR_WIDTH_PX, height), &png);
        draw_cell_outline(canvas, (left, right), (bottom, top));
        let mut marks = Vec::with_capacity(self.ticks.len());
        for tick in &self.ticks {
            let y = bottom - self.position_on_bar(tick.position) * height;
            let middle = y.floor() + 0.5;
            marks.push(((right, middle), (right + TICK_LENGTH_PX, middle)));
            let at = (right + LABEL_GAP, y + 0.35 * TICK_SIZE_PX);
            write_text(canvas, &tick.label, at, Anchor::Start);
        }
        canvas.segments(&marks, FRAME_STROKE);
        let name = truncate_to_width(&self.quantity.label, LABEL_SIZE_PX, height);
        let beyond = right + LABEL_GAP + widest_label(&self.ticks) + 22.0;
        draw_label(canvas, &name, (beyond, (top + bottom) / 2.0), -90.0);
        if self.has_gaps {
            draw_gap_key(canvas, (left, bottom + 16.0));
        }
        Ok(())
    }
}

fn draw_gap_key(canvas: &mut Canvas, (left, top): (f64, f64)) {
    let (right, bottom) = (left + BAR_WIDTH_PX, top + 16.0);
    canvas.rectangle(
        (left, top),
        (right - left, bottom - top),
        &hexadecimal(GREY),
    );
    draw_cell_outline(canvas, (left, right), (bottom, top));
    let at = (right + LABEL_GAP, bottom - 3.0);
    write_text(canvas, "no value", at, Anchor::Start);
}

/// Returns a range around zero: symmetric, unless one side is much larger.
fn widen_around_zero(found: Range) -> Range {
    let (below, above) = (-found.low.min(0.0), found.high.max(0.0));
    let (less, more) = (below.min(above), below.max(above));
    if more < 1e-100 {
        return Range {
            low: -1.0,
            high: 1.0,
        };
    }
    // A side without values gets the range of the other side, so half of the bar is unused.
    if less < MAX_NOISE_RATIO * more || more <= MIN_LOPSIDED_RATIO * less {
        return Range {
            low: -more,
            high: more,
        };
    }
    Range {
        low: -below,
        high: above,
    }
}

fn signed_ticks(range: Range) -> Vec<Tick> {
    let lower = Range { high: 0.0, ..range };
    let upper = Range { low: 0.0, ..range };
    let below = ticks(Scale::Linear, lower, 4).into_iter();
    below
        .filter(|tick| tick.position < 0.0)
        .chain(ticks(Scale::Linear, upper, 4))
        .collect()
}

fn interpolate_colour(colours: &[Colour; 11], share: f64) -> Colour {
    let along = 10.0 * share.clamp(0.0, 1.0);
    let below = (along.floor() as usize).min(9);
    match colours.get(below..) {
        Some([low, high, ..]) => mix_colours(*low, *high, along - below as f64),
        _ => GREY,
    }
}

fn mix_colours(under: Colour, over: Colour, share: f64) -> Colour {
    let mut mixture = under;
    for (channel, over) in mixture.iter_mut().zip(over) {
        let (low, high) = (f64::from(*channel), f64::from(over));
        *channel = (low + share.clamp(0.0, 1.0) * (high - low)).round() as u8;
    }
    mixture
}
