//! A derived variant in motion: which solver takes it, its samples as a table, and the names
//! of what a solver's errors give by number. Solvers themselves are the library's.

use eomgen_compiled_model::driven::Driven;
use model_spec::model::Model;
use sim::inputs::HeldInputs;
use sim::ode::{Method, Names, Settings, SolveError, Surface, Trajectory, simulate_into};
use sim::piecewise_linear::{ExactError, PiecewiseLinear};

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
    surfaces: Vec<Surface>,
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
    /// Why the solver did not come to the end, if it did not.
    pub stopped: Option<Stopped>,
}

/// Why a solver did not come to the end.
pub struct Stopped {
    /// Where it stands, s, if that is known.
    pub t: Option<f64>,
    /// What is wrong, with names, and what to do.
    pub reason: String,
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
        let system =
            Driven::new(jit::evaluator(program.clone()), inputs.clone()).map_err(Problem::input)?;
        let surfaces = system.surfaces();
        Ok(Self {
            system,
            inputs,
            initial,
            columns,
            observables: program.observables.len(),
            surfaces,
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

    /// The states at the given times, all of them, with a progress bar for a run that takes
    /// long.
    pub fn simulate(&self, times: &[f64]) -> Outcome<Simulated> {
        let simulated = self.follow(times)?;
        match simulated.stopped {
            Some(stopped) => Err(Problem::input(stopped.reason)),
            None => Ok(simulated),
        }
    }

    /// The same, of the times that the solver comes to; an error if that is none.
    pub fn follow(&self, times: &[f64]) -> Outcome<Simulated> {
        let Some((equations, model)) = &self.exact else {
            return self.general(times);
        };
        let mut trajectory = Trajectory::default();
        let ended = equations.propagator(model).and_then(|mut propagator| {
            let span = span(times);
            let bar = Bar::new("simulating", span.1 - span.0, "s");
            let mut progress = |t: f64| bar.set(t - span.0);
            let request = (self.initial.as_slice(), span, times);
            propagator.simulate_into(&mut trajectory, request, &self.inputs, &mut progress)
        });
        match ended {
            Err(error) if self.solver == Solver::Auto && is_for_the_general(&error) => {
                let reason = error.named(&self.names());
                warn(&format!("warning: not solved exactly but by rk: {reason}"));
                self.general(times)
            }
            ended => {
                let stopped = ended.err().map(|error| Stopped {
                    t: error.time(),
                    reason: error.named(&self.names()),
                });
                so_far(trajectory, Solver::Exact, stopped)
            }
        }
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
        let mut trajectory = Trajectory::default();
        let request = (self.initial.as_slice(), span, times);
        let into = &mut trajectory;
        let ended = simulate_into(into, &self.system, request, &settings, &mut progress);
        let stopped = ended.err().map(|error: SolveError| Stopped {
            t: error.time(),
            reason: error.named(&self.names()),
        });
        so_far(trajectory, solver, stopped)
    }

    /// What the numbers in an error stand for.
    fn names(&self) -> Names<'_> {
        let states = &self.columns[1..self.columns.len() - self.observables];
        Names {
            states,
            surfaces: &self.surfaces,
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

/// What a solver found; an error if it was stopped before it had begun.
fn so_far(trajectory: Trajectory, solver: Solver, stopped: Option<Stopped>) -> Outcome<Simulated> {
    match stopped {
        // A request that makes no sense may be refused where the motion begins.
        Some(stopped) if trajectory.times.len() <= usize::from(stopped.t.is_none()) => {
            Err(Problem::input(stopped.reason))
        }
        stopped => Ok(Simulated {
            trajectory,
            solver,
            stopped,
        }),
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
