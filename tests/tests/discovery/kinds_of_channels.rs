//! Every kind of channel of every kind of model: a record that the model itself makes shows nothing
//! missing, to `compare` and to `discover`.

use std::fs;
use std::path::Path;

use eomgen_tests::program::refused;

use super::machines::{
    BEAM, CYLINDER, Machine, PENDULUM, SAMPLES, STEP, Table, answered, description, mass, spread,
};

/// Both commands find that a channel shows nothing missing, and leave a small part of its noise.
fn finds_nothing(folder: &Path, description: &str, noise: f64, shown: &str) {
    for command in ["compare", "discover"] {
        let answer = answered(folder, command, description);
        assert_eq!(
            answer["verdict"], "no_significant_gap",
            "{command} {shown}: {answer:#}"
        );
        let gap = &answer["gap"]["c"];
        let before = if command == "discover" {
            &gap["before"]
        } else {
            gap
        };
        for part in ["train", "test"] {
            let left = before[part].as_f64().expect("a gap");
            assert!(
                left < 0.2 * noise,
                "{command} {shown}: {left:e} of {noise:e} in {part}"
            );
        }
    }
}

/// Every channel of a machine by itself.
fn every_channel_shows_nothing(machine: &Machine) {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let train = machine.records(folder);
    for channel in &machine.channels {
        let noise = 2e-3 * spread(&train.column(channel.1));
        let description = description(machine, channel, noise);
        finds_nothing(folder, &description, noise, &format!("{channel:?}"));
    }
}

#[test]
fn linear_model() {
    every_channel_shows_nothing(&mass("1/2*k*x^2", "k*x", "u", ""));
}

#[test]
fn piecewise_linear_model() {
    let spring = "1/2*k*deadzone(x, b)^2";
    every_channel_shows_nothing(&mass(spring, "k*deadzone(x, b)", "u", ""));
}

#[test]
fn model_with_dry_friction() {
    let drive = "u - F*sign(dot(x))";
    let machine = mass("1/2*k*x^2", "k*x", drive, "");
    every_channel_shows_nothing(&machine);
}

#[test]
fn nonlinear_model() {
    let channels = [
        ("x", "x", "rad"),
        ("x_dot", "x_dot", "rad/s"),
        ("x_ddot", "a", "rad/s^2"),
        ("o", "o", "m"),
        ("o_dot", "v_o", "m/s"),
        ("o_ddot", "a_o", "m/s^2"),
    ];
    every_channel_shows_nothing(&Machine::new(PENDULUM, ("N m", 1.5), &channels));
}

#[test]
fn model_with_a_small_nonlinear_term() {
    let spring = "1/2*k*x^2 + 1/4*k_3*x^4";
    every_channel_shows_nothing(&mass(spring, "k*x + k_3*x^3", "u", ""));
}

#[test]
fn linear_model_with_a_state() {
    let states = "[states]\nz = { unit = \"N\", rate = \"(u - z)/tau\" }\n";
    let mut machine = mass("1/2*k*x^2", "k*x", "z", states);
    machine.channels.push(("z", "z", "N"));
    every_channel_shows_nothing(&machine);
}

#[test]
fn nonlinear_model_with_a_state_in_pascals() {
    let channels = [
        ("x", "x", "m"),
        ("x_dot", "x_dot", "m/s"),
        ("x_ddot", "a", "m/s^2"),
        ("o", "o", "N"),
        ("p", "p", "Pa"),
        ("place_ddot", "a_place", "m/s^2"),
    ];
    every_channel_shows_nothing(&Machine::new(CYLINDER, ("V", 1.0), &channels));
}

#[test]
fn model_with_a_field() {
    let channels = [
        ("x", "x", "rad"),
        ("x_dot", "x_dot", "rad/s"),
        ("o", "o", "m"),
    ];
    every_channel_shows_nothing(&Machine::new(BEAM, ("N m", 0.5), &channels));
}

/// The acceleration of a tip is what its speed differs by a moment later.
#[test]
fn acceleration_of_the_tip_of_a_beam() {
    const PARTS: usize = 100;
    let channel = ("o_ddot", "a_o", "m/s^2");
    let machine = Machine::new(BEAM, ("N m", 0.5), &[channel]);
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    machine.records(folder);
    let mut noise = 0.0;
    for (name, turn) in [("test", 1.0), ("train", 0.0)] {
        let h = STEP / PARTS as f64;
        let speeds = machine.motion(folder, name, turn, h).column("v_o");
        let mut table = Table::read(&folder.join(format!("{name}.csv")));
        let accelerations = (0..SAMPLES).map(|sample| match PARTS * sample {
            first if first + 2 < speeds.len() => {
                let [a, b, c] = [0, 1, 2].map(|later| speeds[first + later]);
                (4.0 * b - 3.0 * a - c) / (2.0 * h)
            }
            _ => f64::NAN,
        });
        let accelerations: Vec<f64> = accelerations.collect();
        noise = 5e-3 * spread(&accelerations[..SAMPLES - 1]);
        table.add("a_o", accelerations);
        table.write(&folder.join(format!("{name}.csv")));
    }
    let description = description(&machine, &channel, noise);
    finds_nothing(folder, &description, noise, "o_ddot");
}

/// A spring that the model lacks is found by an accelerometer on a point of the machine.
#[test]
fn spring_seen_by_the_acceleration_of_a_point() {
    let channel = ("o_ddot", "a_o", "m/s^2");
    let machine = Machine::new(PENDULUM, ("N m", 1.5), &[channel]);
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let truth = Machine {
        specification: PENDULUM.replace("u - c*dot(x)", "u - c*dot(x) - m*g*l*x/10"),
        ..machine.clone()
    };
    let noise = 2e-3 * spread(&truth.records(folder).column("a_o"));
    fs::write(folder.join("model.toml"), PENDULUM).expect("a file");
    let description = description(&machine, &channel, noise);
    let answer = answered(folder, "discover", &description);
    let effect = &answer["effects"][0];
    assert_eq!(effect["effect"], "elastic_restraint", "{answer:#}");
    let parameters = effect["parameters"].as_object().expect("parameters");
    let stiffness = parameters.values().next().expect("a stiffness");
    let found = stiffness["value"].as_f64().expect("a number");
    assert!((found / 0.4905 - 1.0).abs() < 0.05, "{answer:#}");
    let written = fs::read_to_string(folder.join("answer/extended.toml")).expect("a file");
    fs::write(folder.join("model.toml"), written).expect("a file");
    let again = answered(folder, "compare", &description);
    assert_eq!(again["verdict"], "no_significant_gap", "{again:#}");
}

/// The force of a cylinder has a second derivative only with that of the voltage.
#[test]
fn acceleration_that_is_not_defined_is_refused() {
    let channel = ("o_ddot", "o", "N/s^2");
    let machine = Machine::new(CYLINDER, ("V", 1.0), &[channel]);
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    machine.records(folder);
    let dataset = folder.join("dataset.toml");
    fs::write(&dataset, description(&machine, &channel, 1.0)).expect("a file");
    for command in ["compare", "discover"] {
        let paths = [
            folder.join("model.toml"),
            dataset.clone(),
            folder.join("answer"),
        ];
        let [specification, dataset, out] = paths.map(|path| path.display().to_string());
        let message = refused(&[command, &specification, &dataset, "--out", &out]);
        assert!(
            message.contains("`o` needs the rate of an input"),
            "{message}"
        );
    }
}

/// The torque of a pendulum, and of a mass, along motions that are given.
#[test]
fn inputs_along_a_given_motion() {
    let spring = mass("1/2*k*x^2", "k*x", "u", "");
    let pendulum = Machine::new(PENDULUM, ("N m", 1.5), &[("u", "u", "N m")]);
    for (machine, unit) in [(spring, "m"), (pendulum, "rad")] {
        let folder = tempfile::tempdir().expect("a folder");
        let folder = folder.path();
        let train = machine.records(folder);
        // The curve through samples of a motion does not jump in its second rate as the held input does.
        let noise = 0.3 * spread(&train.column("u"));
        let channel = ("u", "u", machine.input.0);
        let description = description(&machine, &channel, noise);
        let (before, after) = description.split_once("[inputs.u]").expect("an input");
        let (_, after) = after.split_once("[channels").expect("a channel");
        let (after, _) = after.split_once("[initial]").expect("the initial state");
        let motion = format!("[motion.x]\ncolumn = \"x\"\nunit = \"{unit}\"\n");
        finds_nothing(
            folder,
            &format!("{before}{motion}[channels{after}"),
            noise,
            "u",
        );
    }
}
