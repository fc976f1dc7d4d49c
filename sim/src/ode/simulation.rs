//! Simulations with the general solvers: whole simulations, and simulations that are continued from call to
//! call.

use super::adams::Adams;
use super::dormand_prince::DormandPrince853;
use super::driver::{Driver, Run, Span};
use super::error::SolveError;
use super::events::SurfaceMode;
use super::magnitudes::Magnitudes;
use super::radau::Radau;
use super::request;
use super::settings::{Method, Settings};
use super::stepper::{Point, Stepper};
use super::system::System;
use super::trajectory::Trajectory;
use super::watch::{WatchState, WatchedSystem};

/// Length of the first step relative to the span; the error estimate corrects it at once.
const FIRST_STEP_FRACTION: f64 = 1e-6;

/// Simulates `system` from `initial` over `span` (begin, end; s) and returns the states at
/// `samples` (s, ascending, inside the span). Calls `progress` with the time after every step.
///
/// # Errors
/// An invalid request, a rate that is not finite, or a limit of `settings`; see [`SolveError`].
pub fn simulate(
    system: &dyn System,
    initial: &[f64],
    span: (f64, f64),
    samples: &[f64],
    settings: &Settings,
    progress: &mut dyn FnMut(f64),
) -> Result<Trajectory, SolveError> {
    let mut trajectory = Trajectory::default();
    let request = (initial, span, samples);
    simulate_into(&mut trajectory, system, request, settings, progress)?;
    Ok(trajectory)
}

/// Simulates like [`simulate`] into an empty `trajectory`, which keeps all results up to an error.
/// The request is the initial state, the span and the samples.
///
/// # Errors
/// Same as [`simulate`].
pub fn simulate_into(
    trajectory: &mut Trajectory,
    system: &dyn System,
    (initial, span, samples): (&[f64], (f64, f64), &[f64]),
    settings: &Settings,
    progress: &mut dyn FnMut(f64),
) -> Result<(), SolveError> {
    request::check(system, initial, span, samples, settings)?;
    let mut simulation = Simulation::begin(system, (span.0, initial), span.1 - span.0, settings);
    let span = Span {
        end: span.1,
        may_pass: false,
    };
    simulation.continue_run(system, (span, samples), trajectory, progress)
}

/// A simulation that is continued from call to call. Each call must pass the same system, whose inputs may have
/// changed since the last call; see [`Simulation::follow_input_jump`].
pub struct Simulation {
    run: Box<dyn ContinuableRun>,
    record: WatchState,
    settings: Settings,
    point: Point,
    is_started: bool,
}

impl Simulation {
    /// Starts at a time (s) and a state. The first step is short compared with `length` (s).
    ///
    /// # Errors An invalid state or setting, or rates at the start that are not finite.
    pub fn new(
        system: &dyn System,
        (t, state): (f64, &[f64]),
        length: f64,
        settings: &Settings,
    ) -> Result<Self, SolveError> {
        request::check(system, state, (t, t + length), &[], settings)?;
        Ok(Self::begin(system, (t, state), length, settings))
    }

    fn begin(
        system: &dyn System,
        (t, state): (f64, &[f64]),
        length: f64,
        settings: &Settings,
    ) -> Self {
        let point = Point {
            t,
            y: state.to_vec(),
        };
        let watched = WatchedSystem::new(system, (t, state));
        watched.leave_surfaces(t, state, FIRST_STEP_FRACTION * length);
        let record = watched.pause();
        let sizes = system.typical_sizes();
        let start = (&point, FIRST_STEP_FRACTION * length, &sizes[..]);
        let run: Box<dyn ContinuableRun> = match settings.method {
            Method::DormandPrince853 => Box::new(new_run::<DormandPrince853>(start, settings)),
            Method::Adams => Box::new(new_run::<Adams>(start, settings)),
            Method::Radau => Box::new(new_run::<Radau>(start, settings)),
        };
        Self {
            run,
            record,
            settings: *settings,
            point,
            is_started: false,
        }
    }

    /// Returns the time reached, s.
    pub fn time(&self) -> f64 {
        self.point.t
    }

    /// Returns the state at the time reached.
    pub fn state(&self) -> &[f64] {
        &self.point.y
    }

    /// Returns the modes of the surfaces, by the index of their functions.
    pub fn modes(&self) -> &[SurfaceMode] {
        self.run.modes()
    }

    /// Continues to the time `until` (s), and adds the states at `samples` (s, ascending, after the time
    /// reached), the events and the solver statistics to `trajectory`. A step may extend beyond `until`; its
    /// end becomes part of the motion in a later call.
    ///
    /// # Errors
    /// An invalid request, a rate that is not finite, or a limit of the settings; the simulation keeps the last
    /// point that it reached.
    pub fn advance(
        &mut self,
        system: &dyn System,
        (until, samples): (f64, &[f64]),
        trajectory: &mut Trajectory,
        progress: &mut dyn FnMut(f64),
    ) -> Result<(), SolveError> {
        if until == self.point.t && samples.is_empty() {
            return Ok(());
        }
        request::check_span((self.point.t, until), samples)?;
        let span = Span {
            end: until,
            may_pass: true,
        };
        self.continue_run(system, (span, samples), trajectory, progress)
    }

    fn continue_run(
        &mut self,
        system: &dyn System,
        requested: (Span, &[f64]),
        trajectory: &mut Trajectory,
        progress: &mut dyn FnMut(f64),
    ) -> Result<(), SolveError> {
        let watched = WatchedSystem::resume(system, std::mem::take(&mut self.record));
        let call = ContinuationRequest {
            requested,
            settings: &self.settings,
            is_first: !self.is_started,
        };
        self.is_started = true;
        let ended = self
            .run
            .continue_run(&watched, system, call, (trajectory, progress));
        trajectory.statistics.evaluations += watched.evaluations();
        self.record = watched.pause();
        self.point = match &ended {
            Ok(point) => point.clone(),
            Err(_) => self.run.current_point(),
        };
        trajectory.final_state.clone_from(&self.point.y);
        ended.map(|_| ())
    }

    /// Continues with inputs that changed at the time reached: the system returns the old inputs before that
    /// time and the new inputs from it on. Adds jumps of the state and changes of modes to `trajectory`.
    ///
    /// # Errors
    /// Modes that change too often.
    pub fn follow_input_jump(
        &mut self,
        system: &dyn System,
        trajectory: &mut Trajectory,
    ) -> Result<(), SolveError> {
        self.run.restart(self.point.clone());
        let watched = WatchedSystem::resume(system, std::mem::take(&mut self.record));
        let span = Span {
            end: self.point.t,
            may_pass: true,
        };
        let call = ContinuationRequest {
            requested: (span, &[]),
            settings: &self.settings,
            is_first: !self.is_started,
        };
        self.is_started = true;
        let ended = self.run.follow_input_jump(&watched, call, trajectory);
        self.record = watched.pause();
        self.point = self.run.current_point();
        ended
    }
}

/// One call of a simulation.
struct ContinuationRequest<'c> {
    requested: (Span, &'c [f64]),
    settings: &'c Settings,
    is_first: bool,
}

/// A run of the solver loop, for any method.
trait ContinuableRun {
    fn continue_run(
        &mut self,
        watched: &WatchedSystem<'_, dyn System + '_>,
        system: &dyn System,
        call: ContinuationRequest<'_>,
        results: (&mut Trajectory, &mut dyn FnMut(f64)),
    ) -> Result<Point, SolveError>;

    fn follow_input_jump(
        &mut self,
        watched: &WatchedSystem<'_, dyn System + '_>,
        call: ContinuationRequest<'_>,
        trajectory: &mut Trajectory,
    ) -> Result<(), SolveError>;

    fn restart(&mut self, point: Point);

    fn current_point(&self) -> Point;

    fn modes(&self) -> &[SurfaceMode];
}

impl<M: Stepper> ContinuableRun for Run<M> {
    fn continue_run(
        &mut self,
        watched: &WatchedSystem<'_, dyn System + '_>,
        system: &dyn System,
        call: ContinuationRequest<'_>,
        (trajectory, progress): (&mut Trajectory, &mut dyn FnMut(f64)),
    ) -> Result<Point, SolveError> {
        let mut driver = Driver::new(watched, self, call.requested, call.settings, trajectory);
        if call.is_first {
            driver.start();
        }
        driver.run_to_end(system, progress)?;
        driver.end_point()
    }

    fn follow_input_jump(
        &mut self,
        watched: &WatchedSystem<'_, dyn System + '_>,
        call: ContinuationRequest<'_>,
        trajectory: &mut Trajectory,
    ) -> Result<(), SolveError> {
        let mut driver = Driver::new(watched, self, call.requested, call.settings, trajectory);
        if call.is_first {
            driver.start();
        }
        driver.follow_input_jump()
    }

    fn restart(&mut self, point: Point) {
        Run::restart(self, point);
    }

    fn current_point(&self) -> Point {
        self.last_point().clone()
    }

    fn modes(&self) -> &[SurfaceMode] {
        &self.modes
    }
}

fn new_run<M: Stepper>(
    (start, step, typical_sizes): (&Point, f64, &[f64]),
    settings: &Settings,
) -> Run<M> {
    let magnitudes = Magnitudes::new(&start.y, typical_sizes, settings.tolerance);
    Run::new(M::new(start.clone(), step, magnitudes), settings.tolerance)
}
