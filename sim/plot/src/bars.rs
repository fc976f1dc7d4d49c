//! Histograms of counts, and shares of a whole as stacked bars.

use super::PlotError;
use super::axis::{Axis, Range, Scale, Tick, ticks};
use super::canvas::{Anchor, Canvas, FRAME_STROKE, GRID_STROKE, Stroke, Text};
use super::figure::Reference;
use super::layout::{LABEL_SIZE_PX, TICK_SIZE_PX, TITLE_SIZE_PX};
use super::lettering::text_width;

/// Histogram of numbers that start at 0.
#[derive(Clone, Debug, Default)]
pub struct Histogram<'a> {
    /// Title above the frame.
    pub title: String,
    /// Label of the horizontal axis.
    pub horizontal_label: String,
    /// Label of the vertical axis.
    pub vertical_label: String,
    /// Counts of 0, 1, 2, ...
    pub counts: &'a [usize],
    /// Named numbers in ascending order, drawn as dashed vertical lines.
    pub marks: Vec<Reference>,
}

/// Stacked bars, each divided into the same parts.
#[derive(Clone, Debug, Default)]
pub struct Shares {
    /// Title above the frame.
    pub title: String,
    /// Names of the parts, from left to right; at most four.
    pub parts: Vec<String>,
    /// Name and shares (with the sum 1) of each bar. The sum of the first two shares is written next to the
    /// bar.
    pub rows: Vec<(String, Vec<f64>)>,
}

const WIDTH_PX: f64 = 720.0;
const HEIGHT_PX: f64 = 330.0;
/// Margins to the left and right, and above and below the frame, in px.
const MARGINS_PX: ((f64, f64), (f64, f64)) = ((78.0, 24.0), (54.0, 62.0));
/// Height of a row of shares and of its bar, in px.
const ROW_HEIGHTS_PX: (f64, f64) = (20.0, 14.0);
pub(super) const COLUMN_COLOUR: &str = "#56a0d3";
/// Two strong colours for the most important parts, grey and a pale one; all differ in lightness.
const PART_COLOURS: [&str; 4] = ["#0b4f86", "#56a0d3", "#c4c4c4", "#f2cfae"];

const MARK_STROKE: Stroke = Stroke::new("#555555", 1.0, "5 4");

/// Draws a histogram as an SVG document with a width of 720 px.
///
/// # Errors
///
/// [`PlotError`] if all counts are 0.
pub fn histogram(of: &Histogram<'_>) -> Result<String, PlotError> {
    let most = of.counts.iter().copied().max().unwrap_or(0);
    if most == 0 {
        return Err(empty_error(&of.vertical_label));
    }
    let ((left, right), (above, below)) = MARGINS_PX;
    let linear = |low, high, pixels| Axis {
        scale: Scale::Linear,
        range: Range { low, high },
        pixels,
    };
    let last = of.counts.len() as f64 - 0.5;
    let along = linear(-0.5, last, (left, WIDTH_PX - right));
    let up = linear(0.0, 1.08 * most as f64, (HEIGHT_PX - below, above));
    let mut canvas = Canvas::default();
    for tick in ticks(up.scale, up.range, 6) {
        draw_level(&mut canvas, &tick, &up, along.pixels);
    }
    for (number, count) in of.counts.iter().enumerate() {
        let middle = number as f64;
        let (from, to) = (along.pixel(middle - 0.42), along.pixel(middle + 0.42));
        let top = up.pixel(*count as f64);
        canvas.rectangle((from, top), (to - from, up.pixels.0 - top), COLUMN_COLOUR);
    }
    for tick in ticks(along.scale, along.range, 12) {
        let at = (along.pixel(tick.position), up.pixels.0 + 19.0);
        write_text(&mut canvas, &tick.label, at, Anchor::Middle);
    }
    draw_marks(&mut canvas, &of.marks, &along, &up);
    draw_outline(&mut canvas, along.pixels, up.pixels);
    let middle = (along.pixels.0 + along.pixels.1) / 2.0;
    draw_label(
        &mut canvas,
        &of.horizontal_label,
        (middle, up.pixels.0 + 44.0),
        0.0,
    );
    let middle = (up.pixels.0 + up.pixels.1) / 2.0;
    draw_label(&mut canvas, &of.vertical_label, (19.0, middle), -90.0);
    draw_title(&mut canvas, &of.title, (left, 22.0));
    Ok(canvas.document(&of.title, WIDTH_PX, HEIGHT_PX))
}

/// Draws shares as an SVG document with a width of 720 px.
///
/// # Errors
///
/// [`PlotError`] without rows.
pub fn shares(of: &Shares) -> Result<String, PlotError> {
    let names = of
        .rows
        .iter()
        .map(|(name, _)| text_width(name, TICK_SIZE_PX));
    let widest = names.fold(0.0, f64::max);
    if of.rows.is_empty() {
        return Err(empty_error(&of.title));
    }
    let (top, (row, bar)) = (62.0, ROW_HEIGHTS_PX);
    let bottom = top + row * of.rows.len() as f64 + 6.0;
    let along = Axis {
        scale: Scale::Linear,
        range: Range {
            low: 0.0,
            high: 100.0,
        },
        pixels: (widest + 20.0, WIDTH_PX - 64.0),
    };
    let mut canvas = Canvas::default();
    for tick in ticks(along.scale, along.range, 6) {
        let x = along.pixel(tick.position);
        canvas.segments(&[((x, bottom), (x, top))], GRID_STROKE);
        write_text(&mut canvas, &tick.label, (x, bottom + 19.0), Anchor::Middle);
    }
    for (index, (name, parts)) in of.rows.iter().enumerate() {
        let y = top + 6.0 + row * index as f64;
        let base = y + 0.5 * bar + 0.36 * TICK_SIZE_PX;
        write_text(&mut canvas, name, (along.pixels.0 - 8.0, base), Anchor::End);
        let mut from = 0.0;
        for (part, colour) in parts.iter().zip(PART_COLOURS) {
            let to = from + 100.0 * part;
            let (start, end) = (along.pixel(from), along.pixel(to));
            canvas.rectangle((start, y), (end - start, bar), colour);
            from = to;
        }
        let together = 100.0 * parts.iter().take(2).sum::<f64>();
        let text = format!("{together:.0} %");
        let at = (WIDTH_PX - 12.0, base);
        write_text(&mut canvas, &text, at, Anchor::End);
    }
    draw_outline(&mut canvas, along.pixels, (bottom, top));
    let middle = (along.pixels.0 + along.pixels.1) / 2.0;
    draw_label(&mut canvas, "share [%]", (middle, bottom + 42.0), 0.0);
    draw_title(&mut canvas, &of.title, (16.0, 22.0));
    draw_legend(&mut canvas, &of.parts, (along.pixels.0, 48.0));
    Ok(canvas.document(&of.title, WIDTH_PX, bottom + 56.0))
}

pub(super) fn draw_level(canvas: &mut Canvas, tick: &Tick, up: &Axis, (left, right): (f64, f64)) {
    let y = up.pixel(tick.position);
    canvas.segments(&[((left, y), (right, y))], GRID_STROKE);
    let at = (left - 7.0, y + 0.35 * TICK_SIZE_PX);
    write_text(canvas, &tick.label, at, Anchor::End);
}

/// Draws vertical lines with their names above the frame; the names do not overlap.
pub(super) fn draw_marks(canvas: &mut Canvas, marks: &[Reference], along: &Axis, up: &Axis) {
    let mut free_from = along.pixels.0;
    for mark in marks {
        let x = along.pixel(mark.value);
        canvas.segments(&[((x, up.pixels.0), (x, up.pixels.1))], MARK_STROKE);
        let long = text_width(&mark.label, TICK_SIZE_PX);
        let start = (x - long / 2.0).min(along.pixels.1 - long).max(free_from);
        free_from = start + long + 10.0;
        let at = (start, up.pixels.1 - 8.0);
        write_text(canvas, &mark.label, at, Anchor::Start);
    }
}

fn draw_legend(canvas: &mut Canvas, parts: &[String], (mut x, y): (f64, f64)) {
    for (name, colour) in parts.iter().zip(PART_COLOURS) {
        canvas.rectangle((x, y - 11.0), (ROW_HEIGHTS_PX.1, 12.0), colour);
        write_text(canvas, name, (x + ROW_HEIGHTS_PX.1 + 6.0, y), Anchor::Start);
        x += ROW_HEIGHTS_PX.1 + 22.0 + text_width(name, TICK_SIZE_PX);
    }
}

pub(super) fn draw_outline(
    canvas: &mut Canvas,
    (left, right): (f64, f64),
    (bottom, top): (f64, f64),
) {
    let corners = [(left, top), (right, top), (right, bottom), (left, bottom)];
    let around = corners.into_iter().chain([(left, top)]);
    canvas.lines(&[around.collect()], FRAME_STROKE);
}

pub(super) fn write_text(canvas: &mut Canvas, text: &str, at: (f64, f64), anchor: Anchor) {
    canvas.text(Text {
        text,
        position: at,
        size: TICK_SIZE_PX,
        anchor,
        is_bold: false,
    });
}

pub(super) fn draw_label(canvas: &mut Canvas, text: &str, at: (f64, f64), angle: f64) {
    let text = Text {
        text,
        position: at,
        size: LABEL_SIZE_PX,
        anchor: Anchor::Middle,
        is_bold: false,
    };
    canvas.rotated_text(text, angle);
}

pub(super) fn draw_title(canvas: &mut Canvas, text: &str, at: (f64, f64)) {
    canvas.text(Text {
        text,
        position: at,
        size: TITLE_SIZE_PX,
        anchor: Anchor::Start,
        is_bold: true,
    });
}

fn empty_error(name: &str) -> PlotError {
    PlotError::Empty {
        panel: 0,
        series: name.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use roxmltree::Document;

    use super::*;

    /// Returns position and extent of the rectangles of a colour, from the attributes `at` and `extent`.
    fn rectangles(svg: &str, colour: &str, [at, extent]: [&str; 2]) -> Vec<(f64, f64)> {
        let document = Document::parse(svg).unwrap();
        let number = |node: roxmltree::Node<'_, '_>, name| {
            let value: f64 = node.attribute(name).unwrap().parse().unwrap();
            value
        };
        document
            .descendants()
            .filter(|n| n.has_tag_name("rect") && n.attribute("fill") == Some(colour))
            .map(|n| (number(n, at), number(n, extent)))
            .collect()
    }

    #[test]
    fn column_heights_match_counts() {
        let svg = histogram(&Histogram {
            counts: &[2, 0, 8, 4],
            marks: vec![Reference {
                label: "here: 2".to_owned(),
                value: 2.0,
            }],
            ..Histogram::default()
        })
        .unwrap();
        let found = rectangles(&svg, COLUMN_COLOUR, ["y", "height"]);
        // A count of 0 has no column, and all columns have the same base line. Pixels have two decimals.
        let [two, eight, four] = found[..] else {
            panic!("{found:?}")
        };
        assert!((four.1 - 2.0 * two.1).abs() < 0.03 && (eight.1 - 4.0 * two.1).abs() < 0.05);
        assert!((two.0 + two.1 - eight.0 - eight.1).abs() < 0.03);
        assert!(svg.contains("here: 2"));
    }

    #[test]
    fn parts_are_adjacent_and_fill_bar() {
        let row = |parts: &[f64]| ("a claim".to_owned(), parts.to_vec());
        let svg = shares(&Shares {
            rows: vec![row(&[0.25, 0.25, 0.0, 0.5]), row(&[1.0])],
            ..Shares::default()
        })
        .unwrap();
        let of = |colour| rectangles(&svg, colour, ["x", "width"]);
        let [first, whole] = of(PART_COLOURS[0])[..] else {
            panic!("{svg}")
        };
        let (second, last) = (of(PART_COLOURS[1])[0], of(PART_COLOURS[3])[0]);
        assert!(of(PART_COLOURS[2]).is_empty());
        assert!((first.1 - 0.25 * whole.1).abs() < 0.02 && (last.1 - 0.5 * whole.1).abs() < 0.02);
        assert!((second.0 - first.0 - first.1).abs() < 0.02);
        assert!((last.0 - second.0 - second.1).abs() < 0.02);
        assert!(svg.contains("50 %") && svg.contains("100 %"));
    }

    #[test]
    fn empty_input_is_an_error() {
        let none = Histogram {
            counts: &[0, 0],
            ..Histogram::default()
        };
        assert!(histogram(&none).is_err());
        assert!(shares(&Shares::default()).is_err());
    }
}
