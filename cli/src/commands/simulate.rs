//! `eomgen simulate`: a trajectory as a table, CSV or Parquet.

use std::path::Path;

use codegen::evaluator::Evaluator;
use model_spec::model::Model;
use serde_json::json;
use sim::derived::Driven;
use sim::record::{HeldInputs, read_inputs};
use sim::solve::{Settings, Trajectory, simulate};

use crate::arguments::{Simulate, Solver};
use crate::output::write_file;
use crate::problem::{Outcome, Problem, say};
use crate::progress::Bar;
use crate::table::Table;
use crate::variant::{derive_variant, load, orders};

/// The most rows written.
const MOST_ROWS: f64 = 2e7;

/// Rows where nothing is said about them.
const DEFAULT_ROWS: f64 = 1000.0;

/// Runs the command.
pub fn run(options: &Simulate) -> Outcome {
    let (Solver::Auto | Solver::Rk) = options.solver;
    let mut model = load(&options.spec)?.model;
    for assignment in &options.set {
        model = set_parameter(&model, assignment)?;
    }
    let orders = orders(&model, options.order.as_deref())?;
    let variant = derive_variant(model, &orders)?;
    let inputs = inputs(options, &variant.model)?;
    let times = sample_times(options, &inputs)?;
    let run = Run::new(&variant.model, variant.evaluator(), inputs)?;
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

/// `NAME=VALUE`, the value in the unit the specification declares.
fn set_parameter(model: &Model, assignment: &str) -> Outcome<Model> {
    let (name, value) = assignment.split_once('=').ok_or_else(|| {
        Problem::input(format!("--set {assignment}: expected NAME=VALUE, such as b_sp=25e-6"))
    })?;
    let number: f64 = value.trim().parse().map_err(|_| {
        Problem::input(format!("--set {assignment}: \"{value}\" is no number"))
    })?;
    model
        .with_parameter(name.trim(), number)
        .map_err(|error| Problem::model(&model.source, error))
}

fn inputs(options: &Simulate, model: &Model) -> Outcome<HeldInputs> {
    match &options.record {
        Some(dataset) => {
            let (inputs, warnings) =
                read_inputs(dataset, &options.record_name, model).map_err(Problem::input)?;
            for warning in warnings {
                eprintln!("warning: {warning}");
            }
            Ok(inputs)
        }
        None => {
            for input in &model.inputs {
                eprintln!("warning: no record gives the input `{}`: it is 0", input.name);
            }
            Ok(HeldInputs::zero(model.inputs.len()))
        }
    }
}

/// The times of the rows, in s.
fn sample_times(options: &Simulate, inputs: &HeldInputs) -> Outcome<Vec<f64>> {
    let start = if options.record.is_some() { inputs.times()[0] } else { 0.0 };
    let end = match (options.until, options.record.is_some()) {
        (Some(until), _) => until,
        (None, true) => inputs.times()[inputs.times().len() - 1],
        (None, false) => return Err(Problem::input("--until is missing: the simulated time in s")),
    };
    if !(end.is_finite() && end > start) {
        return Err(Problem::input(format!("--until {end}: expected a time in s after {start}")));
    }
    if options.record.is_some() && options.sample.is_none() {
        return Ok(inputs.times().iter().copied().filter(|t| *t <= end).collect());
    }
    let step = options.sample.unwrap_or((end - start) / DEFAULT_ROWS);
    if !(step.is_finite() && step > 0.0) {
        return Err(Problem::input(format!("--sample {step}: expected a positive time in s")));
    }
    let rows = ((end - start) / step * (1.0 + 1e-12)).floor();
    if rows > MOST_ROWS {
        return Err(Problem::input(format!(
            "--sample {step} makes {rows:e} rows; the limit is {MOST_ROWS:e}"
        )));
    }
    Ok((0..=rows as usize)
        .map(|row| (start + row as f64 * step).min(end))
        .collect())
}

/// A model with its inputs, ready to be simulated.
pub struct Run {
    system: Driven,
    initial: Vec<f64>,
    columns: Vec<String>,
    observables: usize,
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
        let system = Driven::new(evaluator, inputs).map_err(Problem::input)?;
        Ok(Self {
            system,
            initial,
            columns,
            observables,
        })
    }

    /// The states at the given times, with a progress bar for a run that takes long.
    pub fn trajectory(&self, times: &[f64], tolerance: f64) -> Outcome<Trajectory> {
        let (start, end) = (times[0], times[times.len() - 1]);
        let settings = Settings::with_tolerance(tolerance);
        let bar = Bar::new("simulating", end - start, "s");
        let mut progress = |t: f64| bar.set(t - start);
        simulate(&self.system, &self.initial, (start, end), times, &settings, &mut progress)
            .map_err(|error| Problem::input(error.to_string()))
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

/// Whether a path asks for Parquet.
pub fn is_parquet(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("parquet"))
}
