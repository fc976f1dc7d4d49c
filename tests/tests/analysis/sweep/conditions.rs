//! Comparison of sweeps with inputs and initial states (`--input`, `--record`, `--state`) with rows of `simulate`.

use std::fs;

use eomgen_tests::program::{run, run_accepted, text};

use super::sweep_folder::{SweepFolder, accept, column, expect_rejection, merge_command, table};

/// Oscillator m x'' + c x' + k x = u with a cubic spring, and a rotating disc that the force does not drive.
const DRIVEN: &str = r#"
[model]
name = "driven"
[parameters]
m = { value = 1, unit = "kg", min = 0 }
c = { value = 500, unit = "g/s" }
k = { value = 4, unit = "N/m" }
h = { value = 0, unit = "N/m^3", doc = "cubic stiffness" }
F = { value = 3, unit = "N" }
d = { value = 0.7, unit = "s" }
omega = { value = 2, unit = "rad/s" }
[coordinates]
x = { unit = "m" }
[inputs]
u = { unit = "N" }
[kinetic]
mass = "1/2*m*dot(x)^2"
[potential]
spring = "1/2*k*x^2 + 1/4*h*x^4"
[dissipation]
damper = "1/2*c*dot(x)^2"
[forces]
motor = { on = "x", value = "u" }
"#;

/// Returns [`DRIVEN`] without the cubic term.
fn linear() -> String {
    DRIVEN.replace(" + 1/4*h*x^4", "").replace(
        "h = { value = 0, unit = \"N/m^3\", doc = \"cubic stiffness\" }\n",
        "",
    )
}

const RECORD: &str = r#"
[records]
train = ["train.csv", "late.csv"]
[time]
column = "t"
unit = "s"
[inputs.u]
column = "u"
unit = "N"
hold = "zero-order"
"#;

fn folder(specification: &str) -> SweepFolder {
    let place = SweepFolder::new();
    let write = |name: &str, text: &str| fs::write(place.path_to(name), text).expect("a file");
    write("driven.toml", specification);
    write("dataset.toml", RECORD);
    let record = |start: f64| {
        let row = |row: u32| {
            let t = f64::from(row) / 64.0;
            format!("{:?},{:?}\n", start + t, 2.0 * (5.0 * t).sin() + t)
        };
        "t,u\n".to_owned() + &(0..257).map(row).collect::<String>()
    };
    write("train.csv", &record(0.0));
    write("late.csv", &record(1.5));
    place
}

/// Returns the arguments of a command: the model, `--out` and additional options.
fn arguments(place: &SweepFolder, command: &str, out: &str, more: &[&str]) -> Vec<String> {
    let file = |name: &str| place.path_to(name).display().to_string();
    let start = [command.to_owned(), file("driven.toml")];
    let end = ["--out".to_owned(), file(out)];
    let more = more.iter().map(|more| match *more {
        "dataset.toml" => file(more),
        more => more.to_owned(),
    });
    start.into_iter().chain(end).chain(more).collect()
}

/// Returns columns of a table of `simulate`.
fn simulated<const N: usize>(
    place: &SweepFolder,
    more: &[&str],
    names: [&str; N],
) -> [Vec<f64>; N] {
    accept(&arguments(place, "simulate", "rows.csv", more));
    let text = fs::read_to_string(place.path_to("rows.csv")).expect("a table");
    let header = text.lines().next().unwrap_or_default();
    names.map(|name| {
        let place = header.split(',').position(|known| known == name);
        let place = place.unwrap_or_else(|| panic!("{name} in {header}"));
        let number = |line: &str| {
            line.split(',')
                .nth(place)
                .and_then(|text| text.parse().ok())
        };
        let numbers = text.lines().skip(1).map(number);
        numbers.collect::<Option<_>>().expect("numbers")
    })
}

/// Runs a command, asserts success and returns its messages.
fn messages(arguments: &[String]) -> String {
    let output = run(&arguments.iter().map(String::as_str).collect::<Vec<_>>());
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    said
}

fn find_maximum(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::MIN, f64::max)
}

#[test]
fn driven_sweeps_match_rows_of_simulate() {
    let until = ["--until", "4"];
    for (specification, conditions) in [
        // The input is a step at a time that is a parameter; the motion has an exact solution.
        (linear(), &["--input", "u=F*above(t - d)"][..]),
        (
            linear(),
            &[
                "--input",
                "u=0.5*sin(3*t)",
                "--state",
                "x_dot=-0.2*omega*F/k",
            ],
        ),
        (
            DRIVEN.to_owned(),
            &[
                "--input",
                "u=F*above(t - d)",
                "--set",
                "h=5",
                "--state",
                "x=-0.1*F/k",
            ],
        ),
        (
            DRIVEN.to_owned(),
            &["--set", "h=5", "--record", "dataset.toml"],
        ),
        (
            linear(),
            &[
                "--record",
                "dataset.toml",
                "--state",
                "x=F/k",
                "--state",
                "x_dot=0.1",
            ],
        ),
    ] {
        let place = folder(&specification);
        let vary = ["--vary", "d,k=0.5:1.1:2"];
        let measures = ["--measure", "max:x,final:x_dot,final:energy"];
        let all = [&vary[..], &measures, &until, conditions].concat();
        accept(&arguments(&place, "sweep", "map", &all));
        let swept = table(&place.path_to("map"));
        for (point, value) in ["0.5", "1.1"].into_iter().enumerate() {
            let values = [format!("d={value}"), format!("k={value}")];
            let set = ["--set", &values[0], "--set", &values[1]];
            let more = [&until[..], conditions, &set].concat();
            let names = ["x", "x_dot", "energy"];
            let [x, rate, energy] = simulated(&place, &more, names);
            let last = |rows: &[f64]| rows.last().copied().expect("a row");
            let rights = [find_maximum(&x), last(&rate), last(&energy)];
            for (name, right) in ["max:x", "final:x_dot", "final:energy"]
                .into_iter()
                .zip(rights)
            {
                let found = column(&swept, name)[point];
                // A maximum may be between two rows, which are 1/64 s apart with the record.
                let above = if name == "max:x" { 1e-4 } else { 1e-12 };
                let scale = right.abs().max(1e-3);
                assert!(
                    found >= right - 1e-12 * scale && found <= right + above * scale,
                    "{conditions:?}, {values:?}: {name} {found}, expected {right}"
                );
            }
        }
    }
}

/// Position control with a reference that only the controller measures, and a disturbance.
const CONTROLLED: &str = r#"
[model]
name = "driven"
[parameters]
m = { value = 2, unit = "kg", min = 0 }
k_p = { value = 30, unit = "N/m" }
k_d = { value = 15, unit = "N s/m" }
omega = { value = 3, unit = "rad/s" }
A = { value = 0.4, unit = "m" }
[coordinates]
x = { unit = "m", initial = 0.3 }
[inputs]
r = { unit = "m" }
u = { unit = "N" }
w = { unit = "N" }
[kinetic]
mass = "1/2*m*dot(x)^2"
[forces]
motor = { on = "x", value = "u + w" }
[controllers.pd]
period = { value = 50, unit = "ms" }
outputs = { u = "k_p*(r - x) - k_d*dot(x)" }
"#;

/// Returns the position after 2 s, from the exact motion between samples, with r = A sin(omega t). If `is_disturbed`, w
/// = sin(t), otherwise 0.
fn controlled_position(k_p: f64, omega: f64, is_disturbed: bool) -> f64 {
    let (mass, h) = (2.0, 0.05);
    let (mut x, mut v) = (0.3, 0.0);
    for sample in 0..40 {
        let t = 0.05 * f64::from(sample);
        let u = k_p * (0.4 * (omega * t).sin() - x) - 15.0 * v;
        let a = u / mass;
        let (mut x_w, mut v_w) = (0.0, 0.0);
        if is_disturbed {
            v_w = (t.cos() - (t + h).cos()) / mass;
            x_w = (t.cos() * h - ((t + h).sin() - t.sin())) / mass;
        }
        x += v * h + 0.5 * a * h * h + x_w;
        v += a * h + v_w;
    }
    x
}

/// Earlier versions of the sweep rejected the reference as not measured, unless all inputs without a controller were
/// driven.
#[test]
fn sweep_of_a_controlled_model_drives_a_reference_that_only_the_controller_measures() {
    let place = folder(CONTROLLED);
    let (undriven, reference) = ("input `w` is not driven", "r=A*sin(omega*t)");
    for is_disturbed in [false, true] {
        let disturbance = ["--input", "w=sin(t)"];
        let disturbance = if is_disturbed { &disturbance[..] } else { &[] };
        let given = ["--input", reference, "--until", "2"];
        let vary = [
            "--vary",
            "k_p,omega=20:40:2",
            "--vary",
            "k_d=15:16:2",
            "--measure",
        ];
        let all = [&vary[..], &["final:x"], &given, disturbance].concat();
        let out = format!("map_{is_disturbed}");
        let said = messages(&arguments(&place, "sweep", &out, &all));
        assert_eq!(said.contains(undriven), !is_disturbed, "{said}");
        let swept = table(&place.path_to(&out));
        for (point, k_p) in [(0, 20.0), (2, 40.0)] {
            let expected = controlled_position(k_p, k_p, is_disturbed);
            let found = column(&swept, "final:x")[point];
            assert!(
                (found - expected).abs() < 1e-8,
                "k_p = {k_p}: {found}, expected {expected}"
            );
        }
    }
}

#[test]
fn sweep_of_a_controlled_model_with_record_and_expression_matches_simulate() {
    let place = folder(CONTROLLED);
    let dataset = RECORD.replace("inputs.u", "inputs.w");
    fs::write(place.path_to("dataset.toml"), dataset).expect("a file");
    let given = [
        "--record",
        "dataset.toml",
        "--input",
        "r=A*cos(omega*t)",
        "--until",
        "3",
    ];
    let vary = ["--vary", "A=0.1:0.5:2", "--measure", "final:x"];
    let said = messages(&arguments(
        &place,
        "sweep",
        "map",
        &[&vary[..], &given].concat(),
    ));
    assert!(!said.contains("is not driven"), "{said}");
    let swept = table(&place.path_to("map"));
    for (point, set) in ["A=0.1", "A=0.5"].into_iter().enumerate() {
        let more = [&given[..], &["--set", set]].concat();
        let [rows] = simulated(&place, &more, ["x"]);
        let (found, last) = (
            column(&swept, "final:x")[point],
            rows.last().expect("a row"),
        );
        assert!((found - last).abs() < 1e-9, "{set}: {found}, {last}");
    }
}

#[test]
fn record_gives_start_and_end() {
    let place = folder(DRIVEN);
    let record = ["--record", "dataset.toml", "--record-name", "train[1]"];
    let vary = [
        "--vary",
        "h=0:8:2",
        "--measure",
        "final:x,lyapunov,poincare:x",
    ];
    let section = [
        "--section",
        "x_dot=0:down",
        "--transient",
        "0",
        "--periods",
        "2",
    ];
    let all = [&record[..], &vary, &section].concat();
    accept(&arguments(&place, "sweep", "map", &all));
    let swept = table(&place.path_to("map"));
    for (point, h) in ["h=0", "h=8"].into_iter().enumerate() {
        let [rows] = simulated(&place, &[&record[..], &["--set", h]].concat(), ["x"]);
        let found = column(&swept, "final:x")[point];
        let last = rows.last().expect("a row");
        assert!((found - last).abs() < 1e-12, "{h}: {found}, {last}");
    }
    // Without the cubic term, perturbations decay as exp(-c t/(2 m)) for any input.
    let (exponent, error) = (
        column(&swept, "lambda_1")[0],
        column(&swept, "lambda_1_se")[0],
    );
    assert!((exponent + 0.25).abs() < error, "{exponent} +- {error}");
    assert_eq!(column(&swept, "poincare:x_status"), [0.0, 0.0]);
    let late = ["--until", "9"];
    let message = expect_rejection(&arguments(
        &place,
        "sweep",
        "other",
        &[&all[..], &late].concat(),
    ));
    assert!(message.contains("the record ends at 5.5 s"), "{message}");
}

/// Closed forms: the steady response to u = F sin(omega t) at t = 2 pi k/omega, and the decay exp(-c t/(2 m)).
#[test]
fn forcing_by_an_input_has_closed_form_section() {
    let place = folder(&linear());
    let input = [
        "--input",
        "u=F*sin(omega*t)",
        "--state",
        "x=0.3",
        "--set",
        "c=2000",
    ];
    let vary = ["--vary", "omega=1:3:2", "--measure", "poincare,lyapunov"];
    let span = ["--transient", "15", "--periods", "20"];
    let all = [&input[..], &vary, &span].concat();
    accept(&arguments(&place, "sweep", "map", &all));
    let swept = table(&place.path_to("map"));
    for (point, omega) in [1.0_f64, 3.0].into_iter().enumerate() {
        let (stiffness, damping) = (4.0 - omega * omega, 2.0 * omega);
        let expected = -3.0 * damping / (stiffness.powi(2) + damping.powi(2));
        let found = column(&swept, "poincare_mean")[point];
        assert!(
            (found - expected).abs() < 1e-7,
            "{omega}: {found}, expected {expected}"
        );
        let (exponent, error) = (column(&swept, "lambda_1"), column(&swept, "lambda_1_se"));
        assert!(error[point] < 0.1, "{error:?}");
        assert!(
            (exponent[point] + 1.0).abs() < 3.0 * error[point],
            "{exponent:?}, {error:?}"
        );
    }
}

#[test]
fn trimmed_state_is_the_equilibrium_of_each_point() {
    let place = folder(DRIVEN);
    let held = [
        "--vary", "k=2:8:3", "--input", "u=F", "--state", "trim", "--until", "3",
    ];
    let measures = ["--measure", "max:x,rms:x"];
    accept(&arguments(
        &place,
        "sweep",
        "map",
        &[&held[..], &measures].concat(),
    ));
    let swept = table(&place.path_to("map"));
    for (point, k) in [2.0, 5.0, 8.0].into_iter().enumerate() {
        for name in ["max:x", "rms:x"] {
            assert!(
                (column(&swept, name)[point] - 3.0 / k).abs() < 1e-8,
                "{name} at {k}"
            );
        }
    }
}

#[test]
fn shards_of_a_driven_sweep_give_the_same_bytes() {
    let place = folder(DRIVEN);
    let options = [
        "--vary",
        "h=0:5:4",
        "--measure",
        "max:x",
        "--record",
        "dataset.toml",
        "--state",
        "x=F/k",
        "--input",
        "u=F*above(t - d)",
    ];
    let of_record: Vec<&str> = options[..options.len() - 2].to_vec();
    let of_input: Vec<&str> = [&options[..4], &options[6..], &["--until", "2"]].concat();
    for (name, options) in [("record", of_record), ("input", of_input)] {
        accept(&arguments(&place, "sweep", name, &options));
        let shards = format!("{name}_shards");
        for shard in ["2/2", "1/2"] {
            let more = [&options[..], &["--shard", shard, "--threads", "2"]].concat();
            accept(&arguments(&place, "sweep", &shards, &more));
        }
        accept(&merge_command(&place.path_to(&shards)));
        for file in ["sweep.parquet", "sweep.csv", "sweep.json"] {
            let bytes = |folder: &str| fs::read(place.path_to(folder).join(file)).expect("a file");
            assert!(bytes(name) == bytes(&shards), "{name}: {file}");
        }
        let other = [&options[..], &["--state", "x_dot=1"]].concat();
        let message = expect_rejection(&arguments(&place, "sweep", name, &other));
        assert!(message.contains("differences: --state"), "{message}");
    }
}

#[test]
fn invalid_conditions_are_rejected_with_location() {
    let place = folder(DRIVEN);
    let options = ["--vary", "h=0:5:4", "--measure", "max:x", "--until", "1"];
    for (more, parts) in [
        (
            &["--input", "v=1"][..],
            &["--input:1:1", "has no input `v`"][..],
        ),
        (&["--input", "u=2*zz"], &["--input:1:5", "zz"]),
        (&["--input", "u"], &["expected NAME=VALUE"]),
        (
            &["--state", "y=1"],
            &["--state:1:1", "no state and no input `y`"],
        ),
        (&["--state", "x=2*kk"], &["--state:1:5", "kk"]),
        (&["--state", "u=1"], &["expected a coordinate"]),
        (&["--record", "nothing.toml"], &["nothing.toml"]),
        (
            &["--record", "dataset.toml", "--record-name", "test[0]"],
            &["test[0]"],
        ),
        (&["--record-name", "train[1]"], &["--record"]),
    ] {
        let message = expect_rejection(&arguments(
            &place,
            "sweep",
            "map",
            &[&options[..], more].concat(),
        ));
        for part in parts {
            assert!(
                message.contains(part),
                "{more:?}: {part} is missing in\n{message}"
            );
        }
        assert!(!place.path_to("map").exists(), "{more:?}");
    }
    let help = run_accepted(&["sweep", "--help"]);
    for option in ["--input", "--record", "--record-name", "--state"] {
        assert!(help.contains(option), "{option}");
    }
}
