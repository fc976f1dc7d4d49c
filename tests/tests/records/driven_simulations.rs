//! Tests of simulations driven by a record: comparison of a ballscrew axis with its closed form, and rejection of
//! invalid records with their location.

use std::path::{Path, PathBuf};

use eomgen_tests::models::path;
use eomgen_tests::program::{run_accepted, run_rejected};

struct Dataset {
    folder: tempfile::TempDir,
}

/// Description of a dataset with one record, in ms and kN.
const DESCRIPTION: &str = r#"
[records]
train = ["train.csv"]

[time]
column = "time"
unit = "ms"

[inputs.force]
column = "f"
unit = "kN"
hold = "zero-order"
"#;

impl Dataset {
    fn new(description: &str, record: &str) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::write(folder.path().join("dataset.toml"), description).expect("a file");
        std::fs::write(folder.path().join("train.csv"), record).expect("a file");
        Self { folder }
    }

    fn arguments(&self, more: &[&str]) -> Vec<String> {
        let mut arguments = vec!["simulate".to_owned(), path("emps").display().to_string()];
        arguments.extend([
            "--record".to_owned(),
            self.file("dataset.toml").display().to_string(),
        ]);
        arguments.extend(["--out".to_owned(), self.file("a.csv").display().to_string()]);
        arguments.extend(more.iter().map(|argument| (*argument).to_owned()));
        arguments
    }

    fn file(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Returns the message of the rejected record; asserts that no table is written.
    fn rejection(&self, more: &[&str]) -> String {
        std::fs::remove_file(self.file("a.csv")).ok();
        let arguments = self.arguments(more);
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        let message = run_rejected(&arguments);
        assert!(!self.file("a.csv").exists(), "{message}");
        message
    }

    /// Simulates and returns rows of t, q and q'.
    fn simulate(&self, more: &[&str]) -> Vec<[f64; 3]> {
        let arguments = self.arguments(more);
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        run_accepted(&arguments);
        rows(&self.file("a.csv"))
    }
}

fn rows(path: &Path) -> Vec<[f64; 3]> {
    let text = std::fs::read_to_string(path).expect("a table");
    assert!(text.starts_with("t,q,q_dot,"), "{text}");
    let number = |field: Option<&str>| field.and_then(|f| f.parse().ok()).expect("a number");
    let row = |line: &str| {
        let mut fields = line.split(',');
        [(); 3].map(|()| number(fields.next()))
    };
    text.lines().skip(1).map(row).collect()
}

/// Advances the solution of M q'' = F - F_v q' with constant F; the speed tends to F/F_v.
fn coast([q, v]: [f64; 2], force: f64, time: f64) -> [f64; 2] {
    let (mass, friction) = (95.0, 210.0);
    let (lasting, rate) = (force / friction, friction / mass);
    let decayed = (v - lasting) * (-rate * time).exp();
    [
        q + lasting * time + (v - lasting - decayed) / rate,
        lasting + decayed,
    ]
}

/// Times in s and forces in N; each force is held until the next time.
const STEPS: [(f64, f64); 5] = [
    (0.0, 100.0),
    (0.3, -250.0),
    (0.35, 400.0),
    (0.9, 0.0),
    (1.5, 7.0),
];

/// Returns [`STEPS`] as a record in ms and kN.
fn record() -> String {
    let lines = STEPS.map(|(t, force)| format!("{:?},x,{:?}\n", t * 1e3, force / 1e3));
    format!("time,comment,f\n{}", lines.concat())
}

/// Returns position and speed at a time, from rest at 0.
fn closed_form(t: f64) -> [f64; 2] {
    let mut state = [0.0, 0.0];
    for (index, (begin, force)) in STEPS.iter().enumerate() {
        let end = STEPS
            .get(index + 1)
            .map_or(f64::INFINITY, |next| next.0)
            .min(t);
        if end > *begin {
            state = coast(state, *force, end - begin);
        }
    }
    state
}

/// Maximum deviation with a relative tolerance of 1e-12 per step; q reaches 0.6 m.
const TOLERANCE: f64 = 1e-11;

#[test]
fn axis_under_held_force_matches_closed_form() {
    let dataset = Dataset::new(DESCRIPTION, &record());
    let options = ["--tolerance", "1e-12"];
    let at_the_record = dataset.simulate(&options);
    assert_eq!(
        at_the_record.iter().map(|row| row[0]).collect::<Vec<_>>(),
        STEPS.map(|s| s.0)
    );
    let sampled =
        dataset.simulate(&[&options[..], &["--interval", "0.01", "--until", "2"]].concat());
    assert_eq!(sampled.len(), 201);
    for [t, q, v] in at_the_record.iter().chain(&sampled) {
        let expected = closed_form(*t);
        assert!(
            (q - expected[0]).abs() <= TOLERANCE,
            "q = {q} at {t} s, expected {expected:?}"
        );
        assert!(
            (v - expected[1]).abs() <= TOLERANCE,
            "q' = {v} at {t} s, expected {expected:?}"
        );
    }
    let fastest = sampled.iter().map(|row| row[2]).fold(0.0, f64::max);
    assert!(fastest > 0.5, "the axis hardly moves: {fastest} m/s");
}

#[test]
fn record_can_be_truncated_and_start_late() {
    let late = "time,f\n2000,0.1\n2500,0.2\n3000,0\n";
    let dataset = Dataset::new(DESCRIPTION, late);
    let rows = dataset.simulate(&["--until", "2.75"]);
    assert_eq!(
        rows.iter().map(|row| row[0]).collect::<Vec<_>>(),
        [2.0, 2.5]
    );
    assert!((rows[1][2] - coast([0.0; 2], 100.0, 0.5)[1]).abs() < 1e-9);
    assert!(
        dataset
            .rejection(&["--until", "2.25"])
            .contains("fewer than two samples")
    );
    assert!(
        dataset
            .rejection(&["--until", "4"])
            .contains("ends at 3.0 s")
    );
    assert!(dataset.rejection(&["--until", "1"]).contains("after 2.0"));
}

#[test]
fn invalid_records_are_rejected() {
    for (record, part) in [
        ("", "is empty"),
        ("time,f\n", "has 0 samples"),
        ("time,f\n0,1\n", "has 1 samples; expected 2 or more"),
        ("time,g\n0,1\n1,2\n", "no column `f`; the file has time, g"),
        ("t,f\n0,1\n1,2\n", "no column `time`"),
        (
            "time,f\n0,1\n1,nan\n",
            "input `force`: 1 of 2 samples are missing",
        ),
        (
            "time,f\n0,inf\n1,2\n",
            "line 2: column 2: \"inf\" is not a finite number",
        ),
        (
            "time,f\n0,1\n1,\n",
            "input `force`: 1 of 2 samples are missing",
        ),
        (
            "time,f\n0,1\none,2\n",
            "line 3: column 1: \"one\" is not a number",
        ),
        ("time,f\n0,1\n1,2,3\n", "line 3: has 3 cells"),
        ("time,f,f\n0,1,1\n1,2,2\n", "two columns `f`"),
        (
            "time,f\n0,1\n2,2\n1,3\n",
            "line 4: the time does not increase",
        ),
        ("time,f\n0,1\n0,2\n", "line 3: the time does not increase"),
    ] {
        let message = Dataset::new(DESCRIPTION, record).rejection(&[]);
        assert!(
            message.contains("train.csv") && message.contains(part),
            "{record:?}: {message}"
        );
    }
}

#[test]
#[cfg(unix)]
fn link_to_outside_of_dataset_folder_is_rejected() {
    let elsewhere = tempfile::tempdir().expect("a folder");
    let secret = elsewhere.path().join("secret.csv");
    std::fs::write(&secret, "time,secret\n0,1\n1,2\n").expect("written");
    let description = DESCRIPTION.replacen("\"train.csv\"", "\"link.csv\"", 1);
    let dataset = Dataset::new(&description, &record());
    let link = dataset.folder.path().join("link.csv");
    std::os::unix::fs::symlink(&secret, link).expect("a link");
    let message = dataset.rejection(&[]);
    assert!(
        message.contains("outside the dataset's folder"),
        "{message}"
    );
    assert!(!message.contains("secret"), "{message}");
}

#[test]
fn invalid_datasets_are_rejected() {
    for (from, to, part) in [
        ("unit = \"kN\"", "unit = \"m\"", "expected N"),
        ("unit = \"kN\"", "unit = \"kQ\"", "kQ"),
        ("unit = \"ms\"", "unit = \"mm\"", "expected s"),
        ("\"zero-order\"", "\"cubic\"", "expected \"zero-order\""),
        ("[time]", "[tyme]", "did you mean `time`?"),
        ("[records]", "[records", "dataset.toml:2:9"),
        ("\"train.csv\"", "\"missing.csv\"", "missing.csv"),
        (
            "\"train.csv\"",
            "\"../train.csv\"",
            "outside the dataset's folder",
        ),
        (
            "\"train.csv\"",
            "\"a/../../train.csv\"",
            "outside the dataset's folder",
        ),
        (
            "\"train.csv\"",
            "\"/etc/hostname\"",
            "outside the dataset's folder",
        ),
        ("\"train.csv\"", "\".\"", "is not a file"),
        ("\"train.csv\"", "7", "dataset.toml:3:10"),
    ] {
        let description = DESCRIPTION.replacen(from, to, 1);
        assert_ne!(description, DESCRIPTION);
        let message = Dataset::new(&description, &record()).rejection(&[]);
        assert!(message.contains(part), "{to}: {message}");
    }
    for dataset in ["/nowhere/dataset.toml", "/"] {
        let emps = path("emps").display().to_string();
        let message = run_rejected(&[
            "simulate",
            &emps,
            "--record",
            dataset,
            "--out",
            "never-made.csv",
        ]);
        assert!(message.contains("cannot read"), "{message}");
    }
}

#[test]
fn invalid_record_names_are_rejected() {
    let dataset = Dataset::new(DESCRIPTION, &record());
    for name in [
        "train[1]",
        "test[0]",
        "train",
        "train[-1]",
        "train[0",
        "other[0]",
        "",
        "train[99999999999999999999]",
    ] {
        let message = dataset.rejection(&[&format!("--record-name={name}")]);
        assert!(
            message.contains("1 as train[..] and 0 as test[..]"),
            "{name}: {message}"
        );
    }
}

#[test]
fn input_without_record_is_zero_with_a_warning() {
    let description = DESCRIPTION.replace("[inputs.force]", "[inputs.torque]");
    let dataset = Dataset::new(&description, &record());
    let arguments = dataset.arguments(&[]);
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let output = eomgen_tests::program::run(&arguments);
    let message = eomgen_tests::program::text(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{message}");
    assert!(
        message.contains("input `force` is not driven and is taken as 0"),
        "{message}"
    );
    assert!(message.contains("no input `torque`"), "{message}");
    assert!(rows(&dataset.file("a.csv")).iter().all(|row| row[1] == 0.0));
}

/// Mass on a spring whose foot has the prescribed motion s: m (r'' + s'') + k r = 0.
const MOVED_FOOT: &str = r#"
[model]
name = "moved_foot"
[parameters]
m = { value = 2, unit = "kg" }
k = { value = 200, unit = "N/m" }
[inputs]
s = { unit = "m", rates = 2 }
[coordinates]
r = { unit = "m" }
[kinetic]
mass = "1/2*m*(dot(s) + dot(r))^2"
[potential]
spring = "1/2*k*r^2"
[observables]
foot = "s"
rate = "s_dot"
"#;

/// Returns r, r', s and s' at 2 s for s = 0.01 sin(7 t), in closed form: r'' + 100 r = 0.49 sin(7
/// t).
fn moved_foot_state() -> [f64; 4] {
    let (amplitude, w, natural, t) = (0.01, 7.0_f64, 10.0_f64, 2.0);
    let forced = amplitude * w * w / (natural * natural - w * w);
    [
        forced * ((w * t).sin() - w / natural * (natural * t).sin()),
        forced * w * ((w * t).cos() - (natural * t).cos()),
        amplitude * (w * t).sin(),
        amplitude * w * (w * t).cos(),
    ]
}

#[test]
fn prescribed_motion_by_expression_and_by_record_match_closed_form() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str| folder.path().join(name).display().to_string();
    std::fs::write(file("foot.toml"), MOVED_FOOT).expect("a file");
    let samples = (0..=400).map(|k| f64::from(k) * 0.005);
    let lines = samples.map(|t| format!("{t},{:e}\n", 0.01 * (7.0 * t).sin()));
    let record = format!("t,s\n{}", lines.collect::<String>());
    std::fs::write(file("train.csv"), record).expect("a file");
    let description = "[records]\ntrain = [\"train.csv\"]\n[time]\ncolumn = \"t\"\nunit = \"s\"\n\
                       [inputs.s]\ncolumn = \"s\"\nunit = \"m\"\n";
    std::fs::write(file("dataset.toml"), description).expect("a file");
    let last = |more: &[&str]| -> Vec<f64> {
        let (spec, out) = (file("foot.toml"), file("out.csv"));
        run_accepted(
            &[
                &["simulate", &spec, "--out", &out, "--tolerance", "1e-11"],
                more,
            ]
            .concat(),
        );
        let text = std::fs::read_to_string(&out).expect("a table");
        let row = text.lines().last().expect("a row").split(',').skip(1);
        row.map(|field| field.parse().expect("a number")).collect()
    };
    let off = |found: &[f64]| {
        let pairs = found.iter().zip(moved_foot_state());
        pairs
            .map(|(found, right)| (found - right).abs())
            .fold(0.0, f64::max)
    };
    let expression = "s=0.01*sin(7*t)";
    for (solver, bound) in [("exact", 1e-14), ("rk", 1e-11), ("radau", 1e-8)] {
        let found = last(&["--input", expression, "--until", "2", "--solver", solver]);
        assert!(off(&found) < bound, "{solver}: {found:?}");
    }
    let unit = last(&["--input", "s=10*sin(7*t) mm", "--until", "2"]);
    assert!(off(&unit) < 1e-11, "{unit:?}");
    // The bounds allow for the error of a cubic spline through samples with 5 ms spacing.
    let found = last(&["--record", &file("dataset.toml")]);
    assert!(off(&found[..2]) < 1e-6 && off(&found) < 1e-5, "{found:?}");
    let held = run_rejected(&[
        "simulate",
        &file("foot.toml"),
        "--record",
        &file("dataset.toml"),
        "--solver",
        "exact",
        "--out",
        &file("none.csv"),
    ]);
    assert!(held.contains("use --solver rk"), "{held}");
}
