//! Points, model, measures and job of a sweep, from the command line.

use eomgen_compiled_model::{CompiledModel, Orders};
use eomgen_model_spec::model::Model;
use eomgen_sweep::job::Plan;
use eomgen_sweep::over_time::measure_names;
use eomgen_sweep::parameters::columns;
use eomgen_sweep::{
    Axis, Grid, Job, Lyapunov, Measure, OverTime, Poincare, Points, Samples, Section, Span,
    SweepError, Window,
};

use crate::arguments::Sweep;
use crate::error::{Error, Result};
use crate::model::orders;
use crate::settings::warn_of_inputs;

/// Measures other than statistics over time.
const MEASURES: [&str; 3] = ["lyapunov", "poincare", "poincare:NAME"];

pub fn input_error(error: SweepError) -> Error {
    Error::input(error.to_string())
}

fn unknown_measure(name: &str) -> Error {
    let known = MEASURES
        .map(str::to_owned)
        .into_iter()
        .chain(measure_names());
    let known: Vec<String> = known.collect();
    Error::input(format!(
        "--measure {name}: unknown measure; expected one of {}",
        known.join(", ")
    ))
}

/// Returns the points of a model with parameters set.
pub fn points(options: &Sweep, declared: &Model, set: &[(&str, f64)]) -> Result<Points> {
    if let Some(count) = options.samples {
        let model = with_parameters(declared, set)?;
        let samples = Samples::new(&model, count, options.seed).map_err(input_error)?;
        return Ok(Points::Samples(samples));
    }
    let axes = options.vary.iter().map(|text| Axis::parse(text));
    let axes = axes.collect::<Result<Vec<_>, _>>().map_err(input_error)?;
    let grid = Grid::new(axes).map_err(input_error)?;
    if let Some((name, _)) = set
        .iter()
        .find(|(name, _)| grid.names().any(|varied| varied == *name))
    {
        return Err(Error::input(format!(
            "`{name}` is both set and varied; give only one of --set and --vary"
        )));
    }
    Ok(Points::Grid(grid))
}

/// Derives the model at the first point. All varied parameters are numbers there.
pub fn model(
    options: &Sweep,
    declared: &Model,
    points: &Points,
    set: &[(&str, f64)],
) -> Result<CompiledModel> {
    let at = |point: usize| {
        let settings = [set, &points.settings(point)].concat();
        with_parameters(declared, &settings)
    };
    // Bounds are intervals: if both ends of an axis are admissible, all values between them are.
    at(points.count() - 1)?;
    let first = at(0)?;
    warn_of_inputs(&first);
    let orders = orders(&first, options.model.order.text())?;
    Ok(CompiledModel::derive_without_inertia_check(
        first,
        Orders::PerField(&orders),
    )?)
}

fn with_parameters(model: &Model, settings: &[(&str, f64)]) -> Result<Model> {
    model
        .with_parameters(settings)
        .map_err(|error| Error::model(&model.source, error))
}

/// Returns the measures in the order of the command line.
pub fn measures<'a>(
    options: &Sweep,
    model: &'a CompiledModel,
    points: &Points,
) -> Result<Vec<Box<dyn Measure + 'a>>> {
    let lines = points.axes().iter().filter(|axis| axis.count > 1).count();
    let span = Span {
        transient: options.transient,
        periods: options.periods,
    };
    let forcing = options.frequency.clone();
    let section = match (&options.section, options.until) {
        (None, _) => Section::Forcing(forcing.clone()),
        (Some(event), Some(until)) => Section::Crossing {
            event: event.clone(),
            until,
        },
        (Some(event), None) => {
            return Err(Error::input(format!(
                "--section {event}: --until is missing: the time in s in which crossings are located"
            )));
        }
    };
    let window = match options.until {
        Some(end) => Window::Until(end),
        None => Window::Periods { forcing, span },
    };
    let measure = |name: &String| -> Result<Box<dyn Measure + 'a>> {
        if name == "lyapunov" {
            return Ok(Box::new(
                Lyapunov::new(model, &window).map_err(input_error)?,
            ));
        }
        if let Some(measure) = Poincare::new(model, name, &section, span, lines == 1) {
            return Ok(Box::new(measure.map_err(input_error)?));
        }
        let measure = OverTime::new(model, name, &window).ok_or_else(|| unknown_measure(name))?;
        Ok(Box::new(measure.map_err(input_error)?))
    };
    options.measure.iter().map(measure).collect()
}

pub fn job(
    compiled: &CompiledModel,
    points: &Points,
    set: &[(&str, f64)],
    measures: &[Box<dyn Measure + '_>],
) -> Result<Job> {
    let (model, orders) = (compiled.model(), compiled.orders());
    let plan = Plan::new(
        model.hash(),
        &model.name,
        orders,
        set,
        columns(model, points).map_err(input_error)?,
        points,
        measures.iter().map(|measure| measure.describe()).collect(),
    );
    Job::new(plan).map_err(input_error)
}
