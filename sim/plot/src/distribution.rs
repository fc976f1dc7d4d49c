//! Distributions of numbers: a histogram and the cumulative share.

use super::PlotError;
use super::axis::{Axis, Range, Scale, ticks};
use super::bars::{
    COLUMN_COLOUR, draw_label, draw_level, draw_marks, draw_outline, draw_title, write_text,
};
use super::canvas::{Anchor, Canvas, Stroke};
use super::error::is_drawable;
use super::figure::Reference;
use super::quantity::Quantity;

/// Numbers and their statistics.
#[derive(Clone, Debug, Default)]
pub struct Distribution<'a> {
    /// Title above the frame.
    pub title: String,
    /// Name of the quantity.
    pub quantity: String,
    /// SI unit; empty for a dimensionless number.
    pub unit: String,
    /// Numbers in ascending order.
    pub sorted: &'a [f64],
    /// Named numbers in ascending order, drawn as dashed vertical lines.
    pub marks: Vec<Reference>,
}

const WIDTH_PX: f64 = 720.0;
const HEIGHT_PX: f64 = 360.0;
/// Margins to the left and right, and above and below the frame, in px.
const MARGINS_PX: ((f64, f64), (f64, f64)) = ((78.0, 70.0), (58.0, 62.0));
const COLUMN_COUNT_RANGE: (usize, usize) = (5, 60);
/// Number of points of the curve; more points would not be visible.
const MAX_CURVE_POINTS: usize = 400;

const CURVE: Stroke = Stroke::new("#d55e00", 1.6, "");

/// Draws a distribution as an SVG document with a width of 720 px.
///
/// # Errors
///
/// [`PlotError`] without numbers, or with one that is not finite.
pub fn distribution(of: &Distribution<'_>) -> Result<String, PlotError> {
    if of.sorted.is_empty() || !of.sorted.iter().copied().all(is_drawable) {
        return Err(PlotError::Empty {
            panel: 0,
            series: of.quantity.clone(),
        });
    }
    let largest = of
        .sorted
        .iter()
        .fold(0.0, |most: f64, value| most.max(value.abs()));
    let quantity = Quantity::with_prefix(&of.quantity, &of.unit, largest);
    let values: Vec<f64> = of
        .sorted
        .iter()
        .map(|value| value / quantity.scale)
        .collect();
    let whole = Range::from_positions(values.iter().copied()).unwrap_or(Range {
        low: 0.0,
        high: 1.0,
    });
    let counts = count_columns(&values, whole.widen_point());
    let most = counts.iter().copied().max().unwrap_or(1);
    let axes = Axes::new(whole.widen_point(), most);
    let mut canvas = Canvas::default();
    for tick in ticks(axes.vertical.scale, axes.vertical.range, 6) {
        draw_level(&mut canvas, &tick, &axes.vertical, axes.horizontal.pixels);
    }
    draw_columns(&mut canvas, &counts, whole.widen_point(), &axes);
    canvas.lines(&[cumulative_curve(&values, &axes)], CURVE);
    let marks = of.marks.iter().map(|mark| scale_mark(mark, quantity.scale));
    let marks: Vec<Reference> = marks.collect();
    draw_marks(&mut canvas, &marks, &axes.horizontal, &axes.vertical);
    draw_names(&mut canvas, &axes, &quantity.label);
    draw_title(&mut canvas, &of.title, (16.0, 22.0));
    Ok(canvas.document(&of.title, WIDTH_PX, HEIGHT_PX))
}

struct Axes {
    horizontal: Axis,
    vertical: Axis,
    cumulative: Axis,
}

impl Axes {
    fn new(whole: Range, most: usize) -> Self {
        let ((left, right), (above, below)) = MARGINS_PX;
        let axis = |range, pixels| Axis {
            scale: Scale::Linear,
            range,
            pixels,
        };
        let upright = (HEIGHT_PX - below, above);
        let to = |high| Range { low: 0.0, high };
        Self {
            horizontal: axis(whole.pad(0.03), (left, WIDTH_PX - right)),
            vertical: axis(to(1.08 * most as f64), upright),
            cumulative: axis(to(108.0), upright),
        }
    }
}

fn draw_names(
    canvas: &mut Canvas,
    Axes {
        horizontal: along,
        vertical: up,
        cumulative: share,
    }: &Axes,
    quantity: &str,
) {
    for tick in ticks(along.scale, along.range, 8) {
        let at = (along.pixel(tick.position), up.pixels.0 + 19.0);
        write_text(canvas, &tick.label, at, Anchor::Middle);
    }
    for part in [0.0, 25.0, 50.0, 75.0, 100.0_f64] {
        let at = (along.pixels.1 + 7.0, share.pixel(part) + 5.0);
        write_text(canvas, &format!("{part:.0}"), at, Anchor::Start);
    }
    draw_outline(canvas, along.pixels, up.pixels);
    let middle = (along.pixels.0 + along.pixels.1) / 2.0;
    draw_label(canvas, quantity, (middle, up.pixels.0 + 44.0), 0.0);
    let middle = (up.pixels.0 + up.pixels.1) / 2.0;
    draw_label(canvas, "samples", (19.0, middle), -90.0);
    let share = "cumulative share [%], orange";
    draw_label(canvas, share, (WIDTH_PX - 14.0, middle), -90.0);
}

fn scale_mark(mark: &Reference, scale: f64) -> Reference {
    Reference {
        label: mark.label.clone(),
        value: mark.value / scale,
    }
}

/// Returns the number of values in each column. The column width follows D. Freedman and P. Diaconis (1981):
/// twice the interquartile range divided by the cube root of the number of values.
fn count_columns(sorted: &[f64], range: Range) -> Vec<usize> {
    let at = |part: f64| sorted[(part * (sorted.len() - 1) as f64).round() as usize];
    let width = 2.0 * (at(0.75) - at(0.25)) / (sorted.len() as f64).cbrt();
    let span = range.high - range.low;
    let (least, most) = COLUMN_COUNT_RANGE;
    let columns = ((span / width).ceil().min(most as f64) as usize).clamp(least, most);
    let mut counts = vec![0; columns];
    for value in sorted {
        let index = (value - range.low) / span * columns as f64;
        counts[(index as usize).min(columns - 1)] += 1;
    }
    counts
}

fn draw_columns(canvas: &mut Canvas, counts: &[usize], range: Range, axes: &Axes) {
    let (along, up) = (&axes.horizontal, &axes.vertical);
    let edge = |index: usize| {
        let part = index as f64 / counts.len() as f64;
        along.pixel(range.low + part * (range.high - range.low))
    };
    for (index, count) in counts.iter().enumerate() {
        let (from, to, top) = (edge(index), edge(index + 1), up.pixel(*count as f64));
        canvas.rectangle(
            (from + 0.5, top),
            (to - from - 1.0, up.pixels.0 - top),
            COLUMN_COLOUR,
        );
    }
}

/// Returns the cumulative share as a staircase with a limited number of steps.
fn cumulative_curve(
    sorted: &[f64],
    Axes {
        horizontal: along,
        cumulative: share,
        ..
    }: &Axes,
) -> Vec<(f64, f64)> {
    let count = sorted.len();
    let part = |number: usize| share.pixel(100.0 * number as f64 / count as f64);
    let step = count.div_ceil(MAX_CURVE_POINTS);
    let kept = (0..count).filter(|index| index % step == 0 || *index + 1 == count);
    let mut points = vec![(along.pixels.0, part(0))];
    for index in kept {
        let before = points.last().map_or(part(0), |(_, y)| *y);
        let x = along.pixel(sorted[index]);
        points.extend([(x, before), (x, part(index + 1))]);
    }
    points.push((along.pixels.1, part(count)));
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_contain_every_number_once() {
        for values in [
            vec![2.0],
            vec![2.0; 9],
            (0..1000).map(f64::from).collect(),
            vec![-1.0, 5.0],
        ] {
            let range = Range::from_positions(values.iter().copied())
                .expect("a range")
                .widen_point();
            let counts = count_columns(&values, range);
            assert_eq!(counts.iter().sum::<usize>(), values.len());
            assert!((COLUMN_COUNT_RANGE.0..=COLUMN_COUNT_RANGE.1).contains(&counts.len()));
        }
        // Evenly spaced values: columns are at most 2 * 499/10 wide, so there are eleven.
        let even: Vec<f64> = (0..1000).map(f64::from).collect();
        let whole = Range {
            low: 0.0,
            high: 1000.0,
        };
        let counts = count_columns(&even, whole);
        assert_eq!(counts.len(), 11);
        assert!(counts.iter().all(|count| (90..=91).contains(count)));
    }

    #[test]
    fn invalid_numbers_are_an_error() {
        for sorted in [&[][..], &[f64::NAN], &[1.0, f64::INFINITY]] {
            let of = Distribution {
                sorted,
                ..Distribution::default()
            };
            assert!(distribution(&of).is_err());
        }
        let of = Distribution {
            sorted: &[1.0],
            ..Distribution::default()
        };
        assert!(distribution(&of).expect("a figure").ends_with("</svg>\n"));
    }
}
