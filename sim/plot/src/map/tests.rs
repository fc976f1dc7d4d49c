//! Tests of complete figures: size, colours at known positions, text, and invalid input.

use std::collections::BTreeSet;

use roxmltree::{Document, Node};

use super::types::Colour;
use super::*;
use crate::render_png;

const NAN: f64 = f64::NAN;

struct Picture {
    width: usize,
    height: usize,
    bytes: Vec<u8>,
}

impl Picture {
    fn render(svg: &str) -> Result<Self, PlotError> {
        Ok(Self::decode(&render_png(svg)?))
    }

    fn decode(png: &[u8]) -> Self {
        let decoder = png::Decoder::new(std::io::Cursor::new(png));
        let mut reader = decoder.read_info().unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut bytes).unwrap();
        assert_eq!(info.color_type, png::ColorType::Rgb);
        Self {
            width: info.width as usize,
            height: info.height as usize,
            bytes,
        }
    }

    fn colour_at(&self, column: usize, row: usize) -> Colour {
        let first = 3 * (row * self.width + column);
        self.bytes[first..first + 3].try_into().unwrap()
    }

    fn row_colours(&self, row: usize) -> Vec<Colour> {
        let mut colours: Vec<Colour> = (0..self.width).map(|x| self.colour_at(x, row)).collect();
        colours.dedup();
        colours
    }

    fn count(&self, is_meant: impl Fn(Colour) -> bool) -> usize {
        let pixels = self.bytes.chunks_exact(3);
        pixels.filter(|p| is_meant([p[0], p[1], p[2]])).count()
    }
}

fn coordinate<'a>(name: &str, unit: &str, values: &'a [f64]) -> Coordinate<'a> {
    Coordinate {
        name: name.to_owned(),
        unit: unit.to_owned(),
        spacing: Spacing::Linear,
        values,
    }
}

fn exponents<'a>(columns: &'a [f64], rows: &'a [f64], values: &'a [f64]) -> Map<'a> {
    Map {
        title: "Largest exponent of arm_1".to_owned(),
        horizontal: coordinate("b_sp", "m", columns),
        vertical: coordinate("omega", "rad/s", rows),
        quantity: "lambda_1".to_owned(),
        unit: "1/s".to_owned(),
        shades: Shades::Signed,
        values,
    }
}

#[test]
fn cells_have_their_colours() -> Result<(), PlotError> {
    // Bottom row: smallest value, zero. Top row: largest value, no value.
    let (columns, rows) = ([0.0, 1e-4], [10.0, 20.0]);
    let map = exponents(&columns, &rows, &[-8.0, 0.0, 8.0, NAN]);
    let picture = Picture::render(&draw_map(&map)?)?;
    assert_eq!((picture.width, picture.height), (1000, 760));
    // Centres of the four quarters of the frame, which extends from 85 px to 845 px.
    let (left, right, low, high) = (280, 650, 530, 210);
    assert_eq!(picture.colour_at(left, low), [0x05, 0x30, 0x61]);
    assert_eq!(picture.colour_at(right, low), [0xff, 0xff, 0xff]);
    assert_eq!(picture.colour_at(left, high), [0x67, 0x00, 0x1f]);
    assert_eq!(picture.colour_at(right, high), [158; 3]);
    Ok(())
}

#[test]
fn map_with_unequal_sides_shows_both_signs() -> Result<(), PlotError> {
    let (columns, rows) = ([0.0, 1.0, 2.0], [1.0]);
    let strong = exponents(&columns, &rows, &[-2.0, 5.0, 100.0]);
    let picture = Picture::render(&draw_map(&strong)?)?;
    // Row 600 is within the only row of cells; the bar has one colour along it.
    let colours = picture.row_colours(600);
    for end in [[0x05, 0x30, 0x61], [0x67, 0x00, 0x1f]] {
        assert!(colours.contains(&end), "{end:?} in {colours:?}");
    }
    // For ratios up to three, equal magnitudes have equal shades: -4 and 4 are halfway on a scale up to 8.
    let even = exponents(&columns, &rows, &[-4.0, 4.0, 8.0]);
    let picture = Picture::render(&draw_map(&even)?)?;
    let colours = picture.row_colours(600);
    // Colour halfway between the middle and an end of eleven colours, which is between two of them.
    let (blue, red) = ([0x6b, 0xac, 0xd1], [0xe5, 0x83, 0x68]);
    assert!(
        colours.contains(&blue) && colours.contains(&red),
        "{colours:02x?}"
    );
    Ok(())
}

#[test]
fn sequential_shades_go_from_least_to_greatest() -> Result<(), PlotError> {
    let (columns, rows) = ([1.0, 10.0, 100.0], [1.0]);
    let mut map = exponents(&columns, &rows, &[1e-6, 2e-6, 3e-6]);
    map.shades = Shades::Sequential;
    map.horizontal.spacing = Spacing::Logarithmic;
    let picture = Picture::render(&draw_map(&map)?)?;
    let colours = picture.row_colours(400);
    for shade in [[0x44, 0x01, 0x54], [0x21, 0x91, 0x8c], [0xfd, 0xe7, 0x25]] {
        assert!(colours.contains(&shade), "{shade:02x?} in {colours:02x?}");
    }
    // On a logarithmic axis, equal ratios have equal widths: a third of the frame each.
    let width = |shade| {
        (0..1000)
            .filter(|x| picture.colour_at(*x, 400) == shade)
            .count()
    };
    let (first, last) = (width([0x44, 0x01, 0x54]), width([0xfd, 0xe7, 0x25]));
    assert!(first > 200 && first.abs_diff(last) <= 1, "{first} {last}");
    Ok(())
}

#[test]
fn points_are_at_their_coordinates() -> Result<(), PlotError> {
    let (along, up) = ([0.0, 1.0, 2.0, NAN], [0.0, 1e-6, -1e-6, 5.0]);
    let scatter = Scatter {
        title: "Section".to_owned(),
        horizontal: coordinate("b_sp", "m", &along),
        vertical: coordinate("x_sp", "m", &up),
    };
    let picture = Picture::render(&draw_scatter(&scatter)?)?;
    let is_ink = |colour: Colour| colour[2].saturating_sub(colour[0]) > 60;
    // Three discs of radius 3 px cover 28 px each, less at their edges.
    let ink = picture.count(is_ink);
    assert!((60..120).contains(&ink), "{ink}");
    let middle = (0..760).filter(|row| (450..600).any(|x| is_ink(picture.colour_at(x, *row))));
    let rows: Vec<usize> = middle.collect();
    // The middle abscissa has the largest value, which is drawn near the top (52 px), below the margin.
    assert!(rows.iter().all(|row| (60..90).contains(row)), "{rows:?}");
    Ok(())
}

#[test]
fn diagram_is_independent_of_order_and_reproducible() -> Result<(), PlotError> {
    let along: Vec<f64> = (0..5000).map(|i| f64::from(i / 50)).collect();
    let up: Vec<f64> = (0..5000).map(|i| (f64::from(i) * 0.7).sin()).collect();
    let picture = |along: &[f64], up: &[f64]| {
        draw_scatter(&Scatter {
            title: "t".to_owned(),
            horizontal: coordinate("b", "m", along),
            vertical: coordinate("x", "m", up),
        })
    };
    let forwards = picture(&along, &up)?;
    assert_eq!(forwards, picture(&along, &up)?);
    let reversed = |values: &[f64]| values.iter().rev().copied().collect::<Vec<_>>();
    let backwards = Picture::render(&picture(&reversed(&along), &reversed(&up))?)?;
    let forwards = Picture::render(&forwards)?;
    // The products are computed in another order, so they differ in the last bit and a colour can be rounded
    // differently.
    let differing = forwards.bytes.iter().zip(&backwards.bytes);
    assert!(differing.into_iter().all(|(a, b)| a.abs_diff(*b) <= 1));
    Ok(())
}

/// Checks that a figure is well formed, without identifiers, and that no text reaches its edges.
fn check(svg: &str) -> Result<(), PlotError> {
    let document = Document::parse(svg).unwrap();
    let allowed = [
        "svg", "title", "style", "rect", "path", "text", "tspan", "image", "g", "circle",
    ];
    for node in document.descendants().filter(Node::is_element) {
        assert!(allowed.contains(&node.tag_name().name()), "{node:?}");
        let link = node.attribute("href").unwrap_or("data:image/png;base64,");
        assert!(link.starts_with("data:image/png;base64,"), "{link}");
    }
    assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
    let picture = Picture::render(svg)?;
    assert_eq!((picture.width, picture.height), (1000, 760));
    let is_white = |column, row| picture.colour_at(column, row) == [255; 3];
    assert!((0..1000).all(|column| is_white(column, 0) && is_white(column, 759)));
    assert!((0..760).all(|row| is_white(0, row) && is_white(999, row)));
    Ok(())
}

#[test]
fn extreme_maps_are_drawn() -> Result<(), PlotError> {
    for (columns, values) in [
        (&[0.0, 1e-300][..], &[0.0, 0.0][..]),
        (&[1.0, 1.0 + 1e-15], &[5.0, 5.0]),
        (&[-1e99, 1e99], &[1e99, -1e99]),
        (&[1.0, 2.0], &[NAN, 5e-324]),
        (&[1.0, 2.0], &[f64::INFINITY, -3.0]),
        (&[3.0], &[7.0]),
    ] {
        for shades in [Shades::Signed, Shades::Sequential] {
            let mut map = exponents(columns, &[1.0], values);
            map.shades = shades;
            check(&draw_map(&map)?)?;
        }
    }
    Ok(())
}

#[test]
fn hostile_text_is_escaped_and_inside_the_figure() -> Result<(), PlotError> {
    for hostile in [
        "\0\u{1b}[31m θ̈ 漢字 ".repeat(200),
        "W".repeat(300),
        "</text><script>alert(1)</script> & \" ' ".repeat(20),
        String::new(),
    ] {
        let mut map = exponents(&[1.0, 2.0], &[1.0], &[NAN, 5.0]);
        map.title = hostile.clone();
        map.quantity = hostile.clone();
        map.horizontal.unit = hostile.clone();
        map.vertical.name = hostile.clone();
        check(&draw_map(&map)?)?;
    }
    Ok(())
}

#[test]
fn extreme_scatter_plots_are_drawn() -> Result<(), PlotError> {
    for (along, up) in [
        (vec![1.0], vec![0.0]),
        (vec![0.0, 1.0], vec![-1e99, 1e99]),
        (vec![0.0, 1.0, 2.0], vec![f64::INFINITY, 5e-324, NAN]),
        (vec![4.0; 9000], vec![-2.0; 9000]),
    ] {
        let title = "W_1 ".repeat(300);
        let scatter = Scatter {
            title: title.clone(),
            horizontal: coordinate(&title, "m", &along),
            vertical: coordinate(&title, &title, &up),
        };
        check(&draw_scatter(&scatter)?)?;
    }
    Ok(())
}

#[test]
fn subscript_is_below_base_line_without_ligature() -> Result<(), PlotError> {
    let ink = |name: &str| -> Result<u32, PlotError> {
        let picture = Picture::render(&draw_scatter(&Scatter {
            title: String::new(),
            horizontal: coordinate(name, "", &[1.0]),
            vertical: coordinate("x", "", &[1.0]),
        })?)?;
        // The base line is at 743 px; subscripts are 3 px lower.
        let rows = 744..747;
        let pixels_of = |row| (0..1000).map(move |column| (column, row));
        let pixels = rows.flat_map(pixels_of);
        Ok(pixels
            .map(|(x, y)| 255 - u32::from(picture.colour_at(x, y)[0]))
            .sum())
    };
    // In f_la, the ligature of f and l would be above the base line.
    let (expected, found) = (ink("x_la")?, ink("f_la")?);
    assert!(
        found.abs_diff(expected) < expected / 8,
        "{found} {expected}"
    );
    Ok(())
}

#[test]
fn size_is_bounded() -> Result<(), PlotError> {
    // A linear congruential generator makes the image nearly incompressible.
    let mut state = 1_u32;
    let mut next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 8) / f64::from(1_u32 << 24)
    };
    let values: Vec<f64> = (0..1_000_000).map(|_| next()).collect();
    let lines: Vec<f64> = (0..1000).map(f64::from).collect();
    let svg = draw_map(&exponents(&lines, &lines, &values))?;
    // Three bytes per pixel of the frame, and four characters per three bytes.
    assert!(svg.len() < 4 * 1000 * 760, "{} bytes", svg.len());
    for count in [2000, 200_000] {
        let svg = draw_scatter(&Scatter {
            title: String::new(),
            horizontal: coordinate("b", "m", &values[..count]),
            vertical: coordinate("x", "m", &values[count..2 * count]),
        })?;
        assert!(svg.len() < 1_500_000, "{count}: {} bytes", svg.len());
    }
    Ok(())
}

#[test]
fn uneven_cells_have_their_widths() -> Result<(), PlotError> {
    // The edges are at -0.5, 0.5, 2.5 and 5.5.
    let (columns, rows) = ([0.0, 1.0, 4.0], [1.0]);
    let mut map = exponents(&columns, &rows, &[0.0, 1.0, 2.0]);
    map.shades = Shades::Sequential;
    let picture = Picture::render(&draw_map(&map)?)?;
    let width = |shade| {
        (0..860)
            .filter(|x| picture.colour_at(*x, 400) == shade)
            .count()
    };
    let widths = [[0x44, 0x01, 0x54], [0x21, 0x91, 0x8c], [0xfd, 0xe7, 0x25]].map(width);
    let unit = widths.iter().sum::<usize>() / 6;
    for (width, share) in widths.into_iter().zip([1, 2, 3]) {
        assert!(width.abs_diff(share * unit) <= 4, "{widths:?}");
    }
    Ok(())
}

#[test]
fn text_is_lettered_like_other_figures() -> Result<(), PlotError> {
    let (columns, rows) = ([0.0, 1e-4], [10.0, 20.0]);
    let svg = draw_map(&exponents(&columns, &rows, &[-8.0, 0.0, 8.0, NAN]))?;
    let document = Document::parse(&svg).unwrap();
    let texts = document.descendants().filter(|n| n.has_tag_name("text"));
    let texts: BTreeSet<String> = texts
        .map(|node| {
            node.descendants()
                .filter(Node::is_text)
                .filter_map(|n| n.text())
                .collect()
        })
        .collect();
    for text in [
        "Largest exponent of arm_1",
        "bsp [µm]",
        "ω [rad/s]",
        "λ1 [1/s]",
        "−4",
        "no value",
    ] {
        assert!(texts.contains(text), "{text} is not in {texts:?}");
    }
    Ok(())
}

#[test]
fn invalid_pictures_are_an_error() {
    let attempt = |columns: &[f64], values: &[f64]| draw_map(&exponents(columns, &[1.0], values));
    assert_eq!(
        attempt(&[1.0, 2.0], &[1.0]),
        Err(PlotError::Cells {
            columns: 2,
            rows: 1,
            values: 1
        })
    );
    let nothing = Err(empty_error("lambda_1"));
    assert_eq!(attempt(&[], &[]), nothing);
    assert_eq!(attempt(&[1.0, 2.0], &[NAN, NAN]), nothing);
    for columns in [[2.0, 2.0], [2.0, 1.0], [2.0, NAN]] {
        let refused = attempt(&columns, &[1.0, 1.0]);
        assert!(matches!(refused, Err(PlotError::Grid { index: 1, .. })));
    }
    let mut logarithmic = exponents(&[0.0, 1.0], &[1.0], &[1.0, 1.0]);
    logarithmic.horizontal.spacing = Spacing::Logarithmic;
    assert!(matches!(
        draw_map(&logarithmic),
        Err(PlotError::Grid { index: 0, .. })
    ));
    let scatter = |along, up| {
        draw_scatter(&Scatter {
            title: String::new(),
            horizontal: coordinate("b", "m", along),
            vertical: coordinate("x", "m", up),
        })
    };
    assert!(matches!(
        scatter(&[1.0], &[]),
        Err(PlotError::Lengths { .. })
    ));
    assert_eq!(scatter(&[], &[]), Err(empty_error("x")));
    assert_eq!(scatter(&[1.0], &[NAN]), Err(empty_error("x")));
}
