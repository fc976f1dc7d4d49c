//! Tests of `modes --plot`: curves are compared with the closed form of a clamped beam, bars with the printed table.
//! The regime of a piecewise model is shown.

use eomgen_tests::program::{run, run_accepted, run_rejected, text};
use serde_json::Value;

use super::{BEAM, OSCILLATOR, numbers, run_json, shipped, write_model};

/// Mass on a spring that touches an elastic wall beyond a position.
const WALL: &str = r#"
[model]
name = "wall"
[parameters]
m = { value = 2, unit = "kg" }
k = { value = 50, unit = "N/m" }
k_w = { value = 150, unit = "N/m" }
d = { value = 0.1, unit = "m" }
[coordinates]
x = { unit = "m" }
[kinetic]
mass = "1/2*m*dot(x)^2"
[forces]
spring = { on = "x", value = "-k*x" }
wall = { on = "x", value = "-k_w*(x - d)*above(x - d)" }
"#;

/// Returns the points of all curves of a drawing, in pixels.
fn curves(svg: &str) -> Vec<Vec<(f64, f64)>> {
    let paths = svg
        .lines()
        .filter(|line| line.starts_with("<path") && line.contains("stroke=\"#0072b2\""));
    let points = |line: &str| {
        let data = line.split(" d=\"M").nth(1).expect("a line");
        let data = data.split('"').next().expect("its points");
        let point = |pair: &str| {
            let (x, y) = pair.split_once(',').expect("a pair");
            (x.parse().expect("a number"), y.parse().expect("a number"))
        };
        data.split(' ').map(point).collect()
    };
    paths.map(points).collect()
}

#[test]
fn curves_match_shapes_of_clamped_beam() {
    let folder = tempfile::tempdir().expect("a folder");
    let (spec, svg) = (
        write_model(folder.path(), BEAM),
        folder.path().join("a.svg"),
    );
    let shown = svg.display().to_string();
    run_accepted(&["modes", &spec, "--plot", &shown]);
    let svg = std::fs::read_to_string(svg).expect("the figure");
    let drawn = curves(&svg);
    assert_eq!(drawn.len(), 5);
    // Mode shape cosh - cos - sigma (sinh - sin), relative to the deflection of the free end (W. C. Young, R. G.
    // Budynas, Roark's Formulas).
    for (curve, wavenumber) in drawn
        .iter()
        .zip([1.875104069_f64, 4.694091133, 7.854757438])
    {
        let shape = |s: f64| {
            let sigma =
                (wavenumber.sinh() - wavenumber.sin()) / (wavenumber.cosh() + wavenumber.cos());
            let z = wavenumber * s;
            z.cosh() - z.cos() - sigma * (z.sinh() - z.sin())
        };
        let (first, last) = (curve[0].1, curve[curve.len() - 1].1);
        for (place, (_, y)) in curve.iter().enumerate() {
            let s = place as f64 / (curve.len() - 1) as f64;
            let found = (y - first) / (last - first);
            // Coordinates in pixels have two decimals, and the deflection of the end is about 50 pixels.
            let expected: f64 = shape(s) / shape(1.0);
            assert!(
                (found - expected).abs() < 1e-3,
                "{place}: {found} {expected}"
            );
        }
    }
    assert!(svg.contains("x</text>") || svg.contains("x [m]"), "{svg}");
    assert!(svg.contains("Hz, damping ratio 0.000000"), "{svg}");
}

#[test]
fn piecewise_model_prints_its_regime() {
    let folder = tempfile::tempdir().expect("a folder");
    let spec = write_model(folder.path(), WALL);
    let svg = folder.path().join("a.svg");
    let shown = svg.display().to_string();
    // The frequency is sqrt(k/m) = 5 rad/s without contact and sqrt((k + k_w)/m) = 10 rad/s in contact with the wall.
    for (x, side, omega) in [("0", "<", 5.0), ("0.2", ">", 10.0)] {
        let at = format!("x={x}");
        let found = run_json(&["modes", &spec, "--state", &at, "--json", "--plot", &shown]);
        let regime = &found["regime"][0];
        assert_eq!(regime["surface"], "x - d");
        assert_eq!(regime["side"], side);
        let frequency = found["modes"][0]["frequency"].as_f64().expect("a number");
        assert!((frequency * std::f64::consts::TAU - omega).abs() < 1e-12);
        let table = run_accepted(&["modes", &spec, "--state", &at]);
        assert!(
            table.ends_with(&format!("regime: x - d {side} 0\n")),
            "{table}"
        );
        let svg = std::fs::read_to_string(&svg).expect("the figure");
        let escaped = side.replace('<', "&lt;").replace('>', "&gt;");
        assert!(svg.contains(&format!("where x - d {escaped} 0")), "{svg}");
    }
}

#[test]
fn figures_of_all_machines_are_complete_documents() {
    let folder = tempfile::tempdir().expect("a folder");
    let svg = folder.path().join("a.svg");
    let shown = svg.display().to_string();
    let arm = shipped("planetary_arm");
    for arguments in [
        vec!["modes", &arm, "--order", "0"],
        vec!["modes", &arm, "--order", "1"],
        vec!["modes", &arm, "--order", "128"],
        vec!["modes", &shipped("loudspeaker")],
        vec!["modes", &shipped("chaplygin_sleigh"), "--state", "x_dot=1"],
        vec!["modes", &shipped("puma_560")],
        vec!["modes", &shipped("two_link_arm"), "--state", "theta_2=0.5"],
    ] {
        run_accepted(&[&arguments[..], &["--plot", &shown]].concat());
        let svg = std::fs::read_to_string(&svg).expect("the figure");
        assert!(svg.ends_with("</svg>\n") && svg.contains("mode 1: "));
        assert!(
            !svg.contains("NaN") && !svg.contains("inf"),
            "{arguments:?}"
        );
        let modes: Value = run_json(&[&arguments[..], &["--json"]].concat());
        let drawn = svg.matches(">mode ").count();
        assert_eq!(
            drawn,
            modes["modes"].as_array().expect("modes").len().min(12)
        );
    }
    // A machine with one coordinate has one bar of full length.
    let spec = write_model(folder.path(), OSCILLATOR);
    let found = run_json(&["modes", &spec, "--json", "--plot", &shown]);
    assert_eq!(numbers(&found["modes"][0]["shape"]), [1.0]);
    let svg = std::fs::read_to_string(&svg).expect("the figure");
    assert!(svg.contains("1.00 m"), "{svg}");
}

#[test]
fn figure_on_stdout_excludes_other_output() {
    let folder = tempfile::tempdir().expect("a folder");
    let spec = write_model(folder.path(), OSCILLATOR);
    let output = run(&["modes", &spec, "--plot", "-"]);
    let (figure, table) = (text(&output.stdout), text(&output.stderr));
    assert!(figure.starts_with("<svg") && figure.ends_with("</svg>\n"));
    assert!(table.contains("damping ratio"), "{table}");
    let message = run_rejected(&["modes", &spec, "--plot", "modes.png"]);
    assert!(message.contains("ends in .svg"), "{message}");
    let message = run_rejected(&["modes", &spec, "--json", "--plot", "-"]);
    assert!(message.contains("--json and --plot -"), "{message}");
}
