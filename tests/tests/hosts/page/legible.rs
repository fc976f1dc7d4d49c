//! Tests of the legibility of the tour, of reports and of interactive pages. No text is smaller than 11 px in any
//! window. No names of the program appear in prose. No commands and numbers are cut, no texts overlap in figures, no
//! column consists of single words, dots of rates are above their letters, and figures have the colours of the page.

use std::path::Path;

use eomgen_tests::measured::{DESCRIPTION, Measured};
use eomgen_tests::models::{path, project};
use eomgen_tests::program::run_accepted;
use serde_json::{Value, json};

use super::browser::{BrowserSettings, WIDE_WINDOW, browser, run_probe_script};
use super::{drawn_example, write_page};

/// Smallest font size, in px.
const SMALLEST: f64 = 11.0;

const NARROW_DARK: BrowserSettings = BrowserSettings {
    width: 400,
    dark: true,
    ..WIDE_WINDOW
};

/// Window of a tablet.
const MEDIUM: BrowserSettings = BrowserSettings {
    width: 800,
    ..WIDE_WINDOW
};

/// Asserts the legibility of a page: narrow in dark colours, medium and wide in light colours.
fn assert_legible(browser: &str, page: &Path) {
    for look in [NARROW_DARK, MEDIUM, WIDE_WINDOW] {
        let seen = run_probe_script("legible.js", browser, page, look);
        assert_eq!(seen["errors"], json!([]), "{seen}");
        assert_eq!(seen["excess"], 0, "wider than its window: {seen}");
        let size = seen["smallest"].as_f64().expect("a number");
        // Font sizes in scaled figures are rounded.
        assert!(size > SMALLEST - 0.05, "{seen}");
        for key in [
            "identifiers",
            "cut",
            "fields",
            "columns",
            "dots",
            "overlaps",
        ] {
            assert_eq!(seen[key], json!([]), "{key}: {seen}");
        }
        let figures = seen["backgrounds"].as_array().expect("a list");
        assert!(figures.iter().all(|fill| *fill == seen["page"]), "{seen}");
    }
}

#[test]
fn tour_is_legible_and_moves() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("tour");
    run_accepted(&["tour", "--out", &out.display().to_string()]);
    let page = std::fs::read_to_string(out.join("index.html")).expect("a page");
    let opening = page.split("<nav>").next().expect("an opening");
    assert!(
        opening.contains("<canvas id=\"drawing\""),
        "nothing moves at the top"
    );
    assert!(
        opening.contains("eomgen found Coulomb friction of 1"),
        "{opening}"
    );
    for raw in ["nesting_bias", "regime_kernels", "train[0]", "e-5 m", "+-"] {
        let prose = page
            .split("<iframe")
            .next()
            .expect("text before the reports");
        let prose = prose
            .split("<pre>")
            .map(|part| part.split_once("</pre>").map_or(part, |(_, rest)| rest));
        assert!(prose.clone().all(|part| !part.contains(raw)), "{raw}");
    }
    let Some(browser) = browser() else { return };
    assert_legible(browser, &out.join("index.html"));
    let seen = run_probe_script("probe.js", browser, &out.join("index.html"), WIDE_WINDOW);
    assert_eq!(seen["moved"], json!([true, true, true]), "{seen}");
}

/// Runs a command on a stage with hidden friction; returns its folder.
fn run_report(command: &str) -> Measured {
    let measured = Measured::stage(3.0);
    measured.write(
        "dataset.toml",
        format!("title = \"Stage\"\n{DESCRIPTION}").as_bytes(),
    );
    measured.run_command(command, "out");
    measured
}

#[test]
fn reports_are_legible_and_name_their_records() {
    for command in ["compare", "discover"] {
        let measured = run_report(command);
        let page = measured.read("out/report.html");
        let figures: Vec<&str> = page.split("<figure>").skip(1).collect();
        assert!(figures.len() > 3, "{} figures", figures.len());
        for figure in figures {
            let caption = figure.split("<figcaption>").nth(1).expect("a caption");
            let caption = caption.split("</figcaption>").next().expect("its end");
            assert!(caption.to_lowercase().contains("record"), "{caption}");
        }
        let labels = ["simulated before", "simulated after"];
        let expected = command == "discover";
        assert!(
            labels.iter().all(|label| page.contains(label) == expected),
            "{command}"
        );
        assert!(page.contains(">simulated<") != expected, "{command}");
        for wrong in ["(m)²", "m²/Hz]</text>"] {
            assert!(
                !page
                    .replace("mm²", "")
                    .replace("µm²", "")
                    .replace("nm²", "")
                    .contains(wrong),
                "{wrong}"
            );
        }
        let Some(browser) = browser() else { return };
        assert_legible(browser, &measured.file("out/report.html"));
    }
}

/// Evaluates an expression with the functions of the page's scripts and returns the printed text.
fn run_on_canvas(expression: &str) -> String {
    let read = |file: &str| std::fs::read_to_string(project().join(file)).expect("a script");
    let script = [
        read("sim/page/src/play/canvas.js"),
        read("sim/page/src/play/slider.js"),
        read("cli/src/page/play/curves.js"),
        format!("console.log(JSON.stringify({expression}))"),
    ];
    let output = std::process::Command::new("node")
        .args(["-e", &script.concat()])
        .output()
        .expect("node can be run");
    String::from_utf8_lossy(&output.stdout).trim().to_owned()
}

#[test]
fn numbers_on_canvas_have_powers_of_ten() {
    if browser().is_none() {
        return;
    }
    let written = run_on_canvas("[-2.5e-7, 1e16, 0, 12.5].map((value) => shown(value, 3))");
    assert_eq!(written, r#"["−2.5·10⁻⁷","1.0·10¹⁶","0","12.5"]"#);
}

#[test]
fn rounding_errors_on_canvas_are_zero_or_constant() {
    if browser().is_none() {
        return;
    }
    let written = run_on_canvas("[-1.75e-43, 2e-3].map((value) => withoutNoise(value, 3e-14))");
    assert_eq!(written, "[0,0.002]");
    let (low, high) = (16.2, 16.2 * (1.0 + 1e-7));
    let written = run_on_canvas(&format!("endLabels(...ends([{low}, {high}]))"));
    assert_eq!(written, r#"["8.1","24.3"]"#);
    let written = run_on_canvas("endLabels(...ends([16.2, 16.21]))");
    assert_eq!(written, r#"["16.2","16.21"]"#);
}

#[test]
fn changed_values_are_a_list() {
    if browser().is_none() {
        return;
    }
    let controls = "[\"m = 0 kg\", \"\", \"l = 2 m\"].map((text) => ({ changed: () => text }))";
    let written = run_on_canvas(&format!("changedValues({controls})"));
    assert_eq!(written, r#""m = 0 kg, l = 2 m""#);
}

#[test]
fn curves_have_different_colours() {
    if browser().is_none() {
        return;
    }
    assert_eq!(
        run_on_canvas("distinctMarks([0, 1, 6, 12], 6)"),
        "[0,1,2,3]"
    );
    assert_eq!(run_on_canvas("distinctMarks([0, 2, 2, 1], 3)"), "[0,2,1,1]");
}

#[test]
fn pages_without_javascript_have_no_inactive_controls() {
    let Some(browser) = browser() else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let measured = run_report("discover");
    let page = write_page(&path("crane"), &[], folder.path());
    for page in [page, measured.file("out/report.html")] {
        let look = BrowserSettings {
            scripts: false,
            ..WIDE_WINDOW
        };
        let seen = run_probe_script("unscripted.js", browser, &page, look);
        assert_eq!(seen["dead"], json!([]), "{seen}");
        assert_eq!(seen["message"], true, "{seen}");
        let height = seen["controls"].as_f64().expect("a height");
        assert!(height > 60.0, "{seen}");
    }
}

#[test]
fn fast_machine_starts_in_slow_motion() {
    let speed = |spec: &Path| {
        let page = run_accepted(&["page", &spec.display().to_string(), "--out", "-"]);
        let (_, control) = page.split_once("<input id=\"speed\"").expect("a speed");
        let (_, value) = control.split_once("value=\"").expect("a value");
        let (value, _) = value.split_once('"').expect("its end");
        value.parse::<f64>().expect("a number")
    };
    // The natural frequency of the resonator is about 20 kHz.
    let resonator = speed(&project().join("examples/recipes/mems_resonator.toml"));
    assert!((-5.0..-4.0).contains(&resonator), "{resonator}");
    assert_eq!(speed(&path("crane")), 0.0);
}

#[test]
fn interactive_pages_are_legible() {
    let Some(browser) = browser() else { return };
    let folder = tempfile::tempdir().expect("a folder");
    for spec in [
        path("crane"),
        path("planetary_arm"),
        drawn_example("double_pendulum"),
        project().join("examples/constrained/flexible_coupler.toml"),
        project().join("examples/friction/stribeck_belt.toml"),
        project().join("examples/impacts/box_with_friction.toml"),
        project().join("examples/recipes/hydraulic_axis.toml"),
        project().join("examples/recipes/mems_resonator.toml"),
        project().join("examples/recipes/robot_arm.toml"),
    ] {
        assert_legible(browser, &write_page(&spec, &[], folder.path()));
    }
}

/// Returns the data of a page's script.
fn data(page: &str) -> Value {
    let text = page
        .split("<script id=\"model\" type=\"application/json\">")
        .nth(1);
    let text = text.and_then(|text| text.split("</script>").next());
    serde_json::from_str(text.expect("data")).expect("JSON")
}

#[test]
fn field_without_drawing_has_its_shapes() {
    let spec = path("hub_beam_tip_mass").display().to_string();
    let data = data(&run_accepted(&[
        "page", &spec, "--order", "3", "--out", "-",
    ]));
    let field = &data["fields"][0];
    let rows = field["functions"].as_array().expect("rows");
    assert!(
        rows.len() > 20
            && rows
                .iter()
                .all(|row| row.as_array().expect("a row").len() == 3)
    );
    let first: Vec<f64> = rows
        .iter()
        .map(|row| row[0].as_f64().expect("a number"))
        .collect();
    // The first clamped-free mode is 0 at the clamp and increases towards the free end.
    assert!(
        first[0].abs() < 1e-12 && first.is_sorted() && first[rows.len() - 1] > 1.0,
        "{first:?}"
    );
}

#[test]
fn names_are_symbols_on_canvas_and_controls() {
    let spec = path("double_pendulum").display().to_string();
    let page = run_accepted(&["page", &spec, "--out", "-"]);
    assert_eq!(data(&page)["state"][0]["symbol"], json!(["θ", "1"]));
    assert_eq!(data(&page)["state"][2]["symbol"], json!(["θ\u{307}", "1"]));
    assert!(!page.contains(">theta_1") && !page.contains("Sums run over the modes"));
}
