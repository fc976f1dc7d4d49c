//! Study `coverage`: share of runs in which the 90 % interval of a fitted parameter contains the true value.
//!
//! The program itself simulates the records. Each run draws the true parameters and sensors from
//! the priors declared in the dataset, so that the posterior interval contains the true value in 90
//! % of all runs. With fixed true values, an informative prior would change this. The records are
//! written to files, read as a dataset, and fitted as by `compare`.

pub(crate) mod binomial;
pub(crate) mod machines;
pub(crate) mod records;

use std::fmt::Write as _;

use eomgen_compiled_model::{CompiledModel, Orders};
use eomgen_discover::fit::null_model::fit_null_model;
use eomgen_discover::model::problem::EstimationProblem;
use eomgen_discover::model::unknowns::UnknownKind;
use eomgen_records::read_dataset;
use rayon::prelude::*;

use crate::sample::Sample;
use binomial::{at_least, at_most};
use machines::{MACHINES, Machine};

/// Half-width of a 90 % interval, in standard deviations.
const HALF_WIDTH: f64 = 1.645;

const ACCEPTED: [f64; 2] = [0.85, 0.95];

/// Maximum accepted bias, in standard deviations.
const ACCEPTED_BIAS: f64 = 0.15;

/// Maximum accepted deviation, in standard deviations. A normally distributed deviation exceeds it in one of two
/// million runs; a fit that stops far from its minimum exceeds it often.
const MAX_DEVIATION: f64 = 5.0;

/// Significance level: probability that a machine at the limit of the accepted range fails by chance.
const CHANCE: f64 = 1e-3;

/// Quantile of the normal distribution, in standard errors, for the probability [`CHANCE`].
const STANDARD_ERRORS: f64 = 3.09;

/// Runs the study on the machines whose name contains `name`, and returns its summary.
///
/// # Errors
///
/// Returns a report of all failed runs and of values outside the accepted range.
pub fn run(sample: &Sample, name: &str) -> Result<String, String> {
    let mut summary = String::new();
    let mut failures = String::new();
    let machines = MACHINES.iter().enumerate();
    for (number, machine) in machines.filter(|(_, machine)| machine.name.contains(name)) {
        let deviations = deviations(machine, number, sample)?;
        let (line, failed) = figures(machine, &deviations);
        let _ = writeln!(summary, "{line}");
        for failure in failed {
            let _ = writeln!(failures, "{failure}");
        }
    }
    match failures.is_empty() {
        true => Ok(summary),
        false => Err(summary + &failures),
    }
}

/// Returns, for each run, the deviation of each estimated parameter from its true value, in
/// standard deviations of the estimate.
fn deviations(machine: &Machine, number: usize, sample: &Sample) -> Result<Vec<Vec<f64>>, String> {
    let model = CompiledModel::from_text(machine.name, machine.text, Orders::Declared)
        .map_err(|error| format!("{}: {error}", machine.name))?;
    let of_run = |run: usize| {
        let stream = (run * MACHINES.len() + number) as u64;
        deviations_of_run(machine, &model, (sample.seed, stream))
            .map_err(|error| format!("{}, run {run}: {error}", machine.name))
    };
    let runs: Vec<Result<Vec<f64>, String>> =
        (0..sample.count).into_par_iter().map(of_run).collect();
    runs.into_iter().collect()
}

/// Draws true values and records, fits them, and returns the deviations.
fn deviations_of_run(
    machine: &Machine,
    model: &CompiledModel,
    seed: (u64, u64),
) -> Result<Vec<f64>, String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let truth = records::write(machine, model, seed, folder.path())?;
    let dataset = read_dataset(&folder.path().join("dataset.toml"), model.model())
        .map_err(|error| error.to_string())?;
    let problem = EstimationProblem::new(&dataset, None, machine.name, machine.text);
    let fit = fit_null_model(&problem, machine.text).map_err(|error| error.to_string())?;
    let of = |((name, _), truth): (&(&str, f64), f64)| {
        let mut unknowns = fit.unknowns();
        let id = unknowns.find_map(|(id, unknown)| match &unknown.kind {
            UnknownKind::Parameter(known) if known == name => Some(id),
            _ => None,
        });
        let id = id.ok_or_else(|| format!("`{name}` is not fitted"))?;
        Ok((fit.train.estimate.theta[id] - truth) / fit.sd[id])
    };
    machine.uncertain.iter().zip(truth).map(of).collect()
}

/// Returns a machine's line of the summary, and a list of the values outside the accepted range.
fn figures(machine: &Machine, deviations: &[Vec<f64>]) -> (String, Vec<String>) {
    let count = deviations.len();
    let mut line = format!("{}, {count} runs:", machine.name);
    let mut failed = Vec::new();
    for (place, (name, _)) in machine.uncertain.iter().enumerate() {
        let of_runs = || deviations.iter().map(|run| run[place]);
        let held = of_runs().filter(|d| d.abs() <= HALF_WIDTH).count();
        let coverage = held as f64 / count as f64;
        let error = (coverage * (1.0 - coverage) / count as f64).sqrt();
        let bias = of_runs().sum::<f64>() / count as f64;
        let largest = of_runs().map(f64::abs).fold(0.0, f64::max);
        let bias_error = 1.0 / (count as f64).sqrt();
        let _ = write!(
            line,
            "\n  {name}: {:.1} +- {:.1} % within the 90 % interval, mean bias {bias:+.2} +- {bias_error:.2} sd, largest deviation {largest:.1} sd",
            100.0 * coverage,
            100.0 * error,
        );
        let [low, high] = ACCEPTED;
        if at_most(held, count, low) < CHANCE || at_least(held, count, high) < CHANCE {
            failed.push(format!(
                "{}, `{name}`: the 90 % interval holds the truth in {held} of {count} runs",
                machine.name
            ));
        }
        if largest > MAX_DEVIATION {
            failed.push(format!(
                "{}, `{name}`: a run deviates by {largest:.1} sd",
                machine.name
            ));
        }
        if bias.abs() > ACCEPTED_BIAS + STANDARD_ERRORS * bias_error {
            failed.push(format!(
                "{}, `{name}`: biased by {bias:+.2} sd",
                machine.name
            ));
        }
    }
    (line, failed)
}
