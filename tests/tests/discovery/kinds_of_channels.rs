//! Test of all kinds of channels and models: `compare` and `discover` find no gap in records that were simulated with
//! the model.

use std::fs;
use std::path::Path;

use eomgen_tests::program::run_rejected;

use super::machines::{
    BEAM, CYLINDER, Machine, PENDULUM, SAMPLES, STEP, Table, description, mass_on_spring,
    run_command, standard_deviation,
};

/// Asserts that both commands find no gap, and a residual far below the noise.
fn assert_no_gap(folder: &Path, description: &str, noise: f64, shown: &str) {
    for command in ["compare", "discover"] {
        let answer = run_command(folder, command, description);
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

fn assert_no_gap_in_any_channel(machine: &Machine) {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let train = machine.write_records(folder);
    for channel in &machine.channels {
        let noise = 2e-3 * standard_deviation(&train.column(channel.1));
        let description = description(machine, channel, noise);
        assert_no_gap(folder, &description, noise, &format!("{channel:?}"));
    }
}

#[test]
fn channels_of_linear_model_show_no_gap() {
    assert_no_gap_in_any_channel(&mass_on_spring("1/2*k*x^2", "k*x", "u", ""));
}

#[test]
fn channels_of_piecewise_linear_model_show_no_gap() {
    let spring = "1/2*k*deadzone(x, b)^2";
    assert_no_gap_in_any_channel(&mass_on_spring(spring, "k*deadzone(x, b)", "u", ""));
}

#[test]
fn channels_of_model_with_dry_friction_show_no_gap() {
    let drive = "u - F*sign(dot(x))";
    let machine = mass_on_spring("1/2*k*x^2", "k*x", drive, "");
    assert_no_gap_in_any_channel(&machine);
}

#[test]
fn channels_of_nonlinear_model_show_no_gap() {
    let channels = [
        ("x", "x", "rad"),
        ("x_dot", "x_dot", "rad/s"),
        ("x_ddot", "a", "rad/s^2"),
        ("o", "o", "m"),
        ("o_dot", "v_o", "m/s"),
        ("o_ddot", "a_o", "m/s^2"),
    ];
    assert_no_gap_in_any_channel(&Machine::new(PENDULUM, ("N m", 1.5), &channels));
}

#[test]
fn channels_of_model_with_small_nonlinear_term_show_no_gap() {
    let spring = "1/2*k*x^2 + 1/4*k_3*x^4";
    assert_no_gap_in_any_channel(&mass_on_spring(spring, "k*x + k_3*x^3", "u", ""));
}

#[test]
fn channels_of_linear_model_with_state_show_no_gap() {
    let states = "[states]\nz = { unit = \"N\", rate = \"(u - z)/tau\" }\n";
    let mut machine = mass_on_spring("1/2*k*x^2", "k*x", "z", states);
    machine.channels.push(("z", "z", "N"));
    assert_no_gap_in_any_channel(&machine);
}

#[test]
fn channels_of_nonlinear_model_with_state_in_pascals_show_no_gap() {
    let channels = [
        ("x", "x", "m"),
        ("x_dot", "x_dot", "m/s"),
        ("x_ddot", "a", "m/s^2"),
        ("o", "o", "N"),
        ("p", "p", "Pa"),
        ("place_ddot", "a_place", "m/s^2"),
    ];
    assert_no_gap_in_any_channel(&Machine::new(CYLINDER, ("V", 1.0), &channels));
}

#[test]
fn channels_of_model_with_field_show_no_gap() {
    let channels = [
        ("x", "x", "rad"),
        ("x_dot", "x_dot", "rad/s"),
        ("o", "o", "m"),
    ];
    assert_no_gap_in_any_channel(&Machine::new(BEAM, ("N m", 0.5), &channels));
}

/// The acceleration of the tip is compared with a difference quotient of its velocity.
#[test]
fn tip_acceleration_of_beam_matches_difference_quotient() {
    const PARTS: usize = 100;
    let channel = ("o_ddot", "a_o", "m/s^2");
    let machine = Machine::new(BEAM, ("N m", 0.5), &[channel]);
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    machine.write_records(folder);
    let mut noise = 0.0;
    for (name, turn) in [("test", 1.0), ("train", 0.0)] {
        let h = STEP / PARTS as f64;
        let speeds = machine.simulate(folder, name, turn, h).column("v_o");
        let mut table = Table::read(&folder.join(format!("{name}.csv")));
        let accelerations = (0..SAMPLES).map(|sample| match PARTS * sample {
            first if first + 2 < speeds.len() => {
                let [a, b, c] = [0, 1, 2].map(|later| speeds[first + later]);
                (4.0 * b - 3.0 * a - c) / (2.0 * h)
            }
            _ => f64::NAN,
        });
        let accelerations: Vec<f64> = accelerations.collect();
        noise = 5e-3 * standard_deviation(&accelerations[..SAMPLES - 1]);
        table.add("a_o", accelerations);
        table.write(&folder.join(format!("{name}.csv")));
    }
    let description = description(&machine, &channel, noise);
    assert_no_gap(folder, &description, noise, "o_ddot");
}

/// An accelerometer on a point of the machine shows the missing spring.
#[test]
fn missing_spring_is_found_from_acceleration_of_a_point() {
    let channel = ("o_ddot", "a_o", "m/s^2");
    let machine = Machine::new(PENDULUM, ("N m", 1.5), &[channel]);
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let truth = Machine {
        specification: PENDULUM.replace("u - c*dot(x)", "u - c*dot(x) - m*g*l*x/10"),
        ..machine.clone()
    };
    let noise = 2e-3 * standard_deviation(&truth.write_records(folder).column("a_o"));
    fs::write(folder.join("model.toml"), PENDULUM).expect("a file");
    let description = description(&machine, &channel, noise);
    let answer = run_command(folder, "discover", &description);
    let effect = &answer["effects"][0];
    assert_eq!(effect["effect"], "elastic_restraint", "{answer:#}");
    let parameters = effect["parameters"].as_object().expect("parameters");
    let stiffness = parameters.values().next().expect("a stiffness");
    let found = stiffness["value"].as_f64().expect("a number");
    assert!((found / 0.4905 - 1.0).abs() < 0.05, "{answer:#}");
    let written = fs::read_to_string(folder.join("answer/extended.toml")).expect("a file");
    fs::write(folder.join("model.toml"), written).expect("a file");
    let again = run_command(folder, "compare", &description);
    assert_eq!(again["verdict"], "no_significant_gap", "{again:#}");
}

/// The second derivative of the cylinder's force depends on the rate of the voltage, which is unknown.
#[test]
fn undefined_acceleration_is_rejected() {
    let channel = ("o_ddot", "o", "N/s^2");
    let machine = Machine::new(CYLINDER, ("V", 1.0), &[channel]);
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    machine.write_records(folder);
    let dataset = folder.join("dataset.toml");
    fs::write(&dataset, description(&machine, &channel, 1.0)).expect("a file");
    for command in ["compare", "discover"] {
        let paths = [
            folder.join("model.toml"),
            dataset.clone(),
            folder.join("answer"),
        ];
        let [specification, dataset, out] = paths.map(|path| path.display().to_string());
        let message = run_rejected(&[command, &specification, &dataset, "--out", &out]);
        assert!(
            message.contains("`o` needs the rate of an input"),
            "{message}"
        );
    }
}

#[test]
fn inputs_along_given_motion_show_no_gap() {
    let spring = mass_on_spring("1/2*k*x^2", "k*x", "u", "");
    let pendulum = Machine::new(PENDULUM, ("N m", 1.5), &[("u", "u", "N m")]);
    for (machine, unit) in [(spring, "m"), (pendulum, "rad")] {
        let folder = tempfile::tempdir().expect("a folder");
        let folder = folder.path();
        let train = machine.write_records(folder);
        // The input is piecewise constant, but the curve through the samples has a continuous second derivative.
        let noise = 0.3 * standard_deviation(&train.column("u"));
        let channel = ("u", "u", machine.input.0);
        let description = description(&machine, &channel, noise);
        let (before, after) = description.split_once("[inputs.u]").expect("an input");
        let (_, after) = after.split_once("[channels").expect("a channel");
        let (after, _) = after.split_once("[initial]").expect("the initial state");
        let motion = format!("[motion.x]\ncolumn = \"x\"\nunit = \"{unit}\"\n");
        assert_no_gap(
            folder,
            &format!("{before}{motion}[channels{after}"),
            noise,
            "u",
        );
    }
}
