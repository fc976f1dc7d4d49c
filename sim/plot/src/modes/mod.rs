//! Figures of natural modes: shapes of fields, and bars of the other coordinates.

mod amplitudes;
mod field;
mod styles;
mod types;

pub use types::{Bar, Mode, Modes, Shape};

use self::amplitudes::{BARS_WIDTH_PX, ROW_PX};
use self::field::FIELD_WIDTH_PX;
use super::PlotError;
use super::bars::{draw_title, write_text};
use super::canvas::{Anchor, Canvas};
use super::error::is_drawable;
use super::layout::TICK_SIZE_PX;
use super::lettering::truncate_to_width;

/// Minimum height of a frame in px, and space above it (title) and below it (ticks and label).
const FRAME_HEIGHT_PX: f64 = 110.0;
const SPACE_ABOVE_PX: f64 = 32.0;
const SPACE_BELOW_PX: f64 = 50.0;
/// Relative imaginary part above which the imaginary part is drawn.
const MIN_OUT_OF_PHASE_FRACTION: f64 = 0.02;

/// Draws modes as an SVG document.
///
/// # Errors
///
/// [`PlotError`] without modes, for a mode without content, and for numbers that cannot be drawn.
pub fn modes(of: &Modes) -> Result<String, PlotError> {
    let Some(first) = of.modes.first() else {
        return Err(PlotError::NoPanels);
    };
    for (panel, mode) in of.modes.iter().enumerate() {
        check_mode(panel, mode)?;
    }
    let bars = if first.bars.is_empty() {
        0.0
    } else {
        BARS_WIDTH_PX
    };
    let whole = (FIELD_WIDTH_PX * first.fields.len() as f64 + bars).max(560.0);
    let mut canvas = Canvas::default();
    let mut y = 24.0;
    draw_title(&mut canvas, &of.title, (16.0, y));
    for note in notes(of) {
        y += 20.0;
        let note = truncate_to_width(&note, TICK_SIZE_PX, whole - 32.0);
        write_text(&mut canvas, &note, (16.0, y), Anchor::Start);
    }
    y += 8.0;
    for mode in &of.modes {
        y = draw_mode(&mut canvas, mode, y);
    }
    Ok(canvas.document(&of.title, whole, y.ceil() + 4.0))
}

fn check_mode(panel: usize, mode: &Mode) -> Result<(), PlotError> {
    let empty = |series: &str| PlotError::Empty {
        panel,
        series: series.to_owned(),
    };
    if mode.fields.is_empty() && mode.bars.is_empty() {
        return Err(PlotError::NoSeries { panel });
    }
    for shape in &mode.fields {
        let (abscissae, values) = (shape.positions.len(), shape.amplitudes.len());
        if abscissae != values {
            return Err(PlotError::Lengths {
                panel,
                series: shape.name.clone(),
                abscissae,
                values,
            });
        }
        let numbers = shape.amplitudes.iter().flatten().chain(&shape.positions);
        if abscissae == 0 || !numbers.copied().all(is_drawable) {
            return Err(empty(&shape.name));
        }
    }
    let wrong = |bar: &&Bar| !bar.amplitude.into_iter().all(is_drawable);
    match mode.bars.iter().find(wrong) {
        Some(bar) => Err(empty(&bar.name)),
        None => Ok(()),
    }
}

fn notes(of: &Modes) -> impl Iterator<Item = String> {
    let later = of.modes.iter().any(has_out_of_phase_part);
    let said =
        "blue: in phase with the largest amplitude; orange, dashed: a quarter of a period later";
    let said = later.then(|| said.to_owned());
    of.notes.iter().cloned().chain(said)
}

/// Returns true if a part of a mode is out of phase with its largest amplitude.
fn has_out_of_phase_part(mode: &Mode) -> bool {
    let shapes = mode.fields.iter().flat_map(|shape| &shape.amplitudes);
    let all = || {
        shapes
            .clone()
            .chain(mode.bars.iter().map(|bar| &bar.amplitude))
    };
    let largest = all().fold(0.0, |most: f64, [re, im]| most.max(re.hypot(*im)));
    all().any(|[_, im]| im.abs() > MIN_OUT_OF_PHASE_FRACTION * largest)
}

fn draw_mode(canvas: &mut Canvas, mode: &Mode, top: f64) -> f64 {
    let later = has_out_of_phase_part(mode);
    let bars = ROW_PX.0 * mode.bars.len() as f64 + 8.0;
    let (upper, height) = (top + SPACE_ABOVE_PX, bars.max(FRAME_HEIGHT_PX));
    draw_title(canvas, &mode.title, (16.0, top + 22.0));
    let mut left = 0.0;
    for shape in &mode.fields {
        field::draw_field(canvas, shape, later, (left, upper, height));
        left += FIELD_WIDTH_PX;
    }
    if !mode.bars.is_empty() {
        amplitudes::draw_amplitudes(canvas, &mode.bars, later, (left, upper));
    }
    upper
        + if mode.fields.is_empty() {
            bars
        } else {
            height + SPACE_BELOW_PX
        }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mode(amplitude: [f64; 2]) -> Mode {
        Mode {
            title: "mode 1: 2 Hz".to_owned(),
            fields: vec![Shape {
                name: "w".to_owned(),
                unit: "m".to_owned(),
                position_name: "x".to_owned(),
                positions: vec![0.0, 0.5],
                amplitudes: vec![[0.0, 0.0], [2.0, 0.0]],
            }],
            bars: vec![Bar {
                name: "theta".to_owned(),
                unit: "rad".to_owned(),
                amplitude,
            }],
        }
    }

    fn draw_single_mode(mode: Mode) -> Result<String, PlotError> {
        modes(&Modes {
            modes: vec![mode],
            ..Modes::default()
        })
    }

    #[test]
    fn bar_has_number_with_sign_or_phase() {
        for (amplitude, number) in [
            ([0.25, 0.0], ">250 mrad<"),
            ([-0.25, 0.0], ">−250 mrad<"),
            ([1.0, 1e-9], ">1.00 rad<"),
            ([0.0, 0.012], ">12.0 mrad, 90°<"),
            ([0.0, -0.012], ">12.0 mrad, −90°<"),
            ([1e-9, 0.0], ">0<"),
        ] {
            let svg = draw_single_mode(mode(amplitude)).expect("a figure");
            assert!(svg.contains(number), "{number}: {svg}");
            let out_of_step = amplitude[1].abs() > 0.1;
            assert_eq!(svg.contains("orange"), out_of_step, "{amplitude:?}");
        }
    }

    #[test]
    fn empty_modes_are_an_error() {
        assert!(modes(&Modes::default()).is_err());
        assert!(draw_single_mode(Mode::default()).is_err());
        assert!(draw_single_mode(mode([f64::NAN, 0.0])).is_err());
        let mut short = mode([1.0, 0.0]);
        short.fields[0].positions.pop();
        assert!(draw_single_mode(short).is_err());
    }
}
