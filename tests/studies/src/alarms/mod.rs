//! Study `alarms`: relative frequency of gaps reported by `compare`, for records of a correct model and for records of
//! a machine with dry friction that the model lacks.
//!
//! The machines are those of the study `coverage`, and machines with nonlinear sensors and short windows. The program
//! simulates the records, with parameters and sensors drawn from their priors.

mod machines;

use std::fmt::Write as _;

use eomgen_compiled_model::{CompiledModel, Orders};
use eomgen_discover::fit::noise_floor::compute_noise_floor;
use eomgen_discover::fit::null_model::fit_null_model;
use eomgen_discover::model::problem::EstimationProblem;
use eomgen_records::read_dataset;
use rayon::prelude::*;

use crate::coverage::binomial::{at_least, at_most};
use crate::coverage::machines::Machine;
use crate::coverage::records;
use crate::sample::Sample;
use machines::Case;

/// Accepted rate of false alarms.
const ACCEPTED: f64 = 0.02;

/// Minimum accepted rate of reported frictions.
const MIN_REPORTED: f64 = 0.98;

/// Significance level: probability that the study fails by chance.
const CHANCE: f64 = 1e-3;

/// Residual of one run in noise floors, the larger of the training and the test residual.
struct Run {
    residual: f64,
    has_gap: bool,
}

/// Runs the study and returns its summary. `scale` is the factor of the friction of each case.
///
/// # Errors
///
/// Returns a report of all failed runs, of a rate of false alarms above the accepted rate, and of frictions that were
/// not reported.
pub fn run(sample: &Sample, scale: f64) -> Result<String, String> {
    let mut summary = String::new();
    let (mut alarms, mut found, mut count) = (0, 0, 0);
    for (number, case) in machines::CASES.iter().enumerate() {
        let right = runs(case, number, 0.0, sample)?;
        let wrong = runs(case, number, scale * case.friction, sample)?;
        let _ = writeln!(
            summary,
            "{}: {}; with friction {}",
            case.machine.name,
            describe(&right),
            describe(&wrong)
        );
        alarms += reported(&right);
        found += reported(&wrong);
        count += right.len();
    }
    let _ = write!(
        summary,
        "{alarms} false alarms in {count} runs, {found} frictions reported in {count} runs"
    );
    let is_missed = at_most(found, count, MIN_REPORTED) < CHANCE && scale >= 1.0;
    match at_least(alarms, count, ACCEPTED) < CHANCE || is_missed {
        false => Ok(summary),
        true => Err(summary),
    }
}

fn reported(runs: &[Run]) -> usize {
    runs.iter().filter(|run| run.has_gap).count()
}

fn describe(runs: &[Run]) -> String {
    let residuals = || runs.iter().map(|run| run.residual);
    format!(
        "{} of {} reported, mean residual {:.2} noise floors",
        reported(runs),
        runs.len(),
        residuals().sum::<f64>() / runs.len() as f64,
    )
}

/// Simulates records of a machine with this dry friction on its driven coordinate and compares them with the model.
fn runs(case: &Case, number: usize, friction: f64, sample: &Sample) -> Result<Vec<Run>, String> {
    let machine = case.machine;
    let text = match friction == 0.0 {
        true => machine.text,
        false => &add_friction(case, friction),
    };
    let model = CompiledModel::from_text(machine.name, text, Orders::Declared)
        .map_err(|error| format!("{}: {error}", machine.name))?;
    let of_run = |run: usize| {
        compare(machine, &model, (sample.seed, (run * 100 + number) as u64))
            .map_err(|error| format!("{}, run {run}: {error}", machine.name))
    };
    (0..sample.count).into_par_iter().map(of_run).collect()
}

fn add_friction(case: &Case, friction: f64) -> String {
    let (driven, unit) = (case.driven, case.machine.input.1);
    let parameter = format!("[parameters]\nF_f = {{ value = {friction}, unit = \"{unit}\" }}\n");
    let force = format!(
        "[forces]\nfriction_f = {{ on = \"{driven}\", value = \"-F_f*sign(dot({driven}))\" }}\n"
    );
    let text = case.machine.text.replace("[parameters]\n", &parameter);
    text.replace("[forces]\n", &force)
}

/// Draws true values, simulates records, and compares them with the model.
fn compare(machine: &Machine, model: &CompiledModel, seed: (u64, u64)) -> Result<Run, String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    records::write(machine, model, seed, folder.path())?;
    let dataset = read_dataset(&folder.path().join("dataset.toml"), model.model())
        .map_err(|error| error.to_string())?;
    let problem = EstimationProblem::new(&dataset, None, machine.name, machine.text);
    let fit = fit_null_model(&problem, machine.text).map_err(|error| error.to_string())?;
    let floor = compute_noise_floor(&problem, &fit, 1);
    Ok(Run {
        residual: fit.train.rms.max(fit.test.rms) / floor.rms,
        has_gap: !fit.is_at_floor(floor.rms),
    })
}
