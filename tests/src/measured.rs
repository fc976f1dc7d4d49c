//! Synthetic records of the stage of `emps.toml`: piecewise constant forces, closed-form motion between their changes,
//! and deterministic noise. Tests modify these records.

use std::path::PathBuf;

use crate::logistic_noise::LogisticNoise;
use crate::models::path;
use crate::program;

/// Number of samples of a record.
pub const SAMPLES: usize = 400;

/// Time between samples, in s.
const STEP: f64 = 0.005;

/// Standard deviation of the position sensor's noise, in m.
const NOISE: f64 = 1e-6;

/// Temporary folder for a dataset and its records.
pub struct Measured {
    folder: tempfile::TempDir,
}

/// Text of the dataset file.
pub const DESCRIPTION: &str = r#"
[records]
train = ["train.csv"]
test = ["test.csv"]

[time]
column = "t"
unit = "s"

[inputs.force]
column = "force"
unit = "N"
hold = "zero-order"

[channels.q]
column = "q"
unit = "m"
noise = 1e-6

[initial]
state = "rest"

[uncertain]
F_v = { relative = 0.05 }

[windows]
length = 0.25
"#;

/// Time, state and motor force of the stage.
#[derive(Clone, Copy)]
pub struct Moment {
    /// Time, s.
    pub t: f64,
    /// Position, m.
    pub q: f64,
    /// Velocity, m/s.
    pub v: f64,
    /// Force of the motor, N.
    pub force: f64,
}

/// Returns a record with columns t, force, q and dry friction in N; `turn` is a phase that changes the input.
pub fn record(friction: f64, turn: f64) -> String {
    record_with_force(&dry(friction), turn)
}

/// Returns dry friction that changes its sign steeply at zero speed.
fn dry(friction: f64) -> impl Fn(Moment) -> f64 {
    move |at| -friction * (at.v / 1e-4).tanh()
}

/// Returns a record of a stage with an additional force, in N.
pub fn record_with_force(other: &dyn Fn(Moment) -> f64, turn: f64) -> String {
    let (mass, viscous) = (95.0, 210.0);
    let (mut q, mut v): (f64, f64) = (0.0, 0.0);
    let mut text = "t,force,q\n".to_owned();
    let mut noise = LogisticNoise::new(NOISE, 0.5);
    for sample in 0..SAMPLES {
        let t = STEP * sample as f64;
        let force = 300.0 * (5.0 * t + turn).cos() - 150.0 * (13.0 * t * (1.0 + 0.3 * turn)).sin();
        text += &format!("{t:.3},{force:.17},{:.9}\n", q + noise.draw());
        // The integration steps are so short that the friction has a constant direction in each step.
        let parts = 50;
        let h = STEP / f64::from(parts);
        let slope = |at: Moment| (force + other(at) - viscous * at.v) / mass;
        for part in 0..parts {
            let t = t + f64::from(part) * h;
            let middle = v + 0.5 * h * slope(Moment { t, q, v, force });
            v += h * slope(Moment {
                t: t + 0.5 * h,
                q,
                v: middle,
                force,
            });
            q += h * middle;
        }
    }
    text
}

impl Measured {
    /// Creates an empty folder.
    pub fn empty() -> Self {
        Self {
            folder: tempfile::tempdir().expect("a folder"),
        }
    }

    /// Writes two valid records of a stage with dry friction `friction`, in N.
    pub fn stage(friction: f64) -> Self {
        Self::stage_with_force(&dry(friction))
    }

    /// Writes two valid records of a stage with an additional force, in N.
    pub fn stage_with_force(other: &dyn Fn(Moment) -> f64) -> Self {
        let measured = Self::empty();
        measured.write("dataset.toml", DESCRIPTION.as_bytes());
        measured.write("train.csv", record_with_force(other, 0.0).as_bytes());
        measured.write("test.csv", record_with_force(other, 1.0).as_bytes());
        measured
    }

    /// Returns the path of a file in the folder.
    pub fn file(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Writes a file in the folder.
    pub fn write(&self, name: &str, bytes: &[u8]) {
        std::fs::write(self.file(name), bytes).expect("a file");
    }

    /// Returns the text of a file in the folder.
    pub fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.file(name)).expect("a file")
    }

    /// Returns the arguments that run `command` on the dataset.
    pub fn arguments(&self, command: &str, out: &str) -> Vec<String> {
        let dataset = self.file("dataset.toml");
        let out = self.file(out);
        let texts = [path("emps"), dataset].map(|path| path.display().to_string());
        let [specification, dataset] = texts;
        let out = out.display().to_string();
        vec![
            command.to_owned(),
            specification,
            dataset,
            "--out".to_owned(),
            out,
        ]
    }

    /// Returns the message of the rejected dataset; asserts that nothing is written.
    pub fn rejection(&self) -> String {
        let arguments = self.arguments("compare", "refused");
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        let message = program::run_rejected(&arguments);
        assert!(!self.file("refused").exists(), "{message}");
        message
    }

    /// Runs `command`; returns its document and its messages.
    pub fn run_command(&self, command: &str, out: &str) -> (serde_json::Value, String) {
        let arguments = self.arguments(command, out);
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        let output = program::run(&arguments);
        let message = program::text(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{message}");
        let name = match command {
            "compare" => "comparison.json",
            _ => "discovery.json",
        };
        let text = self.read(&format!("{out}/{name}"));
        (serde_json::from_str(&text).expect("JSON"), message)
    }
}
