//! `eomgen sweep`: something measured over a grid of parameters, in parallel and in parts.

use eomgen_compiled_model::{CompiledModel, Orders};
use eomgen_sweep::job::Plan;
use eomgen_sweep::parameters::columns;
use eomgen_sweep::{Axis, Folder, Grid, Job, Lyapunov, Measure, Poincare, Shard, Span, SweepError};
use model_spec::model::Model;
use serde_json::{Value, json};

use super::merge::finish;
use super::simulate::{setting, warn_of_inputs};
use crate::arguments::Sweep;
use crate::model::{load, orders};
use crate::problem::{Outcome, Problem, say};
use crate::progress::Bar;

/// What can be measured.
const MEASURES: [&str; 2] = ["lyapunov", "poincare"];

/// Runs the command.
pub fn run(options: &Sweep) -> Outcome {
    check_measures(&options.measure)?;
    let shard = options
        .shard
        .as_deref()
        .map_or(Ok(Shard::WHOLE), Shard::parse);
    let shard = shard.map_err(refused)?;
    let grid = grid(options)?;
    let set = options
        .set
        .iter()
        .map(|assignment| setting(assignment))
        .collect::<Outcome<Vec<_>>>()?;
    let model = model(options, &grid, &set)?;
    let measures = measures(options, &model, &grid)?;
    let job = job(&model, &grid, &set, &measures)?;
    let folder = Folder::open(&options.out, job).map_err(refused)?;
    let mut bar = None;
    let mut progress = |computed: usize, whole: usize| {
        let bar = bar.get_or_insert_with(|| Bar::new("sweeping", whole as f64, "points"));
        bar.set(computed as f64);
    };
    let threads = options.threads.map_or(0, usize::from);
    let done =
        eomgen_sweep::run(&folder, &measures, shard, threads, &mut progress).map_err(refused)?;
    drop(bar);
    let counts = json!({ "computed": done.computed, "found": done.found });
    let summary = format!(
        "{} points computed, {} were there\n",
        done.computed, done.found
    );
    if !shard.is_whole() {
        let document = json!({ "shard": shard.to_string() });
        let hint = format!(
            "{summary}shard {shard} is complete; after the others: eomgen merge {}\n",
            options.out.display()
        );
        return end(options, counts, document, &hint);
    }
    let finished = finish(&folder)?;
    end(
        options,
        counts,
        finished.json(),
        &(summary + &finished.text()),
    )
}

/// Says what was done.
fn end(options: &Sweep, mut counts: Value, document: Value, text: &str) -> Outcome {
    if !options.json {
        return say(text);
    }
    if let (Value::Object(all), Value::Object(more)) = (&mut counts, document) {
        all.extend(more);
    }
    say(&format!("{counts:#}\n"))
}

fn refused(error: SweepError) -> Problem {
    Problem::input(error.to_string())
}

/// Refuses measures that do not exist.
fn check_measures(names: &[String]) -> Outcome {
    match names.iter().find(|name| !MEASURES.contains(&name.as_str())) {
        None => Ok(()),
        Some(unknown) => Err(Problem::input(format!(
            "--measure {unknown}: unknown measure; there is {}",
            MEASURES.join(" and ")
        ))),
    }
}

fn grid(options: &Sweep) -> Outcome<Grid> {
    let axes = options.vary.iter().map(|text| Axis::parse(text));
    let axes = axes.collect::<Result<Vec<_>, _>>().map_err(refused)?;
    Grid::new(axes).map_err(refused)
}

/// The model derived at the grid's first point, where all varied parameters are numbers.
fn model(options: &Sweep, grid: &Grid, set: &[(&str, f64)]) -> Outcome<CompiledModel> {
    if let Some((name, _)) = set
        .iter()
        .find(|(name, _)| grid.names().any(|varied| varied == *name))
    {
        return Err(Problem::input(format!(
            "`{name}` is both set and varied; give one of --set and --vary"
        )));
    }
    let model = load(&options.spec)?.model;
    let at = |point: usize| {
        let settings = [set, &grid.settings(point)].concat();
        with_parameters(&model, &settings)
    };
    // Bounds are intervals: what both ends of the ranges admit, all between admit.
    at(grid.points() - 1)?;
    let first = at(0)?;
    warn_of_inputs(&first);
    let orders = orders(&first, options.order.as_deref())?;
    Ok(CompiledModel::derive_unjudged(
        first,
        Orders::Each(&orders),
    )?)
}

fn with_parameters(model: &Model, settings: &[(&str, f64)]) -> Outcome<Model> {
    model
        .with_parameters(settings)
        .map_err(|error| Problem::model(&model.source, error))
}

/// What is asked for, in the order of the command line.
fn measures<'a>(
    options: &Sweep,
    model: &'a CompiledModel,
    grid: &Grid,
) -> Outcome<Vec<Box<dyn Measure + 'a>>> {
    let lines = grid.axes().iter().filter(|axis| axis.count > 1).count();
    let span = Span {
        transient: options.transient,
        periods: options.periods,
    };
    let frequency = &options.frequency;
    let measure = |name: &String| -> Outcome<Box<dyn Measure + 'a>> {
        Ok(match name.as_str() {
            "lyapunov" => Box::new(Lyapunov::new(model, frequency, span).map_err(refused)?),
            _ => Box::new(Poincare::new(model, frequency, span, lines == 1).map_err(refused)?),
        })
    };
    options.measure.iter().map(measure).collect()
}

fn job(
    compiled: &CompiledModel,
    grid: &Grid,
    set: &[(&str, f64)],
    measures: &[Box<dyn Measure + '_>],
) -> Outcome<Job> {
    let (model, orders) = (compiled.model(), compiled.orders());
    let plan = Plan::new(
        &model.source,
        &model.name,
        orders,
        set,
        columns(model, grid).map_err(refused)?,
        grid,
        measures.iter().map(|measure| measure.describe()).collect(),
    );
    Job::new(plan).map_err(refused)
}
