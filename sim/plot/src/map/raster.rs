//! Pixels of a picture: setting, blending, rectangles and discs, and encoding as PNG.

use super::super::error::PlotError;

/// Size of every picture, in px.
pub const WIDTH: usize = 1000;
pub const HEIGHT: usize = 760;

pub type Colour = [u8; 3];

/// Picture; columns count from the left, rows from the top.
#[derive(Clone, Debug)]
pub struct Raster {
    pixels: Vec<Colour>,
}

impl Raster {
    pub fn new(colour: Colour) -> Self {
        Self {
            pixels: vec![colour; WIDTH * HEIGHT],
        }
    }

    /// Colours a pixel; ignores pixels outside of the picture.
    pub fn set(&mut self, column: usize, row: usize, colour: Colour) {
        self.blend(column, row, colour, 1.0);
    }

    /// Blends a fraction of a colour, from 0 to 1, into a pixel.
    pub fn blend(&mut self, column: usize, row: usize, colour: Colour, share: f64) {
        if column >= WIDTH {
            return;
        }
        if let Some(pixel) = self.pixels.get_mut(row * WIDTH + column) {
            *pixel = mixed(*pixel, colour, share);
        }
    }

    /// Fills pixels from (left, top); `size` is width and height, in px.
    pub fn fill(&mut self, (left, top): (usize, usize), size: (usize, usize), colour: Colour) {
        for row in top..top + size.1 {
            for column in left..left + size.0 {
                self.set(column, row, colour);
            }
        }
    }

    pub fn png(&self, title: &str) -> Result<Vec<u8>, PlotError> {
        let encoding = |error: png::EncodingError| PlotError::Encoding {
            reason: error.to_string(),
        };
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, WIDTH as u32, HEIGHT as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::High);
        encoder
            .add_itxt_chunk("Title".to_owned(), title.replace('\0', " "))
            .map_err(encoding)?;
        let mut writer = encoder.write_header().map_err(encoding)?;
        writer
            .write_image_data(self.pixels.as_flattened())
            .map_err(encoding)?;
        writer.finish().map_err(encoding)?;
        Ok(bytes)
    }
}

/// Visits the pixels of a disc with their covered fractions, computed to a tenth of a pixel.
pub fn disc(x: f64, y: f64, radius: f64, mut cover: impl FnMut(usize, usize, f64)) {
    let reach = radius + 1.0;
    let pixels =
        |centre: f64| (centre - reach).max(0.0) as usize..=(centre + reach).max(0.0) as usize;
    for row in pixels(y) {
        for column in pixels(x) {
            let away = f64::hypot(column as f64 + 0.5 - x, row as f64 + 0.5 - y);
            let share = (radius + 0.5 - away).clamp(0.0, 1.0);
            if share > 0.0 {
                cover(column, row, share);
            }
        }
    }
}

pub fn mixed(under: Colour, over: Colour, share: f64) -> Colour {
    let mut mixture = under;
    for (channel, over) in mixture.iter_mut().zip(over) {
        let (low, high) = (f64::from(*channel), f64::from(over));
        *channel = (low + share.clamp(0.0, 1.0) * (high - low)).round() as u8;
    }
    mixture
}
