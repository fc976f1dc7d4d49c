//! Drawing of one panel and of the shared horizontal axis.

use super::axis::{Axis, Scale, Tick};
use super::canvas::{Anchor, Canvas, FRAME_STROKE, GRID_STROKE, Stroke, Text};
use super::decimate::{Point, polylines, separate_points, thin_orbit};
use super::error::is_drawable;
use super::figure::{Panel, Reference, Series, SeriesRole, SeriesStyle};
use super::layout::{
    LABEL_ROW_PX, LABEL_SIZE_PX, LEGEND_LINE_PX, LEGEND_ROW_PX, Layout, PanelGeometry,
    TICK_SIZE_PX, TITLE_SIZE_PX, reference_label,
};
use super::lettering::{text_width, wrap_label};

/// Colours of Okabe and Ito for colour-blind readers, without the pale yellow.
const COLOURS: [&str; 7] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000",
];
/// Dashes distinguish curves after all colours are used, and overlapping curves.
const DASHES: [&str; 3] = ["", "7 3", "2 3"];

const MEASURED_STROKE: Stroke = Stroke::new("#b9c2ca", 4.5, "");
const REFERENCE_STROKE: Stroke = Stroke::new("#6a6a6a", 1.1, "6 4");
const MARK_STROKE: Stroke = Stroke::new("#8a8a8a", 0.9, "2 3");

pub(super) fn draw_panel(
    canvas: &mut Canvas,
    panel: &Panel<'_>,
    geometry: &PanelGeometry,
    layout: &Layout,
) {
    draw_grid(canvas, geometry, layout);
    draw_references(canvas, panel, geometry, layout);
    for (index, series) in panel.series.iter().enumerate() {
        let samples = samples(series, geometry, layout);
        let lines = match layout.style {
            SeriesStyle::Curve => polylines(samples, layout.column),
            SeriesStyle::Orbit => thin_orbit(samples),
            SeriesStyle::Points => separate_points(samples),
        };
        canvas.lines(&lines, curve_stroke((index, series.role), layout));
    }
    draw_frame(canvas, geometry, layout);
    draw_text(canvas, panel, geometry, layout);
}

pub(super) fn draw_marks(
    canvas: &mut Canvas,
    marks: &[Reference],
    geometry: &PanelGeometry,
    layout: &Layout,
) {
    let (bottom, top) = geometry.ordinate.pixels;
    for (x, _) in visible_marks(marks, layout) {
        canvas.segments(&[((x, bottom), (x, top))], MARK_STROKE);
    }
}

/// Writes the names of vertical lines at the top, if there is space.
pub(super) fn name_marks(
    canvas: &mut Canvas,
    marks: &[Reference],
    geometry: &PanelGeometry,
    layout: &Layout,
) {
    let (_, top) = geometry.ordinate.pixels;
    let mut free_from = f64::NEG_INFINITY;
    for (x, name) in visible_marks(marks, layout) {
        if x < free_from {
            continue;
        }
        free_from = x + text_width(name, TICK_SIZE_PX) + 6.0;
        canvas.text(Text {
            text: name,
            position: (x + 3.0, top + TICK_SIZE_PX),
            size: TICK_SIZE_PX,
            anchor: Anchor::Start,
            is_bold: false,
        });
    }
}

fn visible_marks<'a>(
    marks: &'a [Reference],
    layout: &'a Layout,
) -> impl Iterator<Item = (f64, &'a str)> {
    let (axis, unit) = (&layout.abscissa, layout.abscissa_quantity.scale);
    let positions = marks
        .iter()
        .filter(|mark| is_drawable(mark.value))
        .map(move |mark| (axis.scale.to_position(mark.value / unit), &*mark.label));
    let reached =
        positions.filter(|(position, _)| (axis.range.low..=axis.range.high).contains(position));
    reached.map(|(position, name)| (axis.pixel(position), name))
}

pub(super) fn draw_abscissa(canvas: &mut Canvas, layout: &Layout) {
    let Some(last) = layout.geometries.last() else {
        return;
    };
    let (bottom, _) = last.ordinate.pixels;
    for tick in &layout.abscissa_ticks {
        canvas.text(Text {
            text: &tick.label,
            position: (layout.abscissa.pixel(tick.position), bottom + 19.0),
            size: TICK_SIZE_PX,
            anchor: Anchor::Middle,
            is_bold: false,
        });
    }
    let (left, right) = layout.abscissa.pixels;
    canvas.text(Text {
        text: &layout.abscissa_quantity.label,
        position: ((left + right) / 2.0, bottom + 42.0),
        size: LABEL_SIZE_PX,
        anchor: Anchor::Middle,
        is_bold: false,
    });
}

/// Returns the stroke of a series from its index and role.
fn curve_stroke((index, role): (usize, SeriesRole), layout: &Layout) -> Stroke {
    let colour = match role {
        SeriesRole::Measured => return MEASURED_STROKE,
        SeriesRole::Plain => index,
        SeriesRole::After => 0,
        SeriesRole::Before => 1,
    };
    let dashes = if layout.is_overlaid {
        index
    } else {
        index / COLOURS.len()
    };
    Stroke {
        colour: COLOURS[colour % COLOURS.len()],
        width: match layout.style {
            SeriesStyle::Curve => 1.2,
            SeriesStyle::Orbit => 0.7,
            SeriesStyle::Points => 1.8,
        },
        dashes: DASHES[dashes % DASHES.len()],
    }
}

/// Returns a series in pixels, with NaN for values that cannot be drawn.
fn samples(
    series: &Series<'_>,
    geometry: &PanelGeometry,
    layout: &Layout,
) -> impl Iterator<Item = Point> {
    let (x, y) = (layout.abscissa, geometry.ordinate);
    let (along, up) = (layout.abscissa_quantity.scale, geometry.quantity.scale);
    series
        .abscissa
        .iter()
        .zip(series.values)
        .map(move |(at, value)| {
            let height = if is_drawable(*value) {
                clamped_pixel(&y, value / up)
            } else {
                f64::NAN
            };
            (clamped_pixel(&x, at / along), height)
        })
}

fn clamped_pixel(axis: &Axis, value: f64) -> f64 {
    axis.pixel(axis.scale.to_position(value))
}

fn draw_grid(canvas: &mut Canvas, geometry: &PanelGeometry, layout: &Layout) {
    let (left, right) = layout.abscissa.pixels;
    let (bottom, top) = geometry.ordinate.pixels;
    let level = |tick: &Tick| {
        let y = geometry.ordinate.pixel(tick.position);
        ((left, y), (right, y))
    };
    let upright = |tick: &Tick| {
        let x = layout.abscissa.pixel(tick.position);
        ((x, bottom), (x, top))
    };
    let lines = geometry.ticks.iter().map(level);
    let lines: Vec<_> = lines
        .chain(layout.abscissa_ticks.iter().map(upright))
        .collect();
    canvas.segments(&lines, GRID_STROKE);
}

fn draw_references(
    canvas: &mut Canvas,
    panel: &Panel<'_>,
    geometry: &PanelGeometry,
    layout: &Layout,
) {
    let (left, right) = layout.abscissa.pixels;
    let mut lines: Vec<(f64, &str)> = panel
        .references
        .iter()
        .filter(|reference| is_drawable(reference.value))
        .map(|reference| {
            (
                clamped_pixel(
                    &geometry.ordinate,
                    reference.value / geometry.quantity.scale,
                ),
                &*reference.label,
            )
        })
        .filter(|(y, _)| y.is_finite())
        .collect();
    lines.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut free_from = f64::NEG_INFINITY;
    for (y, label) in lines {
        canvas.segments(&[((left, y), (right, y))], REFERENCE_STROKE);
        // Moves the labels of close lines down, so that they do not overlap.
        let base = (y + 0.35 * TICK_SIZE_PX).max(free_from);
        free_from = base + TICK_SIZE_PX + 2.0;
        canvas.text(Text {
            text: &reference_label(label),
            position: (right + 6.0, base),
            size: TICK_SIZE_PX,
            anchor: Anchor::Start,
            is_bold: false,
        });
    }
}

fn draw_frame(canvas: &mut Canvas, geometry: &PanelGeometry, layout: &Layout) {
    let (left, right) = layout.abscissa.pixels;
    let (bottom, top) = geometry.ordinate.pixels;
    let corners = vec![
        (left, top),
        (right, top),
        (right, bottom),
        (left, bottom),
        (left, top),
    ];
    canvas.lines(&[corners], FRAME_STROKE);
    let length = 5.0;
    let across = geometry.ticks.iter().map(|tick| {
        let y = geometry.ordinate.pixel(tick.position);
        ((left, y), (left + length, y))
    });
    let up = layout.abscissa_ticks.iter().map(|tick| {
        let x = layout.abscissa.pixel(tick.position);
        ((x, bottom), (x, bottom - length))
    });
    let mut marks: Vec<_> = across.chain(up).collect();
    marks.extend(minor_marks(&geometry.ordinate).map(|y| ((left, y), (left + 3.0, y))));
    marks.extend(minor_marks(&layout.abscissa).map(|x| ((x, bottom), (x, bottom - 3.0))));
    canvas.segments(&marks, FRAME_STROKE);
}

/// Returns the pixels of 2 to 9 times each power of ten, if there is space.
fn minor_marks(axis: &Axis) -> impl Iterator<Item = f64> {
    let (low, high) = (axis.range.low, axis.range.high);
    let (start, end) = axis.pixels;
    let roomy = (end - start).abs() / (high - low) > 40.0;
    let decades = match axis.scale {
        Scale::Logarithmic if roomy => low.floor() as i32..high.ceil() as i32,
        _ => 0..0,
    };
    let axis = *axis;
    decades
        .flat_map(|decade| (2..10).map(move |m| f64::from(m).log10() + f64::from(decade)))
        .filter(move |position| (low..=high).contains(position))
        .map(move |position| axis.pixel(position))
}

fn draw_text(canvas: &mut Canvas, panel: &Panel<'_>, geometry: &PanelGeometry, layout: &Layout) {
    let (left, _) = layout.abscissa.pixels;
    let (bottom, top) = geometry.ordinate.pixels;
    for tick in &geometry.ticks {
        canvas.text(Text {
            text: &tick.label,
            position: (
                left - 7.0,
                geometry.ordinate.pixel(tick.position) + 0.35 * TICK_SIZE_PX,
            ),
            size: TICK_SIZE_PX,
            anchor: Anchor::End,
            is_bold: false,
        });
    }
    let lines = wrap_label(&geometry.quantity.label, LABEL_SIZE_PX, bottom - top);
    for (row, line) in lines.iter().enumerate() {
        let label = Text {
            text: line,
            position: (19.0 + LABEL_ROW_PX * row as f64, (top + bottom) / 2.0),
            size: LABEL_SIZE_PX,
            anchor: Anchor::Middle,
            is_bold: false,
        };
        canvas.rotated_text(label, -90.0);
    }
    for (y, line) in &geometry.title {
        canvas.text(Text {
            text: line,
            position: (layout.title_edge, *y),
            size: TITLE_SIZE_PX,
            anchor: Anchor::Start,
            is_bold: true,
        });
    }
    draw_legend(canvas, panel, geometry, layout);
}

fn draw_legend(canvas: &mut Canvas, panel: &Panel<'_>, geometry: &PanelGeometry, layout: &Layout) {
    let roles = panel.series.iter().map(|series| series.role).enumerate();
    for (series, ((x, y), label)) in roles.zip(&geometry.legend) {
        let middle = y - 0.25 * LEGEND_ROW_PX;
        let stroke = curve_stroke(series, layout);
        let stroke = Stroke {
            width: stroke.width.max(2.0),
            ..stroke
        };
        canvas.segments(&[((*x, middle), (x + LEGEND_LINE_PX, middle))], stroke);
        canvas.text(Text {
            text: label,
            position: (x + LEGEND_LINE_PX + 6.0, *y),
            size: TICK_SIZE_PX,
            anchor: Anchor::Start,
            is_bold: false,
        });
    }
}
