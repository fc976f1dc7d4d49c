//! Comparison of a functional mock-up unit (FMU) with its model. The file modelDescription.xml is compared with the
//! specification: names, causalities, initial values, ranges, units of measurement and derivatives. The library in the
//! unit is compared with the program. A separate process loads the library, sets time, state, inputs and parameters by
//! the names in the description, and reads rates and observables.
//!
//! `description` parses the description, `expected` compares it.

mod description;
mod expected;

use std::env::consts::{ARCH, OS};
use std::path::{Path, PathBuf};
use std::process::Command;

use eomgen_codegen::program::Program;
use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_model_spec::model::Model;

use super::emitted::draw_samples;
use super::emitted_c::CCompiler;
use super::interface::BITS;
use super::linked_program::{format_bits, require_success};
use crate::certificate::{Check, Worst};
use crate::compiler::{run, write};
use crate::oracle::{Oracle, OracleError};
use crate::random::Random;
use crate::sampler::Sample;
use description::Description;
use expected::{Variable, Variables};

const DESCRIPTION: &str = "unit_description";
const LIBRARY: &str = "unit_library";
/// Tolerance of results of the library, relative to the largest result of the same kind. The library evaluates the
/// equations on prescribed sides of the switching surfaces, in another order of operations.
const LIBRARY_TOLERANCE: f64 = 1e-9;
/// Number of states for each set of parameters.
const STATES: usize = 20;
/// Largest relative change of a parameter.
const CHANGE: f64 = 0.01;
const SEED: u64 = 0x0f3d_21e4;

/// Functional mock-up unit, and the compiler for the program that loads it.
#[derive(Clone, Debug)]
pub struct UnitSource {
    /// Name of the unit: the file is `NAME.fmu`.
    pub name: String,
    /// SHA-256 of the file.
    pub sha256: String,
    /// Names and contents of the files in the unit.
    pub files: Vec<(String, Vec<u8>)>,
    /// Compiler.
    pub compiler: CCompiler,
}

/// Compares a unit with the model and with the program, which must be without requested outputs.
pub fn check(
    oracle: &Oracle,
    (model, program, default_inputs): (&Model, &Result<Program, String>, &[f64]),
    unit: &UnitSource,
) -> Result<Vec<Check>, OracleError> {
    let read = || {
        let program = program.as_ref().map_err(Clone::clone)?;
        let text = unit.file("modelDescription.xml");
        let text = text.ok_or("the FMU contains no modelDescription.xml")?;
        let text = String::from_utf8_lossy(text);
        let found = Description::parse(&text);
        let found = found.map_err(|error| format!("modelDescription.xml: {error}"))?;
        Ok::<_, String>((program, found))
    };
    let (program, description) = match read() {
        Ok(found) => found,
        Err(message) => {
            let worst = Worst::from_deviation(f64::INFINITY, message);
            return Ok(vec![Check::from_deviation(DESCRIPTION, worst, 0.0)]);
        }
    };
    let variables = Variables::new(model, program, default_inputs);
    let (compared, differences) = variables.compare(&description);
    let detail = match differences.first() {
        Some(first) => format!("first in {first}"),
        None => format!("{compared} variables"),
    };
    let worst = Worst::from_deviation(differences.len() as f64, detail);
    let mut checks = vec![Check::from_deviation(DESCRIPTION, worst, 0.0)];
    let mut samples: Vec<Sample> = draw_samples(oracle)?.into_iter().take(STATES).collect();
    // Before the first sample of its controller, an input has its default value.
    for (place, value) in default_inputs.iter().enumerate() {
        if model.is_controlled(place) {
            samples
                .iter_mut()
                .for_each(|sample| sample.inputs[place] = *value);
        }
    }
    let not_run = |reason: &str| Check::not_run(LIBRARY, LIBRARY_TOLERANCE, reason);
    if samples.is_empty() {
        checks.push(not_run("no state in the model's domain was found"));
        return Ok(checks);
    }
    let parameters = parameter_sets(model, program);
    let found = run_library(
        unit,
        (model, &description),
        &variables,
        (&samples, &parameters),
    );
    checks.push(match found {
        Ok(lines) => {
            let worst = compare_numbers(program, (&samples, &parameters), &lines);
            Check::from_deviation(LIBRARY, worst, LIBRARY_TOLERANCE)
        }
        Err(Obstacle::NotRun(reason)) => not_run(&reason),
        Err(Obstacle::Failed(message)) => {
            let worst = Worst::from_deviation(f64::INFINITY, message);
            Check::from_deviation(LIBRARY, worst, LIBRARY_TOLERANCE)
        }
    });
    Ok(checks)
}

/// Reason why the library returned no numbers.
enum Obstacle {
    NotRun(String),
    Failed(String),
}

impl From<String> for Obstacle {
    fn from(message: String) -> Self {
        Self::Failed(message)
    }
}

impl UnitSource {
    fn file(&self, name: &str) -> Option<&[u8]> {
        let file = self.files.iter().find(|(known, _)| known == name);
        file.map(|(_, contents)| &**contents)
    }

    /// Writes all files into a folder.
    fn unpack(&self, folder: &Path) -> Result<(), String> {
        for (name, contents) in &self.files {
            let parts: Vec<&str> = name.split('/').collect();
            let is_inside = parts.iter().all(|part| !matches!(*part, "" | "." | ".."));
            if !is_inside || name.contains('\\') || name.contains(':') {
                return Err(format!(
                    "the FMU contains a file `{name}` outside of its folder"
                ));
            }
            let path = folder.join(name);
            let parent = path.parent().unwrap_or(folder);
            let written =
                std::fs::create_dir_all(parent).and_then(|()| std::fs::write(&path, contents));
            written.map_err(|error| format!("{}: {error}", path.display()))?;
        }
        Ok(())
    }

    /// Returns the path of the library for this platform.
    fn find_library(&self, version: u8, identifier: &str) -> Option<PathBuf> {
        let system = match OS {
            "macos" => "darwin",
            system => system,
        };
        let folder = match (version, ARCH) {
            (2, "x86_64") => format!("{}64", system.trim_end_matches("dows")),
            (2, "x86") => format!("{}32", system.trim_end_matches("dows")),
            _ => format!("{ARCH}-{system}"),
        };
        let suffix = std::env::consts::DLL_SUFFIX;
        let path = format!("binaries/{folder}/{identifier}{suffix}");
        self.file(&path).map(|_| PathBuf::from(path))
    }
}

/// Returns the default parameters, and parameter sets close to them within the ranges.
fn parameter_sets(model: &Model, program: &Program) -> Vec<Vec<f64>> {
    let mut random = Random::new(SEED);
    let defaults = program.default_parameters();
    let mut changed = Vec::new();
    let mut settings = Vec::new();
    for (own, value) in program.parameters.iter().zip(&defaults) {
        let name = &*own.quantity.name;
        let known = model.parameters.iter().find(|known| known.name == name);
        let low = known
            .and_then(|known| known.min)
            .unwrap_or(f64::NEG_INFINITY);
        let high = known.and_then(|known| known.max).unwrap_or(f64::INFINITY);
        let other = (value * (1.0 + CHANGE * random.away_from_zero()))
            .max(low)
            .min(high);
        settings.extend(known.map(|known| (name, known.unit.from_si(other))));
        changed.push(other);
    }
    match model.with_parameters(&settings) {
        Ok(_) => vec![defaults, changed],
        Err(_) => vec![defaults],
    }
}

/// Returns the lines of bits that the library prints: rates and observables.
fn run_library(
    unit: &UnitSource,
    (model, description): (&Model, &Description),
    variables: &Variables,
    (samples, parameters): (&[Sample], &[Vec<f64>]),
) -> Result<String, Obstacle> {
    let version = description.version();
    let version =
        version.ok_or_else(|| "modelDescription.xml has no known fmiVersion".to_owned())?;
    let exchange = description.identifiers.get("ModelExchange");
    let identifier = exchange.or(description.identifiers.get("CoSimulation"));
    let identifier =
        identifier.ok_or_else(|| "modelDescription.xml has no modelIdentifier".to_owned())?;
    let library = unit.find_library(version, identifier).ok_or_else(|| {
        Obstacle::NotRun("the FMU contains no library for this platform".to_owned())
    })?;
    let folder = tempfile::tempdir()
        .map_err(|error| Obstacle::NotRun(format!("cannot create a temporary folder: {error}")))?;
    let folder = folder.path();
    unit.compiler.probe(folder).map_err(Obstacle::NotRun)?;
    let inside = folder.join("unit");
    unit.unpack(&inside)?;
    let references = |groups: [&[Variable]; 3]| {
        let all = groups.into_iter().flatten().map(|variable| {
            let found = description.reference(&variable.name);
            found.ok_or_else(|| format!("{} has no value reference", variable.name))
        });
        let all: Result<Vec<String>, String> = all.map(|r| r.map(|r| format!("{r}, "))).collect();
        all.map(|all| all.concat())
    };
    let given = references([&variables.parameters, &variables.states, &variables.inputs])?;
    let asked = references([&variables.rates, &variables.observables, &[]])?;
    let harness = include_str!("../harness/unit.c")
        .replace("/*BITS*/", &BITS.replace("NAME_real", "double"))
        .replace("/*GIVEN*/", &given)
        .replace("/*ASKED*/", &asked);
    write(&folder.join("client.c"), &harness)?;
    let defines = [
        format!("-DVERSION={version}"),
        format!("-DEXCHANGE={}", u8::from(exchange.is_some())),
    ];
    let mut arguments: Vec<&str> = defines.iter().map(String::as_str).collect();
    arguments.extend(["-o", "client", "client.c"]);
    if OS == "linux" {
        arguments.push("-ldl");
    }
    let compiled = unit.compiler.compile(folder, &arguments)?;
    require_success("the program that loads the library", compiled).map_err(Obstacle::NotRun)?;
    let resources = inside.join("resources");
    let resources = match version {
        2 => format!("file://{}", resources.display()),
        _ => format!("{}/", resources.display()),
    };
    let mut input = String::new();
    for set in parameters {
        for sample in samples {
            let inputs = sample.inputs.iter().enumerate();
            let free = inputs.filter(|(place, _)| !model.is_controlled(*place));
            let inputs: Vec<f64> = free.map(|(_, value)| *value).collect();
            let numbers = [&[sample.time], &**set, &sample.state, &inputs].concat();
            input += &(format_bits(&numbers) + "\n");
        }
    }
    let token = description.token().unwrap_or_default();
    let mut command = Command::new(folder.join("client"));
    let command = command.arg(inside.join(library)).arg(token).arg(resources);
    Ok(require_success("the FMU's library", run(command, &input)?)?)
}

fn compare_numbers(
    program: &Program,
    (samples, parameters): (&[Sample], &[Vec<f64>]),
    lines: &str,
) -> Worst {
    let mut evaluator = Evaluator::new(program.clone());
    let (states, observables) = (program.states(), program.observables.len());
    let mut worst = Worst::default();
    let mut lines = lines.lines();
    let mut count = 0;
    for set in parameters {
        evaluator.prepare(set);
        for sample in samples {
            count += 1;
            let point = Point {
                t: sample.time,
                state: &sample.state,
                inputs: &sample.inputs,
            };
            let mut rates = vec![f64::NAN; states];
            evaluator.rates(point, &mut rates);
            let mut values = vec![f64::NAN; program.observable_values.len()];
            evaluator.observables(point, &mut values);
            let words = lines.next().unwrap_or_default().split(' ');
            let words = words.filter_map(|word| u64::from_str_radix(word, 16).ok());
            let found: Vec<f64> = words.map(f64::from_bits).collect();
            let place = format!("state {count}");
            let Some((found_rates, found_values)) = found.split_at_checked(states) else {
                return Worst::from_deviation(f64::INFINITY, format!("no numbers at {place}"));
            };
            let of_rates = deviation(found_rates, &rates);
            let of_values = deviation(found_values, &values[..observables]);
            worst.include(Worst::from_deviation(of_rates, format!("rates at {place}")));
            worst.include(Worst::from_deviation(
                of_values,
                format!("observables at {place}"),
            ));
        }
    }
    worst.with_count(count, "states")
}

/// Returns the largest difference relative to the largest number.
fn deviation(found: &[f64], expected: &[f64]) -> f64 {
    if found.len() != expected.len() {
        return f64::INFINITY;
    }
    let scale = expected
        .iter()
        .fold(0.0, |scale: f64, number| scale.max(number.abs()));
    let pairs = found
        .iter()
        .zip(expected)
        .filter(|(found, expected)| found != expected);
    let mut worst = 0.0;
    for (found, expected) in pairs {
        let difference = (found - expected).abs() / scale;
        if difference.is_nan() {
            return f64::INFINITY;
        }
        worst = difference.max(worst);
    }
    worst
}
