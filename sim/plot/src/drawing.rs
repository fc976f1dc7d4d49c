//! Drawings of lines, circles, arrows and text at given positions.

use super::canvas::{Anchor, Canvas, Stroke, Text};
use super::decimate::Point;
use super::layout::{TICK_SIZE_PX, TITLE_SIZE_PX};

/// Drawing of a given size.
#[derive(Clone, Debug, Default)]
pub struct Drawing {
    /// Description for screen readers; not drawn.
    pub title: String,
    /// Width and height, in px.
    pub size: (f64, f64),
    /// Parts; later parts cover earlier ones.
    pub parts: Vec<Part>,
}

/// Part of a drawing, with positions in px from the upper left corner.
#[derive(Clone, Debug)]
pub enum Part {
    /// Line through points.
    Line(LineStyle, Vec<Point>),
    /// Line through points with an arrowhead at its end.
    Arrow(LineStyle, Vec<Point>),
    /// Text at a position. -1, 0 or 1 aligns its start, its middle or its end with the position.
    Text(Point, i8, String),
    /// Larger bold text.
    Heading(Point, String),
}

/// Style of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineStyle {
    /// Outline of a body.
    Body,
    /// Displaced body, with thicker lines.
    Displaced,
    /// Dimension or direction.
    Dimension,
    /// Axis or rest position.
    Imaginary,
}

impl LineStyle {
    fn stroke(self) -> Stroke {
        let (colour, width, dashes) = match self {
            Self::Body => ("#444444", 1.4, ""),
            Self::Displaced => ("#0072b2", 4.0, ""),
            Self::Dimension => ("#d55e00", 1.8, ""),
            Self::Imaginary => ("#8a8a8a", 1.1, "6 4"),
        };
        Stroke::new(colour, width, dashes)
    }
}

/// Returns a point of a circle; the angle is in degrees counter-clockwise from the right.
pub fn point_on_circle(centre: Point, radius: f64, degrees: f64) -> Point {
    let (sin, cos) = degrees.to_radians().sin_cos();
    (centre.0 + radius * cos, centre.1 - radius * sin)
}

/// Returns points of an arc between two angles, in degrees counter-clockwise from the right.
pub fn arc_points(centre: Point, radius: f64, (from, to): (f64, f64)) -> Vec<Point> {
    let steps = ((to - from).abs() / 4.0).ceil().max(1.0) as usize;
    let angle = |step: usize| from + (to - from) * step as f64 / steps as f64;
    (0..=steps)
        .map(|step| point_on_circle(centre, radius, angle(step)))
        .collect()
}

/// Returns the drawing as an SVG document.
pub fn draw_sketch(of: &Drawing) -> String {
    let mut canvas = Canvas::default();
    for part in &of.parts {
        match part {
            Part::Line(look, points) => canvas.lines(std::slice::from_ref(points), look.stroke()),
            Part::Arrow(look, points) => {
                let stroke = look.stroke();
                let head = arrow_head(points);
                canvas.lines(
                    &[points.clone(), head],
                    Stroke {
                        dashes: "",
                        ..stroke
                    },
                );
            }
            Part::Text(at, side, text) => canvas.text(Text {
                text,
                position: *at,
                size: TICK_SIZE_PX,
                anchor: match side {
                    0 => Anchor::Middle,
                    side if *side < 0 => Anchor::Start,
                    _ => Anchor::End,
                },
                is_bold: false,
            }),
            Part::Heading(at, text) => canvas.text(Text {
                text,
                position: *at,
                size: TITLE_SIZE_PX,
                anchor: Anchor::Start,
                is_bold: true,
            }),
        }
    }
    canvas.document(&of.title, of.size.0, of.size.1)
}

fn arrow_head(points: &[Point]) -> Vec<Point> {
    let [.., before, end] = points else {
        return Vec::new();
    };
    let back = (end.1 - before.1).atan2(before.0 - end.0).to_degrees();
    [back - 24.0, back + 24.0]
        .map(|angle| point_on_circle(*end, 9.0, angle))
        .into_iter()
        .enumerate()
        .flat_map(|(index, side)| {
            if index == 0 {
                vec![side, *end]
            } else {
                vec![side]
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_counter_clockwise_and_arcs_end_at_given_angle() {
        let (x, y) = point_on_circle((10.0, 20.0), 5.0, 90.0);
        assert!((x - 10.0).abs() < 1e-12 && (y - 15.0).abs() < 1e-12);
        let arc = arc_points((0.0, 0.0), 1.0, (0.0, 180.0));
        let last = arc[arc.len() - 1];
        assert!((last.0 + 1.0).abs() < 1e-12 && last.1.abs() < 1e-12);
        assert!(arc.iter().all(|(x, y)| (x.hypot(*y) - 1.0).abs() < 1e-12));
    }

    #[test]
    fn arrow_head_is_behind_its_point() {
        let head = arrow_head(&[(0.0, 0.0), (50.0, 0.0)]);
        assert_eq!(head.len(), 3);
        assert_eq!(head[1], (50.0, 0.0));
        assert!(head[0].0 < 45.0 && head[2].0 < 45.0 && head[0].1 * head[2].1 < 0.0);
    }
}
