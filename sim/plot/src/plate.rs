//! Plates: frames side by side in rows, each with axes of its own, as journals set a time
//! history beside its power spectrum.

use super::axis::Scale;
use super::canvas::Canvas;
use super::error::{PlotError, check};
use super::figure::{Drawn, Panel, Reference};
use super::layout::{Abscissa, Format, Layout};
use super::panel;

/// Margins are wide enough for the usual labels, so that the frames of a column align.
const FORMAT: Format = Format {
    width: 580.0,
    frame: 210.0,
    ticks: (6, 6),
    margins: (82.0, 36.0),
    headroom: 0.0,
    overlaid: false,
    drawn: Drawn::Curve,
};
/// The share of a frame with marks that their names take.
const NAMES_OF_MARKS: f64 = 0.09;

/// Frames in rows.
#[derive(Clone, Debug, Default)]
pub struct Plate<'a> {
    /// What the plate shows, for those who cannot see it; not drawn.
    pub title: String,
    /// How many frames stand side by side; at least one.
    pub columns: usize,
    /// Row by row.
    pub frames: Vec<Frame<'a>>,
}

/// A panel with its own axes.
#[derive(Clone, Debug, Default)]
pub struct Frame<'a> {
    /// What is drawn.
    pub panel: Panel<'a>,
    /// What it is drawn over, and how.
    pub axes: Axes,
    /// Upright lines with their names, natural frequencies say; abscissae in SI, ascending.
    pub marks: Vec<Reference>,
    /// Whether curves may lie on each other: then each later one is dashed, and what is below
    /// shows through.
    pub overlaid: bool,
    /// What is drawn through the samples.
    pub drawn: Drawn,
}

/// The axes of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Axes {
    /// A quantity over time in s.
    #[default]
    Time,
    /// The logarithm of a positive quantity over time in s.
    Growth,
    /// A density over frequency in Hz, both logarithmic.
    Frequency,
    /// The logarithm of a positive quantity over a number with this name.
    Count(&'static str),
    /// A quantity over another.
    Quantity {
        /// The other's name.
        symbol: &'static str,
        /// Its SI unit; empty for a number.
        unit: &'static str,
    },
}

impl Axes {
    fn scales(self) -> (Abscissa, Scale) {
        let (symbol, unit, along, up) = match self {
            Self::Time => ("t", "s", Scale::Linear, Scale::Linear),
            Self::Growth => ("t", "s", Scale::Linear, Scale::Logarithmic),
            Self::Frequency => ("f", "Hz", Scale::Logarithmic, Scale::Logarithmic),
            Self::Count(name) => (name, "", Scale::Linear, Scale::Logarithmic),
            Self::Quantity { symbol, unit } => (symbol, unit, Scale::Linear, Scale::Linear),
        };
        let abscissa = Abscissa {
            symbol,
            unit,
            scale: along,
        };
        (abscissa, up)
    }
}

/// Draws a plate as an SVG document, 580 px wide for each column.
///
/// # Errors
///
/// As for [`super::time_history`], panels counted row by row.
pub fn plate(plate: &Plate<'_>) -> Result<String, PlotError> {
    let panels: Vec<Panel<'_>> = plate.frames.iter().map(|f| f.panel.clone()).collect();
    check(&panels, |place| {
        plate.frames.get(place).map_or(Drawn::Curve, |f| f.drawn)
    })?;
    let columns = plate.columns.max(1);
    let mut canvas = Canvas::default();
    let mut top = 0.0;
    for row in plate.frames.chunks(columns) {
        let mut height = 0.0_f64;
        for (column, frame) in row.iter().enumerate() {
            let (drawing, tall) = draw(frame)?;
            canvas.place(drawing, (column as f64 * FORMAT.width, top));
            height = height.max(tall);
        }
        top += height;
    }
    let width = FORMAT.width * columns as f64;
    Ok(canvas.document(&plate.title, width, top))
}

/// A frame by itself, and its height.
fn draw(frame: &Frame<'_>) -> Result<(Canvas, f64), PlotError> {
    let (abscissa, scale) = frame.axes.scales();
    let panels = std::slice::from_ref(&frame.panel);
    let format = Format {
        headroom: match frame.marks.as_slice() {
            [] => 0.0,
            _ => NAMES_OF_MARKS,
        },
        overlaid: frame.overlaid,
        drawn: frame.drawn,
        ..FORMAT
    };
    let layout = Layout::new(panels, &abscissa, scale, format)?;
    let mut canvas = Canvas::default();
    for place in &layout.places {
        panel::draw_marks(&mut canvas, &frame.marks, place, &layout);
        panel::draw(&mut canvas, &frame.panel, place, &layout);
        panel::name_marks(&mut canvas, &frame.marks, place, &layout);
    }
    panel::draw_abscissa(&mut canvas, &layout);
    Ok((canvas, layout.height))
}
