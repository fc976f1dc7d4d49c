//! Tests of `--measure poincare:NAME` and `--section` for any coordinate and for models without forcing.

use eomgen_tests::program::{run, run_accepted, run_rejected};

use super::sweep_folder::{SweepFolder, accept, column, table};

/// x = sin(t) and y = cos(1.5 t): two independent free oscillators.
const TWO: &str = r#"
[model]
name = "two"
[parameters]
m = { value = 1, unit = "kg" }
k = { value = 1, unit = "N/m" }
c = { value = 2.25, unit = "N/m" }
[coordinates]
x = { unit = "m", initial_rate = 1 }
y = { unit = "m", initial = 1 }
[kinetic]
both = "1/2*m*(dot(x)^2 + dot(y)^2)"
[potential]
both = "1/2*k*x^2 + 1/2*c*y^2"
"#;

fn sweep_two(place: &SweepFolder, more: &[&str]) -> Vec<String> {
    std::fs::write(place.path_to("two.toml"), TWO).expect("a specification");
    let (spec, out) = (place.path_to("two.toml"), place.path_to("two"));
    let (spec, out) = (spec.display().to_string(), out.display().to_string());
    let given = ["sweep", &spec, "--out", &out, "--vary", "m=1:1.5:2"];
    given
        .iter()
        .chain(more)
        .map(|part| (*part).to_owned())
        .collect()
}

fn as_strs(arguments: &[String]) -> Vec<&str> {
    arguments.iter().map(String::as_str).collect()
}

#[test]
fn section_at_a_coordinate_value_samples_autonomous_model() {
    let place = SweepFolder::new();
    let section = [
        "--measure",
        "poincare:y",
        "--section",
        "x=0:down",
        "--until",
        "200",
    ];
    let span = ["--transient", "3", "--periods", "12"];
    accept(&sweep_two(&place, &[&section[..], &span].concat()));
    let found = table(&place.path_to("two"));
    let one = |name: &str| column(&found, name)[0];
    // x crosses 0 downwards at t = pi (2 k + 1). At these times y = cos(1.5 pi (2 k + 1)) = 0.
    assert!((one("poincare:y_time") - std::f64::consts::TAU).abs() < 1e-7);
    for point in 1..=12 {
        let y = one(&format!("poincare:y_{point}"));
        assert!(y.abs() < 1e-6, "{point}: {y}");
    }
    // At these times the rate of y alternates between 1.5 and -1.5.
    assert_eq!(one("poincare:y_period"), 2.0);
    assert_eq!(one("poincare:y_clusters"), 2.0);
}

#[test]
fn upward_section_samples_rising_crossings() {
    let place = SweepFolder::new();
    let section = [
        "--measure",
        "poincare:y",
        "--section",
        "x=0.5",
        "--until",
        "200",
    ];
    let span = ["--transient", "2", "--periods", "8"];
    accept(&sweep_two(&place, &[&section[..], &span].concat()));
    let found = table(&place.path_to("two"));
    for point in 1..=8_u32 {
        // sin(t) crosses 1/2 upwards at t = pi/6 + 2 pi k.
        let t = std::f64::consts::PI / 6.0 + std::f64::consts::TAU * f64::from(point + 1);
        let y = column(&found, &format!("poincare:y_{point}"))[0];
        assert!((y - (1.5 * t).cos()).abs() < 1e-6, "{point}: {y}");
    }
}

#[test]
fn poincare_of_another_coordinate_samples_once_per_period() {
    let place = SweepFolder::new();
    let more = [
        "--measure",
        "poincare:x_dot",
        "--vary",
        "c=500:500:1",
        "--transient",
        "40",
    ];
    let spec = place.path_to("oscillator.toml").display().to_string();
    let out = place.path_to("map").display().to_string();
    let given = ["sweep", &spec, "--out", &out];
    run_accepted(&[&given[..], &more, &["--periods", "4"]].concat());
    // With m = 1, k = 4 and omega = 2 the response is resonant: x = -F/(c omega) cos(omega t).
    let found = table(&place.path_to("map"));
    let rate = column(&found, "poincare:x_dot_mean")[0];
    assert!(rate.abs() < 1e-9, "{rate}");
}

/// x crosses 0 downwards at t = pi sqrt(m) (2 k + 1). Before 19 s there are three crossings for m = 1 and two for m =
/// 1.5.
#[test]
fn points_with_too_few_crossings_are_reported() {
    let section = [
        "--measure",
        "poincare:y",
        "--section",
        "x=0:down",
        "--until",
        "19",
    ];
    for (span, code, message) in [
        (
            ["1", "2"],
            0,
            "warning: poincare:y: 1 of 2 points has no number, because the section has too few crossings: 2 of 3 at m = 1.5.",
        ),
        (
            ["0", "3"],
            0,
            "2 of 3 at m = 1.5. Give a later end (--until), fewer crossings (--transient, --periods), or another section",
        ),
        (["0", "2"], 0, ""),
        (
            ["3", "2"],
            1,
            "error: poincare:y: 2 of 2 points have no number, because the section has too few crossings: 3 of 5 at m = 1; 2 of 5 at m = 1.5.",
        ),
    ] {
        let place = SweepFolder::new();
        let span = ["--transient", span[0], "--periods", span[1]];
        let output = run(&as_strs(&sweep_two(
            &place,
            &[&section[..], &span].concat(),
        )));
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{span:?}: {said}");
        assert!(said.contains(message), "{span:?}: {said}");
        assert_eq!(said.contains("crossings"), !message.is_empty(), "{said}");
        let found = table(&place.path_to("two"));
        let few = column(&found, "poincare:y_status")
            .iter()
            .filter(|status| **status == 6.0);
        assert_eq!(
            few.count(),
            usize::from(!message.is_empty()) + usize::from(code == 1)
        );
        let wanted: f64 =
            span[1].parse::<f64>().unwrap_or(0.0) + span[3].parse::<f64>().unwrap_or(0.0);
        let crossings = column(&found, "poincare:y_crossings");
        assert_eq!(crossings, [wanted.min(3.0), wanted.min(2.0)], "{span:?}");
        let merged = run(&["merge", &place.path_to("two").display().to_string()]);
        assert_eq!(merged.status.code(), Some(code));
    }
}

#[test]
fn invalid_sections_are_rejected() {
    let place = SweepFolder::new();
    for (more, what) in [
        (
            &[
                "--measure",
                "poincare:z",
                "--section",
                "x=0",
                "--until",
                "9",
            ][..],
            "`z`",
        ),
        (
            &["--measure", "poincare", "--section", "x", "--until", "9"],
            "no `=`",
        ),
        (
            &[
                "--measure",
                "poincare",
                "--section",
                "x=0:over",
                "--until",
                "9",
            ],
            "is not a direction",
        ),
        (
            &[
                "--measure",
                "poincare",
                "--section",
                "x=NaN",
                "--until",
                "9",
            ],
            "finite",
        ),
        (
            &["--measure", "poincare", "--section", "x=0"],
            "--until is missing",
        ),
        (
            &["--measure", "poincare", "--section", "x=0", "--until", "-1"],
            "greater than 0",
        ),
        (&["--measure", "poincare"], "--section NAME=VALUE"),
    ] {
        let arguments = sweep_two(&place, more);
        let message = run_rejected(&as_strs(&arguments));
        assert!(message.contains(what), "{more:?}: {message}");
        assert!(!place.path_to("two").exists());
    }
}

/// Shaft driven by a motor with a varying torque; PHI stands for the angle.
const SHAFT: &str = r#"
[model]
name = "shaft"
[parameters]
J = { value = 1, unit = "kg m^2" }
c = { value = 0.5, unit = "N m s" }
T_0 = { value = 1, unit = "N m" }
T_1 = { value = 0.5, unit = "N m" }
omega = { value = 3, unit = "rad/s" }
[coordinates]
phi = { unit = "rad" }
[kinetic]
k = "1/2*J*dot(phi)^2"
[dissipation]
c = "1/2*c*dot(phi)^2"
[forces]
motor = { on = "phi", value = "T_0 + T_1*cos(omega*t)" }
"#;

/// Shaft that a rotating field synchronises with its speed; the phase between shaft and field does not depend on d.
const LOCKED_SHAFT: &str = r#"
[model]
name = "locked"
[parameters]
J = { value = 2, unit = "kg m^2" }
d = { value = 5, unit = "N m s" }
k = { value = 50, unit = "N m" }
omega = { value = 6, unit = "rad/s" }
[coordinates]
phi = { unit = "rad" }
[kinetic]
k = "1/2*J*dot(phi)^2"
[dissipation]
b = "1/2*d*(dot(phi) - omega)^2"
[forces]
field = { on = "phi", value = "-k*sin(phi - omega*t)" }
"#;

/// Returns the period and the largest value sampled once per forcing period.
fn repetition(place: &SweepFolder, text: &str, vary: &str, quantity: &str) -> (f64, f64) {
    std::fs::write(place.path_to("model.toml"), text).expect("a specification");
    let _ = std::fs::remove_dir_all(place.path_to("out"));
    let (spec, out) = (place.path_to("model.toml"), place.path_to("out"));
    let (spec, out) = (spec.display().to_string(), out.display().to_string());
    let measure = format!("poincare:{quantity}");
    let given = [
        "sweep",
        &spec,
        "--out",
        &out,
        "--vary",
        vary,
        "--measure",
        &measure,
        "--transient",
        "300",
    ];
    let given: Vec<String> = given.iter().map(|part| (*part).to_owned()).collect();
    accept(&given);
    let found = table(&place.path_to("out"));
    let one = |part: &str| column(&found, &format!("{measure}_{part}"))[0];
    (one("period"), one("max"))
}

#[test]
fn rotating_and_travelling_machines_have_period_one() {
    use std::f64::consts::PI;
    let place = SweepFolder::new();
    // The period is determined from the rate, and from the angle modulo one turn.
    assert_eq!(repetition(&place, SHAFT, "c=0.5:0.6:2", "phi_dot").0, 1.0);
    let (period, greatest) = repetition(&place, SHAFT, "c=0.5:0.6:2", "phi");
    assert!(period == 1.0 && greatest <= PI, "{period} {greatest}");
    // With constant torque the speed is constant.
    assert_eq!(repetition(&place, SHAFT, "T_1=0:0:1", "phi_dot").0, 1.0);
    let rack = SHAFT
        .replace("phi = { unit = \"rad\" }", "phi = { unit = \"m\" }")
        .replace("kg m^2", "kg")
        .replace("N m s", "N s/m")
        .replace("N m\"", "N\"");
    assert_eq!(repetition(&place, &rack, "c=0.5:0.6:2", "phi_dot").0, 1.0);
    assert_eq!(repetition(&place, &rack, "c=0.5:0.6:2", "phi").0, 1.0);
    // Two wheels in elastic contact turn together, so the equations repeat only for a common turn.
    let gear = SHAFT
        .replace("[coordinates]", "k = { value = 40, unit = \"N m\" }\n[coordinates]\npsi = { unit = \"rad\" }")
        .replace("[dissipation]", "w = \"1/2*J*dot(psi)^2\"\n[potential]\nk = \"1/2*k*(phi - 2*psi)^2\"\n[dissipation]\nd = \"1/2*c*dot(psi)^2\"");
    assert_eq!(repetition(&place, &gear, "c=0.5:0.6:2", "phi_dot").0, 1.0);
    assert_eq!(repetition(&place, &gear, "c=0.5:0.6:2", "psi").0, 1.0);
    // A constant torque rotates the pendulum, so its equations repeat every turn. The torque is modulated, and the
    // motion synchronises with the modulation.
    let pendulum = SHAFT
        .replace(
            "value = 0.5, unit = \"N m\" }",
            "value = 1.5, unit = \"N m\" }",
        )
        .replace(
            "[dissipation]",
            "[potential]\nw = \"-w*cos(phi)\"\n[dissipation]",
        )
        .replace(
            "[coordinates]",
            "w = { value = 0.8, unit = \"N m\" }\n[coordinates]",
        )
        .replace(
            "phi = { unit = \"rad\" }",
            "phi = { unit = \"rad\", initial_rate = \"omega\" }",
        )
        .replace(
            "value = 1, unit = \"N m\" }\nT_1",
            "value = 1.5, unit = \"N m\" }\nT_1",
        );
    let (period, greatest) = repetition(&place, &pendulum, "c=0.5:0.5:1", "phi");
    assert!(period == 1.0 && greatest <= PI, "{period} {greatest}");
}

#[test]
fn locked_shaft_has_period_one() {
    let place = SweepFolder::new();
    for quantity in ["phi", "phi_dot"] {
        for vary in ["d=4:6:2", "omega=6:6:1"] {
            let (period, _) = repetition(&place, LOCKED_SHAFT, vary, quantity);
            assert_eq!(period, 1.0, "{quantity}, {vary}");
        }
    }
    // The load pulsates at half the frequency of the field.
    let pulsating = LOCKED_SHAFT.replace("omega*t)\" }", "omega*t) + 0.1*k*sin(omega*t/2)\" }");
    assert_eq!(repetition(&place, &pulsating, "d=5:5:1", "phi_dot").0, 2.0);
}

/// Rotor in a periodic potential V that decelerates and accelerates it.
const ROTOR: &str = r#"
[model]
name = "rotor"
[parameters]
J = { value = 1, unit = "kg m^2" }
a = { value = 0.1, unit = "N m" }
[coordinates]
p = { unit = "rad", initial = 0.1, initial_rate = 6 }
[kinetic]
k = "1/2*J*dot(p)^2"
[potential]
v = "V"
"#;

/// Sweeps `a` with a section; returns a column of the measure at the first value of `a`.
fn sweep_with_section(
    place: &SweepFolder,
    text: &str,
    measure: &str,
    section: &str,
) -> impl Fn(&str) -> f64 + use<> {
    std::fs::write(place.path_to("model.toml"), text).expect("a specification");
    let _ = std::fs::remove_dir_all(place.path_to("out"));
    let (spec, out) = (place.path_to("model.toml"), place.path_to("out"));
    let (spec, out) = (spec.display().to_string(), out.display().to_string());
    let line = format!(
        "sweep|{spec}|--out|{out}|--vary|a=0.1:0.2:2|--measure|{measure}|--section|{section}|--until|60\
         |--transient|3|--periods|10"
    );
    accept(&line.split('|').map(str::to_owned).collect::<Vec<_>>());
    let found = table(&place.path_to("out"));
    let measure = measure.to_owned();
    move |part: &str| column(&found, &format!("{measure}_{part}"))[0]
}

#[test]
fn section_at_an_angle_is_crossed_once_per_turn() {
    let place = SweepFolder::new();
    let rotor = ROTOR.replace("\"V\"", "\"a*cos(p)\"");
    // The energy 18 + 0.1 cos(0.1) is conserved.
    let rate = |p: f64| (36.0 + 0.2 * (0.1f64.cos() - p.cos())).sqrt();
    for section in ["p=1", "p=1 + 4*pi", "p=-1:up"] {
        let one = sweep_with_section(&place, &rotor, "poincare:p_dot", section);
        let at = if section.starts_with("p=-") {
            -1.0
        } else {
            1.0
        };
        assert_eq!(one("period"), 1.0, "{section}");
        for point in 1..=10 {
            let found = one(&point.to_string());
            assert!((found - rate(at)).abs() < 1e-7, "{section}: {found}");
        }
        // The time for one turn is the integral of 1/rate over the angle.
        let parts = 0..1000;
        let turn: f64 = parts
            .map(|k| 1.0 / rate(std::f64::consts::TAU * f64::from(k) / 1000.0))
            .sum();
        let right = std::f64::consts::TAU * turn / 1000.0;
        assert!((one("time") - right).abs() < 1e-7, "{section}");
    }
    let angle = sweep_with_section(&place, &rotor, "poincare:p", "p=1");
    assert_eq!(angle("period"), 1.0);
    assert!((angle("min") - angle("max")).abs() < 1e-7);
    // The rotor turns backwards without a potential; one solver step covers many turns.
    let back = ROTOR
        .replace("\"V\"", "\"0*a\"")
        .replace("rate = 6", "rate = -6");
    let one = sweep_with_section(&place, &back, "poincare:p_dot", "p=1:down");
    assert_eq!(one("period"), 1.0);
    assert!((one("time") - std::f64::consts::TAU / 6.0).abs() < 1e-9);
}

#[test]
fn section_at_an_angle_with_spring_is_crossed_at_its_value_only() {
    let place = SweepFolder::new();
    // A spring makes the rotor oscillate with w = 2 rad/s and an amplitude of about 12 rad. The section is crossed once
    // in every period 2 pi/w.
    let spring = ROTOR
        .replace("\"V\"", "\"1/2*40*a*p^2\"")
        .replace("initial_rate = 6", "initial_rate = 24");
    let one = sweep_with_section(&place, &spring, "poincare:p_dot", "p=1");
    assert_eq!(one("period"), 1.0);
    let time = one("time");
    assert!((time - std::f64::consts::PI).abs() < 1e-6, "{time}");
}
