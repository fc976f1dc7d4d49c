//! Positions of frames, labels and legends. All frames of a figure have the same edges.

use super::axis::{Axis, Range, Scale, Tick, ticks};
use super::error::{PlotError, is_drawable};
use super::figure::{FigureWidth, Panel, Series, SeriesStyle};
use super::lettering::{text_width, truncate_to_width, wrap_label, wrap_to_width};
use super::quantity::Quantity;

/// Widths of figures, in px.
const WIDE_PX: f64 = 900.0;
const NARROW_PX: f64 = 330.0;
pub(super) const TICK_SIZE_PX: f64 = 14.0;
pub(super) const LABEL_SIZE_PX: f64 = 15.0;
pub(super) const TITLE_SIZE_PX: f64 = 16.0;
/// Length of the line in a legend entry, in px.
pub(super) const LEGEND_LINE_PX: f64 = 22.0;
pub(super) const LEGEND_ROW_PX: f64 = 20.0;

const TITLE_ROW_PX: f64 = 24.0;
const TICK_MARGIN_PX: f64 = 36.0;
/// Line spacing of labels, in px.
pub(super) const LABEL_ROW_PX: f64 = 18.0;
const LARGEST_REFERENCE_LABEL: f64 = 110.0;
const LARGEST_LEGEND_LABEL: f64 = 260.0;
/// Maximum number of characters for the curves of a figure, and number of characters for the four points of a
/// pixel column.
const MAX_CURVE_CHARACTERS: f64 = 180_000.0;
const COLUMN_CHARACTERS: f64 = 60.0;

#[derive(Clone, Copy, Debug)]
pub(super) struct Abscissa {
    pub symbol: &'static str,
    pub unit: &'static str,
    pub scale: Scale,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Format {
    /// Width of the figure, in px.
    pub width: f64,
    /// Height of a frame, in px.
    pub frame: f64,
    pub ticks: (usize, usize),
    /// Minimum margins to the left and right of the frame, in px.
    pub margins: (f64, f64),
    /// Fraction of a frame's height that is reserved at the top for names of marks.
    pub headroom_fraction: f64,
    /// True if later curves are dashed, so that covered curves are visible.
    pub is_overlaid: bool,
    pub style: SeriesStyle,
}

impl Format {
    /// Returns the format of panels over one axis in a figure of this width.
    pub fn stacked(panels: usize, width: FigureWidth) -> Self {
        let (frame, up): (f64, usize) = match panels {
            1 => (300.0, 7),
            2 => (200.0, 6),
            _ => (150.0, 5),
        };
        let (width, frame, along) = match width {
            FigureWidth::Wide => (WIDE_PX, frame, 8),
            FigureWidth::Narrow => (NARROW_PX, frame.min(170.0), 4),
        };
        Self {
            width,
            frame,
            ticks: (along, up),
            margins: (0.0, 22.0),
            headroom_fraction: 0.0,
            is_overlaid: false,
            style: SeriesStyle::Curve,
        }
    }
}

#[derive(Debug)]
pub(super) struct Layout {
    pub abscissa: Axis,
    pub abscissa_quantity: Quantity,
    pub abscissa_ticks: Vec<Tick>,
    pub geometries: Vec<PanelGeometry>,
    pub width: f64,
    pub height: f64,
    /// Left end of the titles: that of the frames; in a narrow figure that of the figure.
    pub title_edge: f64,
    /// Width of the pixel columns for the decimation of curves.
    pub column: f64,
    pub is_overlaid: bool,
    pub style: SeriesStyle,
}

#[derive(Debug)]
pub(super) struct PanelGeometry {
    pub ordinate: Axis,
    pub quantity: Quantity,
    pub ticks: Vec<Tick>,
    /// Lines of the title with the positions of their base lines.
    pub title: Vec<(f64, String)>,
    pub legend: Vec<((f64, f64), String)>,
}

#[derive(Debug)]
struct Ordinate {
    range: Range,
    quantity: Quantity,
    ticks: Vec<Tick>,
}

impl Layout {
    pub fn new(
        panels: &[Panel<'_>],
        abscissa: &Abscissa,
        scale: Scale,
        format: Format,
    ) -> Result<Self, PlotError> {
        let (along, up) = (format.ticks.0, (format.ticks.1, format.headroom_fraction));
        let ordinates = panels
            .iter()
            .enumerate()
            .map(|(index, panel)| Ordinate::new(index, panel, (abscissa.scale, scale), up))
            .collect::<Result<Vec<_>, _>>()?;
        let (range, quantity) = shared_range(panels, abscissa);
        let range = match format.style {
            SeriesStyle::Curve => range,
            SeriesStyle::Orbit | SeriesStyle::Points => range.pad(0.04),
        };
        let edges = (left_edge(&ordinates, format), right_edge(panels, format));
        let axis = Axis {
            scale: abscissa.scale,
            range,
            pixels: edges,
        };
        let title_edge = if format.width > NARROW_PX {
            edges.0
        } else {
            6.0
        };
        let mut top = 6.0;
        let mut geometries = Vec::with_capacity(panels.len());
        for (panel, ordinate) in panels.iter().zip(ordinates) {
            let geometry = PanelGeometry::new(
                (panel, ordinate),
                scale,
                (top, format.frame),
                (title_edge, edges),
            );
            top = geometry.ordinate.pixels.0 + 16.0;
            geometries.push(geometry);
        }
        let curves: usize = panels.iter().map(|panel| panel.series.len()).sum();
        let span = edges.1 - edges.0;
        Ok(Self {
            abscissa: axis,
            abscissa_quantity: quantity,
            abscissa_ticks: ticks(abscissa.scale, range, along),
            geometries,
            width: format.width,
            title_edge,
            height: (top + 40.0).ceil(),
            column: (span * COLUMN_CHARACTERS * curves as f64 / MAX_CURVE_CHARACTERS).max(1.0),
            is_overlaid: format.is_overlaid,
            style: format.style,
        })
    }
}

impl Ordinate {
    /// Returns the vertical axis of a panel from its scales, number of ticks and space at the top.
    fn new(
        index: usize,
        panel: &Panel<'_>,
        (along, scale): (Scale, Scale),
        (marks, headroom): (usize, f64),
    ) -> Result<Self, PlotError> {
        for series in &panel.series {
            if drawable_values(series, along, scale).next().is_none() {
                return Err(PlotError::Empty {
                    panel: index,
                    series: series.label.clone(),
                });
            }
        }
        let references = panel.references.iter().map(|reference| reference.value);
        let values = || {
            let curves = panel
                .series
                .iter()
                .flat_map(|s| drawable_values(s, along, scale));
            curves.chain(references.clone().filter(|value| is_drawable(*value)))
        };
        let quantity = match scale {
            Scale::Linear => {
                let largest = values().fold(0.0, |largest: f64, value| largest.max(value.abs()));
                Quantity::with_prefix(&panel.quantity, &panel.unit, largest)
            }
            Scale::Logarithmic => Quantity::without_prefix(&panel.quantity, &panel.unit),
        };
        let positions = values().map(|value| scale.to_position(value / quantity.scale));
        let range = Range::from_positions(positions).map_or(
            Range {
                low: 0.0,
                high: 1.0,
            },
            |range| range.widen_point().pad(0.05).pad_top(headroom),
        );
        Ok(Self {
            range,
            ticks: ticks(scale, range, marks),
            quantity,
        })
    }
}

impl PanelGeometry {
    /// Computes the positions of a panel from `(top, frame height)`, the left end of titles, and the left and
    /// right `edges`.
    fn new(
        (panel, ordinate): (&Panel<'_>, Ordinate),
        scale: Scale,
        (top, frame): (f64, f64),
        (title_edge, edges): (f64, (f64, f64)),
    ) -> Self {
        let lines = wrap_to_width(&panel.title, TITLE_SIZE_PX, edges.1 - title_edge);
        let title: Vec<(f64, String)> = (1..)
            .zip(lines)
            .map(|(row, line)| (top + f64::from(row) * TITLE_ROW_PX - 8.0, line))
            .collect();
        let title_rows = (TITLE_ROW_PX * title.len() as f64).max(6.0);
        let legend = legend(panel, top + title_rows, (title_edge, edges.1));
        let legend_rows = legend
            .last()
            .map_or(0.0, |((_, y), _)| y + 8.0 - (top + title_rows));
        let frame_top = top + title_rows + legend_rows;
        Self {
            ordinate: Axis {
                scale,
                range: ordinate.range,
                pixels: (frame_top + frame, frame_top),
            },
            quantity: ordinate.quantity,
            ticks: ordinate.ticks,
            title,
            legend,
        }
    }
}

fn drawable_values(series: &Series<'_>, along: Scale, scale: Scale) -> impl Iterator<Item = f64> {
    series
        .abscissa
        .iter()
        .zip(series.values)
        .filter(move |(at, value)| {
            along.to_position(**at).is_finite()
                && is_drawable(**value)
                && scale.to_position(**value).is_finite()
        })
        .map(|(_, value)| *value)
}

fn shared_range(panels: &[Panel<'_>], abscissa: &Abscissa) -> (Range, Quantity) {
    let all = || {
        let series = panels.iter().flat_map(|panel| &panel.series);
        series.flat_map(|series| series.abscissa.iter().copied())
    };
    let quantity = match abscissa.scale {
        Scale::Linear => {
            let largest = all().fold(0.0, |largest: f64, value| largest.max(value.abs()));
            Quantity::with_prefix(abscissa.symbol, abscissa.unit, largest)
        }
        Scale::Logarithmic => Quantity::without_prefix(abscissa.symbol, abscissa.unit),
    };
    let positions = all().map(|value| abscissa.scale.to_position(value / quantity.scale));
    let range = Range::from_positions(positions).unwrap_or(Range {
        low: 0.0,
        high: 1.0,
    });
    (range.widen_point(), quantity)
}

fn left_edge(ordinates: &[Ordinate], format: Format) -> f64 {
    let labels = ordinates.iter().flat_map(|ordinate| &ordinate.ticks);
    let widest = labels
        .map(|tick| text_width(&tick.label, TICK_SIZE_PX))
        .fold(0.0, f64::max);
    let lines = ordinates
        .iter()
        .map(|ordinate| wrap_label(&ordinate.quantity.label, LABEL_SIZE_PX, format.frame).len())
        .max();
    let more = lines.map_or(0, |lines| lines.saturating_sub(1));
    (TICK_MARGIN_PX + LABEL_ROW_PX * more as f64 + widest).max(format.margins.0)
}

fn right_edge(panels: &[Panel<'_>], format: Format) -> f64 {
    let references = panels.iter().flat_map(|panel| &panel.references);
    let widest = references
        .map(|reference| text_width(&reference_label(&reference.label), TICK_SIZE_PX))
        .fold(0.0, f64::max);
    format.width - (widest + 10.0).max(format.margins.1)
}

pub(super) fn reference_label(label: &str) -> String {
    truncate_to_width(label, TICK_SIZE_PX, LARGEST_REFERENCE_LABEL)
}

fn legend(panel: &Panel<'_>, top: f64, edges: (f64, f64)) -> Vec<((f64, f64), String)> {
    if panel.series.len() < 2 {
        return Vec::new();
    }
    let mut at = (edges.0, top + 11.0);
    let mut entries = Vec::with_capacity(panel.series.len());
    for series in &panel.series {
        let label = truncate_to_width(&series.label, TICK_SIZE_PX, LARGEST_LEGEND_LABEL);
        let entry = LEGEND_LINE_PX + 6.0 + text_width(&label, TICK_SIZE_PX);
        if at.0 > edges.0 && at.0 + entry > edges.1 {
            at = (edges.0, at.1 + LEGEND_ROW_PX);
        }
        entries.push((at, label));
        at.0 += entry + 14.0;
    }
    entries
}
