//! Tests with channels of a driven mass on a spring with dry friction. The channels are acceleration with or without
//! position, or two proportional quantities such as two encoders of a joint. Some records have intervals at rest. The
//! records are from Newton's and Coulomb's laws, integrated with small steps.

use eomgen_tests::program;
use eomgen_tests::program::run_on_dataset;
use serde_json::Value;

const OSCILLATOR: &str = r#"
[model]
name = "oscillator"

[parameters]
m = { value = 2, unit = "kg", min = 0 }
c = { value = 6, unit = "N s/m", min = 0 }
k = { value = 300, unit = "N/m", min = 0 }

[coordinates]
x = { unit = "m" }

[inputs]
u = { unit = "N" }

[kinetic]
mass = "1/2*m*dot(x)^2"

[potential]
spring = "1/2*k*x^2"

[dissipation]
damper = "1/2*c*dot(x)^2"

[forces]
motor = { on = "x", value = "u" }
"#;

const DATASET: &str = r#"
[records]
train = ["train.csv"]
test = ["test.csv"]

[time]
column = "t"
unit = "s"

[inputs.u]
column = "u"
unit = "N"

[channels.accelerometer]
column = "a"
unit = "m/s^2"
noise = 5e-3
observable = "dot(dot(x))"

[initial]
state = "rest"

[uncertain]
c = { relative = 0.05 }

[windows]
length = 0.5
"#;

const POSITION: &str = r#"
[channels.x]
column = "x"
unit = "m"
noise = 1e-5
"#;

const FRICTION: f64 = 2.0;

/// Standard deviations of the noise of the accelerometer (m/s^2) and of the position (m).
const NOISE: [f64; 2] = [5e-3, 1e-5];

/// Returns a record of t, u, x, a. If `idle`, the force is too small to move the mass in every second half second.
fn record(friction: f64, turn: f64, idle: bool) -> String {
    let (m, c, k) = (2.0, 6.0, 300.0);
    let (mut x, mut v, mut noise): (f64, f64, f64) = (0.0, 0.0, 0.3 + 0.1 * turn);
    let mut text = "t,u,x,a\n".to_owned();
    let mut drawn = || {
        noise = 4.0 * noise * (1.0 - noise) * 0.999_999;
        2.8 * (noise - 0.5)
    };
    for sample in 0..800 {
        let t = 0.005 * f64::from(sample);
        let wave = 20.0 * (9.0 * t + turn).sin() + 12.0 * (23.0 * t * (1.0 + 0.1 * turn)).sin();
        let u = match idle && (2.0 * t) as u32 % 2 == 1 {
            true => 0.0,
            false => wave,
        };
        // At rest, the friction balances the other forces up to its level.
        let acceleration = |x: f64, v: f64| {
            let others = u - c * v - k * x;
            match v == 0.0 {
                true => (others - others.clamp(-friction, friction)) / m,
                false => (others - friction * v.signum()) / m,
            }
        };
        let shown = [acceleration(x, v), x];
        let [a, q] = [0, 1].map(|place| shown[place] + NOISE[place] * drawn());
        text += &format!("{t:.3},{u:.17},{q:.12},{a:.12}\n");
        for _ in 0..200 {
            let h = 2.5e-5;
            let after = v + h * acceleration(x, v);
            // Friction stops the motion but does not reverse it.
            v = if v * after < 0.0 { 0.0 } else { after };
            x += h * v;
        }
    }
    text
}

fn run_on_records(
    command: &str,
    specification: &str,
    dataset: &str,
    records: [String; 2],
) -> Value {
    let folder = tempfile::tempdir().expect("a folder");
    let file = |name: &str| folder.path().join(name);
    let [train, test] = &records;
    for (name, text) in [
        ("oscillator.toml", specification),
        ("dataset.toml", dataset),
        ("train.csv", train),
        ("test.csv", test),
    ] {
        std::fs::write(file(name), text).expect("a file");
    }
    let paths = ["oscillator.toml", "dataset.toml", "out"].map(file);
    program::run_on_dataset(command, paths.each_ref())
}

#[test]
fn friction_is_found_from_acceleration_with_and_without_position() {
    for dataset in [DATASET.to_owned(), format!("{DATASET}{POSITION}")] {
        let records = || [record(FRICTION, 0.0, false), record(FRICTION, 1.0, false)];
        let found = run_on_records("discover", OSCILLATOR, &dataset, records());
        assert_eq!(found["verdict"], "effects_found", "{found:#}");
        let effects = found["effects"].as_array().expect("effects");
        assert_eq!(effects.len(), 1, "{effects:#?}");
        assert_eq!(effects[0]["effect"], "coulomb_friction", "{effects:#?}");
        let level = effects[0]["parameters"].as_object();
        let level = level.and_then(|p| p.values().next());
        let level = level.and_then(|p| p["value"].as_f64()).expect("a level");
        assert!((level / FRICTION - 1.0).abs() < 0.03, "{level}");
    }
    let nothing = [record(0.0, 0.0, false), record(0.0, 1.0, false)];
    let found = run_on_records("discover", OSCILLATOR, DATASET, nothing);
    assert_eq!(found["verdict"], "no_significant_gap", "{found:#}");
}

#[test]
fn sticking_mass_has_zero_acceleration() {
    let with_friction = OSCILLATOR.replace(
        "[coordinates]",
        "F_c = { value = 12, unit = \"N\" }\n\n[coordinates]",
    ) + "dry = { on = \"x\", value = \"-F_c*sign(dot(x))\" }\n";
    let records = [record(12.0, 0.0, true), record(12.0, 1.0, true)];
    let resting = records[0].lines().skip(1);
    let resting = resting.filter(|line| {
        let last = line.rsplit(',').next().and_then(|a| a.parse::<f64>().ok());
        last.is_some_and(|a| a.abs() < 1e-2)
    });
    assert!(resting.count() > 100, "the mass never rests");
    let found = run_on_records("compare", &with_friction, DATASET, records);
    assert_eq!(found["verdict"], "no_significant_gap", "{:#}", found["gap"]);
}

#[test]
fn both_encoders_of_a_joint_are_proportional_channels() {
    let geared =
        format!("{OSCILLATOR}\n[observables]\nmotor = {{ value = \"50*x\", unit = \"m\" }}\n");
    let accelerometer = DATASET.split_once("[channels.accelerometer]");
    let (begin, rest) = accelerometer.expect("a channel");
    let (_, end) = rest.split_once("[initial]").expect("a table");
    let motor = POSITION.replace("[channels.x]", "[channels.motor]");
    let motor = motor
        .replace("column = \"x\"", "column = \"a\"")
        .replace("1e-5", "2e-3");
    let dataset = format!("{begin}{POSITION}{motor}\n[initial]{end}");
    // A second encoder replaces the accelerometer's column; it has a lower resolution and another gain.
    let both = |gain: f64, friction: f64, turn: f64| {
        let mut noise = 0.4;
        let mut text = "t,u,x,a\n".to_owned();
        for line in record(friction, turn, false).lines().skip(1) {
            let cells: Vec<f64> = line
                .split(',')
                .filter_map(|cell| cell.parse().ok())
                .collect();
            let &[t, u, x, _] = &cells[..] else {
                panic!("{line}")
            };
            noise = 4.0 * noise * (1.0_f64 - noise) * 0.999_999;
            let shown = 50.0 * gain * x + 2e-3 * 2.8 * (noise - 0.5);
            text += &format!("{t:.3},{u:.17},{x:.12},{shown:.12}\n");
        }
        text
    };
    let found = |gain: f64, friction: f64| {
        let records = [0.0, 1.0].map(|turn| both(gain, friction, turn));
        run_on_records("discover", &geared, &dataset, records)
    };
    for (gain, friction, effect) in [
        (1.0, FRICTION, Some("coulomb_friction")),
        (1.07, 0.0, Some("sensor_gain")),
        (1.0, 0.0, None),
    ] {
        let found = found(gain, friction);
        let effects = found["effects"].as_array().expect("effects");
        let names: Vec<&str> = effects
            .iter()
            .filter_map(|e| e["effect"].as_str())
            .collect();
        assert_eq!(names, Vec::from_iter(effect), "{effects:#?}");
        if effect == Some("sensor_gain") {
            assert_eq!(effects[0]["on"], "motor");
        }
    }
}

/// Compares records of x'' = -x' - 100 x from two initial positions with the oscillator, whose specification has the
/// initial position 0.1 m.
fn compare_free_vibrations(train: f64, test: f64, channel: &str, initial: &str) -> Value {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| {
        std::fs::write(folder.path().join(name), text).expect("written");
    };
    let frequency = 99.75_f64.sqrt();
    for (name, first) in [("train.csv", train), ("test.csv", test)] {
        let row = |sample: u32| {
            let t = f64::from(sample) * 0.01;
            let phase = frequency * t;
            let shape = phase.cos() + 0.5 / frequency * phase.sin();
            // The noise of the sensor is the rounding to 0.1 mm.
            let y = first * (-0.5 * t).exp() * shape;
            format!("{t:.2},{:.4}\n", y)
        };
        let rows: String = (0..500).map(row).collect();
        write(name, &format!("t,y\n{rows}"));
    }
    write(
        "model.toml",
        "[model]\nname = \"oscillator\"\n[parameters]\nm = { value = 1, unit = \"kg\" }\n\
         k = { value = 100, unit = \"N/m\" }\nc = { value = 1, unit = \"N s/m\" }\n\
         [coordinates]\nx = { unit = \"m\", initial = 0.1 }\n[kinetic]\nmass = \"1/2*m*dot(x)^2\"\n\
         [potential]\nspring = \"1/2*k*x^2\"\n[dissipation]\ndamper = \"1/2*c*dot(x)^2\"\n\
         [observables]\ny = { value = \"x\", unit = \"m\" }\n",
    );
    write(
        "dataset.toml",
        &format!(
            "[records]\ntrain = [\"train.csv\"]\ntest = [\"test.csv\"]\n[time]\ncolumn = \"t\"\n\
         unit = \"s\"\n[channels.{channel}]\ncolumn = \"y\"\nunit = \"m\"\nnoise = 3e-5\n\
         [initial]\n{initial}\n"
        ),
    );
    let paths = ["model.toml", "dataset.toml", "out"].map(|name| folder.path().join(name));
    run_on_dataset("compare", [&paths[0], &paths[1], &paths[2]])
}

#[test]
fn free_vibration_from_the_other_side_is_not_reported_as_wrong_sign() {
    let found = compare_free_vibrations(-0.1, -0.07, "y", "state = \"estimate\"");
    assert_eq!(found["verdict"], "no_significant_gap", "{found:#}");
}

#[test]
fn initial_state_that_a_record_contradicts_is_named() {
    // Each case contains the first positions of the records, the initial state, and the records that contradict it.
    let cases = [
        ([0.1, 0.05], "state = \"rest\"", vec!["test[0]"]),
        ([0.1, 0.1001], "state = \"rest\"", vec![]),
        (
            [0.05, 0.0502],
            "state = \"given\"\nvalues = { x = 0.05 }",
            vec![],
        ),
        (
            [0.05, -0.04],
            "state = \"given\"\nvalues = { x = 0.07 }",
            vec!["train[0]", "test[0]"],
        ),
        ([0.05, -0.04], "state = \"estimate\"", vec![]),
    ];
    for ([train, test], initial, contradicted) in cases {
        let found = compare_free_vibrations(train, test, "x", initial);
        let notes = found["notes"].as_array().expect("notes").iter();
        let notes = notes.filter_map(|note| note.as_str()?.split_once(": `x` begins at"));
        let records: Vec<&str> = notes.map(|(record, _)| record).collect();
        assert_eq!(records, contradicted, "{initial}: {found:#}");
    }
}

/// If a reversal of the friction moves past a sample, the acceleration at the sample changes by a jump. A difference
/// quotient with a small step is then not a derivative.
#[test]
fn jumps_of_an_acceleration_do_not_narrow_intervals() {
    let with_friction = OSCILLATOR.replace(
        "[coordinates]",
        "F_c = { value = 2, unit = \"N\" }\n\n[coordinates]",
    ) + "dry = { on = \"x\", value = \"-F_c*sign(dot(x))\" }\n";
    let with_friction = with_friction.replace("value = 300", "value = 309");
    let exact = "gain = { sd = 0 }\nbias = { sd = 0 }\ndelay = { sd = 0 }\n";
    let dataset = format!("{DATASET}{POSITION}{exact}")
        .replace("observable =", &format!("{exact}observable ="))
        .replace(
            "c = { relative = 0.05 }",
            "k = { relative = 0.05 }\nm = { relative = 0.05 }",
        );
    for turn in [0.0, 2.0, 4.0, 6.0] {
        let records = [
            record(FRICTION, turn, false),
            record(FRICTION, turn + 1.0, false),
        ];
        let found = run_on_records("compare", &with_friction, &dataset, records);
        for (name, right) in [("k", 300.0), ("m", 2.0)] {
            let estimate = &found["refitted"][name];
            let [value, sd] = ["value", "sd"].map(|key| estimate[key].as_f64().expect("a number"));
            let off = (value - right).abs() / sd;
            assert!(off < 5.0, "{turn}: {name} = {value} +- {sd}");
            assert!(sd > 1e-5 * right, "{turn}: {name} = {value} +- {sd}");
        }
    }
}
