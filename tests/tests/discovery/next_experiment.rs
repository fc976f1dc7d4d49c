//! Tests of proposed experiments. The experiment is simulated with hand-written equations of the true machine. With the
//! additional record, discovery names the true effect of the class.

use std::path::Path;

use eomgen_tests::logistic_noise::LogisticNoise;
use eomgen_tests::program;
use serde_json::Value;

use super::specifications::OSCILLATOR;

/// Machine of one coordinate `x` that is driven by an input `u`, with the settings of its records.
struct Machine<'m> {
    specification: &'m str,
    units: [&'m str; 2],
    noise: f64,
    /// Window length, s.
    window: f64,
    uncertain: &'m str,
    experiment: &'m str,
    mass: f64,
    /// Force without dry friction, as a function of position, rate and input.
    force: &'m dyn Fn(f64, f64, f64) -> f64,
    friction: f64,
    /// Initial state of the first records.
    begin: (f64, f64),
    input: fn(f64, f64) -> f64,
}

/// Time between samples, in s.
const SAMPLE: f64 = 0.005;
const SAMPLES: usize = 600;

const ROTOR: &str = r#"
[model]
name = "rotor"

[parameters]
J = { value = 0.02, unit = "kg m^2", min = 0 }

[coordinates]
x = { unit = "rad" }

[inputs]
u = { unit = "N m" }

[kinetic]
rotor = "1/2*J*dot(x)^2"

[forces]
motor = { on = "x", value = "u" }
"#;

impl Machine<'_> {
    /// Returns a record from an initial state for an input at each sample. The steps are implicit in the dry friction,
    /// so that sticking is possible. `seed` selects the noise.
    fn record(&self, (mut x, mut v): (f64, f64), input: &[f64], seed: f64) -> String {
        let parts = 200;
        let h = SAMPLE / f64::from(parts);
        let mut noise = LogisticNoise::new(self.noise, 0.3 + 0.01 * seed);
        let mut text = "t,u,x\n".to_owned();
        for (sample, u) in input.iter().enumerate() {
            let seen = x + noise.draw();
            text += &format!("{:.4},{u:.12},{seen:.12}\n", SAMPLE * sample as f64);
            for _ in 0..parts {
                let free = v + h * (self.force)(x, v, *u) / self.mass;
                let most = h * self.friction / self.mass;
                v = free - free.clamp(-most, most);
                x += h * v;
            }
        }
        text
    }

    fn dataset(&self, train: &str, test: &str) -> String {
        let [unit, input] = self.units;
        format!(
            "[records]\ntrain = [{train}]\ntest = [{test}]\n\n[time]\ncolumn = \"t\"\nunit = \"s\"\n\n\
             [inputs.u]\ncolumn = \"u\"\nunit = \"{input}\"\n\n\
             [channels.x]\ncolumn = \"x\"\nunit = \"{unit}\"\nnoise = {:e}\n\n[initial]\nstate = \"estimate\"\n\n\
             [uncertain]\n{}\n\n[windows]\nlength = {}\n\n[experiment]\n{}\n",
            self.noise, self.uncertain, self.window, self.experiment
        )
    }

    fn answer(&self, folder: &Path, records: [&str; 2], out: &str) -> Value {
        self.document(folder, "discover", records, out)
    }

    fn document(&self, folder: &Path, command: &str, [train, test]: [&str; 2], out: &str) -> Value {
        let place = |name: &str| folder.join(name);
        std::fs::write(place("dataset.toml"), self.dataset(train, test)).expect("a file");
        let paths = ["spec.toml", "dataset.toml", out].map(place);
        program::run_on_dataset(command, paths.each_ref())
    }

    /// Runs `discover` on the first records and returns the class of equivalent effects.
    fn first_class(&self, folder: &Path) -> Value {
        let write = |name: &str, text: &str| {
            std::fs::write(folder.join(name), text).expect("a file");
        };
        write("spec.toml", self.specification);
        for (name, turn) in [("train.csv", 0.0), ("test.csv", 1.0)] {
            let times = (0..SAMPLES).map(|sample| SAMPLE * sample as f64);
            let input: Vec<f64> = times.map(|t| (self.input)(t, turn)).collect();
            write(name, &self.record(self.begin, &input, turn));
        }
        let first = self.answer(folder, ["\"train.csv\"", "\"test.csv\""], "first");
        let class = &first["effects"][0];
        assert_eq!(class["status"], "class", "{class:#}");
        class.clone()
    }

    /// Returns the proposed input at each sample, if an experiment was proposed.
    fn proposed_input(&self, folder: &Path) -> Option<Vec<f64>> {
        let played = std::fs::read_to_string(folder.join("first/experiment.csv")).ok()?;
        let mut lines = played.lines();
        assert_eq!(lines.next(), Some("t,u"));
        let input = lines.enumerate().map(|(sample, line)| {
            let (t, u) = line.split_once(',').expect("two columns");
            let t: f64 = t.parse().expect("a time");
            assert!((t - SAMPLE * sample as f64).abs() < 1e-9);
            u.parse::<f64>().expect("a number")
        });
        Some(input.collect())
    }

    /// Asserts that the first records give a class that contains the true effect. Asserts that, with two records of the
    /// experiment, only the true effect remains. Returns the proposed experiment.
    fn assert_resolved(&self, folder: &Path, effect: &str, on: &str) -> Value {
        let class = &self.first_class(folder);
        let is_true = |of: &Value| of["effect"] == effect && of["on"] == on;
        let others = class["equivalent"].as_array().expect("a list");
        assert!(is_true(class) || others.iter().any(is_true), "{class:#}");
        let next = &class["next_experiment"];
        assert_eq!(next["file"], "experiment.csv", "{next:#}");
        let separation = next["separation"].as_f64();
        assert!(separation.is_some_and(|of| of >= 3.0), "{next:#}");

        let input = self.proposed_input(folder).expect("an experiment");
        let write = |name: &str, text: &str| {
            std::fs::write(folder.join(name), text).expect("a file");
        };
        write("played.csv", &self.record((0.0, 0.0), &input, 2.0));
        write("again.csv", &self.record((0.0, 0.0), &input, 3.0));
        let second = self.answer(
            folder,
            [
                "\"train.csv\", \"played.csv\"",
                "\"test.csv\", \"again.csv\"",
            ],
            "second",
        );
        let effects = second["effects"].as_array().expect("a list");
        assert_eq!(effects.len(), 1, "{effects:#?}");
        assert!(is_true(&effects[0]), "{effects:#?}");
        // A softer spring is always equivalent to an additional spring in series.
        let others = effects[0]["equivalent"].as_array().expect("a list");
        let mut others = others.iter().map(|of| of["effect"].as_str());
        assert!(
            others.all(|of| of == Some("joint_compliance")),
            "{effects:#?}"
        );
        next.clone()
    }
}

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a folder")
}

fn rotor_in_bearing() -> String {
    let with = ROTOR.replace(
        "[coordinates]",
        "c = { value = 0.02, unit = \"N m s\", min = 0 }\n\n[coordinates]",
    );
    with.replace(
        "[forces]",
        "[dissipation]\nbearing = \"1/2*c*dot(x)^2\"\n\n[forces]",
    )
}

fn one_way_rotor<'m>(
    specification: &'m str,
    force: &'m dyn Fn(f64, f64, f64) -> f64,
) -> Machine<'m> {
    Machine {
        specification,
        units: ["rad", "N m"],
        noise: 1e-3,
        window: 0.5,
        uncertain: "J = { relative = 0.02 }",
        experiment: "duration = 3\ninputs.u = { range = [-0.4, 0.4] }\nlimits.x = [-40, 40]",
        mass: 0.02,
        force,
        friction: 0.0,
        begin: (0.0, 7.0),
        input: |t, turn| 0.25 + 0.1 * (4.0 * t + turn).sin(),
    }
}

#[test]
fn experiment_separates_dry_friction_from_constant_force() {
    let specification = rotor_in_bearing();
    let machine = Machine {
        friction: 0.1,
        ..one_way_rotor(&specification, &|_, v, u| u - 0.02 * v)
    };
    machine.assert_resolved(folder().path(), "coulomb_friction", "x");
}

/// Viscous friction is always equivalent to a shift of the bearing's friction parameter. If this parameter is fitted,
/// the residual of the wrong model must equal the prediction.
#[test]
fn experiment_separates_asymmetric_from_symmetric_friction() {
    let specification = rotor_in_bearing();
    let force = |_: f64, v: f64, u: f64| u - 0.02 * v - 0.012 * v.abs();
    let (machine, folder) = (one_way_rotor(&specification, &force), folder());
    let next = machine.assert_resolved(folder.path(), "asymmetric_friction", "x");
    let is_alike = |pair: &&Value| {
        [&pair["simulated"]["effect"], &pair["alternative"]["effect"]]
            .iter()
            .all(|effect| **effect != "asymmetric_friction")
    };
    let pairs = next["pairs"].as_array().expect("a list");
    let alike: Vec<&Value> = pairs.iter().filter(is_alike).collect();
    assert_eq!(alike.len(), 2, "{next:#}");
    for pair in alike {
        let separation = pair["separation"].as_f64().expect("a number");
        assert!(separation < 1e-3, "{next:#}");
    }
    let says = next["text"].as_str().expect("a sentence");
    assert!(
        says.contains("does not separate viscous friction"),
        "{says}"
    );

    let rival = |pair: &&Value| {
        pair["simulated"]["effect"] == "asymmetric_friction" && pair["alternative"]["on"] == "c"
    };
    let predicted = pairs.iter().find(rival).expect("a pair");
    let predicted = predicted["separation"].as_f64().expect("a number");
    let wrong = Machine {
        uncertain: "J = { relative = 0.02 }\nc = { relative = 0.5 }",
        ..machine
    };
    let records = ["\"train.csv\", \"played.csv\"", "\"again.csv\""];
    let compared = wrong.document(folder.path(), "compare", records, "compared");
    let left = compared["gap"]["x"]["test"].as_f64().expect("a number") / wrong.noise;
    assert!(
        (0.8..1.3).contains(&(left / predicted)),
        "{left}, expected {predicted}"
    );
}

#[test]
fn experiment_separates_soft_spring_from_gain() {
    Machine {
        specification: OSCILLATOR,
        units: ["m", "N"],
        noise: 1.5e-3,
        window: 1.5,
        uncertain: "k = { relative = 0.02 }",
        experiment: "inputs.u = { range = [-20, 20], band = [0.1, 8] }\nlimits.x = [-0.2, 0.2]",
        mass: 1.0,
        force: &|x, v, u| u - 0.82 * 400.0 * x - 4.0 * v,
        friction: 0.0,
        begin: (0.0, 0.0),
        input: |t, turn| 12.0 * (1.0 - ((0.8 + 0.2 * turn) * t).cos()),
    }
    .assert_resolved(folder().path(), "parameter_shift", "k");
}

#[test]
fn experiment_separates_weight_from_spring() {
    Machine {
        experiment: "duration = 3\ninputs.u = { range = [-0.5, 0.5] }\nlimits.x = [-1.5, 1.5]",
        begin: (0.0, 0.0),
        input: |t, turn| 0.02 * (2.1 * t + 0.7 * turn).cos() - 0.01 * (7.0 * t).sin(),
        ..one_way_rotor(ROTOR, &|x, _, u| u - 0.3 * x.sin())
    }
    .assert_resolved(folder().path(), "gravity", "x");
}

/// The true machine must also stay within the bounds.
#[test]
fn experiment_keeps_declared_bounds() {
    let specification = rotor_in_bearing();
    let machine = Machine {
        experiment: "duration = 3\nsample = 0.01\n\
                     inputs.u = { range = [-0.3, 0.4], rate = 0.5, band = [0.5, 1] }\nlimits.x = [-1, 8]",
        ..one_way_rotor(&specification, &|_, v, u| u - 0.02 * v - 0.012 * v.abs())
    };
    let folder = folder();
    let class = machine.first_class(folder.path());
    assert_eq!(
        class["next_experiment"]["file"], "experiment.csv",
        "{class:#}"
    );
    let text = std::fs::read_to_string(folder.path().join("first/experiment.csv"));
    let text = text.expect("an experiment");
    let cells = |line: &str| -> Vec<f64> {
        let cells = line.split(',');
        cells.map(|cell| cell.parse().expect("a number")).collect()
    };
    let rows: Vec<Vec<f64>> = text.lines().skip(1).map(cells).collect();
    assert_eq!(rows.len(), 301);
    assert!(rows.iter().all(|row| (-0.3..=0.4).contains(&row[1])));
    for pair in rows.windows(2) {
        assert!((pair[1][0] - pair[0][0] - 0.01).abs() < 1e-9);
        assert!((pair[1][1] - pair[0][1]).abs() <= 0.005 * (1.0 + 1e-9));
    }
    // The input is constant between the samples of a record.
    let held = rows.iter().flat_map(|row| [row[1], row[1]]);
    let input: Vec<f64> = held.take(601).collect();
    for line in machine.record((0.0, 0.0), &input, 2.0).lines().skip(1) {
        assert!((-1.1..=8.1).contains(&cells(line)[2]), "{line}");
    }
}

/// Without declared bounds, the input must stay within the range of the records, in which the rotor turns in one
/// direction only.
#[test]
fn experiment_without_bounds_stays_within_recorded_range() {
    let specification = rotor_in_bearing();
    let machine = Machine {
        friction: 0.1,
        experiment: "",
        ..one_way_rotor(&specification, &|_, v, u| u - 0.02 * v)
    };
    let folder = folder();
    let class = machine.first_class(folder.path());
    let next = &class["next_experiment"];
    let bounds = next["bounds"].as_str().expect("a sentence");
    for said in ["the range of u", "the band of u", "the limits of x"] {
        assert!(bounds.contains(said), "{bounds}");
    }
    if let Some(input) = machine.proposed_input(folder.path()) {
        // The range is from 0, the input at rest, to the largest recorded value.
        assert!(input.iter().all(|u| (0.0..=0.35 + 1e-9).contains(u)));
        let record = machine.record((0.0, 0.0), &input, 2.0);
        let shown = |text: &str| -> Vec<f64> {
            let lines = text.lines().skip(1);
            let last = lines.map(|line| line.rsplit(',').next().expect("a cell").to_owned());
            last.map(|cell| cell.parse().expect("a number")).collect()
        };
        let before =
            shown(&std::fs::read_to_string(folder.path().join("train.csv")).expect("a record"));
        let most = before.iter().copied().fold(0.0, f64::max);
        assert!(
            shown(&record)
                .iter()
                .all(|x| *x < 1.1 * most && *x > -0.1 * most)
        );
    } else {
        assert!(next["text"].as_str().is_some_and(|says| !says.is_empty()));
    }
}
