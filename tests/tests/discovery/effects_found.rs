//! Each effect of the catalogue is hidden in records of a suitable small machine and must be found with name, site,
//! sign and value. The records are simulated without noise. The blind suite measures discovery with equations from
//! other sources.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Duration;

use eomgen_discover::catalogue::candidate::{Candidate, list_candidates};
use eomgen_discover::catalogue::load_effects;
use eomgen_discover::catalogue::sites::find_sites;
use eomgen_discover::catalogue::usual_motion::UsualMotion;
use eomgen_model_spec::edit::{self, Edit, SetParameter};
use eomgen_model_spec::source::Source;
use eomgen_tests::program;
use serde_json::Value;

const LIMIT: Duration = Duration::from_secs(280);

struct Machine {
    name: &'static str,
    specification: &'static str,
    channels: &'static [(&'static str, &'static str, f64)],
    uncertain: &'static str,
    /// Unit of the input `u`.
    unit: &'static str,
    input: fn(f64, bool) -> f64,
    /// Time between samples, in s.
    sample: f64,
    window: f64,
    samples: usize,
}

struct Hidden {
    effect: &'static str,
    on: &'static str,
    by: Change,
}

enum Change {
    /// Effect of the catalogue: index among entries of the same name, order and parameter values.
    Entry(usize, Option<u32>, &'static [f64]),
    /// Parameter whose true value differs from the specification.
    Shift(f64),
    /// Sensor fault: name and value of the parameter to find, and a function that computes the faulty reading from the
    /// latest readings.
    Sensor(&'static str, f64, fn(&[f64]) -> f64),
}

const fn hidden(effect: &'static str, on: &'static str, values: &'static [f64]) -> Hidden {
    let by = Change::Entry(0, None, values);
    Hidden { effect, on, by }
}

const CARRIAGE: Machine = Machine {
    name: "carriage",
    specification: r#"
[model]
name = "carriage"

[parameters]
m = { value = 10, unit = "kg", min = 0 }
c = { value = 20, unit = "N s/m", min = 0 }

[coordinates]
x = { unit = "m" }

[inputs]
u = { unit = "N" }

[kinetic]
carriage = "1/2*m*dot(x)^2"

[dissipation]
guide = "1/2*c*dot(x)^2"

[forces]
motor = { on = "x", value = "u" }
"#,
    channels: &[("x", "m", 1e-6)],
    uncertain: "m = { relative = 0.02 }",
    unit: "N",
    input: |t, again| {
        let turn = if again { 1.0 } else { 0.0 };
        40.0 * (5.0 * t + turn).cos() - 20.0 * (13.0 * t * (1.0 + 0.3 * turn)).sin()
    },
    sample: 0.005,
    window: 0.25,
    samples: 400,
};

const ROTOR: Machine = Machine {
    name: "rotor",
    specification: r#"
[model]
name = "rotor"

[parameters]
J = { value = 0.02, unit = "kg m^2", min = 0 }
c = { value = 0.02, unit = "N m s", min = 0 }

[coordinates]
theta = { unit = "rad" }

[inputs]
u = { unit = "N m" }

[kinetic]
rotor = "1/2*J*dot(theta)^2"

[dissipation]
bearing = "1/2*c*dot(theta)^2"

[forces]
motor = { on = "theta", value = "u" }
"#,
    channels: &[("theta", "rad", 1e-5)],
    uncertain: "J = { relative = 0.02 }",
    unit: "N m",
    input: |t, again| {
        let turn = if again { 0.7 } else { 0.0 };
        0.5 * (2.1 * t + turn).cos() - 0.25 * (7.0 * t * (1.0 + 0.3 * turn)).sin()
    },
    sample: 0.005,
    window: 0.5,
    samples: 600,
};

const BEAM: Machine = Machine {
    name: "beam",
    specification: r#"
[model]
name = "beam"

[parameters]
J_h = { value = 0.05, unit = "kg m^2", min = 0 }
rho_A = { value = 0.3, unit = "kg/m", min = 0 }
l = { value = 1, unit = "m", min = 0 }
EI = { value = 5, unit = "N m^2", min = 0 }
c = { value = 0.05, unit = "N m s", min = 0 }

[coordinates]
theta = { unit = "rad" }

[inputs]
u = { unit = "N m" }

[fields.w]
along = "x"
from = 0
to = "l"
basis = "clamped_free"
coordinates = "q"
order = 1
unit = "m"

[kinetic]
hub = "1/2*J_h*dot(theta)^2"
beam = "1/2*integral(rho_A*(x*dot(theta) + dot(w))^2, w)"

[potential]
bending = "1/2*integral(EI*diff(w, x, 2)^2, w)"

[dissipation]
bearing = "1/2*c*dot(theta)^2"

[forces]
motor = { on = "theta", value = "u" }

[observables]
tip = { value = "at(w, l)", unit = "m" }
"#,
    channels: &[("theta", "rad", 1e-5), ("tip", "m", 1e-5)],
    uncertain: "J_h = { relative = 0.02 }",
    unit: "N m",
    input: |t, again| {
        let turn = if again { 0.7 } else { 0.0 };
        0.8 * (4.0 * t + turn).cos() - 0.6 * (19.0 * t * (1.0 + 0.2 * turn)).sin()
    },
    sample: 0.005,
    window: 0.25,
    samples: 400,
};

/// Beam with longer windows. A compliant joint has a separate coordinate. In short windows, its fitted initial state
/// would explain the records.
const BEAM_FOR_LONG: Machine = Machine {
    window: 1.0,
    ..BEAM
};

/// Beam with a payload; a part of its weight can be missing in the specification.
const LOADED_BEAM: Machine = Machine {
    name: "loaded_beam",
    specification: r#"
[model]
name = "loaded_beam"

[parameters]
J_h = { value = 0.05, unit = "kg m^2", min = 0 }
rho_A = { value = 0.5, unit = "kg/m", min = 0 }
l = { value = 0.8, unit = "m", min = 0 }
EI = { value = 8, unit = "N m^2", min = 0 }
m_p = { value = 0.25, unit = "kg", min = 0 }
eta = { value = 1e-3, unit = "s", min = 0 }
c = { value = 0.05, unit = "N m s", min = 0 }

[coordinates]
theta = { unit = "rad" }

[inputs]
u = { unit = "N m" }

[fields.w]
along = "x"
from = 0
to = "l"
basis = "clamped_free"
coordinates = "q"
order = 2
unit = "m"

[kinetic]
hub = "1/2*J_h*dot(theta)^2"
beam = "1/2*integral(rho_A*(x*dot(theta) + dot(w))^2, w)"
payload = "1/2*m_p*(l*dot(theta) + at(dot(w), l))^2"

[potential]
bending = "1/2*integral(EI*diff(w, x, 2)^2, w)"

[dissipation]
bearing = "1/2*c*dot(theta)^2"
bending = "1/2*integral(eta*EI*diff(dot(w), x, 2)^2, w)"

[forces]
motor = { on = "theta", value = "u" }

[observables]
tip = { value = "at(w, l)", unit = "m" }
"#,
    input: |t, again| {
        let turn = if again { 0.7 } else { 0.0 };
        3.0 * (2.0 * t + turn).cos() - 2.0 * (9.0 * t * (1.0 + 0.2 * turn)).sin()
    },
    ..BEAM
};

/// Two bodies on springs in space; gravity can act in one or two directions.
const BODIES: Machine = Machine {
    name: "bodies",
    specification: r#"
[model]
name = "bodies"

[parameters]
m_1 = { value = 2, unit = "kg", min = 0 }
m_2 = { value = 1, unit = "kg", min = 0 }
k = { value = 400, unit = "N/m", min = 0 }
c = { value = 3, unit = "N s/m", min = 0 }

[coordinates]
x_1 = { unit = "m" }
y_1 = { unit = "m" }
z_1 = { unit = "m" }
x_2 = { unit = "m" }
y_2 = { unit = "m" }
z_2 = { unit = "m" }

[inputs]
u = { unit = "N" }

[kinetic]
first = "1/2*m_1*(dot(x_1)^2 + dot(y_1)^2 + dot(z_1)^2)"
second = "1/2*m_2*(dot(x_2)^2 + dot(y_2)^2 + dot(z_2)^2)"

[potential]
ground = "1/2*k*(x_1^2 + y_1^2 + z_1^2)"
between = "1/2*k*((x_2 - x_1)^2 + (y_2 - y_1)^2 + (z_2 - z_1)^2)"

[dissipation]
ground = "1/2*c*(dot(x_1)^2 + dot(y_1)^2 + dot(z_1)^2)"
between = "1/2*c*((dot(x_2) - dot(x_1))^2 + (dot(y_2) - dot(y_1))^2 + (dot(z_2) - dot(z_1))^2)"

[forces]
x = { on = "x_1", value = "u" }
y = { on = "y_1", value = "2*u" }
z = { on = "z_2", value = "u" }
"#,
    channels: &[
        ("x_1", "m", 1e-5),
        ("y_1", "m", 1e-5),
        ("z_1", "m", 1e-5),
        ("x_2", "m", 1e-5),
        ("y_2", "m", 1e-5),
        ("z_2", "m", 1e-5),
    ],
    uncertain: "m_1 = { relative = 0.02 }",
    ..OSCILLATOR
};

/// Two shafts connected by a gear mesh with the deflection `x`. The backlash is small. With a large backlash the teeth
/// would rattle, and the impacts would hide a varying stiffness. The transmission ratio is not a simple fraction, so
/// that the orders of the two shafts differ.
const GEAR: Machine = Machine {
    name: "gear",
    specification: r#"
[model]
name = "gear"

[parameters]
J_1 = { value = 2e-3, unit = "kg m^2", min = 0 }
J_2 = { value = 2e-2, unit = "kg m^2", min = 0 }
r_1 = { value = 0.05, unit = "m", min = 0 }
r_2 = { value = 0.13, unit = "m", min = 0 }
k = { value = 2e4, unit = "N/m", min = 0 }
c = { value = 40, unit = "N s/m", min = 0 }
b = { value = 3e-4, unit = "m", min = 0 }
c_1 = { value = 0.01, unit = "N m s", min = 0 }
c_2 = { value = 0.05, unit = "N m s", min = 0 }

[coordinates]
theta_1 = { unit = "rad" }
x = { unit = "m" }

[inputs]
u = { unit = "N m" }

[definitions]
theta_2 = "(r_1*theta_1 - x)/r_2"

[kinetic]
pinion = "1/2*J_1*dot(theta_1)^2"
wheel = "1/2*J_2*dot(theta_2)^2"

[potential]
teeth = "1/2*k*deadzone(x, b)^2"

[dissipation]
teeth = "1/2*c*contact(x, b)*dot(x)^2"
bearings = "1/2*c_1*dot(theta_1)^2 + 1/2*c_2*dot(theta_2)^2"

[forces]
motor = { on = "theta_1", value = "u" }

[observables]
theta_2 = { value = "theta_2", unit = "rad" }
"#,
    channels: &[("theta_1", "rad", 1e-5), ("theta_2", "rad", 1e-5)],
    uncertain: "J_2 = { relative = 0.02 }",
    unit: "N m",
    input: |t, again| {
        let turn = if again { 0.7 } else { 0.0 };
        1.5 * (3.0 * t + turn).cos() - 0.5 * (9.0 * t * (1.0 + 0.2 * turn)).sin()
    },
    sample: 0.002,
    window: 0.1,
    samples: 700,
};

const OSCILLATOR: Machine = Machine {
    name: "oscillator",
    specification: super::specifications::OSCILLATOR,
    channels: &[("x", "m", 1e-5)],
    uncertain: "m = { relative = 0.02 }",
    unit: "N",
    input: |t, again| {
        let turn = if again { 1.0 } else { 0.0 };
        18.0 * (11.0 * t + turn).cos() - 9.0 * (23.0 * t * (1.0 + 0.2 * turn)).sin()
    },
    sample: 0.005,
    window: 0.5,
    samples: 400,
};

impl Machine {
    fn description(&self) -> String {
        let mut text = format!(
            "[records]\ntrain = [\"train.csv\"]\ntest = [\"test.csv\"]\n\n[time]\ncolumn = \"t\"\nunit = \"s\"\n\n\
             [inputs.u]\ncolumn = \"u\"\nunit = \"{}\"\n\n[initial]\nstate = \"rest\"\n\n[uncertain]\n{}\n\n\
             [windows]\nlength = {}\n",
            self.unit, self.uncertain, self.window
        );
        for (name, unit, noise) in self.channels {
            text += &format!(
                "\n[channels.{name}]\ncolumn = \"{name}\"\nunit = \"{unit}\"\nnoise = {noise:e}\n"
            );
        }
        text
    }

    /// Simulates the machine with `hidden` and writes one of the two records.
    fn record(&self, folder: &Path, hidden: &Hidden, again: bool) {
        let (file, record) = match again {
            false => ("train.csv", "train[0]"),
            true => ("test.csv", "test[0]"),
        };
        let inputs: Vec<(String, String)> = (0..self.samples)
            .map(|sample| {
                let t = sample as f64 * self.sample;
                (
                    format!("{t:.6}"),
                    format!("{:.12e}", (self.input)(t, again)),
                )
            })
            .collect();
        let lines: String = inputs.iter().map(|(t, u)| format!("{t},{u}\n")).collect();
        std::fs::write(folder.join(file), format!("t,u\n{lines}")).expect("a file");
        let place = |name: &str| folder.join(name).display().to_string();
        program::run_accepted(&[
            "simulate",
            &place("truth.toml"),
            "--record",
            &place("dataset.toml"),
            "--record-name",
            record,
            "--out",
            &place("motion.csv"),
        ]);
        let motion = std::fs::read_to_string(folder.join("motion.csv")).expect("a motion");
        let mut rows = motion
            .lines()
            .map(|line| line.split(',').collect::<Vec<&str>>());
        let names = rows.next().expect("names");
        let columns: Vec<usize> = (self.channels.iter())
            .map(|(name, ..)| names.iter().position(|n| n == name).expect("a column"))
            .collect();
        let mut seen = vec![Vec::with_capacity(self.samples); columns.len()];
        for row in rows {
            for (seen, column) in seen.iter_mut().zip(&columns) {
                seen.push(row[*column].parse::<f64>().expect("a number"));
            }
        }
        let heading: String = self
            .channels
            .iter()
            .map(|(name, ..)| format!(",{name}"))
            .collect();
        let mut text = format!("t,u{heading}\n");
        for (sample, (t, u)) in inputs.iter().enumerate() {
            text += &format!("{t},{u}");
            for ((name, ..), column) in self.channels.iter().zip(&seen) {
                let value = match hidden.by {
                    Change::Sensor(_, _, reading) if *name == hidden.on => {
                        reading(&column[..=sample])
                    }
                    _ => column[sample],
                };
                text += &format!(",{value:.15e}");
            }
            text.push('\n');
        }
        std::fs::write(folder.join(file), text).expect("a file");
    }

    fn candidate(&self, hidden: &Hidden, entry: usize, order: Option<u32>) -> Candidate {
        let checked = eomgen_model_spec::check(Source::new(self.name, self.specification));
        let model = checked.unwrap_or_else(|found| panic!("{found}")).model;
        let catalogue = load_effects(None).expect("the catalogue");
        let mut named = catalogue
            .iter()
            .filter(|effect| effect.name == hidden.effect);
        let effect = named.nth(entry).expect("an effect");
        let one = std::slice::from_ref(effect);
        let mut found =
            list_candidates(&model, one, &find_sites(&model), &UsualMotion::default()).into_iter();
        let is = |c: &Candidate| {
            c.site == hidden.on && c.angle_order.as_ref().map(|(_, order)| *order) == order
        };
        found.find(is).expect("the effect has a place")
    }

    /// Returns the specification that generates the records, and the true parameter values by name.
    fn truth(&self, hidden: &Hidden) -> (String, Vec<(String, f64)>) {
        match hidden.by {
            Change::Entry(entry, order, values) => {
                let candidate = self.candidate(hidden, entry, order);
                let written =
                    candidate.write_effect(self.specification, self.name, values, "hidden");
                // Records determine shape parameters less accurately than the size, so shape parameters are not
                // compared.
                let sizes = candidate.parameters.iter().zip(values);
                let sizes = sizes.filter(|(parameter, _)| parameter.shape_size.is_none());
                let sizes = sizes.map(|(parameter, value)| (parameter.name.clone(), *value));
                (written.expect("a specification"), sizes.collect())
            }
            Change::Shift(value) => {
                let set = Edit::SetParameter(SetParameter {
                    name: hidden.on.to_owned(),
                    value,
                    source: "hidden".to_owned(),
                });
                let written = edit::apply(&Source::new(self.name, self.specification), &[set]);
                let size = (hidden.on.to_owned(), value);
                (written.expect("a specification"), vec![size])
            }
            Change::Sensor(name, value, _) => (
                self.specification.to_owned(),
                vec![(name.to_owned(), value)],
            ),
        }
    }

    fn answer(&self, hidden: &Hidden, truth: &str) -> Value {
        let folder = tempfile::tempdir().expect("a folder");
        let place = |name: &str| folder.path().join(name);
        std::fs::write(place("truth.toml"), truth).expect("a file");
        std::fs::write(place("spec.toml"), self.specification).expect("a file");
        std::fs::write(place("dataset.toml"), self.description()).expect("a file");
        for again in [false, true] {
            self.record(folder.path(), hidden, again);
        }
        let mut command = program::eomgen();
        command.timeout(LIMIT).arg("discover");
        let output = (command.args([place("spec.toml"), place("dataset.toml")]))
            .arg("--out")
            .arg(place("found"))
            .output()
            .expect("the program can be run");
        let message = program::text(&output.stderr);
        assert_eq!(
            output.status.code(),
            Some(0),
            "{}: {message}",
            hidden.effect
        );
        let text = std::fs::read_to_string(place("found/discovery.json")).expect("a document");
        serde_json::from_str(&text).expect("JSON")
    }

    /// Asserts that the hidden effect is named first with site, sign and value, and that it closes the gap.
    fn assert_found(&self, hidden: &Hidden) {
        let (truth, sizes) = self.truth(hidden);
        let found = self.answer(hidden, &truth);
        let shown = format!("{} on {}: {:#}", hidden.effect, hidden.on, found["effects"]);
        println!("{shown}\n{}", found["closure"]);
        assert_eq!(found["verdict"], "effects_found", "{shown}");
        let first = &found["effects"][0];
        assert_eq!(first["effect"], hidden.effect, "{shown}");
        assert_eq!(first["on"], hidden.on, "{shown}");
        if let Change::Entry(_, Some(order), _) = hidden.by {
            assert_eq!(first["order"]["order"], order, "{shown}");
        }
        let closure = found["closure"]["test"].as_f64();
        assert!(
            closure.is_some_and(|closure| closure >= 0.8),
            "{closure:?}, {shown}"
        );
        for (name, value) in sizes {
            let found = first["parameters"][&name]["value"].as_f64();
            let found = found.unwrap_or_else(|| panic!("no {name}: {shown}"));
            assert!(
                (found - value).abs() <= 0.2 * value.abs(),
                "{name} = {found}, expected {value}: {shown}"
            );
        }
    }
}

#[test]
fn effects_on_a_carriage_are_found() {
    for hidden in [
        hidden("coulomb_friction", "x", &[3.0]),
        hidden("viscous_friction", "x", &[6.0]),
        hidden("stribeck_friction", "x", &[4.0, 0.05]),
        hidden("asymmetric_friction", "x", &[-4.0]),
        hidden("quadratic_drag", "x", &[15.0]),
        hidden("force_offset", "x", &[-2.0]),
        hidden("elastic_restraint", "x", &[30.0]),
        hidden("input_lag", "u", &[60.0]),
        hidden("input_dead_zone", "u", &[5.0]),
        hidden("bristle_friction", "x", &[3.0, 1e-4]),
    ] {
        CARRIAGE.assert_found(&hidden);
    }
}

#[test]
fn effects_periodic_in_an_angle_are_found_on_a_rotor() {
    ROTOR.assert_found(&hidden("gravity", "theta", &[0.04, -0.06]));
    ROTOR.assert_found(&Hidden {
        by: Change::Entry(0, Some(3), &[0.03, 0.05]),
        ..hidden("torque_ripple", "theta", &[])
    });
}

#[test]
fn effects_of_a_flexible_body_are_found() {
    for hidden in [
        hidden("structural_damping", "beam", &[2e-3]),
        hidden("tip_mass", "beam", &[0.02]),
        hidden("stiffness_nonlinearity", "beam", &[2e4]),
    ] {
        BEAM.assert_found(&hidden);
    }
    BEAM_FOR_LONG.assert_found(&hidden("joint_compliance", "beam", &[60.0]));
    BEAM_FOR_LONG.assert_found(&Hidden {
        by: Change::Entry(1, None, &[60.0]),
        ..hidden("joint_compliance", "beam", &[])
    });
}

#[test]
fn effects_of_a_gear_mesh_are_found() {
    GEAR.assert_found(&hidden("asymmetric_backlash", "x", &[1e-4]));
    GEAR.assert_found(&Hidden {
        by: Change::Entry(0, Some(2), &[2e-4, -1e-4]),
        ..hidden("transmission_error", "x", &[])
    });
    GEAR.assert_found(&Hidden {
        by: Change::Entry(0, Some(2), &[0.2, -0.15]),
        ..hidden("stiffness_variation", "x", &[])
    });
}

#[test]
fn effects_of_a_spring_are_found() {
    for (entry, hidden) in [
        (1, hidden("stiffness_nonlinearity", "spring", &[])),
        (0, hidden("backlash", "spring", &[])),
        (1, hidden("backlash", "spring", &[])),
        (2, hidden("end_stop", "spring", &[])),
        (0, hidden("spring_saturation", "spring", &[])),
    ] {
        let by = match hidden.effect {
            "stiffness_nonlinearity" => Change::Entry(entry, None, &[6e4]),
            "backlash" if entry == 0 => Change::Entry(0, None, &[3e-3]),
            "backlash" => Change::Entry(1, None, &[3e-3]),
            "end_stop" => Change::Entry(2, None, &[900.0, 0.03]),
            _ => Change::Entry(entry, None, &[250.0, 0.03]),
        };
        OSCILLATOR.assert_found(&Hidden { by, ..hidden });
    }
    OSCILLATOR.assert_found(&hidden("load_dependent_friction", "x", &[0.1]));
}

#[test]
fn weights_of_a_machine_and_of_its_load_are_found() {
    LOADED_BEAM.assert_found(&hidden("tip_weight", "beam", &[1.0, 2.2]));
    for (machine, by) in [
        (&BODIES, Change::Entry(2, None, &[2.0])),
        (&LOADED_BEAM, Change::Entry(3, None, &[9.81])),
        (&BODIES, Change::Entry(4, None, &[-9.81])),
        (&LOADED_BEAM, Change::Entry(5, None, &[3.0, 9.0])),
    ] {
        machine.assert_found(&Hidden {
            by,
            ..hidden("gravity", "machine", &[])
        });
    }
}

/// In these records a hardening spring is inseparable from stops on both sides, and it closes only a part of the gap.
#[test]
fn inseparable_effect_that_closes_part_of_the_gap_is_reported() {
    let stops = Hidden {
        by: Change::Entry(0, None, &[900.0, 0.03]),
        ..hidden("end_stop", "spring", &[])
    };
    let (truth, _) = OSCILLATOR.truth(&stops);
    let found = OSCILLATOR.answer(&stops, &truth);
    let effects = found["effects"].as_array().expect("effects");
    let is_right = effects.iter().all(|effect| effect["effect"] == "end_stop");
    let is_said = effects
        .iter()
        .all(|effect| effect["status"] == "provisional");
    assert!(!effects.is_empty() && (is_right || is_said), "{effects:#?}");
    let summary = found["summary"].as_str().unwrap_or_default();
    assert!(is_right || summary.contains("floors"), "{summary}");
}

#[test]
fn sensor_faults_and_parameter_shifts_are_found() {
    let late = |column: &[f64]| column[column.len().saturating_sub(5)];
    for (effect, by) in [
        (
            "sensor_delay",
            Change::Sensor("delay", 4.0 * BEAM.sample, late),
        ),
        (
            "sensor_gain",
            Change::Sensor("gain", 1.1, |column| 1.1 * column[column.len() - 1]),
        ),
        (
            "sensor_bias",
            Change::Sensor("bias", 2e-3, |column| column[column.len() - 1] + 2e-3),
        ),
    ] {
        BEAM.assert_found(&Hidden {
            effect,
            on: "tip",
            by,
        });
    }
    CARRIAGE.assert_found(&Hidden {
        effect: "parameter_shift",
        on: "m",
        by: Change::Shift(12.0),
    });
}

#[test]
fn all_catalogue_entries_are_tested_in_this_file() {
    let own = include_str!("effects_found.rs");
    let mut seen = BTreeMap::new();
    for effect in load_effects(None).expect("the catalogue") {
        let entry: &mut usize = seen.entry(effect.name.clone()).or_default();
        let (name, number) = (&effect.name, *entry);
        assert!(own.contains(&format!("hidden(\"{name}\"")), "{name}");
        assert!(
            number == 0 || own.contains(&format!("Change::Entry({number},")),
            "{name}"
        );
        *entry += 1;
    }
}
