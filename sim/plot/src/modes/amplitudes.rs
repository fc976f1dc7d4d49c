//! Bars of amplitudes with names and numbers.

use super::styles::{IN_PHASE_COLOUR, OUT_OF_PHASE_COLOUR};
use super::types::Bar;
use crate::axis::{Axis, Range, Scale};
use crate::bars::{draw_outline, write_text};
use crate::canvas::{Anchor, Canvas, FRAME_STROKE, GRID_STROKE};
use crate::layout::TICK_SIZE_PX;
use crate::lettering::{text_width, truncate_to_width};
use crate::quantity::scaled_unit;

/// Width of the bars with their names and numbers, in px.
pub(super) const BARS_WIDTH_PX: f64 = 420.0;
/// Distance between rows and height of a bar, in px.
pub(super) const ROW_PX: (f64, f64) = (21.0, 13.0);
/// Amplitudes below this value are shown as 0.
const MIN_SHOWN_AMPLITUDE: f64 = 5e-5;

pub(super) fn draw_amplitudes(
    canvas: &mut Canvas,
    bars: &[Bar],
    later: bool,
    (left, top): (f64, f64),
) {
    let names = bars.iter().map(|bar| text_width(&bar.name, TICK_SIZE_PX));
    let widest = names.fold(0.0, f64::max).min(130.0);
    let edges = (left + widest + 24.0, left + BARS_WIDTH_PX - 130.0);
    let x = Axis {
        scale: Scale::Linear,
        range: Range {
            low: -1.04,
            high: 1.04,
        },
        pixels: edges,
    };
    let bottom = top + ROW_PX.0 * bars.len() as f64 + 4.0;
    for end in [-1.0, 0.0, 1.0] {
        let at = x.pixel(end);
        let line = if end == 0.0 {
            FRAME_STROKE
        } else {
            GRID_STROKE
        };
        canvas.segments(&[((at, bottom), (at, top))], line);
    }
    for (index, bar) in bars.iter().enumerate() {
        let y = top + 5.0 + ROW_PX.0 * index as f64;
        let base = y + 0.5 * ROW_PX.1 + 0.36 * TICK_SIZE_PX;
        let name = truncate_to_width(&bar.name, TICK_SIZE_PX, 130.0);
        write_text(canvas, &name, (edges.0 - 8.0, base), Anchor::End);
        let [re, im] = bar
            .amplitude
            .map(|part| part / full_bar_amplitude(bars, &bar.unit));
        let mut fill = |value: f64, (from, tall): (f64, f64), colour| {
            let (zero, end) = (x.pixel(0.0), x.pixel(value));
            canvas.rectangle((zero.min(end), from), ((end - zero).abs(), tall), colour);
        };
        if later {
            fill(re, (y, 0.55 * ROW_PX.1), IN_PHASE_COLOUR);
            fill(
                -im,
                (y + 0.6 * ROW_PX.1, 0.4 * ROW_PX.1),
                OUT_OF_PHASE_COLOUR,
            );
        } else {
            fill(re, (y, ROW_PX.1), IN_PHASE_COLOUR);
        }
        write_text(
            canvas,
            &format_amplitude(bar),
            (edges.1 + 8.0, base),
            Anchor::Start,
        );
    }
    draw_outline(canvas, edges, (bottom, top));
}

/// Returns the amplitude that a bar of full length represents, for this unit.
fn full_bar_amplitude(bars: &[Bar], unit: &str) -> f64 {
    let alike = bars.iter().filter(|bar| bar.unit == unit);
    let sizes = alike.map(|bar| bar.amplitude[0].hypot(bar.amplitude[1]));
    sizes.fold(1.0, f64::max)
}

/// Returns the text for the amplitude of a bar, with its phase unless it is 0 or 180 degrees.
fn format_amplitude(bar: &Bar) -> String {
    let [re, im] = bar.amplitude;
    let size = re.hypot(im);
    if size < MIN_SHOWN_AMPLITUDE {
        return "0".to_owned();
    }
    let (scale, unit) = scaled_unit(&bar.unit, size);
    let (shown, phase) = (size / scale, im.atan2(re).to_degrees().round());
    let decimals = 2_usize.saturating_sub(shown.log10().max(0.0) as usize);
    let (sign, phase) = match phase {
        phase if phase.abs() >= 180.0 => ("−", String::new()),
        0.0 => ("", String::new()),
        phase => ("", format!(", {phase}°").replace('-', "−")),
    };
    format!("{sign}{shown:.decimals$} {unit}")
        .trim_end()
        .to_owned()
        + &phase
}
