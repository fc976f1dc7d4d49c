//! `eomgen simulate`: a trajectory as CSV or Parquet.

use eomgen_compiled_model::{
    CompiledModel, DEFAULT_TOLERANCE, ExpressionInputs, InputRole, InputTreatment, Motion, Request,
    split_assignments,
};
use eomgen_controller_library::{ControllerLibrary, LibraryError};
use eomgen_model_spec::assignment::Assignment;
use eomgen_sim::inputs::HeldInputs;
use serde_json::json;

use crate::arguments::{Simulate, Solver};
use crate::audit::AuditResult;
use crate::count::count;
use crate::document::SCHEMA;
use crate::error::{Error, Result, warn};
use crate::event_log;
use crate::history;
use crate::model::{derive, load, orders};
use crate::motion::{columns, describe_work, follow, follow_with, table};
use crate::operating_point::initial_state;
use crate::output::Destination;
use crate::ranges::warn_of_ranges;
use crate::samples::{check_size, inputs, times};
use crate::settings::{as_borrowed, settings, with_settings};
use crate::table::Table;

pub fn run(options: &Simulate) -> Result {
    let destination = Destination::for_table(&options.out, options.output.json)?;
    let figure = options
        .plot
        .as_deref()
        .map(|plot| Destination::for_figure(plot, Some(&options.out), options.output.json));
    let figure = figure.transpose()?;
    let log = event_log_destination(options)?;
    let (compiled, inputs, mut library) = driven_model(options)?;
    let times = times(options, &inputs)?;
    if options.integration.solver == Solver::Exact && options.integration.tolerance.is_some() {
        warn("warning: --tolerance has no effect on the exact solver: only rounding limits it");
    }
    if options.integration.solver == Solver::Exact && options.integration.max_step.is_some() {
        warn(
            "warning: --max-step has no effect on the exact solver, which locates every change of an input",
        );
    }
    if options.integration.solver == Solver::Fixed && options.integration.tolerance.is_some() {
        warn("warning: --tolerance has no effect on the solver fixed: --step limits its error");
    }
    let tolerance = options.integration.tolerance.unwrap_or(DEFAULT_TOLERANCE);
    let run = compiled.with_declared_parameters()?;
    check_size(times.len(), columns(&run).len())?;
    let initial = initial_state(&run, &options.initial.state)?;
    let request = Request {
        initial: &initial,
        times: &times,
        inputs: &inputs,
        solver: options.integration.solver.into(),
        tolerance,
        max_step: options.integration.max_step.unwrap_or(f64::INFINITY),
        audit: true,
    };
    let motion = match &mut library {
        Some(library) => follow_with(&run, &request, library)?,
        None => follow(&run, &request)?,
    };
    warn_of_ranges(compiled.model(), &motion.trajectory, &inputs)?;
    if let Some(found) = run.find_unresolved_integral(&motion)? {
        warn(&format!("warning: {}", found.warning_message()));
    }
    let audited = AuditResult::new(&run, &motion, tolerance)?;
    audited.warn();
    let table = table(&run, &motion)?;
    destination.write(&table.encode(&options.out)?)?;
    if let Some(log) = log {
        log.write(&event_log::encode(&run, &motion)?)?;
    }
    if let Some(figure) = figure {
        figure.write(history::figure(&compiled, &table)?.as_bytes())?;
    }
    destination.summarise(&summary(options, &table, &motion, &audited))?;
    let is_finite = report_not_finite(&table, &compiled.state_names());
    match &motion.early_stop {
        Some(stopped) => {
            warn(&format!("error: {}", stopped.reason));
            Err(Error::Failed)
        }
        None if !is_finite || (options.strict && audited.has_failed()) => Err(Error::Failed),
        None => Ok(()),
    }
}

/// Returns the destination of the event log.
fn event_log_destination(options: &Simulate) -> Result<Option<Destination>> {
    let Some(path) = &options.events else {
        return Ok(None);
    };
    let mut others = vec![("--out", options.out.as_path())];
    others.extend(options.plot.as_deref().map(|plot| ("--plot", plot)));
    Destination::for_events(path, &others).map(Some)
}

/// Returns the compiled model, its inputs, and the library of `--controller`.
fn driven_model(
    options: &Simulate,
) -> Result<(CompiledModel, HeldInputs, Option<ControllerLibrary>)> {
    let declared = load(&options.model.spec)?.model;
    // Controllers measure inputs, and fixed steps hold inputs. In both cases, expressions of `--input` must not replace
    // the inputs.
    let is_controlled = !declared.controllers.is_empty() || options.controller.is_some();
    let role = match options.integration.solver {
        Solver::Fixed => Some(InputRole::Held),
        _ => is_controlled.then_some(InputRole::Measured),
    };
    let may_hold = options.inputs.record.is_none();
    let prescribed = split_assignments("--input", &options.inputs.input)?;
    let settings = settings(&declared, &options.parameters.set)?;
    let settings = as_borrowed(&settings);
    let treatment = InputTreatment { role, may_hold };
    let (compiled, given) = ExpressionInputs::derive(
        declared,
        &prescribed,
        (treatment, &settings),
        |model| -> Result<CompiledModel> {
            let model = with_settings(model, &options.parameters.set)?;
            let orders = orders(&model, options.model.order.text())?;
            derive(model, &orders)
        },
    )?;
    let library = open_library(options, &compiled, &prescribed)?;
    let controlled = library.iter().flat_map(ControllerLibrary::inputs);
    let mut driven: Vec<&str> = controlled.map(String::as_str).collect();
    driven.extend(prescribed.iter().map(Assignment::name));
    let others = || inputs(options, compiled.model(), &driven);
    let inputs = given.at(&settings, others)?;
    Ok((compiled, inputs, library))
}

/// Opens the library of `--controller`.
fn open_library(
    options: &Simulate,
    compiled: &CompiledModel,
    prescribed: &[Assignment],
) -> Result<Option<ControllerLibrary>> {
    let Some(path) = &options.controller else {
        return Ok(None);
    };
    let refused = |error: LibraryError| Error::input(format!("--controller {error}"));
    let library = ControllerLibrary::open(path, compiled).map_err(refused)?;
    let mut twice = library.inputs().iter();
    match twice.find(|name| prescribed.iter().any(|given| given.name() == **name)) {
        None => Ok(Some(library)),
        Some(name) => Err(Error::input(format!(
            "--controller {}: the controller drives the input `{name}`, which --input also sets",
            path.display()
        ))),
    }
}

/// Reports columns with numbers that are not finite. Returns true if the states and the energy are finite. Observables
/// may be undefined in some states.
fn report_not_finite(table: &Table, states: &[String]) -> bool {
    let times = table.column("t").unwrap_or_default();
    let mut is_motion_finite = true;
    for (name, first, count) in table.not_finite() {
        let is_of_motion = name == "energy" || states.iter().any(|state| state == name);
        is_motion_finite &= !is_of_motion;
        let kind = if is_of_motion { "error" } else { "warning" };
        let (rows, t) = (table.rows(), times.get(first).copied().unwrap_or_default());
        warn(&format!(
            "{kind}: `{name}` is not finite in {count} of {rows} rows, first at t = {t} s: a function left its \
             domain or a number overflows there; check inputs, parameters and initial states"
        ));
    }
    is_motion_finite
}

fn summary(
    options: &Simulate,
    table: &Table,
    motion: &Motion,
    audited: &AuditResult<'_>,
) -> String {
    let file = options.out.display().to_string();
    let (rows, switches) = (table.rows(), motion.trajectory.events.len());
    let work = motion.trajectory.statistics;
    if options.output.json {
        let document = json!({
            "schema": SCHEMA,
            "file": file,
            "solver": motion.solver.name(),
            "rows": rows,
            "switches": switches,
            "steps": work.steps,
            "rejected": work.rejected_steps,
            "evaluations": work.evaluations,
            "stopped": motion.early_stop.as_ref().map(|stopped| json!({
                "t": stopped.t,
                "reason": stopped.reason,
            })),
            "energy_audit": audited.json(),
        });
        return format!("{document:#}\n");
    }
    let how = describe_work(motion);
    let place = match file.as_str() {
        "-" => "stdout",
        file => file,
    };
    format!(
        "{place}: {}, {}, {how}\n",
        count(rows, "row"),
        count(switches, "switch")
    )
}
