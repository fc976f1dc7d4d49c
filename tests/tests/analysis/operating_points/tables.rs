//! Tests of mode shapes from a file: frequencies of known shapes, certificates, and rejected files.

use std::f64::consts::{PI, TAU};
use std::fmt::Write;
use std::path::Path;

use eomgen_model_spec::source::Source;
use eomgen_tests::certified::certify;
use eomgen_tests::program::{run_accepted, run_rejected};

use super::{run_json, write_model};

/// Beam between x = 0.25 m and 0.95 m with its mode shapes in `modes.csv`.
const BEAM: &str = r#"
[model]
name = "beam"
[parameters]
mu = { value = 2, unit = "kg/m" }
B = { value = 3, unit = "N m^2" }
x_0 = { value = 0.25, unit = "m" }
l = { value = 0.7, unit = "m" }
[fields.w]
along = "x"
from = "x_0"
to = "x_0 + l"
basis = "table"
table = "modes.csv"
coordinates = "q"
order = 3
unit = "m"
[kinetic]
inertia = "1/2*integral(mu*dot(w)^2, w)"
[potential]
elastic = "1/2*integral(B*diff(w, x, 2)^2, w)"
"#;

const MORE: &str = r#"
bed = "1/2*integral(B*exp(-x/l)*diff(w, x, 1)^2, w)/l^2 + 1/4*integral(B*w^4, w)/l^6"
load = "-B*(2*integral(x*w, w)/l^4 + integral(w, w)/l^3)"
between = "1/2*B/l*at(diff(w, x, 1), x_0 + l/3)^2 + 1/2*B/l^3*at(w, x_0 + 0.9*l)^2"
ends = "1/2*B/l*at(diff(w, x, 1), x_0)^2 + 1/2*B/l^3*at(w, x_0 + l)^2"
mixed = "B*integral(x^2*w*diff(w, x, 2), w)/l^4 + B*integral(diff(w, x, 1)*diff(w, x, 2), w)/l"
[observables]
moment = { value = "B*at(diff(w, x, 2), x_0 + l/2)", unit = "N m" }
"#;

/// Returns a table of sine shapes at `rows` positions; positions are closer to each other near the start.
fn sines(rows: usize, modes: usize) -> String {
    let mut text = "x".to_owned();
    (1..=modes).for_each(|r| write!(text, ",phi_{r}").expect("written"));
    for row in 0..rows {
        let even = row as f64 / (rows - 1) as f64;
        let s = 0.8 * even + 0.2 * even * even;
        write!(text, "\n{}", 0.25 + 0.7 * s).expect("written");
        for r in 1..=modes {
            write!(text, ",{}", (r as f64 * PI * s).sin()).expect("written");
        }
    }
    text + "\n"
}

fn with_table(folder: &Path, specification: &str, table: impl AsRef<[u8]>) -> String {
    std::fs::write(folder.join("modes.csv"), table).expect("written");
    write_model(folder, specification)
}

/// Simply supported beam with its modes in a table. By Rayleigh's principle, the relative error of the frequencies is
/// the square of the curvature error: (r pi h)^4/720, plus a small contribution of the ends.
#[test]
fn frequencies_match_shapes_of_table() {
    let folder = tempfile::tempdir().expect("a folder");
    for (rows, tolerance) in [(41, 1e-4), (161, 1e-6)] {
        let model = with_table(folder.path(), BEAM, sines(rows, 3));
        let found = run_json(&["modes", &model, "--json"]);
        let modes = found["modes"].as_array().expect("modes");
        assert_eq!(modes.len(), 3);
        for (r, mode) in (1..).zip(modes) {
            let right = (f64::from(r) * PI / 0.7).powi(2) * 1.5_f64.sqrt() / TAU;
            let frequency = mode["frequency"].as_f64().expect("Hz");
            let error = (frequency / right - 1.0).abs();
            assert!(error < tolerance, "{rows} rows, mode {r}: {error:e}");
        }
    }
}

#[test]
fn certificate_with_table_passes() {
    let folder = tempfile::tempdir().expect("a folder");
    for (order, rows) in [(0, 9), (1, 9), (3, 9), (3, 60)] {
        let text = (BEAM.to_owned() + MORE).replace("order = 3", &format!("order = {order}"));
        let path = with_table(folder.path(), &text, sines(rows, 3));
        let loaded = eomgen_model_spec::load(Path::new(&path));
        let model = loaded
            .unwrap_or_else(|found| panic!("{}", found.render(false)))
            .model;
        let certificate = certify(&model, &model);
        let failures: Vec<_> = certificate.failures().collect();
        assert!(
            certificate.passed,
            "order {order}, {rows} rows: {failures:#?}"
        );
    }
}

/// The hash in the emitted code must depend on the table of shapes.
#[test]
fn hash_includes_the_table() {
    let folder = tempfile::tempdir().expect("a folder");
    let hash = |table: &str| {
        let path = with_table(folder.path(), BEAM, table);
        eomgen_model_spec::load(Path::new(&path))
            .expect("a model")
            .model
            .hash()
    };
    let [one, other] = [sines(21, 3), sines(22, 3)].map(|table| hash(&table));
    assert_ne!(one, other);
    assert_eq!(one, hash(&sines(21, 3)));
}

#[test]
fn specification_text_with_table_needs_a_folder() {
    let found = eomgen_model_spec::check(Source::new("beam.toml", BEAM)).expect_err("no folder");
    let said = found.render(false);
    assert!(
        said.contains("the specification was given as text"),
        "{said}"
    );
    assert!(said.contains("beam.toml:14:9"), "{said}");
}

#[test]
fn edited_models_find_their_table() {
    let folder = tempfile::tempdir().expect("a folder");
    let force = "[inputs]\nu = { unit = \"N\" }\n[forces]\n\
                 load = { on = \"at(w, x_0 + l/2)\", value = \"u\" }\n[potential]";
    let text = BEAM.replace("[potential]", force);
    let model = with_table(folder.path(), &text, sines(21, 3));
    let out = folder.path().join("out.csv").display().to_string();
    let simulate = [
        "simulate",
        &model,
        "--until",
        "0.01",
        "--interval",
        "0.005",
        "--input",
        "u=1",
        "--out",
        &out,
    ];
    run_accepted(&simulate);
}

#[test]
fn invalid_tables_are_rejected_with_location() {
    let folder = tempfile::tempdir().expect("a folder");
    let good = sines(21, 3);
    let lines: Vec<&str> = good.lines().collect();
    let without = |skipped: std::ops::Range<usize>| {
        let kept = (0..lines.len()).filter(|line| !skipped.contains(line));
        kept.map(|line| lines[line].to_owned() + "\n")
            .collect::<String>()
    };
    let line = |number: usize, text: &str| {
        let mut changed = lines.clone();
        changed[number - 1] = text;
        changed.join("\n")
    };
    let utf_16: Vec<u8> = good.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let long: String = (0..3000).map(|i| format!("\n{i},1")).collect();
    let cases: [(Vec<u8>, &str); 21] = [
        (
            line(5, "0.37,1,NaN,1").into(),
            "modes.csv:5:8: `NaN` is not a finite number",
        ),
        (
            line(5, "0.37,1,1e999,1").into(),
            "modes.csv:5:8: `1e999` is not a finite number",
        ),
        (
            line(5, "0.37,1,,1").into(),
            "modes.csv:5:8: a number is missing",
        ),
        (
            line(5, "0.37,1,1").into(),
            "modes.csv:5:1: 3 numbers, but the header has 4 columns",
        ),
        (line(5, "0.37;1;1;1").into(), "modes.csv:5:1: 1 numbers"),
        (line(5, "").into(), "modes.csv:5:1: 1 numbers"),
        (line(5, lines[3]).into(), "modes.csv:5:1: x = "),
        (
            line(1, "x,phi_1,phi_3,phi_2").into(),
            "modes.csv:1:9: unexpected column `phi_3`, expected phi_2",
        ),
        (
            line(1, "s,phi_1,phi_2,phi_3").into(),
            "modes.csv:1:1: unexpected column `s`, expected x",
        ),
        (line(1, lines[1]).into(), "modes.csv:1:1: unexpected column"),
        (without(1..2).into(), "modes.csv:2:1: x = "),
        (without(18..22).into(), "the field has to = 0.95"),
        (without(8..12).into(), "modes.csv:9:1: a gap from x = "),
        (without(2..22).into(), "1 rows: 3 shapes need at least 8"),
        (Vec::new(), "modes.csv:1:1: no header"),
        (b"x".to_vec(), "modes.csv:1:1: no header"),
        (utf_16, "is not UTF-8 text"),
        (
            ("x,phi_1".to_owned() + &long).into(),
            "modes.csv:2002:1: more than 2000 rows",
        ),
        (vec![b'1'; 9 << 20], "is larger than 8 MiB"),
        (vec![0; 100], "is not UTF-8 text"),
        (
            good.replace("phi_1", "phi_x").into(),
            "modes.csv:1:3: unexpected column `phi_x`, expected phi_1",
        ),
    ];
    for (table, said) in cases {
        let model = with_table(folder.path(), BEAM, table);
        let message = run_rejected(&["check", &model]);
        assert!(message.contains(said), "{said}:\n{message}");
        assert!(message.contains("model.toml:14:9"), "{message}");
    }
}

#[test]
fn too_few_or_dependent_shapes_are_rejected() {
    let folder = tempfile::tempdir().expect("a folder");
    let table = |third: fn(f64, f64) -> f64| {
        let mut text = "x,phi_1,phi_2,phi_3\n".to_owned();
        for row in 0..=20 {
            let s = f64::from(row) / 20.0;
            let (one, two) = ((PI * s).sin(), (2.0 * PI * s).sin());
            let x = 0.25 + 0.7 * s;
            writeln!(text, "{x},{one},{two},{}", third(one, two)).expect("written");
        }
        text
    };
    for third in [|one, two| 2.0 * one - 3.0 * two, |_, _| 0.0] as [fn(f64, f64) -> f64; 2] {
        let model = with_table(folder.path(), BEAM, table(third));
        let message = run_rejected(&["check", &model]);
        assert!(
            message.contains("modes.csv:1:1: phi_3 is zero or a linear combination"),
            "{message}"
        );
    }
    let model = with_table(
        folder.path(),
        &BEAM.replace("order = 3", "order = 4"),
        sines(21, 3),
    );
    let message = run_rejected(&["check", &model]);
    assert!(
        message.contains("the order 4 needs more mode shapes than modes.csv"),
        "{message}"
    );
    assert!(message.contains("model.toml:16:9"), "{message}");
    let model = with_table(folder.path(), BEAM, sines(21, 3));
    let message = run_rejected(&["modes", &model, "--order", "4"]);
    assert!(message.contains("the table has 3"), "{message}");
}

#[test]
fn paths_outside_the_folder_are_rejected() {
    let folder = tempfile::tempdir().expect("a folder");
    let inner = folder.path().join("inner");
    std::fs::create_dir(&inner).expect("a folder");
    std::fs::write(folder.path().join("modes.csv"), sines(21, 3)).expect("written");
    let absolute = folder.path().join("modes.csv").display().to_string();
    #[cfg(unix)]
    std::os::unix::fs::symlink(&absolute, inner.join("link.csv")).expect("a link");
    for (name, said) in [
        ("../modes.csv", "is outside the specification's folder"),
        (&*absolute, "is outside the specification's folder"),
        #[cfg(unix)]
        ("link.csv", "is outside the specification's folder"),
        ("", "is outside the specification's folder"),
        ("none.csv", "cannot be read"),
        (".", "is not a file"),
    ] {
        let model = write_model(&inner, &BEAM.replace("modes.csv", name));
        let message = run_rejected(&["check", &model]);
        assert!(message.contains(said), "{name}: {message}");
    }
    for (part, changed, said) in [
        (
            "table = \"modes.csv\"\n",
            "",
            "give the file with the shapes",
        ),
        (
            "\"table\"",
            "\"string\"",
            "`table` is given, but the basis is not \"table\"",
        ),
        ("diff(w, x, 2)^2", "diff(w, x, 3)^2*l^2", "two derivatives"),
        (
            "elastic =",
            "spring = \"1/2*B/l^3*at(w, 2*x_0)^2\"\nelastic =",
            "a fixed fraction of the length",
        ),
    ] {
        assert!(BEAM.contains(part));
        let model = with_table(folder.path(), &BEAM.replace(part, changed), sines(21, 3));
        let message = run_rejected(&["derive", &model]);
        assert!(message.contains(said), "{said}: {message}");
    }
}
