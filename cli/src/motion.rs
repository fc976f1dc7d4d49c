//! Simulation with a progress bar, and the table of the result.

use eomgen_compiled_model::{
    FrictionChoice, InitialChange, Instance, Motion, Request, SampledController, Solver,
    SolverChoice,
};

use crate::count::count;
use crate::error::{Result, warn};
use crate::progress::Bar;
use crate::table::Table;

/// Simulates all requested times. Errors: a solver that stops before the end.
pub fn simulate(instance: &Instance<'_>, request: &Request<'_>) -> Result<Motion> {
    Ok(follow(instance, request)?.into_complete()?)
}

/// Simulates until the end or until the solver stops. Errors: a solver that stops at the start.
pub fn follow(instance: &Instance<'_>, request: &Request<'_>) -> Result<Motion> {
    let (begin, end) = request.time_span();
    let bar = Bar::new("simulating", end - begin, "s");
    let motion = instance.simulate_until_stop(request, &mut |t| bar.set(t - begin))?;
    note_choices(&motion);
    Ok(motion)
}

/// Simulates like [`follow`] with an additional controller.
pub fn follow_with(
    instance: &Instance<'_>,
    request: &Request<'_>,
    controller: &mut dyn SampledController,
) -> Result<Motion> {
    let (begin, end) = request.time_span();
    let bar = Bar::new("simulating", end - begin, "s");
    let mut declared = instance.controllers()?;
    let own = declared
        .iter_mut()
        .map(|own| own as &mut dyn SampledController);
    let mut all: Vec<&mut dyn SampledController> = own.collect();
    all.push(controller);
    let mut progress = |t: f64| bar.set(t - begin);
    let motion = instance.simulate_controlled(request, &mut all, &mut progress)?;
    note_choices(&motion);
    Ok(motion)
}

/// Prints notes about the choice of the solver and of the initial state.
fn note_choices(motion: &Motion) {
    if let Some(SolverChoice::NotSupportedByExact(reason)) = &motion.solver_choice {
        warn(&format!(
            "warning: solved with {} instead of the exact solver: {reason}",
            motion.solver
        ));
    }
    if let Some(SolverChoice::Stiff(reason)) = &motion.solver_choice {
        warn(&format!("note: solved with radau, because {reason}"));
    }
    note_moved("initial state", &motion.initial_changes);
    if let Some(text) = FrictionChoice::describe_all(&motion.friction_choices) {
        warn(&format!("note: {text}"));
    }
}

/// Prints a note about states that were changed to satisfy the constraints.
pub fn note_moved(what: &str, all: &[InitialChange]) {
    if let Some(text) = InitialChange::describe_all(what, all) {
        warn(&format!("note: {text}"));
    }
}

/// Describes the number of steps and evaluations of the solver.
pub fn describe_work(motion: &Motion) -> String {
    let work = motion.trajectory.statistics;
    match motion.solver {
        Solver::Exact => count(work.steps, "exact step"),
        _ => format!(
            "{} of the right-hand side",
            count(work.evaluations, "evaluation")
        ),
    }
}

pub fn columns(instance: &Instance<'_>) -> Vec<String> {
    let model = instance.model();
    let mut columns = vec!["t".to_owned()];
    columns.extend(model.state_names());
    columns.extend(model.observable_names());
    let states = model.model().controller_states().into_iter();
    columns.extend(states.map(|(name, _)| name.to_owned()));
    columns
}

/// Returns a table with one row for each output time: time, state, observables and controller states.
pub fn table(instance: &Instance<'_>, motion: &Motion) -> Result<Table> {
    let columns = columns(instance);
    let mut row = Vec::with_capacity(columns.len());
    let mut table = Table::new(columns);
    instance.observe(motion, |t, state, observables| {
        row.clear();
        row.push(t);
        row.extend_from_slice(state);
        row.extend_from_slice(observables);
        let states = motion.controller_states.rows.get(table.rows());
        row.extend(states.into_iter().flatten());
        table.push(&row);
    })?;
    Ok(table)
}
