//! Cases of the study: machines with file, initial state, inputs and duration.

use std::path::{Path, PathBuf};

use eomgen_compiled_model::{CompiledModel, Motion, Orders, Request, Solver, TypicalSizes};
use eomgen_sim::inputs::HeldInputs;
use eomgen_validate::random::Random;

use super::drawn::{self, Sine};
use super::kind::Kind;
use crate::sample::Sample;

/// Folders of the shipped specifications and examples. The order determines the seeds of the machines.
const FOLDERS: [&str; 8] = [
    "examples/constrained",
    "examples/drawn",
    "examples/friction",
    "examples/impacts",
    "examples/measured",
    "examples/recipes",
    "model-spec/models",
    "examples/closed_loop",
];

/// Number of intervals between the samples of a motion.
pub const INTERVALS: usize = 100;

/// Indices of the samples at which a held input changes.
const INPUT_SAMPLES: [usize; 3] = [21, 48, 77];

/// Maximum duration of the motion of a shipped machine, in s.
const LONGEST: f64 = 2.0;

/// Maximum number of evaluations of the right-hand side for a shipped machine.
const MAX_EVALUATIONS: u64 = 5_000;

/// Displacement from the initial state of a specification, relative to the typical sizes of the states.
const DISPLACEMENT: f64 = 0.1;

/// Maximum number of reductions of the displacement, each by a factor of ten.
const MAX_REDUCTIONS: i32 = 4;

/// Input of a case.
pub(crate) struct CaseInput {
    pub name: String,
    /// Sine, if the input is a function of time instead of samples.
    pub sine: Option<Sine>,
    /// Values in SI, each held from its sample on; empty for a function of time.
    pub samples: Vec<f64>,
}

/// Machine with all data that determine its motion.
pub(crate) struct Case {
    pub name: String,
    pub kind: Kind,
    pub file: PathBuf,
    pub model: CompiledModel,
    /// Initial state, SI.
    pub initial: Vec<f64>,
    pub inputs: Vec<CaseInput>,
    /// Duration, s.
    pub until: f64,
}

impl Case {
    /// Returns the sample times, s.
    pub fn times(&self) -> Vec<f64> {
        let step = self.until / INTERVALS as f64;
        (0..=INTERVALS).map(|k| k as f64 * step).collect()
    }

    /// Returns the value of an input as an expression of t, in the input's unit.
    pub fn expression(&self, input: &CaseInput) -> String {
        if let Some(sine) = &input.sine {
            return format!("{:e}*sin({:e}*t)", sine.amplitude, sine.frequency);
        }
        let known = &self.model.model().inputs;
        let known = known.iter().find(|known| known.name == input.name);
        let times = self.times();
        let mut text = String::new();
        let mut last = 0.0;
        for (value, t) in input.samples.iter().zip(&times) {
            let value = known.map_or(*value, |known| known.unit.from_si(*value));
            if text.is_empty() {
                text = format!("{value:e}");
            } else if value != last {
                text += &format!(" + ({:e})*above(t - {t:e})", value - last);
            }
            last = value;
        }
        text
    }

    /// Returns the held inputs in SI; inputs without values are zero.
    pub fn held_inputs(&self) -> HeldInputs {
        let inputs = &self.model.model().inputs;
        let times = self.times();
        let mut rows = Vec::new();
        for sample in 0..times.len() {
            for input in inputs {
                let own = self.inputs.iter().find(|own| own.name == input.name);
                let value = own.and_then(|own| own.samples.get(sample));
                rows.push(value.copied().unwrap_or(0.0));
            }
        }
        HeldInputs::new(times, rows, inputs.len()).unwrap_or_else(|| HeldInputs::zero(inputs.len()))
    }
}

/// Returns all shipped machines and `sample.count` random machines. The files of random machines are written to
/// `folder`.
///
/// # Errors
/// A machine that cannot be loaded or simulated.
pub(crate) fn all(sample: &Sample, folder: &Path) -> Result<Vec<Case>, String> {
    let mut cases = Vec::new();
    for file in shipped_files()? {
        let seed = sample.seed.wrapping_add(cases.len() as u64);
        let found = shipped_case(file.clone(), seed);
        cases.push(found.map_err(|problem| format!("{}: {problem}", file.display()))?);
    }
    for place in 0..sample.count {
        let seed = sample.seed.wrapping_mul(1_000_003) + place as u64;
        let found = drawn_case(place, &mut Random::new(seed), folder);
        cases.push(found.map_err(|problem| format!("machine {place}: {problem}"))?);
    }
    Ok(cases)
}

fn shipped_files() -> Result<Vec<PathBuf>, String> {
    let project = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut files = Vec::new();
    for folder in FOLDERS {
        let first = files.len();
        let entries =
            std::fs::read_dir(project.join(folder)).map_err(|e| format!("{folder}: {e}"))?;
        for entry in entries {
            let path = entry.map_err(|error| error.to_string())?.path();
            let text = std::fs::read_to_string(&path).unwrap_or_default();
            if path.extension().is_some_and(|end| end == "toml") && text.contains("[model]") {
                files.push(path);
            }
        }
        files[first..].sort();
    }
    Ok(files)
}

fn shipped_case(file: PathBuf, seed: u64) -> Result<Case, String> {
    let model = CompiledModel::load(&file, Orders::Declared).map_err(|e| e.to_string())?;
    let folder = file.parent().and_then(Path::file_name).unwrap_or_default();
    let stem = file.file_stem().unwrap_or_default();
    let mut case = Case {
        name: format!("{}_{}", folder.to_string_lossy(), stem.to_string_lossy()),
        kind: Kind::classify(&model),
        initial: Vec::new(),
        inputs: Vec::new(),
        until: LONGEST,
        file,
        model,
    };
    // With a large displacement or input, the state can leave the domain of the model.
    let mut outcome = Ok(());
    for power in 0..MAX_REDUCTIONS {
        disturb(&mut case, DISPLACEMENT * 0.1_f64.powi(power), seed)?;
        outcome = shorten(&mut case);
        if outcome.is_ok() {
            break;
        }
    }
    outcome.map(|()| case)
}

/// Sets a displaced initial state and inputs. `size` is the magnitude relative to the typical sizes.
fn disturb(case: &mut Case, size: f64, seed: u64) -> Result<(), String> {
    let random = &mut Random::new(seed);
    let instance = case.model.with_declared_parameters();
    let instance = instance.map_err(|error| error.to_string())?;
    let mut initial = instance.initial_state().to_vec();
    // A displaced body could overlap another one.
    if case.model.model().impacts.is_empty() {
        for (value, typical) in initial.iter_mut().zip(case.model.typical_sizes()) {
            *value += size * typical * random.symmetric();
        }
    }
    case.initial = initial;
    case.inputs = draw_inputs(case, size, random)?;
    Ok(())
}

/// Shortens the duration until the motion needs at most the maximum number of evaluations.
///
/// # Errors
/// A motion that stops early.
fn shorten(case: &mut Case) -> Result<(), String> {
    case.until = LONGEST;
    loop {
        let instance = case.model.with_declared_parameters();
        let instance = instance.map_err(|error| error.to_string())?;
        let request = Request {
            initial: &case.initial,
            times: &case.times(),
            inputs: &case.held_inputs(),
            solver: Solver::Rk,
            tolerance: 1e-9,
            max_step: f64::INFINITY,
            audit: false,
        };
        let motion = instance
            .simulate_until_stop(&request, &mut |_| {})
            .and_then(Motion::into_complete)
            .map_err(|error| error.to_string())?;
        if motion.trajectory.statistics.evaluations <= MAX_EVALUATIONS || case.until < 1e-9 {
            return Ok(());
        }
        case.until *= 0.25;
    }
}

fn drawn_case(place: usize, random: &mut Random, folder: &Path) -> Result<Case, String> {
    let machine = drawn::draw(place, random);
    let file = folder.join(format!("machine_{place}.toml"));
    std::fs::write(&file, &machine.text).map_err(|error| error.to_string())?;
    let model = CompiledModel::load(&file, Orders::Declared).map_err(|e| e.to_string())?;
    let instance = model
        .with_declared_parameters()
        .map_err(|e| e.to_string())?;
    let initial = instance.initial_state().to_vec();
    let mut case = Case {
        name: format!("machine_{place}"),
        kind: machine.kind.unwrap_or_else(|| Kind::classify(&model)),
        initial,
        inputs: Vec::new(),
        until: machine.until,
        file,
        model,
    };
    case.inputs = match machine.input {
        Some((name, sine)) => vec![CaseInput {
            name: name.to_owned(),
            sine: Some(sine),
            samples: Vec::new(),
        }],
        None => draw_inputs(&case, DISPLACEMENT, random)?,
    };
    Ok(case)
}

/// Returns held inputs with three steps each, within the range of the input or with a magnitude relative to its typical
/// size. A prescribed motion is constant at a typical position; inputs driven by controllers have no values.
fn draw_inputs(case: &Case, size: f64, random: &mut Random) -> Result<Vec<CaseInput>, String> {
    let model = case.model.model();
    let ranges = model.input_ranges().map_err(|error| error.to_string())?;
    let places = model
        .typical_inputs(1.0)
        .map_err(|error| error.to_string())?;
    let sizes = TypicalSizes::new(model, case.model.orders());
    let mut drawn = Vec::new();
    for (place, (input, range)) in model.inputs.iter().zip(ranges).enumerate() {
        if input.rate_of.is_some() || model.is_controlled(place) {
            continue;
        }
        let most = match range {
            _ if input.rate.is_some() => 0.0,
            Some((low, high)) => 5.0 * size * low.abs().max(high.abs()),
            None => size * sizes.typical_size(input.unit.dimension),
        };
        let values =
            [(); INPUT_SAMPLES.len() + 1].map(|()| places[place] + most * random.symmetric());
        let before = |sample: usize| INPUT_SAMPLES.iter().filter(|at| **at <= sample).count();
        drawn.push(CaseInput {
            name: input.name.clone(),
            sine: None,
            samples: (0..=INTERVALS).map(|k| values[before(k)]).collect(),
        });
    }
    Ok(drawn)
}
