//! Writer of SVG elements. Attributes are numbers and constants of the program. Text is escaped.

use std::fmt::Write;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::decimate::Point;
use super::lettering::{escape_xml, svg_spans};
use super::palette::dark_style;

#[derive(Clone, Copy, Debug)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Stroke {
    pub colour: &'static str,
    pub width: f64,
    /// Lengths of dashes and gaps; empty for a solid line.
    pub dashes: &'static str,
}

impl Stroke {
    pub const fn new(colour: &'static str, width: f64, dashes: &'static str) -> Self {
        Self {
            colour,
            width,
            dashes,
        }
    }
}

pub(super) const GRID_STROKE: Stroke = Stroke::new("#e6e6e6", 0.8, "");
pub(super) const FRAME_STROKE: Stroke = Stroke::new("#444444", 1.0, "");

#[derive(Clone, Copy, Debug)]
pub(super) struct Text<'a> {
    pub text: &'a str,
    pub position: Point,
    pub size: f64,
    pub anchor: Anchor,
    pub is_bold: bool,
}

#[derive(Debug, Default)]
pub(super) struct Canvas {
    body: String,
}

impl Canvas {
    pub fn segments(&mut self, segments: &[(Point, Point)], stroke: Stroke) {
        let data: String = segments
            .iter()
            .map(|(from, to)| format!("M{} {}", format_pair(*from), format_pair(*to)))
            .collect();
        self.path(&data, stroke);
    }

    /// Draws lines through points; a line of one point is a dot.
    pub fn lines(&mut self, lines: &[Vec<Point>], stroke: Stroke) {
        let mut data = String::new();
        for line in lines {
            for (index, point) in line.iter().enumerate() {
                data.push(if index == 0 { 'M' } else { ' ' });
                data.push_str(&format_pair(*point));
            }
            if line.len() == 1 {
                data.push_str("h0");
            }
        }
        self.path(&data, stroke);
    }

    /// Draws a filled rectangle from its upper left corner; nothing if it has no extent.
    pub fn rectangle(&mut self, (x, y): Point, (width, height): Point, colour: &str) {
        if width > 0.0 && height > 0.0 {
            self.element(format_args!(
                "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{colour}\"/>",
                format_pixel(x),
                format_pixel(y),
                format_pixel(width),
                format_pixel(height)
            ));
        }
    }

    fn path(&mut self, data: &str, stroke: Stroke) {
        if data.is_empty() {
            return;
        }
        let dashes = match stroke.dashes {
            "" => String::new(),
            dashes => format!(" stroke-dasharray=\"{dashes}\""),
        };
        self.element(format_args!(
            "<path fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\" \
             stroke-linecap=\"round\"{dashes} d=\"{data}\"/>",
            stroke.colour, stroke.width
        ));
    }

    pub fn insert(&mut self, drawing: Self, (x, y): Point) {
        self.element(format_args!(
            "<g transform=\"translate({x} {y})\">\n{}</g>",
            drawing.body
        ));
    }

    /// Draws discs of one colour, each with an opacity from 0 to 1.
    pub fn dots(
        &mut self,
        centres: impl Iterator<Item = Point>,
        radius: f64,
        colour: &str,
        opacity: f64,
    ) {
        let radius = format_pixel(radius);
        let mut circles = String::new();
        for (x, y) in centres {
            let (x, y) = (format_pixel(x), format_pixel(y));
            let _ = writeln!(circles, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\"/>");
        }
        self.element(format_args!(
            "<g fill=\"{colour}\" fill-opacity=\"{opacity}\">\n{circles}</g>"
        ));
    }

    /// Draws a PNG, stretched to a size, without interpolation. The point is its upper left corner.
    pub fn image(&mut self, (x, y): Point, (width, height): Point, png: &[u8]) {
        self.element(format_args!(
            "<image x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" \
             preserveAspectRatio=\"none\" image-rendering=\"pixelated\" \
             href=\"data:image/png;base64,{}\"/>",
            STANDARD.encode(png)
        ));
    }

    pub fn text(&mut self, text: Text<'_>) {
        self.rotated_text(text, 0.0);
    }

    pub fn rotated_text(&mut self, text: Text<'_>, angle: f64) {
        let spans = svg_spans(text.text, text.size);
        self.write_text(text, angle, &spans);
    }

    /// Draws text as it is: names get no subscripts and Greek letters.
    pub fn verbatim_text(&mut self, text: Text<'_>) {
        self.write_text(text, 0.0, &escape_xml(text.text));
    }

    fn write_text(&mut self, text: Text<'_>, angle: f64, spans: &str) {
        let (x, y) = text.position;
        let anchor = match text.anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let weight = if text.is_bold {
            " font-weight=\"600\""
        } else {
            ""
        };
        let turn = match angle {
            0.0 => String::new(),
            _ => format!(" transform=\"rotate({angle} {x:.2} {y:.2})\""),
        };
        self.element(format_args!(
            "<text x=\"{x:.2}\" y=\"{y:.2}\" font-size=\"{}\" \
             text-anchor=\"{anchor}\"{weight}{turn} xml:space=\"preserve\">{spans}</text>",
            text.size
        ));
    }

    fn element(&mut self, element: std::fmt::Arguments<'_>) {
        let _ = writeln!(self.body, "{element}");
    }

    pub fn document(self, title: &str, width: f64, height: f64) -> String {
        let head = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
             width=\"{width}\" height=\"{height}\" role=\"img\" \
             font-family=\"Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif\" \
             fill=\"#222222\">\n<title>{}</title>\n",
            escape_xml(title)
        );
        let body = format!(
            "<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>\n{}</svg>\n",
            self.body
        );
        let style = dark_style(&format!("{head}{body}"));
        format!("{head}{style}{body}")
    }
}

fn format_pair((x, y): Point) -> String {
    format!("{},{}", format_pixel(x), format_pixel(y))
}

fn format_pixel(pixel: f64) -> String {
    let text = format!("{pixel:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
