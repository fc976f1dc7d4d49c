//! `eomgen simulate`: a trajectory as a table, CSV or Parquet.

use codegen::evaluator::Evaluator;
use model_spec::model::Model;
use serde_json::json;
use sim::derived::Driven;
use sim::record::{HeldInputs, read_inputs};
use sim::solve::{Settings, SolveError, Trajectory, simulate};

use crate::arguments::{Simulate, Solver};
use crate::output::{file_place, write_file};
use crate::problem::{Outcome, Problem, say, warn};
use crate::progress::Bar;
use crate::table::Table;
use crate::variant::{derive_variant, load, orders};

/// The most numbers written, rows times columns: a few GB of memory.
const MOST_NUMBERS: f64 = 1e8;

/// Rows where nothing is said about them.
const DEFAULT_ROWS: f64 = 1000.0;

/// Runs the command.
pub fn run(options: &Simulate) -> Outcome {
    let (Solver::Auto | Solver::Rk) = options.solver;
    file_place(&options.out)?;
    let model = with_settings(load(&options.spec)?.model, &options.set)?;
    let orders = orders(&model, options.order.as_deref())?;
    let variant = derive_variant(model, &orders)?;
    let inputs = inputs(options, &variant.model)?;
    let span = span(options, &inputs)?;
    let times = match options.sample {
        None if options.record.is_some() => record_times(&inputs, span)?,
        step => even_times(span, step)?,
    };
    let run = Run::new(&variant.model, variant.evaluator(), inputs)?;
    check_size(times.len(), run.columns.len())?;
    let trajectory = run.trajectory(&times, options.tolerance)?;
    let table = run.table(&trajectory);
    write_file(&options.out, &table.encode(&options.out)?)?;
    if options.json {
        let work = trajectory.work;
        let document = json!({
            "file": options.out.display().to_string(),
            "rows": table.rows(),
            "switches": trajectory.switches.len(),
            "steps": work.steps,
            "rejected": work.rejected,
            "evaluations": work.evaluations,
        });
        return say(&format!("{document:#}\n"));
    }
    say(&format!(
        "{}: {} rows, {} switches, {} evaluations of the right-hand side\n",
        options.out.display(),
        table.rows(),
        trajectory.switches.len(),
        trajectory.work.evaluations
    ))
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
fn setting(assignment: &str) -> Outcome<(&str, f64)> {
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
                read_inputs(dataset, &options.record_name, model).map_err(Problem::input)?;
            for warning in warnings {
                warn(&format!("warning: {warning}"));
            }
            Ok(inputs)
        }
        None => {
            for input in &model.inputs {
                warn(&format!(
                    "warning: no record gives the input `{}`: it is 0",
                    input.name
                ));
            }
            Ok(HeldInputs::zero(model.inputs.len()))
        }
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

/// A model with its inputs, ready to be simulated.
pub struct Run {
    system: Driven,
    initial: Vec<f64>,
    columns: Vec<String>,
    observables: usize,
    /// What each switching function is.
    guards: Vec<String>,
}

impl Run {
    /// Takes an evaluator of the model's program.
    pub fn new(model: &Model, evaluator: Evaluator, inputs: HeldInputs) -> Outcome<Self> {
        let program = evaluator.program();
        let orders: Vec<usize> = program.fields.iter().map(|field| field.order).collect();
        let initial = model
            .initial_state(&orders)
            .map_err(|error| Problem::model(&model.source, error))?;
        let mut columns = vec!["t".to_owned()];
        columns.extend(program.state_names());
        columns.extend(program.observables.iter().map(|o| o.name.clone()));
        let observables = program.observables.len();
        let guards = program.guards.iter().flat_map(|guard| {
            let count = program.value(guard.value).extent.length();
            std::iter::repeat_n(guard.formula.clone(), count)
        });
        let guards = guards.collect();
        let system = Driven::new(evaluator, inputs).map_err(Problem::input)?;
        Ok(Self {
            system,
            initial,
            columns,
            observables,
            guards,
        })
    }

    /// The states at the given times, with a progress bar for a run that takes long.
    pub fn trajectory(&self, times: &[f64], tolerance: f64) -> Outcome<Trajectory> {
        let (start, end) = (times[0], times[times.len() - 1]);
        let settings = Settings::with_tolerance(tolerance);
        let bar = Bar::new("simulating", end - start, "s");
        let mut progress = |t: f64| bar.set(t - start);
        simulate(
            &self.system,
            &self.initial,
            (start, end),
            times,
            &settings,
            &mut progress,
        )
        .map_err(|error| Problem::input(format!("{error}{}", self.culprit(&error))))
    }

    /// The name of what an error gives by number.
    fn culprit(&self, error: &SolveError) -> String {
        match *error {
            SolveError::NotFinite { state, .. } => {
                let name = self.columns.get(1 + state).map_or("", String::as_str);
                format!("; that is {name}")
            }
            SolveError::Caught { guard, .. } | SolveError::TooManySwitches { guard, .. } => {
                let formula = self.guards.get(guard).map_or("", String::as_str);
                format!("; that is {formula}")
            }
            _ => String::new(),
        }
    }

    /// Time, state and observables of every sample.
    pub fn table(&self, trajectory: &Trajectory) -> Table {
        let mut table = Table::new(self.columns.clone());
        let mut observables = vec![0.0; self.observables];
        let mut row = Vec::with_capacity(self.columns.len());
        for (t, state) in trajectory.times.iter().zip(&trajectory.states) {
            self.system.observables(*t, state, &mut observables);
            row.clear();
            row.push(*t);
            row.extend_from_slice(state);
            row.extend_from_slice(&observables);
            table.push(&row);
        }
        table
    }
}
