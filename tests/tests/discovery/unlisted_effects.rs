//! Tests of effects outside the default lists of effects and orders: hardening springs, springs with a stop, an
//! undeclared stiffness, a ripple of order seven. The records are simulated with the midpoint rule.

use eomgen_tests::logistic_noise::LogisticNoise;
use eomgen_tests::program::{self, Texts};
use serde_json::Value;

use super::specifications::OSCILLATOR;

/// Machine of one coordinate: specification, units of coordinate and input, and the acceleration as
/// a function of position, rate and input.
struct Machine<'m> {
    specification: &'m str,
    units: [&'m str; 2],
    noise: f64,
    gain: f64,
    uncertain: &'m str,
    /// Delay of the input, s.
    late: f64,
    /// True if the input of the machine is held between samples, false if it is smooth.
    is_held: bool,
    input: fn(f64, f64) -> f64,
    acceleration: &'m dyn Fn(f64, f64, f64) -> f64,
}

const ROTOR: &str = r#"
[model]
name = "rotor"

[parameters]
J = { value = 0.02, unit = "kg m^2", min = 0 }
c = { value = 0.02, unit = "N m s", min = 0 }

[coordinates]
x = { unit = "rad" }

[inputs]
u = { unit = "N m" }

[kinetic]
rotor = "1/2*J*dot(x)^2"

[dissipation]
bearing = "1/2*c*dot(x)^2"

[forces]
motor = { on = "x", value = "u" }
"#;

/// Time between samples, in s.
const SAMPLE: f64 = 0.005;
const SAMPLES: usize = 400;

impl Machine<'_> {
    /// Returns a record of t, u, x; `turn` changes the input.
    fn record(&self, turn: f64) -> String {
        let parts = 100;
        let h = SAMPLE / f64::from(parts);
        let (mut x, mut v) = (0.0_f64, 0.0_f64);
        let mut noise = LogisticNoise::new(self.noise, 0.4);
        let mut text = "t,u,x\n".to_owned();
        for sample in 0..SAMPLES {
            let t = SAMPLE * sample as f64;
            let u = (self.input)(t, turn);
            let seen = self.gain * x + noise.draw();
            text += &format!("{t:.4},{u:.12},{seen:.12}\n");
            for part in 0..parts {
                let acts = t + h * (f64::from(part) + 0.5) - self.late;
                let acts = match self.is_held {
                    true => SAMPLE * (acts / SAMPLE).floor(),
                    false => acts,
                };
                let u = (self.input)(acts, turn);
                let middle = (x + 0.5 * h * v, v + 0.5 * h * (self.acceleration)(x, v, u));
                x += h * middle.1;
                v += h * (self.acceleration)(middle.0, middle.1, u);
            }
        }
        text
    }

    fn answer(&self) -> Value {
        let [unit, input] = self.units;
        let dataset = format!(
            "[records]\ntrain = [\"train.csv\"]\ntest = [\"test.csv\"]\n\n[time]\ncolumn = \"t\"\nunit = \"s\"\n\n\
             [inputs.u]\ncolumn = \"u\"\nunit = \"{input}\"\nhold = \"zero-order\"\n\n\
             [channels.x]\ncolumn = \"x\"\nunit = \"{unit}\"\nnoise = {:e}\n\n[initial]\nstate = \"rest\"\n\n\
             [uncertain]\n{}\n\n[windows]\nlength = 0.5\n",
            self.noise, self.uncertain
        );
        let texts = Texts {
            specification: self.specification,
            dataset: &dataset,
            train: &self.record(0.0),
            test: &self.record(1.0),
        };
        program::run_on_texts("discover", texts)
    }

    /// Asserts that only this effect is found at this site; returns it.
    fn only_effect(&self, effect: &str, on: &str) -> Value {
        let found = self.answer();
        let effects = found["effects"].as_array().expect("a list");
        assert_eq!(effects.len(), 1, "{effects:#?}");
        assert_eq!(effects[0]["effect"], effect, "{effects:#?}");
        assert_eq!(effects[0]["on"], on, "{effects:#?}");
        let closure = found["closure"]["test"].as_f64();
        assert!(closure.is_some_and(|part| part > 0.95), "{closure:?}");
        let believed = |entry: &Value| entry["effect"] == effect && entry["on"] == on;
        let rejected = found["rejected"].as_array().expect("a list");
        assert!(!rejected.iter().any(believed), "{rejected:#?}");
        effects[0].clone()
    }
}

fn oscillator<'m>(acceleration: &'m dyn Fn(f64, f64, f64) -> f64) -> Machine<'m> {
    Machine {
        specification: OSCILLATOR,
        units: ["m", "N"],
        noise: 1e-5,
        gain: 1.0,
        uncertain: "m = { relative = 0.01 }",
        late: 0.0,
        is_held: true,
        input: |t, turn| {
            18.0 * (11.0 * t + turn).cos() - 9.0 * (23.0 * t * (1.0 + 0.2 * turn)).sin()
        },
        acceleration,
    }
}

/// Asserts that a parameter of the effect is within the fraction `part` of the hidden value.
fn assert_near(effect: &Value, name: &str, hidden: f64, part: f64) {
    let value = effect["parameters"][name]["value"].as_f64();
    let value = value.unwrap_or_else(|| panic!("no {name}: {effect:#}"));
    assert!(
        (value - hidden).abs() <= part * hidden.abs(),
        "{value}, expected {hidden}"
    );
}

fn estimate(of: &Value) -> (f64, f64) {
    let number = |key: &str| {
        of[key]
            .as_f64()
            .unwrap_or_else(|| panic!("no {key}: {of:#}"))
    };
    (number("value"), number("sd"))
}

#[test]
fn hardening_spring_is_found() {
    let effect = oscillator(&|x, v, u| u - 400.0 * x - 6e4 * x.powi(3) - 4.0 * v)
        .only_effect("stiffness_nonlinearity", "spring");
    assert_near(&effect, "k_3", 6e4, 0.02);
    assert_eq!(effect["status"], "named", "{effect:#}");
}

#[test]
fn parameters_confounded_with_gain_are_as_uncertain_as_the_gain() {
    // A sensor gain is equivalent to a scaling of inertia and stiffness. Therefore the gain is as uncertain as its
    // prior, and the cubic stiffness is three times as uncertain.
    let spring = |x: f64, v: f64, u: f64| u - 400.0 * x - 6e4 * x.powi(3) - 4.0 * v;
    let machine = Machine {
        gain: 1.01,
        noise: 1e-4,
        uncertain: "m = { relative = 0.3 }\nk = { relative = 0.3 }\nc = { relative = 0.3 }",
        ..oscillator(&spring)
    };
    let found = machine.answer();
    let gain = found["sensors"]["x"]["gain"].as_f64().expect("a gain");
    assert!((gain - 1.0).abs() < 1e-3, "{gain}");
    let effect = &found["effects"][0];
    assert_eq!(effect["effect"], "stiffness_nonlinearity", "{effect:#}");
    let (value, sd) = estimate(&effect["parameters"]["k_3"]);
    assert!((value - 6e4).abs() < 1.645 * sd, "{value} +- {sd}");
    assert!((0.03..0.08).contains(&(sd / value)), "{value} +- {sd}");
}

/// A model without linear parts is integrated with a constant step size.
#[test]
fn declared_cubic_spring_is_refitted() {
    let specification = OSCILLATOR
        .replace(
            "[coordinates]",
            "k_3 = { value = 4e4, unit = \"N/m^3\" }\n\n[coordinates]",
        )
        .replace("1/2*k*x^2", "1/2*k*x^2 + 1/4*k_3*x^4");
    assert_eq!(specification.matches("k_3").count(), 2);
    let spring = |x: f64, v: f64, u: f64| u - 400.0 * x - 6e4 * x.powi(3) - 4.0 * v;
    let machine = Machine {
        specification: &specification,
        uncertain: "k_3 = { relative = 1 }",
        ..oscillator(&spring)
    };
    let found = machine.answer();
    assert_eq!(found["verdict"], "no_significant_gap", "{found:#}");
    let (value, sd) = estimate(&found["refitted"]["k_3"]);
    assert!((value - 6e4).abs() < 3.0 * sd, "{value} +- {sd}");
    assert!(sd < 0.02 * value, "{value} +- {sd}");
}

#[test]
fn one_sided_stop_is_found_as_stop() {
    let effect = oscillator(&|x, v, u| u - 400.0 * x - 900.0 * (x - 0.03).max(0.0) - 4.0 * v)
        .only_effect("end_stop", "spring");
    assert_near(&effect, "k_s", 900.0, 0.05);
    assert_near(&effect, "p_s", 0.03, 0.05);
}

#[test]
fn soft_two_sided_stop_is_not_reported_as_hardening_spring() {
    // The stiffness of the stop increases over a few millimetres. A cubic spring fits approximately but needs a second
    // effect.
    let beyond = |x: f64| {
        let past = x.abs() - 0.024;
        0.5 * (past.hypot(2e-3) + past) * x.signum()
    };
    let effect = oscillator(&|x, v, u| u - 400.0 * x - 2.0 * beyond(x) - 4.0 * v)
        .only_effect("end_stop", "spring");
    assert_near(&effect, "k_s", 2.0, 0.2);
    assert_near(&effect, "p_s", 0.024, 0.1);
}

#[test]
fn play_in_a_coupling_is_found_as_backlash() {
    let play = |x: f64| x - x.clamp(-3e-3, 3e-3);
    let effect =
        oscillator(&|x, v, u| u - 400.0 * play(x) - 4.0 * v).only_effect("backlash", "spring");
    assert_near(&effect, "b_0", 3e-3, 0.05);
}

#[test]
fn undeclared_stiffness_is_named_before_pairs_of_effects() {
    let effect =
        oscillator(&|x, v, u| u - 0.82 * 400.0 * x - 4.0 * v).only_effect("parameter_shift", "k");
    assert_near(&effect, "k", 0.82 * 400.0, 0.01);
}

#[test]
fn unlisted_order_is_found_in_residual_force() {
    let rotor = Machine {
        specification: ROTOR,
        units: ["rad", "N m"],
        noise: 1e-4,
        gain: 1.0,
        uncertain: "J = { relative = 0.01 }",
        late: 0.0,
        is_held: true,
        input: |t, turn| 0.5 * (2.1 * t + 0.7 * turn).cos() - 0.25 * (7.0 * t).sin(),
        acceleration: &|x, v, u| (u - 0.02 * v + 0.05 * (7.0 * x + 0.4).cos()) / 0.02,
    };
    let effect = rotor.only_effect("torque_ripple", "x");
    assert_eq!(effect["order"]["order"], 7, "{effect:#}");
}

/// Over several revolutions, an unbalanced weight and a torque ripple of order one have the same form.
#[test]
fn weight_on_rotating_shaft_is_equivalent_to_ripple_of_order_one() {
    let rotor = Machine {
        specification: ROTOR,
        units: ["rad", "N m"],
        noise: 1e-4,
        gain: 1.0,
        uncertain: "J = { relative = 0.01 }",
        late: 0.0,
        is_held: true,
        input: |t, turn| 1.2 * (2.1 * t + 0.7 * turn).cos() - 0.25 * (7.0 * t).sin(),
        acceleration: &|x, v, u| (u - 0.02 * v + 0.05 * (x + 0.4).cos()) / 0.02,
    };
    let effect = rotor.only_effect("gravity", "x");
    assert_eq!(effect["status"], "class", "{effect:#}");
    let other = &effect["equivalent"][0];
    assert_eq!(other["effect"], "torque_ripple", "{effect:#}");
    assert_eq!(other["on"], "x", "{effect:#}");
}

/// A delayed drive appears as a delay of all sensors. If the delay exceeds the sensors' priors, it is reported as a
/// delayed input.
#[test]
fn common_sensor_delay_is_noted_as_delayed_input() {
    let acceleration = |x: f64, v: f64, u: f64| u - 400.0 * x - 4.0 * v;
    let late = Machine {
        late: 0.01,
        ..oscillator(&acceleration)
    };
    let found = late.answer();
    let notes = found["notes"].to_string();
    assert!(notes.contains("a delayed input"), "{notes}");
    assert!(notes.contains("[inputs.u]"), "{notes}");
}

/// If samples of a smooth input are held, they are late by half an interval on average.
#[test]
fn lead_by_half_an_interval_is_noted_as_held_input() {
    let acceleration = |x: f64, v: f64, u: f64| u - 400.0 * x - 4.0 * v;
    let notes = |is_held: bool| {
        let machine = Machine {
            is_held,
            ..oscillator(&acceleration)
        };
        machine.answer()["notes"].to_string()
    };
    let smooth = notes(false);
    assert!(smooth.contains("half the interval of 5.00 ms"), "{smooth}");
    let held = notes(true);
    assert!(!held.contains("half the interval"), "{held}");
}

/// The true force is held between samples, as the dataset declares. The fitted lead is smaller than its uncertainty.
#[test]
fn insignificant_lead_is_not_noted_as_held_input() {
    let measured = eomgen_tests::models::project().join("examples/measured");
    let [stage, dataset] =
        ["stage.toml", "dataset.toml"].map(|name| measured.join(name).display().to_string());
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("compared").display().to_string();
    program::run_accepted(&["compare", &stage, &dataset, "--out", &out]);
    let document = std::fs::read_to_string(folder.path().join("compared/comparison.json"));
    let document = document.expect("a document");
    assert!(!document.contains("half the interval"), "{document}");
}

/// The motion reaches the stop only in the held-out records.
#[test]
fn effect_visible_only_in_held_out_records_is_noted() {
    let stop = |x: f64| 900.0 * (x - 0.08).max(0.0);
    let acceleration = |x: f64, v: f64, u: f64| u - 400.0 * x - stop(x) - 4.0 * v;
    let machine = Machine {
        input: |t, turn| (4.0 + 26.0 * turn) * ((11.0 * t + turn).cos() - (23.0 * t).sin()),
        ..oscillator(&acceleration)
    };
    let found = machine.answer();
    assert_eq!(found["verdict"], "unexplained", "{found:#}");
    let notes = found["notes"].to_string();
    assert!(
        notes.contains("hardly acts in the training records"),
        "{notes}"
    );
}
