//! Test with dry friction hidden in the arm's joint. The records are simulated with fixed steps from hand-written
//! equations, independent of the program.

use std::path::Path;
use std::time::Duration;

use eomgen_blind::friction::AxisForces;
use eomgen_blind::hidden::Sensors;
use eomgen_blind::inputs::{Excitation, drive};
use eomgen_blind::machines::{Kind, Machine, Setup};
use eomgen_blind::random::RandomStream;
use eomgen_blind::records::sensor_readings;
use eomgen_tests::models::path;
use eomgen_tests::program;
use serde_json::Value;

/// Dry friction of the carrier, N m.
const FRICTION: f64 = 1.0;

const LIMIT: Duration = Duration::from_secs(280);

fn arm_with_friction() -> Machine {
    let mut machine = Kind::Arm.nominal();
    let Machine::Arm(arm) = &mut machine else {
        panic!("expected the arm");
    };
    arm.modes = 2;
    arm.on_carrier = AxisForces {
        coulomb: FRICTION,
        ..arm.on_carrier.clone()
    };
    arm.prepare();
    machine
}

fn write_records(folder: &Path) {
    let setup = Setup {
        duration: 0.6,
        ..Kind::Arm.setup()
    };
    let machine = arm_with_friction();
    let mut draw = RandomStream::new(16, 1);
    for (place, name) in ["train.csv", "test.csv"].iter().enumerate() {
        let drive = drive(Kind::Arm, &setup, Excitation::Usual, place, &mut draw);
        let sensors = Sensors::ideal(setup.channels.len());
        let columns = sensor_readings(&machine, &setup, &drive, &sensors, &mut draw);
        let mut text = "t,u,theta_s,theta_c,tip\n".to_owned();
        for (sample, input) in drive.input.iter().enumerate() {
            text += &format!("{:.6},{input:.8e}", sample as f64 * setup.sample);
            for column in &columns {
                text += &format!(",{:.9e}", column[sample]);
            }
            text.push('\n');
        }
        std::fs::write(folder.join(name), text).expect("a file");
    }
    let mut text = "[records]\ntrain = [\"train.csv\"]\ntest = [\"test.csv\"]\n\n\
                    [time]\ncolumn = \"t\"\nunit = \"s\"\n\n\
                    [inputs.u]\ncolumn = \"u\"\nunit = \"N m\"\nhold = \"zero-order\"\n\n\
                    [initial]\nstate = \"rest\"\n\n[uncertain]\nb_m = { relative = 0.02 }\n\n\
                    [windows]\nlength = 0.1\nstart = \"fitted\"\n"
        .to_owned();
    for channel in &setup.channels {
        text += &format!(
            "\n[channels.{0}]\ncolumn = \"{0}\"\nunit = \"{1}\"\nnoise = {2:e}\n",
            channel.name, channel.unit, channel.noise
        );
    }
    std::fs::write(folder.join("dataset.toml"), text).expect("a file");
}

fn run_command(command: &str, specification: &Path, folder: &Path, name: &str) -> Value {
    let out = folder.join(command);
    let mut run = program::eomgen();
    let output = (run.timeout(LIMIT).arg(command).arg(specification))
        .arg(folder.join("dataset.toml"))
        .args(["--order", "2", "--out"])
        .arg(&out)
        .output()
        .expect("the program can be run");
    let message = program::text(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{message}");
    let text = std::fs::read_to_string(out.join(name)).expect("a document");
    serde_json::from_str(&text).expect("JSON")
}

#[test]
fn dry_friction_of_the_joint_is_found_with_site_and_sign() {
    let folder = tempfile::tempdir().expect("a folder");
    write_records(folder.path());
    let specification = path("planetary_arm_rig");
    let found = run_command("discover", &specification, folder.path(), "discovery.json");
    println!(
        "{}\n{}\n{}",
        found["effects"], found["gap"], found["seconds"]
    );
    assert_eq!(found["verdict"], "effects_found", "{found:#}");
    let effects = found["effects"].as_array().expect("a list");
    assert_eq!(effects.len(), 1, "{effects:#?}");
    assert_eq!(effects[0]["effect"], "coulomb_friction", "{effects:#?}");
    assert_eq!(effects[0]["on"], "theta_c", "{effects:#?}");
    let size = effects[0]["parameters"]["T_c"]["value"].as_f64();
    let size = size.expect("a size");
    assert!((size - FRICTION).abs() < 0.1 * FRICTION, "{size}");
    let closure = found["closure"]["test"].as_f64().expect("a closure");
    assert!(closure >= 0.8, "{closure}");
    assert_eq!(
        found["validation"]["passed"], true,
        "{}",
        found["validation"]
    );

    // The extended specification contains the friction, and its residual is at the noise floor.
    let extended = folder.path().join("discover/extended.toml");
    let text = std::fs::read_to_string(&extended).expect("a specification");
    assert!(text.contains("-T_c*sign(dot(theta_c))"), "{text}");
    let compared = run_command("compare", &extended, folder.path(), "comparison.json");
    assert_eq!(compared["verdict"], "no_significant_gap", "{compared:#}");
    for (name, noise) in [("theta_s", 6e-5), ("theta_c", 3e-5), ("tip", 1.5e-5)] {
        for set in ["train", "test"] {
            let left = compared["gap"][name][set].as_f64().expect("a gap");
            assert!(left < 1.2 * noise, "{name}, {set}: {left}, noise {noise}");
        }
    }
}
