//! From an initial state over time: which solver takes a motion, and what its errors say by
//! number put in names. Solvers themselves are the crate `sim`'s.

use std::cell::RefCell;

use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::{
    Method, Names, ObservedStep, Settings, SolveError, Surface, Trajectory, Unfollowed,
    simulate_into,
};
use eomgen_sim::piecewise_linear::{ExactError, Propagator, StepObserver};

use crate::audit::{Audit, Auditor, EnergyAt};
use crate::driven::Driven;
use crate::error::Error;
use crate::instance::Instance;
use crate::motion::{Cause, Choice, Motion, Solver, Stopped};

/// The relative tolerance where nothing is said about it.
pub const DEFAULT_TOLERANCE: f64 = 1e-9;

/// More explicit steps than this to the end, kept short by stability alone, and
/// [`Solver::Auto`] takes an implicit solver: what that needs for all is a few times less.
const MOST_STIFF_STEPS: u64 = 100_000;

/// What is to be simulated.
#[derive(Clone, Copy, Debug)]
pub struct Request<'r> {
    /// The state at the first of the times, SI.
    pub initial: &'r [f64],
    /// The times of the samples, s, ascending.
    pub times: &'r [f64],
    /// What drives the motion.
    pub inputs: &'r HeldInputs,
    /// How to integrate.
    pub solver: Solver,
    /// The relative tolerance of solvers that have one.
    pub tolerance: f64,
    /// The longest step of solvers that have a tolerance, s; see [`Settings::max_step`].
    pub max_step: f64,
    /// Whether to compare the change of the energy with the work done; see [`Audit`].
    pub audit: bool,
}

impl Request<'_> {
    fn settings(&self) -> Settings {
        Settings {
            max_step: self.max_step,
            ..Settings::with_tolerance(self.tolerance)
        }
    }

    /// The first and the last of the times, s.
    pub fn span(&self) -> (f64, f64) {
        let first = self.times.first().copied().unwrap_or(0.0);
        (first, self.times.last().copied().unwrap_or(first))
    }
}

impl Instance<'_> {
    /// The states at the given times (s, ascending) of the motion that starts with `initial`
    /// (SI) at the first of them.
    ///
    /// # Errors
    /// A request that makes no sense, a solver that does not take the model, and
    /// [`Error::Stopped`] where the motion could not be followed to the end;
    /// [`Instance::follow`] keeps what was found until there.
    pub fn simulate(
        &self,
        initial: &[f64],
        times: &[f64],
        inputs: &HeldInputs,
        solver: Solver,
    ) -> Result<Motion, Error> {
        let request = Request {
            initial,
            times,
            inputs,
            solver,
            tolerance: DEFAULT_TOLERANCE,
            max_step: f64::INFINITY,
            audit: false,
        };
        self.follow(&request, &mut |_| {})?.complete()
    }

    /// The same, of the times that the solver comes to. `progress` is told the time of the motion.
    ///
    /// # Errors
    /// A request that makes no sense, a solver that does not take the model, a motion that
    /// stops before it has begun.
    pub fn follow(
        &self,
        request: &Request<'_>,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Motion, Error> {
        let asked = |method| Settings {
            method,
            ..request.settings()
        };
        let exact = match request.solver {
            Solver::Rk => {
                return self.general(request, &asked(Method::DormandPrince853), None, progress);
            }
            Solver::Adams => return self.general(request, &asked(Method::Adams), None, progress),
            Solver::Radau => return self.general(request, &asked(Method::Radau), None, progress),
            Solver::Exact | Solver::Auto => self.model.piecewise_linear(),
        };
        let is_free = request.solver == Solver::Auto;
        if request.inputs.moves() {
            let reason = "the exact solver holds inputs between their samples, and these are functions of \
                          the time";
            return match is_free {
                true => self.chosen(
                    request,
                    Some(Choice::NotLinear(reason.to_owned())),
                    progress,
                ),
                false => Err(Error::Request(format!("{reason}: use --solver rk"))),
            };
        }
        if let Err(error) = exact {
            if is_free {
                let choice = Some(Choice::NotLinear(error.to_string()));
                return self.chosen(request, choice, progress);
            }
            return Err(error.into());
        }
        // Judged as for the other solvers, and it gives the switching functions their names.
        let evaluator = RefCell::new(self.evaluator()?);
        let mut trajectory = Trajectory::default();
        let mut auditor = request.audit.then(|| self.auditor(None));
        let ended = self.propagator().and_then(|mut propagator| {
            let auditor = auditor.as_mut().map(|auditor| (auditor, &evaluator));
            propagate(
                &mut propagator,
                &mut trajectory,
                request,
                (progress, auditor),
            )
        });
        let audit = auditor.map(|auditor| auditor.audit().clone());
        let Err(error) = ended else {
            let choice = is_free.then_some(Choice::PiecewiseLinear);
            return Ok(motion(trajectory, request, Solver::Exact, (choice, audit)));
        };
        let surfaces = Driven::new(&evaluator, request.inputs).surfaces();
        let reason = self.named((&surfaces, Solver::Exact), |names| error.named(names));
        if is_free && is_for_the_general(&error) {
            let choice = Some(Choice::NotFollowed(reason));
            return self.chosen(request, choice, progress);
        }
        let choice = is_free.then_some(Choice::PiecewiseLinear);
        let t = error.time();
        let so_far = motion(trajectory, request, Solver::Exact, (choice, audit));
        let cause = self.cause_of_exact(&error);
        stopped(so_far, Stopped { t, reason, cause })
    }

    /// With an explicit solver for any model, or an implicit one where the motion is stiff.
    fn chosen(
        &self,
        request: &Request<'_>,
        choice: Option<Choice>,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Motion, Error> {
        let explicit = Settings {
            max_steps_if_stiff: MOST_STIFF_STEPS,
            ..request.settings()
        };
        let motion = self.general(request, &explicit, choice, progress)?;
        let cause = motion.stopped.as_ref().map(|stopped| &stopped.cause);
        let Some(Cause::Stiff(what)) = cause else {
            return Ok(motion);
        };
        let implicit = Settings {
            method: Method::Radau,
            ..request.settings()
        };
        let choice = Some(Choice::Stiff(what.clone()));
        self.general(request, &implicit, choice, progress)
    }

    /// With a solver for any model.
    fn general(
        &self,
        request: &Request<'_>,
        settings: &Settings,
        choice: Option<Choice>,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Motion, Error> {
        let is_constrained = !self.model.model().constraints.is_empty();
        if !self.model.model().impacts.is_empty() && settings.method == Method::Adams {
            return Err(Error::Request(
                "adams goes on from the steps before, which the impacts of this model cut off: use \
                 --solver rk or radau"
                    .to_owned(),
            ));
        }
        if is_constrained && settings.method == Method::Adams {
            return Err(Error::Request(
                "adams goes on from the steps before, which the constraints of this model cut off \
                 at every step: use --solver rk or radau"
                    .to_owned(),
            ));
        }
        // First of all: it says more of constraints that follow from others than their pivots do.
        let (initial, moved) =
            self.consistent_start(request.initial, request.span(), request.inputs)?;
        let evaluator = RefCell::new(self.evaluator()?);
        let mut system = self.driven(&evaluator, request.inputs)?;
        if settings.method == Method::Adams {
            // It goes on from the steps before, which rest cuts off: it says where that is.
            system = system.with_sliding(None);
        }
        let solver = match settings.method {
            Method::DormandPrince853 => Solver::Rk,
            Method::Adams => Solver::Adams,
            Method::Radau => Solver::Radau,
        };
        if settings.method == Method::Radau {
            system = system.with_jacobian(self.jacobian_evaluator()?);
        }
        let auditor = request.audit.then(|| self.auditor(Some(request.tolerance)));
        let system = system.with_auditor(auditor);
        let mut trajectory = Trajectory::default();
        let asked = (initial.as_slice(), request.span(), request.times);
        let ended = simulate_into(&mut trajectory, &system, asked, settings, progress);
        let so_far = Motion {
            moved,
            ..motion(trajectory, request, solver, (choice, system.audit()))
        };
        match ended {
            Ok(()) => Ok(so_far),
            Err(error) => {
                let (t, surfaces) = (SolveError::time(&error), system.surfaces());
                let cause = self.cause(&error);
                let ended_at = t.unwrap_or(request.span().0);
                let may_be = matches!(cause, Cause::NotFinite | Cause::Limit);
                let passed = system.projection().filter(|_| may_be);
                let passed = passed.and_then(|projection| {
                    let state = &so_far.trajectory.last;
                    let mut rates = vec![0.0; state.len()];
                    let inputs = &request.inputs.at(ended_at);
                    let point = Point {
                        t: ended_at,
                        state,
                        inputs,
                    };
                    evaluator.borrow_mut().rates(point, &mut rates);
                    let mut watch = projection.watch.borrow_mut();
                    watch.ended((ended_at, state), &rates, request.inputs)
                });
                let (t, singular) = match passed {
                    Some((passed, reason)) => (Some(passed), Some(reason)),
                    None => (t, None),
                };
                let reason = match (system.overlap(), singular) {
                    (Some(overlap), _) => format!("at t = {ended_at:?} s {overlap}"),
                    (None, Some(reason)) => reason,
                    (None, None) => self.named((&surfaces, solver), |names| error.named(names)),
                };
                stopped(so_far, Stopped { t, reason, cause })
            }
        }
    }

    /// An auditor of a motion with a relative tolerance; none for an exact one.
    fn auditor(&self, tolerance: Option<f64>) -> Auditor {
        let driven = self.driven_contact().map(|name| {
            format!(
                "inputs move the contact of the impact `{name}`, which jumps where they do between samples"
            )
        });
        Auditor::new(tolerance, self.model().typical_sizes(), driven)
    }

    /// What kind of reason an error is.
    fn cause(&self, error: &SolveError) -> Cause {
        match error {
            SolveError::NotFinite { .. } | SolveError::NotPositiveDefinite { .. } => {
                Cause::NotFinite
            }
            SolveError::Caught { .. } | SolveError::TooManySwitches { .. } => Cause::Switching,
            SolveError::Stiff { state, within, .. } => {
                let state = &self.model.state_names()[*state];
                Cause::Stiff(format!("stiff: `{state}` settles within {within:.1e} s"))
            }
            SolveError::Request { .. }
            | SolveError::StepTooSmall { .. }
            | SolveError::TooManySteps { .. } => Cause::Limit,
        }
    }

    /// The same of the exact solver's.
    fn cause_of_exact(&self, error: &ExactError) -> Cause {
        match error {
            ExactError::Stopped(error) => self.cause(error),
            ExactError::Held { .. } => Cause::Switching,
            ExactError::NotFinite | ExactError::NotPositiveDefinite => Cause::NotFinite,
            _ => Cause::Limit,
        }
    }

    /// The message of an error whose numbers stand for the states and for these switching functions, by
    /// a solver.
    fn named(
        &self,
        (surfaces, solver): (&[Surface], Solver),
        message: impl FnOnce(&Names<'_>) -> String,
    ) -> String {
        let states = self.model.state_names();
        let unfollowed = match solver {
            Solver::Adams => Unfollowed::Adams,
            _ if !self.model.model().impacts.is_empty() => Unfollowed::Impacts,
            _ => Unfollowed::Formula,
        };
        message(&Names {
            states: &states,
            surfaces,
            unfollowed,
        })
    }
}

/// Auditor of a motion by the exact solver, and the evaluator of its energies.
type ExactAudit<'a> = Option<(&'a mut Auditor, &'a RefCell<Evaluator>)>;

fn propagate(
    propagator: &mut Propagator,
    trajectory: &mut Trajectory,
    request: &Request<'_>,
    (progress, auditor): (&mut dyn FnMut(f64), ExactAudit<'_>),
) -> Result<(), ExactError> {
    let asked = (request.initial, request.span(), request.times);
    let Some((auditor, evaluator)) = auditor else {
        return propagator.simulate_into(trajectory, asked, request.inputs, progress);
    };
    let mut evaluator = evaluator.borrow_mut();
    let mut observables = vec![0.0; evaluator.program().observables.len()];
    let mut energies = |t: f64, state: &[f64]| {
        let inputs = &request.inputs.at(t);
        evaluator.observables(Point { t, state, inputs }, &mut observables);
        EnergyAt::of(&observables)
    };
    let mut observer = |step: &mut ObservedStep<'_>, is_held: bool| match is_held {
        true => auditor.leave_out(step, &mut energies, HELD),
        false => auditor.step(step, &mut energies),
    };
    let observer = (progress, Some(&mut observer as &mut StepObserver<'_>));
    propagator.simulate_observed(trajectory, asked, request.inputs, observer)
}

/// Why the audit leaves out what the exact solver holds on a surface.
const HELD: &str = "a surface held the motion, and the power of what holds it is not in the model";

fn motion(
    trajectory: Trajectory,
    request: &Request<'_>,
    solver: Solver,
    (choice, audit): (Option<Choice>, Option<Audit>),
) -> Motion {
    Motion {
        trajectory,
        inputs: request.inputs.clone(),
        solver,
        choice,
        stopped: None,
        moved: Vec::new(),
        audit,
    }
}

/// What was found before a solver stopped; an error if it stopped before it had begun.
fn stopped(mut motion: Motion, why: Stopped) -> Result<Motion, Error> {
    // A request that makes no sense may be refused where the motion begins.
    if motion.trajectory.times.len() <= usize::from(why.t.is_none()) {
        return Err(Error::Stopped {
            t: why.t,
            reason: why.reason,
        });
    }
    motion.stopped = Some(why);
    Ok(motion)
}

/// Whether the general solver may do better.
fn is_for_the_general(error: &ExactError) -> bool {
    matches!(error, ExactError::Held { .. } | ExactError::NotConverged)
}
