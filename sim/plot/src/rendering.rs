//! PNG of figures: rendering of SVG documents, and encoding of pixels.

use std::sync::Arc;

use resvg::tiny_skia::{Pixmap, PixmapPaint, Transform};
use resvg::usvg::fontdb::{Database, Source};
use resvg::usvg::{ImageKind, Node, Options, Tree};

use super::PlotError;
use super::palette::without_style;

/// Renders an SVG document of this crate as PNG with its width and height in px. The font is DejaVu Sans, which
/// is part of the program; system fonts are not used.
///
/// # Errors
///
/// [`PlotError::Encoding`] for a text that is not an SVG document.
pub fn render_png(svg: &str) -> Result<Vec<u8>, PlotError> {
    let mut fonts = Database::new();
    for font in [dejavu::sans::regular(), dejavu::sans::bold()] {
        fonts.load_font_source(Source::Binary(Arc::new(font)));
    }
    let options = Options {
        fontdb: Arc::new(fonts),
        ..Options::default()
    };
    // Without zero-width non-joiners, a letter and its subscript could become a ligature (f_la).
    let svg = without_style(svg).replace("<tspan", "\u{200c}<tspan");
    let tree = Tree::from_str(&svg, &options).map_err(encoding_error)?;
    let size = tree.size().to_int_size();
    let mut pixmap = Pixmap::new(size.width(), size.height())
        .ok_or_else(|| encoding_error("the figure is too large"))?;
    for node in tree.root().children() {
        draw_node(&mut pixmap, node)?;
    }
    // The background is opaque, so premultiplied and plain colours are equal.
    let pixels = pixmap.pixels().iter();
    let bytes: Vec<u8> = pixels
        .flat_map(|pixel| [pixel.red(), pixel.green(), pixel.blue()])
        .collect();
    encode_png((size.width(), size.height()), png::ColorType::Rgb, &bytes)
}

/// Draws an element of the document. This function draws images itself, because `resvg` omits all images if its
/// decoders for JPEG, GIF and WebP are disabled.
fn draw_node(pixmap: &mut Pixmap, node: &Node) -> Result<(), PlotError> {
    let children = match node {
        Node::Group(group) => group.children(),
        _ => &[],
    };
    if let [Node::Image(image)] = children
        && let ImageKind::PNG(png) = image.kind()
    {
        let image_pixels = Pixmap::decode_png(png).map_err(encoding_error)?;
        let (paint, transform) = (PixmapPaint::default(), image.abs_transform());
        pixmap.draw_pixmap(0, 0, image_pixels.as_ref(), &paint, transform, None);
    } else if let Some(area) = node.abs_layer_bounding_box() {
        // `render_node` moves the corner of the area to the origin.
        let transform = Transform::from_translate(area.x(), area.y());
        resvg::render_node(node, transform, &mut pixmap.as_mut());
    }
    Ok(())
}

/// Encodes pixels row by row, with eight bits per channel.
pub(super) fn encode_png(
    (width, height): (u32, u32),
    colours: png::ColorType,
    bytes: &[u8],
) -> Result<Vec<u8>, PlotError> {
    let mut encoded = Vec::new();
    let mut encoder = png::Encoder::new(&mut encoded, width, height);
    encoder.set_color(colours);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::High);
    let mut writer = encoder.write_header().map_err(encoding_error)?;
    writer.write_image_data(bytes).map_err(encoding_error)?;
    writer.finish().map_err(encoding_error)?;
    Ok(encoded)
}

fn encoding_error(reason: impl ToString) -> PlotError {
    PlotError::Encoding {
        reason: reason.to_string(),
    }
}
