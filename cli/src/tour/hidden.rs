//! Last chapter of the tour: `compare` and `discover` are applied to records of a simulated stage. The stage has dry
//! friction that the specification lacks.

use std::path::{Path, PathBuf};

use eomgen_compiled_model::{Request, Solver};
use eomgen_discover::catalogue::effect::effect_in_words;
use eomgen_model_spec::edit::{self, Edit, NewForce, NewParameter, NewValue};
use eomgen_model_spec::model::Model;
use eomgen_model_spec::models;
use eomgen_model_spec::source::Source;
use eomgen_sim::inputs::HeldInputs;
use serde_json::Value;

use crate::discovery::{self, Task};
use crate::error::{Error, Result};
use crate::model::derive;
use crate::motion::{simulate, table};
use crate::output::write_file;
use crate::page;
use crate::table::Table;

/// Folder of the records, in the folder of the tour.
pub const FOLDER: &str = "hidden";

/// Name of the written specification.
pub const SPECIFICATION_FILE: &str = "stage.toml";

/// Name of the written dataset file.
pub const DATASET_FILE: &str = "dataset.toml";

/// Specification of the stage without dry friction.
const SPECIFICATION: &str = models::EMPS.text;

/// Hidden dry friction in N. The force is a smooth function of the speed, unlike the effect in the catalogue.
const FRICTION: f64 = 12.0;

/// Speed range in which the friction changes sign, in m/s.
const TRANSITION_SPEED: f64 = 2e-4;

/// Number of samples of a record.
const SAMPLES: usize = 750;

/// Time between samples, in s.
const SAMPLE_TIME: f64 = 0.002;

/// Standard deviation of the sensor noise, in m.
const NOISE: f64 = 2e-6;

/// Relative tolerance of the simulations.
const TOLERANCE: f64 = 1e-9;

/// Result of the discovery, and the reports of comparison and discovery.
pub struct Rediscovery {
    discovery: Value,
    /// Model of the stage, with the descriptions of its coordinates.
    model: Model,
    reports: [String; 2],
    extended: String,
}

/// Writes the records to `out`, then runs the comparison and the discovery.
pub fn rediscover(out: &Path) -> Result<Rediscovery> {
    let folder = out.join(FOLDER);
    let specification = folder.join(SPECIFICATION_FILE);
    write_file(&specification, SPECIFICATION.as_bytes())?;
    let truth = truth()?;
    for (name, turn) in [("train.csv", 0.0), ("test.csv", 1.0)] {
        let path = folder.join(name);
        write_file(&path, &record(&truth, turn)?.encode(&path)?)?;
    }
    let dataset = folder.join(DATASET_FILE);
    write_file(&dataset, description().as_bytes())?;
    let (compared, found) = (folder.join("compared"), folder.join("found"));
    let task = |out| Task {
        spec: &specification,
        order: None,
        dataset: &dataset,
        out,
        seed: 1,
    };
    discovery::compare(&task(&compared))?;
    let discovery = discovery::discover(&task(&found), None, None)?;
    let stage = eomgen_model_spec::check(Source::new(SPECIFICATION_FILE, SPECIFICATION))
        .map_err(Error::Specification)?;
    Ok(Rediscovery {
        discovery,
        model: stage.model,
        reports: [
            text(compared.join("report.html"))?,
            text(found.join("report.html"))?,
        ],
        extended: text(found.join("extended.toml"))?,
    })
}

fn text(path: PathBuf) -> Result<String> {
    std::fs::read_to_string(&path).map_err(|error| Error::file("read", &path, &error))
}

/// Returns the specification with the hidden friction.
fn truth() -> Result<String> {
    let parameter = |name: &str, value: f64, unit: &str| {
        Edit::AddParameter(NewParameter {
            name: name.to_owned(),
            value: NewValue::Number(value),
            unit: unit.to_owned(),
            doc: String::new(),
            source: String::new(),
        })
    };
    let friction = Edit::AddForce(NewForce {
        name: "hidden".to_owned(),
        on: "q".to_owned(),
        value: "-hidden_level*dot(q)/sqrt(dot(q)^2 + hidden_speed^2)".to_owned(),
        doc: String::new(),
        source: String::new(),
    });
    let edits = [
        parameter("hidden_level", FRICTION, "N"),
        parameter("hidden_speed", TRANSITION_SPEED, "m/s"),
        friction,
    ];
    edit::apply(&Source::new("stage.toml", SPECIFICATION), &edits)
        .map_err(|error| Error::input(error.to_string()))
}

/// Simulates a record, driven by two sinusoidal forces. `turn` shifts their phase and frequency.
fn record(truth: &str, turn: f64) -> Result<Table> {
    let checked =
        eomgen_model_spec::check(Source::new("stage.toml", truth)).map_err(Error::Specification)?;
    let compiled = derive(checked.model, &[])?;
    let times: Vec<f64> = (0..SAMPLES).map(|i| i as f64 * SAMPLE_TIME).collect();
    let force = |t: &f64| {
        let slow = 300.0 * (5.0 * t + turn).cos();
        slow - 150.0 * (13.0 * t * (1.0 + 0.3 * turn)).sin()
    };
    let forces: Vec<f64> = times.iter().map(force).collect();
    let inputs = HeldInputs::new(times.clone(), forces.clone(), 1)
        .ok_or_else(|| Error::input("the stage has no force"))?;
    let run = compiled.with_declared_parameters()?;
    let request = Request {
        initial: run.initial_state(),
        times: &times,
        inputs: &inputs,
        solver: Solver::Rk,
        tolerance: TOLERANCE,
        max_step: f64::INFINITY,
        audit: false,
    };
    let motion = table(&run, &simulate(&run, &request)?)?;
    let positions = motion
        .column("q")
        .ok_or_else(|| Error::input("the stage has no position"))?;
    // The fractional parts of n^2 times the golden ratio are evenly distributed without a visible pattern.
    let noise = |sample: usize| {
        let turns = (sample * sample) as f64 * 0.618_033_988_749_895;
        NOISE * 12f64.sqrt() * (turns.fract() - 0.5)
    };
    let seen = positions.iter().enumerate().map(|(i, q)| q + noise(i));
    Ok(Table::from_columns(&[
        ("t".to_owned(), times),
        ("force".to_owned(), forces),
        ("q".to_owned(), seen.collect()),
    ]))
}

fn description() -> String {
    format!(
        "title = \"Simulated stage with a hidden friction\"\n\n\
         [records]\ntrain = [\"train.csv\"]\ntest = [\"test.csv\"]\n\n\
         [time]\ncolumn = \"t\"\nunit = \"s\"\n\n\
         [inputs.force]\ncolumn = \"force\"\nunit = \"N\"\nhold = \"zero-order\"\n\n\
         [channels.q]\ncolumn = \"q\"\nunit = \"m\"\nnoise = {NOISE:e}\n\n\
         [initial]\nstate = \"rest\"\n\n\
         [uncertain]\nF_v = {{ relative = 0.05 }}\n\n\
         [windows]\nlength = 0.25\n"
    )
}

impl Rediscovery {
    /// Returns the result in one sentence.
    pub fn sentence(&self) -> String {
        format!(
            "From noisy records of a positioning stage, eomgen found {}, which the specification lacks: on held-out \
             data, the RMS residual fell from {} to {}.",
            self.describe_effects(),
            self.residual("before"),
            self.residual("after"),
        )
    }

    pub fn chapter(&self) -> page::Hidden<'_> {
        let floor = micrometres(&self.discovery["gap"]["q"]["floor"]);
        let facts = [
            (
                "Hidden in the records",
                format!(
                    "a dry friction of {FRICTION} N, and noise of the position of {:.0} µm (standard deviation)",
                    1e6 * NOISE
                ),
            ),
            (
                "Residual of the original model",
                format!(
                    "{} on held-out data, {}",
                    self.residual("before"),
                    self.multiple("before")
                ),
            ),
            ("Found", self.describe_effects()),
            (
                "Residual with the found effect",
                format!(
                    "{} on held-out data, {}",
                    self.residual("after"),
                    self.multiple("after")
                ),
            ),
            (
                "Noise floor",
                format!("{floor}, the residual of a correct model"),
            ),
        ];
        page::Hidden {
            facts: facts.to_vec(),
            path: FOLDER,
            extended: &self.extended,
            reports: [&self.reports[0], &self.reports[1]],
        }
    }

    /// Describes the found effects.
    fn describe_effects(&self) -> String {
        let effects = self.discovery["effects"].as_array().into_iter().flatten();
        match effects
            .map(|entry| describe_effect(&self.model, entry))
            .collect::<Vec<String>>()
        {
            all if all.is_empty() => "no effect".to_owned(),
            all => all.join(" and "),
        }
    }

    /// Returns the RMS residual on held-out data.
    fn residual(&self, when: &str) -> String {
        micrometres(&self.discovery["gap"]["q"][when]["test"])
    }

    /// Returns the RMS residual on held-out data as a multiple of the noise floor.
    fn multiple(&self, when: &str) -> String {
        let gap = &self.discovery["gap"]["q"];
        let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
        let multiple = number(&gap[when]["test"]) / number(&gap["floor"]);
        format!("{multiple:.1} times the noise floor")
    }
}

fn micrometres(value: &Value) -> String {
    format!("{:.1} µm", 1e6 * value.as_f64().unwrap_or(f64::NAN))
}

/// Describes an effect with its first parameter and its site.
fn describe_effect(model: &Model, entry: &Value) -> String {
    let word = |key: &str| effect_in_words(entry[key].as_str().unwrap_or_default());
    let parameter = entry["parameters"]
        .as_object()
        .and_then(|p| p.values().next());
    let size = parameter.map_or_else(String::new, |p| {
        let number = |key: &str| p[key].as_f64().unwrap_or(f64::NAN);
        let unit = p["unit"].as_str().unwrap_or_default();
        format!(
            " of {:.2} ± {:.2} {unit} (one standard deviation)",
            number("value"),
            number("sd")
        )
    });
    let site = describe_site(model, entry["on"].as_str().unwrap_or_default());
    format!("{}{size} on {site}", word("effect"))
}

/// Returns the description of a coordinate. A coordinate without a description and other sites have their names.
fn describe_site(model: &Model, name: &str) -> String {
    let coordinate = model.coordinates.iter().find(|known| known.name == name);
    match coordinate {
        Some(known) if !known.doc.is_empty() => format!("the {}", known.doc),
        _ => effect_in_words(name),
    }
}
