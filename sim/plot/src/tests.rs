//! Tests of complete figures: well-formed, small and correctly labelled.

use roxmltree::{Document, Node};

use super::*;

const SAMPLE_COUNT: usize = 100_000;

fn times() -> Vec<f64> {
    (0..SAMPLE_COUNT)
        .map(|i| 2.0 * i as f64 / (SAMPLE_COUNT - 1) as f64)
        .collect()
}

fn noisy(times: &[f64], amplitude: f64) -> Vec<f64> {
    times
        .iter()
        .map(|t| amplitude * ((31.4 * t).sin() + (9e4 * t).sin()))
        .collect()
}

fn series<'a>(label: &str, abscissa: &'a [f64], values: &'a [f64]) -> Series<'a> {
    Series {
        label: label.to_owned(),
        abscissa,
        values,
        role: SeriesRole::Plain,
    }
}

fn panel<'a>(quantity: &str, unit: &str, series: Vec<Series<'a>>) -> Panel<'a> {
    Panel {
        title: String::new(),
        quantity: quantity.to_owned(),
        unit: unit.to_owned(),
        series,
        references: Vec::new(),
    }
}

fn history(panels: Vec<Panel<'_>>) -> Result<String, PlotError> {
    time_history(&TimeHistory {
        title: "test".to_owned(),
        panels,
    })
}

fn text_of(node: Node<'_, '_>) -> String {
    node.descendants()
        .filter(Node::is_text)
        .filter_map(|n| n.text())
        .collect()
}

fn texts(document: &Document<'_>) -> Vec<String> {
    let nodes = document.descendants().filter(|n| n.has_tag_name("text"));
    nodes.map(text_of).collect()
}

fn curves<'a>(document: &'a Document<'_>, colour: &str) -> Vec<&'a str> {
    document
        .descendants()
        .filter(|n| n.has_tag_name("path") && n.attribute("stroke") == Some(colour))
        .filter_map(|n| n.attribute("d"))
        .collect()
}

#[test]
fn many_samples_give_small_well_formed_figure() -> Result<(), Box<dyn std::error::Error>> {
    let t = times();
    let values = noisy(&t, 2e-5);
    for curves_per_panel in [1, 9] {
        let all = vec![series("run", &t, &values); curves_per_panel];
        let svg = history(vec![
            panel("x_sp", "m", all.clone()),
            panel("x_pr", "m", all),
        ])?;
        assert!(svg.len() < 200_000, "{} bytes", svg.len());
        let document = Document::parse(&svg)?;
        let points: usize = curves(&document, "#0072b2")
            .iter()
            .map(|d| d.matches(',').count())
            .sum();
        assert!(points > 500 && points < 2 * 2 * 4 * 900, "{points} points");
    }
    Ok(())
}

#[test]
fn labels_have_prefixes_and_subscripts() -> Result<(), Box<dyn std::error::Error>> {
    let t = [0.0, 1.0, 2.0];
    let panels = vec![
        panel("x_sp", "m", vec![series("", &t, &[0.0, 3e-5, -1e-5])]),
        panel("theta_c", "rad", vec![series("", &t, &[0.0, 0.02, 0.01])]),
    ];
    let svg = history(panels)?;
    let texts = texts(&Document::parse(&svg)?);
    for label in ["xsp [µm]", "θc [mrad]", "t [s]", "−10", "30"] {
        assert!(
            texts.iter().any(|text| text == label),
            "{label} is not in {texts:?}"
        );
    }
    Ok(())
}

#[test]
fn samples_that_are_not_finite_leave_gaps() -> Result<(), Box<dyn std::error::Error>> {
    let t: Vec<f64> = (0..9).map(f64::from).collect();
    let mut values = t.clone();
    values[2] = f64::NAN;
    values[5] = f64::INFINITY;
    values[6] = f64::NEG_INFINITY;
    let svg = history(vec![panel("x", "m", vec![series("", &t, &values)])])?;
    let document = Document::parse(&svg)?;
    let curves = curves(&document, "#0072b2");
    let lines: Vec<usize> = curves
        .iter()
        .flat_map(|d| d.split('M').skip(1))
        .map(|line| line.matches(',').count())
        .collect();
    assert_eq!(lines, [2, 2, 2]);
    Ok(())
}

#[test]
fn legend_is_drawn_only_for_several_series() -> Result<(), Box<dyn std::error::Error>> {
    let t = [0.0, 1.0];
    let one = history(vec![panel("x", "m", vec![series("first", &t, &t)])])?;
    let two = vec![series("first", &t, &t), series("second", &t, &t)];
    let two = history(vec![panel("x", "m", two)])?;
    assert!(!one.contains("first"));
    assert!(two.contains(">first<") && two.contains(">second<"));
    Ok(())
}

#[test]
fn reference_lines_are_dashed_labelled_and_in_the_frame() -> Result<(), Box<dyn std::error::Error>>
{
    let t = [0.0, 1.0];
    let mut limits = panel("x", "m", vec![series("", &t, &[0.0, 1e-6])]);
    for (label, value) in [("+b_sp", 25e-6), ("−b_sp", -25e-6), ("nowhere", f64::NAN)] {
        limits.references.push(Reference {
            label: label.to_owned(),
            value,
        });
    }
    let svg = history(vec![limits])?;
    let document = Document::parse(&svg)?;
    let texts = texts(&document);
    let is_written = |text: &str| texts.iter().any(|t| t == text);
    assert!(is_written("+bsp") && is_written("−bsp") && !is_written("nowhere"));
    assert!(is_written("20") && is_written("−20"), "{texts:?}");
    let dashed = document
        .descendants()
        .filter(|n| n.attribute("stroke-dasharray").is_some());
    assert_eq!(dashed.count(), 2);
    Ok(())
}

#[test]
fn markup_in_text_is_escaped() -> Result<(), Box<dyn std::error::Error>> {
    let t = [0.0, 1.0];
    let hostile = "</text><script>alert(1)</script> & \" ' \0 \u{1b}";
    let mut panel = panel(
        hostile,
        hostile,
        vec![series(hostile, &t, &t), series("", &t, &t)],
    );
    panel.title = hostile.to_owned();
    panel.references = vec![Reference {
        label: hostile.to_owned(),
        value: 0.5,
    }];
    let svg = time_history(&TimeHistory {
        title: hostile.to_owned(),
        panels: vec![panel],
    })?;
    let document = Document::parse(&svg)?;
    let allowed = ["svg", "title", "style", "rect", "path", "text", "tspan"];
    for node in document.descendants().filter(Node::is_element) {
        assert!(allowed.contains(&node.tag_name().name()), "{node:?}");
    }
    Ok(())
}

#[test]
fn spectrum_omits_values_without_logarithm() -> Result<(), Box<dyn std::error::Error>> {
    let frequencies = [0.0, 1.0, 10.0, 100.0, 1000.0];
    let densities = [1.0, 1e-8, 1e-10, 0.0, 1e-12];
    let content = panel("S_x", "m^2/Hz", vec![series("", &frequencies, &densities)]);
    let svg = spectrum(&Spectrum {
        title: "test".to_owned(),
        frequency: FrequencyAxis::Logarithmic,
        panels: vec![content],
    })?;
    let document = Document::parse(&svg)?;
    let texts = texts(&document);
    for label in ["Sx [m²/Hz]", "f [Hz]", "10⁻¹⁰", "10²"] {
        assert!(
            texts.iter().any(|text| text == label),
            "{label} is not in {texts:?}"
        );
    }
    assert!(!svg.contains("NaN"));
    let curves = curves(&document, "#0072b2");
    assert_eq!(curves.concat().matches('M').count(), 2);
    Ok(())
}

#[test]
fn extreme_values_are_drawn_without_overflow() -> Result<(), Box<dyn std::error::Error>> {
    let t = [0.0, 1.0, 2.0];
    let cases = [
        [0.0, 0.0, 0.0],
        [7.0, 7.0, 7.0],
        [1.0, 1.0 + 1e-15, 1.0],
        [-1e99, 1e99, 0.0],
        [5e-324, 0.0, 1e-310],
        [f64::MAX, 1.0, f64::MIN],
    ];
    for values in cases {
        let svg = history(vec![panel("x", "m", vec![series("", &t, &values)])])?;
        Document::parse(&svg)?;
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{values:?}");
    }
    let single = history(vec![panel("x", "m", vec![series("", &[3.0], &[1.0])])])?;
    assert!(single.contains("h0"));
    Ok(())
}

#[test]
fn invalid_figures_are_an_error() {
    let t = [0.0, 1.0];
    let nothing = [f64::NAN, f64::NAN];
    let series_of = |abscissa: &'static [f64], values: &'static [f64]| {
        history(vec![panel("x", "m", vec![series("a", abscissa, values)])])
    };
    assert_eq!(history(Vec::new()), Err(PlotError::NoPanels));
    assert_eq!(
        history(vec![panel("x", "m", Vec::new())]),
        Err(PlotError::NoSeries { panel: 0 })
    );
    let empty = Err(PlotError::Empty {
        panel: 0,
        series: "a".to_owned(),
    });
    assert_eq!(series_of(&[], &[]), empty);
    assert_eq!(
        history(vec![panel("x", "m", vec![series("a", &t, &nothing)])]),
        empty
    );
    assert!(matches!(
        series_of(&[0.0], &[0.0, 1.0]),
        Err(PlotError::Lengths { .. })
    ));
    for abscissa in [&[0.0, f64::NAN], &[1.0, 0.0]] {
        let wrong = series_of(abscissa, &[0.0, 1.0]);
        assert!(
            matches!(wrong, Err(PlotError::Abscissa { sample: 1, .. })),
            "{wrong:?}"
        );
    }
}

#[test]
fn overlaid_curves_are_dashed() -> Result<(), Box<dyn std::error::Error>> {
    let t = [1.0, 10.0, 100.0];
    let values = [1.0, 2.0, 3.0];
    let dashes = |overlaid| -> Result<Vec<bool>, Box<dyn std::error::Error>> {
        let frame = Frame {
            panel: panel(
                "dr",
                "m",
                vec![series("S = 4", &t, &values), series("S = 5", &t, &values)],
            ),
            axes: Axes::Frequency,
            marks: vec![Reference {
                label: "f_1".to_owned(),
                value: 10.0,
            }],
            is_overlaid: overlaid,
            ..Frame::default()
        };
        let svg = plate(&Plate {
            title: String::new(),
            columns: 1,
            frames: vec![frame],
        })?;
        let document = Document::parse(&svg)?;
        assert!(texts(&document).iter().any(|text| text == "f1"));
        let is_curve =
            |n: &Node<'_, '_>| matches!(n.attribute("stroke"), Some("#0072b2" | "#d55e00"));
        let curves = document.descendants().filter(is_curve);
        Ok(curves
            .map(|n| n.has_attribute("stroke-dasharray"))
            .collect())
    };
    // Curves first, then lines of the legend.
    assert_eq!(dashes(true)?, [false, true, false, true]);
    assert_eq!(dashes(false)?, [false; 4]);
    Ok(())
}

/// Returns the smallest font size of a figure, and its width, px.
fn smallest_lettering(svg: &str) -> Result<(f64, f64), Box<dyn std::error::Error>> {
    let document = Document::parse(svg)?;
    let sizes = document
        .descendants()
        .filter_map(|node| node.attribute("font-size")?.parse().ok());
    let width = document.root_element().attribute("width").unwrap_or("");
    Ok((sizes.fold(f64::INFINITY, f64::min), width.parse()?))
}

#[test]
fn narrow_figures_are_readable_without_scaling() -> Result<(), Box<dyn std::error::Error>> {
    let t = [0.0, 1.0];
    let mut content = panel(
        "x_sp",
        "m",
        vec![series("before", &t, &t), series("after", &t, &t)],
    );
    content.title = "Relative displacement of sun and planet along the line of action".to_owned();
    let frames = vec![Frame {
        panel: content.clone(),
        ..Frame::default()
    }];
    let history = TimeHistory {
        title: String::new(),
        panels: vec![content],
    };
    let plate = Plate {
        title: String::new(),
        columns: 2,
        frames: [frames.clone(), frames].concat(),
    };
    for svg in [
        time_history_at(&history, FigureWidth::Narrow)?,
        plate_at(&plate, FigureWidth::Narrow)?,
    ] {
        let (size, width) = smallest_lettering(&svg)?;
        assert!(size >= 11.0 && width <= 330.0, "{size} {width}");
        assert!(!svg.contains('…'), "a text is cut: {svg}");
        assert!(
            texts(&Document::parse(&svg)?).contains(&"action".to_owned()),
            "{svg}"
        );
    }
    Ok(())
}

#[test]
fn roles_have_the_same_colours_in_any_order() -> Result<(), Box<dyn std::error::Error>> {
    let t = [0.0, 1.0];
    let of = |role| Series {
        role,
        ..series("a", &t, &t)
    };
    let colours = |roles: &[SeriesRole]| -> Result<Vec<String>, Box<dyn std::error::Error>> {
        let all = roles.iter().map(|role| of(*role)).collect();
        let svg = history(vec![panel("x", "m", all)])?;
        let document = Document::parse(&svg)?;
        let strokes = document.descendants().filter_map(|n| n.attribute("stroke"));
        let known = ["#b9c2ca", "#0072b2", "#d55e00"];
        let strokes = strokes.filter(|stroke| known.contains(stroke));
        Ok(strokes.take(roles.len()).map(str::to_owned).collect())
    };
    use SeriesRole::{After, Before, Measured};
    assert_eq!(colours(&[Measured, Before])?, ["#b9c2ca", "#d55e00"]);
    assert_eq!(
        colours(&[Measured, Before, After])?,
        ["#b9c2ca", "#d55e00", "#0072b2"]
    );
    assert_eq!(colours(&[Before, After])?, ["#d55e00", "#0072b2"]);
    Ok(())
}

#[test]
fn every_colour_has_a_dark_counterpart() -> Result<(), Box<dyn std::error::Error>> {
    let t = [0.0, 1.0];
    let all = (0..9).map(|_| series("a", &t, &t)).collect();
    let svg = history(vec![panel("x", "m", all)])?;
    let bars = bars::histogram(&bars::Histogram {
        counts: &[1, 2],
        ..bars::Histogram::default()
    })?;
    for svg in [svg, bars] {
        let document = Document::parse(&svg)?;
        let style = document
            .descendants()
            .find(|node| node.has_tag_name("style"));
        let style = style.and_then(|node| node.text()).unwrap_or_default();
        assert!(
            style.starts_with("@media (prefers-color-scheme:dark)"),
            "{style}"
        );
        for node in document.descendants() {
            for name in ["fill", "stroke"] {
                let colour = node
                    .attribute(name)
                    .filter(|colour| colour.starts_with('#'));
                let Some(colour) = colour else { continue };
                assert!(
                    style.contains(&format!("[{name}=\"{colour}\"]")),
                    "{colour}"
                );
            }
        }
    }
    Ok(())
}
