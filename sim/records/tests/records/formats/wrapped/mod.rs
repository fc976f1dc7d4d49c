//! Tests of wrapped columns: they are rejected with a remedy, or unwrapped by `wrap`; other jumps are accepted.

use std::fmt::Write;

use eomgen_model_spec::model::Model;
use eomgen_records::dataset::Dataset;
use eomgen_records::{Refusal, propose_dataset, read_dataset};
use tempfile::TempDir;

use super::write;

const ROTOR: &str = r#"
[model]
name = "rotor"
[parameters]
J = { value = 0.01, unit = "kg m^2" }
k = { value = 0.2, unit = "N m" }
[coordinates]
phi = { unit = "rad" }
[inputs]
u = { unit = "N m" }
[kinetic]
wheel = "1/2*J*dot(phi)^2"
[forces]
motor = { on = "phi", value = "u" }
"#;

const DESCRIPTION: &str = r#"
[records]
train = ["train.csv"]
test = ["test.csv"]
[time]
column = "t"
unit = "s"
[channels.phi]
column = "phi"
unit = "deg"
noise = 0.1
"#;

const COUNT: usize = 400;

fn rotor() -> Model {
    let source = eomgen_model_spec::source::Source::new("rotor.toml", ROTOR);
    eomgen_model_spec::check(source).expect("a model").model
}

/// Returns an angle in degrees over many turns with reversals; `turn` is the size of a turn.
fn angle(k: usize, turn: f64) -> f64 {
    let t = 0.01 * k as f64;
    900.0 * (1.1 * t + turn).sin() + 700.0 * t
}

/// Creates a folder with records of an angle and an input. `sensor` gives the reading of an angle.
fn folder(description: &str, sensor: impl Fn(f64) -> f64, u: impl Fn(usize) -> f64) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    write(folder.path(), "dataset.toml", description);
    for (name, turn) in [("train.csv", 0.0), ("test.csv", 1.0)] {
        let mut text = "t,u,phi\n".to_owned();
        for k in 0..COUNT {
            let (t, phi) = (0.01 * k as f64, sensor(angle(k, turn)));
            writeln!(text, "{t:.2},{},{phi:.6}", u(k)).expect("a string");
        }
        write(folder.path(), name, &text);
    }
    folder
}

fn wrapped(value: f64) -> f64 {
    (value + 180.0).rem_euclid(360.0) - 180.0
}

fn read(folder: &TempDir) -> Result<Dataset, Refusal> {
    read_dataset(&folder.path().join("dataset.toml"), &rotor())
}

fn rejection_message(folder: &TempDir) -> String {
    read(folder)
        .map(|_| ())
        .expect_err("it is taken")
        .to_string()
}

/// Returns the dataset file with additional keys of the channel.
fn with_channel_keys(keys: &str) -> String {
    format!("{DESCRIPTION}{keys}\n")
}

/// Returns the largest difference of a channel from the angle in degrees, up to full turns.
fn find_largest_error(values: &[f64], turn: f64, every: usize) -> f64 {
    let degrees = |k: usize| values[k].to_degrees() - angle(k * every, turn);
    let offset = (degrees(0) / 360.0).round() * 360.0;
    // The low-pass filter of `every` is inaccurate at the ends.
    let inside = 10 * (every - 1)..values.len() - 10 * (every - 1);
    inside
        .map(|k| (degrees(k) - offset).abs())
        .fold(0.0, f64::max)
}

#[test]
fn wrapped_channel_is_rejected_with_key_to_write() {
    let said = rejection_message(&folder(DESCRIPTION, wrapped, |_| 0.0));
    for part in [
        "train.csv: `phi` jumps ",
        " times by about 360.0000 deg, first at 0.",
        "write wrap = 360 in [channels.phi]",
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }
    let radians = DESCRIPTION.replace("\"deg\"", "\"rad\"");
    let said = rejection_message(&folder(&radians, |v| wrapped(v).to_radians(), |_| 0.0));
    assert!(said.contains("write wrap = 6.283185307179586 in"), "{said}");
    assert!(
        read(&folder(
            &with_channel_keys("wrap = \"none\""),
            wrapped,
            |_| 0.0
        ))
        .is_ok()
    );
}

/// Returns the error message for a counter with the given period; `turns` is its motion in turns.
fn counter_rejection_message(period: f64, mut turns: impl FnMut(usize) -> f64) -> String {
    let counts = DESCRIPTION
        .replace("\"deg\"", "\"1\"")
        .replace("0.1", "1")
        .replace("test = [\"test.csv\"]", "test = [\"train.csv\"]");
    let folder = folder(&counts, |v| v, |_| 0.0);
    let mut text = "t,u,phi\n".to_owned();
    for k in 0..2000_u32 {
        let count = (turns(k as usize) * period).floor().rem_euclid(period);
        writeln!(text, "{:.2},0,{count}", 0.01 * f64::from(k)).expect("a string");
    }
    write(folder.path(), "train.csv", &text);
    rejection_message(&folder)
}

#[test]
fn usual_counter_period_is_proposed_exactly() {
    let mut noise = 12345_u64;
    let mut uniform = move || {
        noise = noise
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (noise >> 40) as f64 / 2f64.powi(24) - 0.5
    };
    for period in [256.0, 1000.0, 1024.0, 3600.0, 4096.0, 65536.0, 16_777_216.0] {
        for (wraps, noise) in [(2.0, 0.0), (3.0, 0.0), (2.0, 1.0), (3.0, 1.0)] {
            let said = counter_rejection_message(period, |k| {
                let part = f64::from(k as u32) / 2000.0;
                0.4 + wraps * (part + 0.05 * (9.0 * part).sin()) + noise * uniform() / period
            });
            let right = format!("write wrap = {period} in [channels.phi]");
            assert!(said.contains(&right), "{period}, {wraps}, {noise}: {said}");
            assert!(
                noise > 0.0 || period > 1e5 || !said.contains("uncertain"),
                "{said}"
            );
            assert!(!said.contains("0 1,"), "the unit 1 is not named: {said}");
        }
    }
}

#[test]
fn unusual_period_is_proposed_with_uncertainty() {
    let said = counter_rejection_message(5003.0, |k| 0.4 + 0.0017 * k as f64);
    assert!(
        said.contains("write wrap = 5003 in [channels.phi] (uncertain by 1"),
        "{said}"
    );
    let said = counter_rejection_message(65003.0, |k| 0.4 + 0.0017 * k as f64);
    assert!(
        said.contains("write wrap = 65003 in [channels.phi] (uncertain by 1"),
        "{said}"
    );
}

#[test]
fn declared_channel_is_unwrapped_before_decimation() {
    for (unit, keys, scale) in [
        ("deg", "wrap = 360", 1.0),
        ("rad", "wrap = 6.283", 1f64.to_radians()),
        ("deg", "wrap = \"360 deg\"", 1.0),
        ("deg", "wrap = \"2*pi rad\"", 1.0),
        ("deg", "wrap = \"2*pi\"", 1.0),
        ("rad", "wrap = \"2*pi\"", 1f64.to_radians()),
        ("rad", "wrap = \"3600/10 deg\"", 1f64.to_radians()),
    ] {
        for every in [1, 4] {
            let description = with_channel_keys(keys)
                .replace("\"deg\"", &format!("\"{unit}\""))
                .replace(
                    "column = \"t\"",
                    &format!("column = \"t\"\nevery = {every}"),
                );
            let dataset = read(&folder(&description, |v| scale * wrapped(v), |_| 0.0));
            let dataset = dataset.unwrap_or_else(|refusal| panic!("{refusal}"));
            for (record, turn) in [(&dataset.train[0], 0.0), (&dataset.test[0], 1.0)] {
                let error = find_largest_error(&record.channels[0], turn, every);
                assert!(error < 0.05, "{unit}, {every}: {error}");
            }
        }
    }
}

#[test]
fn parts_of_file_keep_turns_from_known_start() {
    let parts =
        "train = [{ file = \"train.csv\", to = 2 }]\ntest = [{ file = \"train.csv\", from = 2 }]";
    let whole = "train = [\"train.csv\"]\ntest = [\"test.csv\"]";
    let folder_of = folder(
        &with_channel_keys("wrap = 360").replace(whole, parts),
        wrapped,
        |_| 0.0,
    );
    let dataset = read(&folder_of).unwrap_or_else(|refusal| panic!("{refusal}"));
    let [before, after] = [&dataset.train[0], &dataset.test[0]].map(|record| &record.channels[0]);
    let step = (after[0] - before[before.len() - 1]).to_degrees();
    assert!(
        (step - angle(200, 0.0) + angle(199, 0.0)).abs() < 1e-3,
        "{step}"
    );
    // A sensor with the range 0 to 360 degrees reads 359.9 at rest.
    let resting = with_channel_keys("wrap = 360\n[initial]\nstate = \"rest\"");
    let from_zero = folder(&resting, |v| (v - 0.1).rem_euclid(360.0), |_| 0.0);
    let dataset = read(&from_zero).unwrap_or_else(|refusal| panic!("{refusal}"));
    let first = dataset.train[0].channels[0][0].to_degrees();
    assert!((first + 0.1).abs() < 1e-3, "{first}");
}

#[test]
fn wrong_period_is_rejected() {
    for (keys, part) in [
        ("wrap = 100", "spans 357."),
        ("wrap = 720", "jumps by about 360.0000 deg"),
        ("wrap = 0", "cannot wrap around after 0"),
        ("wrap = \"no\"", "or \"none\""),
        ("wrap = \"50*pi/90\"", "spans 357."),
        ("wrap = \"0 deg\"", "cannot wrap around after 0"),
        ("wrap = \"-2*pi\"", "cannot wrap around after -360"),
        ("wrap = \"360 mm\"", "in deg, not in mm"),
        ("wrap = \"2*q\"", "unknown name `q`"),
        ("wrap = \"k\"", "expected in deg"),
        ("wrap = \"2*(\"", "or \"none\""),
    ] {
        let said = rejection_message(&folder(&with_channel_keys(keys), wrapped, |_| 0.0));
        assert!(said.contains(part), "{part}: {said}");
    }
}

#[test]
fn gap_with_unknown_turns_is_rejected_only_inside_part() {
    let with_gap = |description: &str| {
        let folder = folder(description, wrapped, |_| 0.0);
        let mut text = "t,u,phi\n".to_owned();
        for k in 0..COUNT {
            // The angle is at rest up to the gap, and moves by 90 degrees per sample after it.
            let phi = wrapped(90.0 * k.saturating_sub(215) as f64 + 0.01 * k as f64);
            let phi = if (200..230).contains(&k) {
                String::new()
            } else {
                format!("{phi:.3}")
            };
            writeln!(text, "{:.2},0,{phi}", 0.01 * k as f64).expect("a string");
        }
        write(folder.path(), "train.csv", &text);
        folder
    };
    let said = rejection_message(&with_gap(&with_channel_keys("wrap = 360")));
    assert!(
        said.contains("`phi` is missing from 1.990000 s to 2.300000 s"),
        "{said}"
    );
    let parts =
        "train = [{ file = \"train.csv\", to = 1.99 }, { file = \"train.csv\", from = 2.3 }]";
    let parted = with_channel_keys("wrap = 360").replace("train = [\"train.csv\"]", parts);
    let dataset = read(&with_gap(&parted)).unwrap_or_else(|refusal| panic!("{refusal}"));
    assert_eq!(dataset.train.len(), 2);
}

#[test]
fn square_wave_input_is_not_wrapped() {
    let fed = "[inputs.u]\ncolumn = \"u\"\nunit = \"rad\"\n";
    let model = ROTOR.replace("u = { unit = \"N m\" }", "u = { unit = \"rad\" }");
    let model = model.replace("value = \"u\"", "value = \"k*u\"");
    let model = eomgen_model_spec::source::Source::new("rotor.toml", model);
    let model = eomgen_model_spec::check(model).expect("a model").model;
    let read = |u: &dyn Fn(usize) -> f64| {
        let folder = folder(
            &with_channel_keys(&format!("wrap = 360\n{fed}")),
            wrapped,
            u,
        );
        read_dataset(&folder.path().join("dataset.toml"), &model).map(|_| ())
    };
    let turn = std::f64::consts::TAU;
    let square = |k: usize| {
        if (k / 50).is_multiple_of(2) {
            0.5 * turn
        } else {
            -0.5 * turn
        }
    };
    let sawtooth = |k: usize| 0.03 * (k % 50) as f64;
    let angle = |k: usize| (0.11 * k as f64).rem_euclid(turn);
    for (name, u, is_taken) in [
        ("square", &square as &dyn Fn(usize) -> f64, true),
        ("sawtooth", &sawtooth, true),
        ("angle", &angle, false),
    ] {
        let found = read(u);
        assert_eq!(found.is_ok(), is_taken, "{name}: {found:?}");
        if let Err(refusal) = found {
            assert!(refusal.to_string().contains("in [inputs.u]"), "{refusal}");
        }
    }
}

#[test]
fn proposed_file_declares_wrap() {
    let folder = folder("", |v| wrapped(v).to_radians(), |k| (0.1 * k as f64).sin());
    let text = propose_dataset(&folder.path().join("train.csv"), "train.csv", &rotor());
    let text = text.unwrap_or_else(|refusal| panic!("{refusal}"));
    assert!(text.contains("wrap = 6.283185307179586"), "{text}");
    write(folder.path(), "dataset.toml", &text);
    let dataset = read(&folder).unwrap_or_else(|refusal| panic!("{refusal}: {text}"));
    assert!(find_largest_error(&dataset.train[0].channels[0], 0.0, 1) < 0.05);
    assert!(dataset.channels[0].noise < 1e-3, "{text}");
}

#[test]
fn angle_with_jumps_of_360_and_no_unit_is_in_degrees() {
    let folder = folder("", wrapped, |k| (0.1 * k as f64).sin());
    let text = propose_dataset(&folder.path().join("train.csv"), "train.csv", &rotor());
    let text = text.unwrap_or_else(|refusal| panic!("{refusal}"));
    for line in ["unit = \"deg\"", "wrap = 360"] {
        assert!(text.contains(line), "{line}: {text}");
    }
    write(folder.path(), "dataset.toml", &text);
    let dataset = read(&folder).unwrap_or_else(|refusal| panic!("{refusal}: {text}"));
    assert!(find_largest_error(&dataset.train[0].channels[0], 0.0, 1) < 0.05);
}
