//! Text in pixels in DejaVu Sans, which has the Greek letters, superscripts and dots of names.

use ab_glyph::{Font, FontRef, Glyph, GlyphId, PxScale, ScaleFont, point};

use super::super::axis::Tick;
use super::super::error::PlotError;
use super::super::lettering::{SUBSCRIPT_SIZE, split_runs};
use super::super::symbol::{DOT_ABOVE, TWO_DOTS_ABOVE};
use super::raster::{Colour, Raster};

/// Default size of a text, in px.
pub const TICK_SIZE: f64 = 15.0;
const TEXT: Colour = [26; 3];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Align {
    Start,
    Middle,
    End,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    Right,
    Up,
}

#[derive(Debug)]
pub struct Typeface {
    regular: FontRef<'static>,
    bold: FontRef<'static>,
}

#[derive(Clone, Copy, Debug)]
pub struct Line<'a> {
    pub text: &'a str,
    /// Font size, in px.
    pub size: f64,
    /// True for bold text without subscripts and Greek letters of names.
    pub heading: bool,
    pub align: Align,
    pub direction: Direction,
}

impl<'a> Line<'a> {
    pub fn level(text: &'a str, align: Align) -> Self {
        Self {
            text,
            size: TICK_SIZE,
            heading: false,
            align,
            direction: Direction::Right,
        }
    }
}

impl Typeface {
    pub fn new() -> Result<Self, PlotError> {
        let font = |bytes| {
            FontRef::try_from_slice(bytes).map_err(|error| PlotError::Encoding {
                reason: error.to_string(),
            })
        };
        Ok(Self {
            regular: font(dejavu::sans::regular())?,
            bold: font(dejavu::sans::bold())?,
        })
    }

    pub fn width(&self, line: Line<'_>) -> f64 {
        f64::from(self.glyphs(line).1)
    }

    pub fn widest(&self, ticks: &[Tick]) -> f64 {
        let widths = ticks
            .iter()
            .map(|tick| self.width(Line::level(&tick.label, Align::Start)));
        widths.fold(0.0, f64::max)
    }

    pub fn write_within(&self, raster: &mut Raster, line: Line<'_>, at: (f64, f64), room: f64) {
        if self.width(line) <= room {
            return self.write(raster, line, at);
        }
        // No character is narrow enough for more to fit.
        let mut kept: Vec<char> = line.text.chars().take(400).collect();
        while kept.pop().is_some() {
            let cut = format!("{}…", kept.iter().collect::<String>().trim_end());
            let cut = Line { text: &cut, ..line };
            if self.width(cut) <= room {
                return self.write(raster, cut, at);
            }
        }
    }

    /// Writes a line; its base line starts, is centred or ends at a point.
    pub fn write(&self, raster: &mut Raster, line: Line<'_>, (x, y): (f64, f64)) {
        let font = self.font(line);
        let (glyphs, width) = self.glyphs(line);
        let back = match line.align {
            Align::Start => 0.0,
            Align::Middle => 0.5 * f64::from(width),
            Align::End => f64::from(width),
        };
        for glyph in glyphs {
            let Some(outline) = font.outline_glyph(glyph) else {
                continue;
            };
            let corner = outline.px_bounds().min;
            outline.draw(|right, down, share| {
                let along = f64::from(corner.x) + f64::from(right) - back.round();
                let across = f64::from(corner.y) + f64::from(down);
                let (column, row) = match line.direction {
                    Direction::Right => (x.round() + along, y.round() + across),
                    Direction::Up => (x.round() + across, y.round() - along),
                };
                if column >= 0.0 && row >= 0.0 {
                    raster.blend(column as usize, row as usize, TEXT, f64::from(share));
                }
            });
        }
    }

    fn font(&self, line: Line<'_>) -> &FontRef<'static> {
        if line.heading {
            &self.bold
        } else {
            &self.regular
        }
    }

    fn glyphs(&self, line: Line<'_>) -> (Vec<Glyph>, f32) {
        let font = self.font(line);
        let mut placed = Placed::default();
        if line.heading {
            placed.append(font, line.text, line.size, 0.0);
        } else {
            for run in split_runs(line.text) {
                let (share, down) = if run.is_subscript {
                    (SUBSCRIPT_SIZE, 0.2)
                } else {
                    (1.0, 0.0)
                };
                placed.append(font, &run.text, share * line.size, down * line.size);
            }
        }
        (placed.glyphs, placed.end)
    }
}

#[derive(Default)]
struct Placed {
    glyphs: Vec<Glyph>,
    end: f32,
}

impl Placed {
    fn append(&mut self, font: &FontRef<'static>, text: &str, size: f64, down: f64) {
        let scaled = font.as_scaled(height(font, size));
        let mut before: Option<Glyph> = None;
        for c in text.chars() {
            let id = scaled.glyph_id(if c.is_control() { ' ' } else { c });
            if let (DOT_ABOVE | TWO_DOTS_ABOVE, Some(letter)) = (c, &before) {
                self.glyphs.push(above(font, letter, id));
                continue;
            }
            self.end += before.map_or(0.0, |before| scaled.kern(before.id, id));
            let at = point(self.end, down as f32);
            let glyph = id.with_scale_and_position(scaled.scale(), at);
            self.glyphs.push(glyph.clone());
            self.end += scaled.h_advance(id);
            before = Some(glyph);
        }
    }
}

/// Returns a mark centred above a letter of any height.
fn above(font: &FontRef<'static>, letter: &Glyph, mark: GlyphId) -> Glyph {
    let factor = font.as_scaled(letter.scale).scale_factor();
    let mut at = letter.position;
    let outlines = (font.outline(letter.id), font.outline(mark));
    if let (Some(letter), Some(mark)) = outlines {
        let (letter, mark) = (letter.bounds, mark.bounds);
        let aside = (letter.min.x + letter.max.x - mark.min.x - mark.max.x) / 2.0;
        // The distance is the height of a dot; the font's units point upwards.
        let gap = (mark.max.y - mark.min.y).abs();
        let up = letter.min.y.max(letter.max.y) + gap - mark.min.y.min(mark.max.y);
        at.x += aside * factor.horizontal;
        at.y -= up.max(0.0) * factor.vertical;
    }
    mark.with_scale_and_position(letter.scale, at)
}

/// Returns the height from the lowest descender to the highest ascender, for a letter size.
fn height(font: &FontRef<'static>, size: f64) -> PxScale {
    let em = font.units_per_em().unwrap_or(1000.0);
    PxScale::from(size as f32 * font.height_unscaled() / em)
}
