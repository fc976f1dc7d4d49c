//! Parts and figures that the sketches of the machine share.

use eomgen_plot::drawing::{Drawing, LineStyle, Part, arc_points, draw_sketch};

use super::report::Figure;

/// Returns a figure from parts; its caption is the title. `size` in px.
pub(super) fn draw_figure(file: &str, caption: &str, size: (f64, f64), parts: Vec<Part>) -> Figure {
    Figure {
        file: file.to_owned(),
        paper: String::new(),
        caption: caption.to_owned(),
        cases: Vec::new(),
        svg: draw_sketch(&Drawing {
            title: caption.to_owned(),
            size,
            parts,
        }),
    }
}

/// Returns a text at a point, px. `side`: -1, 0 or 1 aligns its start, its middle or its end with the point.
pub(super) fn words(at: (f64, f64), side: i8, text: &str) -> Part {
    Part::Text(at, side, text.to_owned())
}

/// Returns the outline of a circle, px.
pub(super) fn circle(centre: (f64, f64), radius: f64) -> Part {
    Part::Line(LineStyle::Body, arc_points(centre, radius, (0.0, 360.0)))
}
