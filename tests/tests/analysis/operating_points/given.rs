//! Tests of values given on the command line, and of the nearest equilibria.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use eomgen_tests::program::{run, run_accepted, run_rejected};
use serde_json::Value;

use super::{OSCILLATOR, columns, numbers, run_json, shipped, write_model};

/// Pendulum with a motor at its pivot.
const DRIVEN: &str = r#"
[model]
name = "driven_pendulum"
[parameters]
m = { value = 0.15, unit = "kg", min = 0 }
l = { value = 300, unit = "mm", min = 0 }
c = { value = 2e-4, unit = "N m s" }
g = { value = 9.81, unit = "m/s^2" }
[coordinates]
theta = { unit = "rad", initial = "pi/2" }
[inputs]
u = { unit = "N m" }
[definitions]
x = "l*sin(theta)"
y = "-l*cos(theta)"
[kinetic]
bob = "1/2*m*(dot(x)^2 + dot(y)^2)"
[potential]
gravity = "m*g*y"
[dissipation]
pivot = "1/2*c*dot(theta)^2"
[forces]
motor = { on = "theta", value = "u" }
"#;

fn number(document: &Value, name: &str) -> f64 {
    document["at"][name].as_f64().expect("a number")
}

#[test]
fn trim_finds_nearest_equilibrium_of_driven_pendulum() {
    let folder = tempfile::tempdir().expect("a folder");
    let model = write_model(folder.path(), DRIVEN);
    let level = number(&run_json(&["trim", &model]), "theta");
    assert!(level.abs() < 1e-9 || (level - PI).abs() < 1e-9, "{level}");
    for (state, right) in [
        ("theta=80 deg", 0.0),
        ("theta=100 deg", PI),
        ("theta=-pi/3", 0.0),
        ("theta=2*pi + 1", TAU),
    ] {
        let found = number(&run_json(&["trim", &model, "--state", state]), "theta");
        assert!((found - right).abs() < 1e-9, "{state}: {found}");
    }
    let held = run_json(&["trim", &model, "--fix", "theta=30 deg"]);
    assert!(
        (number(&held, "u") - 0.15 * 9.81 * 0.3 * 0.5).abs() < 1e-12,
        "{held}"
    );
}

#[test]
fn modes_and_linearise_report_whether_state_is_equilibrium() {
    let folder = tempfile::tempdir().expect("a folder");
    let model = write_model(folder.path(), DRIVEN);
    for command in ["modes", "linearise"] {
        for (at, is_equilibrium) in [
            (&["--state", "theta=pi"][..], true),
            (&["--state", "theta=0"], true),
            (&["--state", "theta=pi/2", "--state", "u=m*g*l"], true),
            (&["--state", "trim", "--state", "theta=1.2"], true),
            (&["--state", "theta=3.14"], false),
            (&["--state", "theta_dot=0.1", "--state", "theta=0"], false),
            (&[], false),
        ] {
            let given = [&[command, &model, "--json"], at].concat();
            let found = run(&given);
            assert!(found.status.success(), "{given:?}");
            let document: Value = serde_json::from_slice(&found.stdout).expect("JSON");
            assert_eq!(document["equilibrium"], is_equilibrium, "{given:?}");
            let said = String::from_utf8_lossy(&found.stderr).into_owned();
            assert_eq!(
                said.contains("not an equilibrium"),
                !is_equilibrium,
                "{given:?}: {said}"
            );
        }
    }
    let trimmed = run_json(&[
        "modes",
        &model,
        "--state",
        "trim",
        "--state",
        "theta=100 deg",
        "--json",
    ]);
    assert!((number(&trimmed, "theta") - PI).abs() < 1e-9);
}

/// Mass with zero spring force at x = 0, and a first-order state (pressure) that decays.
const MOVING: &str = r#"
[model]
name = "moving"
[parameters]
m = { value = 1, unit = "kg" }
k = { value = 100, unit = "N/m" }
T = { value = 1, unit = "s" }
[coordinates]
x = { unit = "m" }
[states]
p = { unit = "Pa", rate = "-p/T" }
[kinetic]
T = "1/2*m*dot(x)^2"
[potential]
V = "1/2*k*x^2"
"#;

#[test]
fn warning_names_nonzero_rates_away_from_equilibrium() {
    let folder = tempfile::tempdir().expect("a folder");
    let model = write_model(folder.path(), MOVING);
    let parts = ["the machine moves", "the machine accelerates", "p changes"];
    for command in ["modes", "linearise"] {
        for (at, changes) in [
            ("x_dot=1", [true, false, false]),
            ("x=1", [false, true, false]),
            ("p=1", [false, false, true]),
            ("x=0", [false, false, false]),
        ] {
            let found = run(&[command, &model, "--state", at]);
            assert!(found.status.success(), "{command} {at}");
            let said = String::from_utf8_lossy(&found.stderr).into_owned();
            assert_eq!(parts.map(|part| said.contains(part)), changes, "{said}");
        }
    }
}

#[test]
fn all_commands_accept_expressions_and_units() {
    let folder = tempfile::tempdir().expect("a folder");
    let model = write_model(folder.path(), OSCILLATOR);
    // omega^2 = k/m.
    for (set, omega) in [
        (&["--set", "k=0.072 N/mm"][..], 6.0),
        (&["--set", "m=4*m"], 2.5),
        (&["--set", "k=200", "--set", "m=8000 g"], 5.0),
    ] {
        let found = run_json(&[&["modes", &model, "--json"], set].concat());
        let frequency = found["modes"][0]["frequency"].as_f64().expect("Hz");
        assert!(
            (TAU * frequency / omega - 1.0).abs() < 1e-12,
            "{set:?} {frequency}"
        );
    }
    let out = folder.path().join("motion.csv");
    let file = out.display().to_string();
    let given = [
        "simulate",
        &model,
        "--until",
        "1",
        "--interval",
        "0.5",
        "--out",
        &file,
    ];
    let initial = ["--state", "x=25 mm", "--state", "x_dot=F_0/(m*w_0)"];
    run_accepted(&[&given[..], &initial].concat());
    let rows = columns(&out, &["x", "x_dot"]);
    assert_eq!(rows[0], [0.025, 0.75]);
    let held = run_json(&["trim", &model, "--fix", "u=F_0*2"]);
    assert!((number(&held, "x") - 0.12).abs() < 1e-13);
    let at = run_json(&[
        "linearise",
        &shipped("pendulum"),
        "--state",
        "theta=90 deg",
        "--state",
        "t=20 ms",
    ]);
    assert_eq!((number(&at, "theta"), number(&at, "t")), (FRAC_PI_2, 0.02));
}

#[test]
fn frequencies_for_all_magnitudes_of_stiffness_are_found() {
    let folder = tempfile::tempdir().expect("a folder");
    let model = write_model(folder.path(), OSCILLATOR);
    for stiffness in ["1e-200", "1e-9", "1e150", "1e300"] {
        let set = format!("k={stiffness}");
        let found = run_json(&["modes", &model, "--set", &set, "--json"]);
        let frequency = found["modes"][0]["frequency"].as_f64().expect("Hz");
        let right = (stiffness.parse::<f64>().expect("a number") / 2.0).sqrt() / TAU;
        assert!(
            (frequency / right - 1.0).abs() < 1e-12,
            "{stiffness}: {frequency:e}"
        );
        assert_eq!(
            number(&run_json(&["trim", &model, "--set", &set]), "x"),
            0.0
        );
    }
    let endless = run(&["modes", &model, "--set", "k=1e308", "--set", "m=1e-10"]);
    let said = String::from_utf8_lossy(&endless.stderr).into_owned();
    assert_eq!(endless.status.code(), Some(2));
    assert!(said.contains("not finite"), "{said}");
}

#[test]
fn rolling_bicycle_is_in_equilibrium_at_its_speed() {
    let spec = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../examples/constrained/bicycle.toml"
    );
    let modes = run_json(&["modes", spec, "--json"]);
    assert_eq!(modes["equilibrium"], true);
    let found = run_json(&["trim", spec]);
    assert!(
        (number(&found, "x_dot") - 5.0).abs() < 1e-9,
        "{}",
        found["at"]
    );
}

#[test]
fn modes_with_clipped_root_match_spring() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = r#"
[model]
name = "clipped"
[parameters]
m = { value = 1, unit = "kg", min = 0 }
k = { value = 100, unit = "N/m" }
h = { value = 100, unit = "N/m^(3/2)" }
d = { value = 0.01, unit = "m" }
[coordinates]
x = { unit = "m" }
[kinetic]
T = "1/2*m*dot(x)^2"
[potential]
V = "1/2*k*x^2"
[forces]
contact = { on = "x", value = "-h*sqrt(max(x - d, 0))*d" }
"#;
    let model = write_model(folder.path(), text);
    let printed = run_accepted(&["modes", &model]);
    assert!(printed.contains("1.591549"), "{printed}");
}

#[test]
fn moving_base_is_not_an_equilibrium() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = "[model]\nname = \"base\"\n[parameters]\nm = { value = 1, unit = \"kg\" }\n\
                k = { value = 100, unit = \"N/m\" }\n[coordinates]\nx = { unit = \"m\" }\n\
                [inputs]\ns = { unit = \"m\", rates = 2 }\n[kinetic]\nT = \"1/2*m*dot(x)^2\"\n\
                [potential]\nV = \"1/2*k*(x - s)^2\"\n";
    let model = write_model(folder.path(), text);
    let moving = run(&["modes", &model, "--state", "s_dot=1"]);
    let warned = String::from_utf8(moving.stderr).expect("text");
    assert!(
        warned.contains("prescribed motion moves (s_dot is not 0)"),
        "{warned}"
    );
    let found = run(&["trim", &model, "--state", "s_dot=1"]);
    let warned = String::from_utf8(found.stderr).expect("text");
    assert!(
        warned.contains("an equilibrium at t = 0 s only"),
        "{warned}"
    );
    let still = run_json(&["linearise", &model, "--state", "s=0.2", "--state", "x=0.2"]);
    assert_eq!(still["equilibrium"], true);
}

#[test]
fn rates_of_prescribed_motion_are_zero_at_an_equilibrium() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = "[model]\nname = \"load\"\n[parameters]\nm = { value = 1, unit = \"kg\" }\n\
                l = { value = 2, unit = \"m\" }\ng = { value = 9.81, unit = \"m/s^2\" }\n\
                [coordinates]\ntheta = { unit = \"rad\" }\n[inputs]\n\
                s = { unit = \"m\", rates = 2 }\nM = { unit = \"N m\" }\n\
                [definitions]\nplace = [\"s + l*sin(theta)\", \"-l*cos(theta)\"]\n\
                [kinetic]\nT = \"1/2*m*dot(dot(place), dot(place))\"\n\
                [potential]\nV = \"-m*g*l*cos(theta)\"\n[forces]\ntorque = { on = \"theta\", value = \"M\" }\n";
    let model = write_model(folder.path(), text);
    let found = run(&["trim", &model, "--fix", "theta=0.3"]);
    assert!(
        found.status.success() && found.stderr.is_empty(),
        "{found:?}"
    );
    let found: Value = serde_json::from_slice(&found.stdout).expect("JSON");
    assert_eq!(
        [&found["at"]["s_dot"], &found["at"]["s_ddot"]].map(Value::as_f64),
        [Some(0.0); 2]
    );
    let torque = found["at"]["M"].as_f64().expect("a torque");
    assert!((torque - 19.62 * 0.3_f64.sin()).abs() < 1e-9, "{torque}");
    let accelerated = run(&["trim", &model, "--fix", "theta=0.3", "--fix", "M=0"]);
    assert!(!accelerated.status.success(), "{accelerated:?}");
}

#[test]
fn surfaces_of_inputs_are_named_without_their_units() {
    let folder = tempfile::tempdir().expect("a folder");
    let model = write_model(folder.path(), OSCILLATOR);
    let events = folder.path().join("events.csv").display().to_string();
    let out = folder.path().join("out.csv").display().to_string();
    for (input, surface) in [
        ("u=10*t*above(t - 0.5)", "-0.5 + t"),
        ("u=2*above(sin(3*t) - 0.25) kN", "-0.25 + sin(3*t)"),
        ("u=max(t^2 - 1, 0)*1e-3 kN", "-1 + t^2"),
    ] {
        let arguments = [
            "simulate", &model, "--until", "2", "--solver", "rk", "--input", input,
        ];
        let output = run(&[
            &arguments[..],
            &["--events", &events, "--out", &out, "--json"],
        ]
        .concat());
        assert_eq!(output.status.code(), Some(0), "{input}");
        let log = std::fs::read_to_string(&events).expect("events");
        assert!(log.contains(surface), "{input}: {log}");
        let printed = String::from_utf8_lossy(&output.stdout).into_owned();
        let messages = String::from_utf8_lossy(&output.stderr).into_owned();
        for text in [log, printed, messages] {
            assert!(!text.contains("one_"), "{input}: {text}");
        }
    }
}

#[test]
fn order_of_settings_has_no_effect() {
    let folder = tempfile::tempdir().expect("a folder");
    let model = write_model(folder.path(), OSCILLATOR);
    for settings in [
        ["k=m*w_0^2", "w_0=3", "m=2*m"],
        ["m=2*m", "k=m*w_0^2", "w_0=3"],
        ["w_0=3", "m=2*m", "k=m*w_0^2"],
    ] {
        let options = settings.iter().flat_map(|setting| ["--set", setting]);
        let options: Vec<&str> = options.collect();
        let found = run_json(&[&["linearise", &model], &options[..]].concat());
        assert_eq!(numbers(&found["A"][1]), [-9.0, 0.0], "{settings:?}");
        assert_eq!(numbers(&found["B"][1]), [0.25], "{settings:?}");
    }
    let message = run_rejected(&[
        "linearise",
        &model,
        "--set",
        "m=k/w_0^2",
        "--set",
        "k=m*w_0^2",
    ]);
    assert!(message.contains("refer to each other"), "{message}");
}

#[test]
fn free_inputs_are_zero_if_no_force_must_be_balanced() {
    let cart = shipped("cart_two_arms");
    for input in ["0", "0.3", "-2", "1e-9", "1e6"] {
        for others in [&[][..], &["--fix", "x_dot=0"], &["--state", "theta_2=0.7"]] {
            let start = format!("u={input}");
            let request = ["trim", &cart, "--fix", "theta_1=0", "--state", &start];
            let found = run_json(&[&request, others].concat());
            let place = format!("u = {input}, {others:?}");
            let steady = found["steady_rates"].as_array().expect("names");
            assert!(steady.is_empty(), "{place}: {steady:?}");
            for name in ["u", "theta_2"] {
                assert!(number(&found, name).abs() < 1e-12, "{place}: {found}");
            }
        }
    }
}

/// Bob on a rod that swings about two axes; a motor drives the vertical axis.
const CONICAL: &str = r#"
[model]
name = "conical_pendulum"
[parameters]
m = { value = 2, unit = "kg" }
l = { value = 500, unit = "mm" }
g = { value = 9.81, unit = "m/s^2" }
[coordinates]
theta = { unit = "rad", initial = 0.5, range = [0.01, 3] }
phi = { unit = "rad", initial_rate = 4 }
[inputs]
M = { unit = "N m" }
[kinetic]
bob = "1/2*m*l^2*(dot(theta)^2 + sin(theta)^2*dot(phi)^2)"
[potential]
weight = "-m*g*l*cos(theta)"
[forces]
motor = { on = "phi", value = "M" }
"#;

#[test]
fn conical_pendulum_at_its_speed_is_in_equilibrium_without_torque() {
    let folder = tempfile::tempdir().expect("a folder");
    let model = write_model(folder.path(), CONICAL);
    for (angle, others) in [
        (0.5, &[][..]),
        (0.5, &["--state", "M=1"]),
        (0.5, &["--fix", "M=0"]),
        (1.2, &["--state", "phi_dot=-3"]),
        (1.4, &["--state", "phi_dot=30"]),
    ] {
        let fixed = format!("theta={angle}");
        let found = run_json(&[&["trim", &model, "--fix", &fixed], others].concat());
        let right = (9.81 / (0.5 * f64::cos(angle))).sqrt();
        let speed = number(&found, "phi_dot").abs();
        assert!(
            (speed / right - 1.0).abs() < 1e-9,
            "{angle}, {others:?}: {found}"
        );
        assert!(
            number(&found, "M").abs() < 1e-9,
            "{angle}, {others:?}: {found}"
        );
    }
}
