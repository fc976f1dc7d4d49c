//! Tests of the event log of `simulate --events`: surfaces, kinds, modes and jumps.

use std::path::Path;

use eomgen_tests::program::{run_accepted, run_rejected};

/// Row of an event log: time (s), surface, kind, modes before and after, jumps of the rates.
struct Row {
    t: f64,
    texts: [String; 4],
    jumps: Vec<f64>,
}

impl Row {
    fn texts(&self) -> [&str; 4] {
        self.texts.each_ref().map(String::as_str)
    }
}

/// Simulates a specification and returns header and rows of its event log, and the number of switches.
fn log(text: &str, options: &[&str]) -> (String, Vec<Row>, u64) {
    let folder = tempfile::tempdir().expect("a folder");
    let place = |name: &str| folder.path().join(name).display().to_string();
    let (spec, log) = (place("machine.toml"), place("events.csv"));
    std::fs::write(&spec, text).expect("written");
    let table = place("motion.csv");
    let given = [
        "simulate", &spec, "--out", &table, "--events", &log, "--json",
    ];
    let document = run_accepted(&[&given[..], options].concat());
    let document: serde_json::Value = serde_json::from_str(&document).expect("JSON");
    let mut reader = csv::Reader::from_path(&log).expect("an event log");
    let header = reader
        .headers()
        .expect("a header")
        .iter()
        .collect::<Vec<_>>();
    let header = header.join(",");
    let rows = reader.records().map(|record| {
        let record = record.expect("a row");
        let number = |place: usize| record[place].parse::<f64>().expect("a number");
        Row {
            t: number(0),
            texts: [1, 2, 3, 4].map(|place| record[place].to_owned()),
            jumps: (5..record.len()).map(number).collect(),
        }
    });
    (
        header,
        rows.collect(),
        document["switches"].as_u64().expect("a count"),
    )
}

const BALL: &str = r#"
[model]
name = "ball"
[parameters]
m = { value = 0.1, unit = "kg" }
g = { value = 9.81, unit = "m/s^2" }
e = { value = 0.5, unit = "1" }
[coordinates]
y = { unit = "m", initial = 1 }
[kinetic]
ball = "1/2*m*dot(y)^2"
[potential]
weight = "m*g*y"
[impacts]
floor = { when = "y", restitution = "e" }
"#;

#[test]
fn every_impact_is_logged_with_its_jump_until_contact_closes() {
    for solver in ["rk", "radau"] {
        let (header, rows, switches) = log(BALL, &["--until", "2", "--solver", solver]);
        assert_eq!(header, "t,surface,kind,from,to,jump_y");
        assert_eq!(rows.len() as u64, switches, "{solver}");
        let (mut t, mut speed) = ((2.0_f64 / 9.81).sqrt(), (2.0 * 9.81_f64).sqrt());
        for row in &rows[..10] {
            assert_eq!(row.texts(), ["floor", "impact", "positive", "positive"]);
            assert!((row.t - t).abs() < 1e-9, "{solver}: {} and {t}", row.t);
            assert!(
                (row.jumps[0] - 1.5 * speed).abs() < 1e-7,
                "{solver}: {}",
                row.jumps[0]
            );
            speed *= 0.5;
            t += 2.0 * speed / 9.81;
        }
        let last = rows.last().expect("a row");
        assert_eq!(
            last.texts(),
            ["floor", "impact", "positive", "closed"],
            "{solver}"
        );
    }
}

#[test]
fn stick_slip_and_crossing_are_logged_alike_by_all_solvers() {
    let sled = r#"
[model]
name = "sled"
[parameters]
m = { value = 1, unit = "kg" }
F = { value = 3, unit = "N" }
A = { value = 4, unit = "N" }
w = { value = 5, unit = "rad/s" }
[coordinates]
x = { unit = "m" }
[kinetic]
T = "1/2*m*dot(x)^2"
[forces]
drive = { on = "x", value = "A*sin(w*t)" }
rub = { on = "x", value = "-F*sign(dot(x))" }
"#;
    for solver in ["rk", "radau", "exact"] {
        let (_, rows, _) = log(sled, &["--until", "1.4", "--solver", solver]);
        let found: Vec<[&str; 4]> = rows.iter().map(Row::texts).collect();
        let expected = [
            ["dot(x)", "slip", "held", "positive"],
            ["dot(x)", "stick", "positive", "held"],
            ["dot(x)", "slip", "held", "negative"],
            ["dot(x)", "stick", "negative", "held"],
        ];
        assert_eq!(found[..4], expected, "{solver}");
        assert!((rows[0].t - 0.75_f64.asin() / 5.0).abs() < 1e-9, "{solver}");
        assert!(rows.iter().all(|row| row.jumps == [0.0]), "{solver}");
    }
}

#[test]
fn corners_reflections_and_jumps_with_inputs_are_logged() {
    let step = |energy: &str| {
        format!(
            r#"
[model]
name = "step"
[parameters]
m = {{ value = 1, unit = "kg" }}
E = {{ value = {energy}, unit = "J" }}
[coordinates]
x = {{ unit = "m", initial = -1, initial_rate = 1 }}
[kinetic]
T = "1/2*m*dot(x)^2"
[potential]
step = "E*above(x)"
"#
        )
    };
    let (_, rows, _) = log(&step("0.375"), &["--until", "2", "--solver", "rk"]);
    assert_eq!(rows.len(), 1);
    assert_eq!(rows[0].texts(), ["x", "corner", "negative", "positive"]);
    assert!((rows[0].jumps[0] + 0.5).abs() < 1e-9 && (rows[0].t - 1.0).abs() < 1e-9);
    let (_, rows, _) = log(&step("0.75"), &["--until", "2", "--solver", "rk"]);
    assert_eq!(rows.len(), 1);
    assert_eq!(rows[0].texts(), ["x", "reflection", "negative", "negative"]);
    assert!((rows[0].jumps[0] + 2.0).abs() < 1e-9);
    let base = r#"
[model]
name = "base"
[parameters]
m = { value = 1, unit = "kg" }
k = { value = 10, unit = "N/m" }
[coordinates]
x = { unit = "m" }
[inputs]
s = { unit = "m", rates = 2 }
[kinetic]
T = "1/2*m*(dot(x) + s_dot)^2"
[potential]
spring = "1/2*k*x^2"
"#;
    let drive = "s=0.5*max(t - 0.3, 0)";
    let options = ["--until", "1", "--solver", "rk", "--input", drive];
    let (_, rows, _) = log(base, &options);
    let jumps: Vec<&Row> = rows.iter().filter(|row| row.jumps[0] != 0.0).collect();
    assert_eq!(jumps.len(), 1);
    assert!((jumps[0].jumps[0] + 0.5).abs() < 1e-9 && (jumps[0].t - 0.3).abs() < 1e-9);
}

#[test]
fn event_log_needs_its_own_csv_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let place = |name: &str| folder.path().join(name).display().to_string();
    let (spec, table) = (place("ball.toml"), place("ball.csv"));
    std::fs::write(&spec, BALL).expect("written");
    let given = [
        "simulate", &spec, "--until", "1", "--out", &table, "--events",
    ];
    let refused = |path: &str| run_rejected(&[&given[..], &[path]].concat());
    let message = refused(&table);
    assert!(message.contains("are the same file"), "{message}");
    let message = refused(&place("events.parquet"));
    assert!(message.contains("a name that ends in .csv"), "{message}");
    let message = refused("-");
    assert!(message.contains("stdout is for --out"), "{message}");
    assert!(!Path::new(&table).exists());
    let log = place("log.csv");
    run_accepted(&[
        "simulate", &spec, "--until", "0.1", "--out", &table, "--events", &log,
    ]);
    let text = std::fs::read_to_string(log).expect("an event log");
    assert_eq!(text, "t,surface,kind,from,to,jump_y\n");
}
