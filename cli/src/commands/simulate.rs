//! `eomgen simulate`: a trajectory as a table, CSV or Parquet.

use eomgen_compiled_model::{DEFAULT_TOLERANCE, Motion, Request};
use eomgen_records::read_inputs;
use model_spec::model::Model;
use serde_json::json;
use sim::inputs::HeldInputs;

use crate::arguments::{Simulate, Solver};
use crate::model::{derive, load, orders};
use crate::motion::{columns, follow, in_words, table};
use crate::output::Destination;
use crate::problem::{Outcome, Problem, warn};
use crate::ranges::warn_of_ranges;
use crate::table::Table;

/// The most numbers written, rows times columns: a few GB of memory.
const MOST_NUMBERS: f64 = 1e8;

/// Rows where nothing is said about them.
const DEFAULT_ROWS: f64 = 1000.0;

/// Runs the command.
pub fn run(options: &Simulate) -> Outcome {
    let destination = Destination::of(&options.out, options.json)?;
    let model = with_settings(load(&options.spec)?.model, &options.set)?;
    let orders = orders(&model, options.order.as_deref())?;
    let compiled = derive(model, &orders)?;
    let inputs = inputs(options, compiled.model())?;
    let span = span(options, &inputs)?;
    let times = match options.sample {
        None if options.record.is_some() => record_times(&inputs, span)?,
        step => even_times(span, step)?,
    };
    if options.solver == Solver::Exact && options.tolerance.is_some() {
        warn("warning: --tolerance has no effect on the exact solver: only rounding limits it");
    }
    let run = compiled.at_declared()?;
    check_size(times.len(), columns(&run).len())?;
    let request = Request {
        initial: run.initial(),
        times: &times,
        inputs: &inputs,
        solver: options.solver.into(),
        tolerance: options.tolerance.unwrap_or(DEFAULT_TOLERANCE),
    };
    let motion = follow(&run, &request)?;
    warn_of_ranges(compiled.model(), &motion.trajectory, &inputs)?;
    let table = table(&run, &motion)?;
    destination.write(&table.encode(&options.out)?)?;
    destination.summarise(&summary(options, &table, &motion))?;
    match &motion.stopped {
        Some(stopped) => {
            warn(&format!("error: {}", stopped.reason));
            Err(Problem::Failed)
        }
        None => Ok(()),
    }
}

/// What is said at the end.
fn summary(options: &Simulate, table: &Table, motion: &Motion) -> String {
    let file = options.out.display();
    let (rows, switches) = (table.rows(), motion.trajectory.switches.len());
    let work = motion.trajectory.work;
    if options.json {
        let document = json!({
            "file": file.to_string(),
            "solver": motion.solver.name(),
            "rows": rows,
            "switches": switches,
            "steps": work.steps,
            "rejected": work.rejected,
            "evaluations": work.evaluations,
            "stopped": motion.stopped.as_ref().map(|stopped| json!({
                "t": stopped.t,
                "reason": stopped.reason,
            })),
        });
        return format!("{document:#}\n");
    }
    let how = in_words(motion);
    format!("{file}: {rows} rows, {switches} switches, {how}\n")
}

/// The model with every `NAME=VALUE`, values in the units that the specification declares.
fn with_settings(model: Model, assignments: &[String]) -> Outcome<Model> {
    let settings = assignments
        .iter()
        .map(|assignment| setting(assignment))
        .collect::<Outcome<Vec<_>>>()?;
    model
        .with_parameters(&settings)
        .map_err(|error| Problem::model(&model.source, error))
}

/// The parts of `NAME=VALUE`.
pub fn setting(assignment: &str) -> Outcome<(&str, f64)> {
    let (name, value) = assignment.split_once('=').ok_or_else(|| {
        Problem::input(format!(
            "--set {assignment}: expected NAME=VALUE, such as b_sp=25e-6"
        ))
    })?;
    let number: f64 = value
        .trim()
        .parse()
        .map_err(|_| Problem::input(format!("--set {assignment}: \"{value}\" is no number")))?;
    Ok((name.trim(), number))
}

fn inputs(options: &Simulate, model: &Model) -> Outcome<HeldInputs> {
    match &options.record {
        Some(dataset) => {
            let (inputs, warnings) =
                read_inputs(dataset, &options.record_name, model).map_err(Problem::records)?;
            for warning in warnings {
                warn(&format!("warning: {warning}"));
            }
            Ok(inputs)
        }
        None => {
            warn_of_inputs(model);
            Ok(HeldInputs::zero(model.inputs.len()))
        }
    }
}

/// Says which inputs are 0 where there is no record.
pub fn warn_of_inputs(model: &Model) {
    for input in &model.inputs {
        warn(&format!(
            "warning: no record gives the input `{}`: it is 0",
            input.name
        ));
    }
}

/// Begin and end of the simulation, in s.
fn span(options: &Simulate, inputs: &HeldInputs) -> Outcome<(f64, f64)> {
    let recorded = options.record.as_ref().map(|_| inputs.times());
    let start = recorded
        .and_then(|times| times.first())
        .copied()
        .unwrap_or(0.0);
    let end = options
        .until
        .or_else(|| recorded.and_then(|times| times.last()).copied());
    let end = end.ok_or_else(|| Problem::input("--until is missing: the simulated time in s"))?;
    if end.is_finite() && end > start {
        return Ok((start, end));
    }
    Err(Problem::input(format!(
        "--until {end:?}: expected a time in s after {start:?}"
    )))
}

/// The record's times up to the end.
fn record_times(inputs: &HeldInputs, (_, end): (f64, f64)) -> Outcome<Vec<f64>> {
    let times: Vec<f64> = inputs
        .times()
        .iter()
        .copied()
        .take_while(|t| *t <= end)
        .collect();
    let last = inputs.times().last().copied().unwrap_or(end);
    if end > last {
        return Err(Problem::input(format!(
            "--until {end:?}: the record ends at {last:?} s; with --sample its last inputs hold on"
        )));
    }
    match times.len() {
        0 | 1 => Err(Problem::input(format!(
            "--until {end:?}: no second sample of the record by then; give a later time, or --sample"
        ))),
        _ => Ok(times),
    }
}

/// Times a step apart, in s; a thousandth of the whole where no step is given.
fn even_times((start, end): (f64, f64), step: Option<f64>) -> Outcome<Vec<f64>> {
    let whole = end - start;
    let step = step.unwrap_or(whole / DEFAULT_ROWS);
    if !(step > 0.0 && step <= whole) {
        return Err(Problem::input(format!(
            "--sample {step:?}: expected a time in s above 0 and at most {whole:?}"
        )));
    }
    let steps = (whole / step * (1.0 + 1e-12)).floor();
    check_size(steps.min(MOST_NUMBERS * 2.0) as usize, 1)?;
    Ok((0..=steps as usize)
        .map(|row| (start + row as f64 * step).min(end))
        .collect())
}

/// Refuses what would not fit into memory.
fn check_size(rows: usize, columns: usize) -> Outcome {
    let numbers = rows as f64 * columns as f64;
    if numbers <= MOST_NUMBERS {
        return Ok(());
    }
    Err(Problem::input(format!(
        "too many rows: the limit is {MOST_NUMBERS:e} numbers; give --sample a longer time"
    )))
}
