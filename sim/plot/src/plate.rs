//! Plates: rows of frames with separate axes, for example a time history next to its spectrum.

use super::axis::Scale;
use super::canvas::Canvas;
use super::error::{PlotError, check_panels};
use super::figure::{FigureWidth, Panel, Reference, SeriesStyle};
use super::layout::{Abscissa, Format, Layout};
use super::panel;

/// Format of a frame. The margins fit the usual labels, so that the frames of a column align.
const FORMAT: Format = Format {
    width: 580.0,
    frame: 210.0,
    ticks: (6, 6),
    margins: (82.0, 36.0),
    headroom_fraction: 0.0,
    is_overlaid: false,
    style: SeriesStyle::Curve,
};
/// Format of a frame in a narrow figure, which has one column.
const NARROW_FORMAT: Format = Format {
    width: 330.0,
    frame: 190.0,
    ticks: (4, 6),
    margins: (0.0, 22.0),
    ..FORMAT
};
/// Fraction of a frame's height for the names of marks.
const NAMES_OF_MARKS: f64 = 0.09;

/// Frames in rows.
#[derive(Clone, Debug, Default)]
pub struct Plate<'a> {
    /// Description for screen readers; not drawn.
    pub title: String,
    /// Number of frames in a row, at least one.
    pub columns: usize,
    /// Frames, row by row.
    pub frames: Vec<Frame<'a>>,
}

/// Panel with separate axes.
#[derive(Clone, Debug, Default)]
pub struct Frame<'a> {
    /// Content of the frame.
    pub panel: Panel<'a>,
    /// Kind of the axes.
    pub axes: Axes,
    /// Vertical lines with names, for example natural frequencies; abscissae in SI, ascending.
    pub marks: Vec<Reference>,
    /// True if curves can overlap; later ones are then dashed.
    pub is_overlaid: bool,
    /// Style of the series.
    pub style: SeriesStyle,
}

/// Axes of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Axes {
    /// Quantity over time in s.
    #[default]
    Time,
    /// Logarithm of a positive quantity over time in s.
    Growth,
    /// Density over frequency in Hz, both logarithmic.
    Frequency,
    /// Logarithm of a positive quantity over a count with this name.
    Count(&'static str),
    /// Quantity over another quantity.
    Quantity {
        /// Name of the other quantity.
        symbol: &'static str,
        /// SI unit of the other quantity; empty for a dimensionless number.
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

/// Draws a plate as an SVG document with 580 px per column.
///
/// # Errors
///
/// Same as [`super::time_history`], with panels counted row by row.
pub fn plate(plate: &Plate<'_>) -> Result<String, PlotError> {
    plate_at(plate, FigureWidth::Wide)
}

/// Draws a plate like [`plate`], with a given width; a narrow plate has one column.
///
/// # Errors
///
/// Same as [`super::time_history`], with panels counted row by row.
pub fn plate_at(plate: &Plate<'_>, width: FigureWidth) -> Result<String, PlotError> {
    let panels: Vec<Panel<'_>> = plate.frames.iter().map(|f| f.panel.clone()).collect();
    check_panels(&panels, |index| {
        plate
            .frames
            .get(index)
            .map_or(SeriesStyle::Curve, |f| f.style)
    })?;
    let (columns, format) = match width {
        FigureWidth::Wide => (plate.columns.max(1), FORMAT),
        FigureWidth::Narrow => (1, NARROW_FORMAT),
    };
    let mut canvas = Canvas::default();
    let mut top = 0.0;
    for row in plate.frames.chunks(columns) {
        let mut height = 0.0_f64;
        for (column, frame) in row.iter().enumerate() {
            let (drawing, tall) = draw_frame(frame, format)?;
            canvas.insert(drawing, (column as f64 * format.width, top));
            height = height.max(tall);
        }
        top += height;
    }
    let width = format.width * columns as f64;
    Ok(canvas.document(&plate.title, width, top))
}

fn draw_frame(frame: &Frame<'_>, format: Format) -> Result<(Canvas, f64), PlotError> {
    let (abscissa, scale) = frame.axes.scales();
    let panels = std::slice::from_ref(&frame.panel);
    let format = Format {
        headroom_fraction: match frame.marks.as_slice() {
            [] => 0.0,
            _ => NAMES_OF_MARKS,
        },
        is_overlaid: frame.is_overlaid,
        style: frame.style,
        ..format
    };
    let layout = Layout::new(panels, &abscissa, scale, format)?;
    let mut canvas = Canvas::default();
    for geometry in &layout.geometries {
        panel::draw_marks(&mut canvas, &frame.marks, geometry, &layout);
        panel::draw_panel(&mut canvas, &frame.panel, geometry, &layout);
        panel::name_marks(&mut canvas, &frame.marks, geometry, &layout);
    }
    panel::draw_abscissa(&mut canvas, &layout);
    Ok((canvas, layout.height))
}
