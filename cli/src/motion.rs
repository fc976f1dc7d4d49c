//! A derived variant in motion: which solver takes it, its samples as a table, and the names
//! of what a solver's errors give by number. Solvers themselves are the library's.

use model_spec::model::Model;
use sim::derived::Driven;
use sim::exact::{ExactError, PiecewiseLinear, Propagator};
use sim::record::HeldInputs;
use sim::solve::{Method, Settings, SolveError, Trajectory, simulate};

use crate::arguments::Solver;
use crate::problem::{Outcome, Problem, warn};
use crate::progress::Bar;
use crate::table::Table;
use crate::variant::Variant;

/// A variant with its inputs and a solver, ready to be simulated.
pub struct Run {
    system: Driven,
    inputs: HeldInputs,
    initial: Vec<f64>,
    columns: Vec<String>,
    observables: usize,
    /// What each switching function is.
    guards: Vec<String>,
    solver: Solver,
    tolerance: f64,
    /// The equations for the exact solver, if it is to be used.
    exact: Option<(PiecewiseLinear, Model)>,
}

/// A trajectory and the solver it comes from.
pub struct Simulated {
    /// The states at the samples.
    pub trajectory: Trajectory,
    /// Who computed them; never [`Solver::Auto`].
    pub solver: Solver,
}

impl Simulated {
    /// The work in words.
    pub fn work(&self) -> String {
        let work = self.trajectory.work;
        match self.solver {
            Solver::Exact => format!("{} exact steps", work.steps),
            _ => format!("{} evaluations of the right-hand side", work.evaluations),
        }
    }
}

impl Run {
    /// Takes a variant. `tolerance` counts for solvers that have one.
    pub fn new(
        variant: &Variant,
        inputs: HeldInputs,
        solver: Solver,
        tolerance: f64,
    ) -> Outcome<Self> {
        let (model, program) = (&variant.model, &variant.program);
        let orders: Vec<usize> = program.fields.iter().map(|field| field.order).collect();
        let initial = model
            .initial_state(&orders)
            .map_err(|error| Problem::model(&model.source, error))?;
        let mut columns = vec!["t".to_owned()];
        columns.extend(program.state_names());
        columns.extend(program.observables.iter().map(|o| o.name.clone()));
        let guards = program.guards.iter().flat_map(|guard| {
            let count = program.value(guard.value).extent.length();
            std::iter::repeat_n(guard.formula.clone(), count)
        });
        let guards = guards.collect();
        let system =
            Driven::new(jit::evaluator(program.clone()), inputs.clone()).map_err(Problem::input)?;
        Ok(Self {
            system,
            inputs,
            initial,
            columns,
            observables: program.observables.len(),
            guards,
            solver,
            tolerance,
            exact: piecewise_linear(model, &orders, solver)?.map(|exact| (exact, model.clone())),
        })
    }

    /// The names of the table's columns.
    pub fn columns(&self) -> &[String] {
        &self.columns
    }

    /// The inputs that drive it.
    pub fn inputs(&self) -> &HeldInputs {
        &self.inputs
    }

    /// The states at the given times, with a progress bar for a run that takes long.
    pub fn simulate(&self, times: &[f64]) -> Outcome<Simulated> {
        let Some((equations, model)) = &self.exact else {
            return self.general(times);
        };
        let propagator = equations.propagator(model);
        let trajectory = propagator.and_then(|propagator| self.exact(propagator, times));
        match trajectory {
            Ok(trajectory) => Ok(Simulated {
                trajectory,
                solver: Solver::Exact,
            }),
            Err(error) if self.solver == Solver::Auto && is_for_the_general(&error) => {
                let reason = self.reason(&error);
                warn(&format!("warning: not solved exactly but by rk: {reason}"));
                self.general(times)
            }
            Err(error) => Err(Problem::input(self.reason(&error))),
        }
    }

    fn exact(&self, mut propagator: Propagator, times: &[f64]) -> Result<Trajectory, ExactError> {
        let span = span(times);
        let bar = Bar::new("simulating", span.1 - span.0, "s");
        let mut progress = |t: f64| bar.set(t - span.0);
        propagator.simulate(&self.initial, span, times, &self.inputs, &mut progress)
    }

    /// With a solver for any model.
    fn general(&self, times: &[f64]) -> Outcome<Simulated> {
        let (method, solver) = match self.solver {
            Solver::Adams => (Method::Adams, Solver::Adams),
            Solver::Auto | Solver::Exact | Solver::Rk => (Method::DormandPrince853, Solver::Rk),
        };
        let settings = Settings {
            method,
            ..Settings::with_tolerance(self.tolerance)
        };
        let span = span(times);
        let bar = Bar::new("simulating", span.1 - span.0, "s");
        let mut progress = |t: f64| bar.set(t - span.0);
        let initial = &self.initial;
        let trajectory = simulate(&self.system, initial, span, times, &settings, &mut progress)
            .map_err(|error| Problem::input(format!("{error}{}", self.culprit(&error))))?;
        Ok(Simulated { trajectory, solver })
    }

    /// Why there is no exact solution, with names.
    fn reason(&self, error: &ExactError) -> String {
        let culprit = match error {
            ExactError::Held { guard, .. } => self.guard(*guard),
            ExactError::Stopped(error) => self.culprit(error),
            _ => String::new(),
        };
        format!("{error}{culprit}")
    }

    /// The name of what an error gives by number.
    fn culprit(&self, error: &SolveError) -> String {
        match *error {
            SolveError::NotFinite { state, .. } => {
                let name = self.columns.get(1 + state).map_or("", String::as_str);
                format!("; that is {name}")
            }
            SolveError::Caught { guard, .. } | SolveError::TooManySwitches { guard, .. } => {
                self.guard(guard)
            }
            _ => String::new(),
        }
    }

    /// The formula of a switching function.
    fn guard(&self, guard: usize) -> String {
        let formula = self.guards.get(guard).map_or("", String::as_str);
        format!("; that is {formula}")
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

/// The equations for the exact solver; none where another is asked for, or where the choice
/// is free and the model not linear between its switches.
fn piecewise_linear(
    model: &Model,
    orders: &[usize],
    solver: Solver,
) -> Outcome<Option<PiecewiseLinear>> {
    match solver {
        Solver::Rk | Solver::Adams => Ok(None),
        Solver::Auto => Ok(PiecewiseLinear::of(model, orders).ok()),
        Solver::Exact => PiecewiseLinear::of(model, orders)
            .map(Some)
            .map_err(|error| Problem::input(error.to_string())),
    }
}

/// Whether the general solver may do better.
fn is_for_the_general(error: &ExactError) -> bool {
    matches!(error, ExactError::Held { .. } | ExactError::NotConverged)
}

/// The first and the last of the times, s.
fn span(times: &[f64]) -> (f64, f64) {
    let first = times.first().copied().unwrap_or(0.0);
    (first, times.last().copied().unwrap_or(first))
}
