//! Every kind of channel of every kind of model: a record that the model itself makes shows nothing
//! missing, to `compare` and to `discover`.

use std::path::Path;

use crate::machines::{BEAM, CYLINDER, Machine, PENDULUM, answered, description, mass, spread};

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
