//! Motion with steps of fixed length. `step` in emitted code has the same method and order of operations, so a
//! simulation and a loop on a microcontroller are bit-identical.

use eomgen_codegen::program::evaluator::{Evaluator, Point, StepMemory};
use eomgen_model_spec::argument::Argument;
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::{Settings, Trajectory};

use crate::error::Error;
use crate::instance::Instance;
use crate::motion::{EarlyStop, StopCause};

/// Largest distance of a time from the nearest step, as a fraction of the step or of the time since the start. It is
/// far above the rounding errors of times.
const GRID_TOLERANCE: f64 = 1e-6;

/// Number of steps between two reports of progress.
const STEPS_PER_REPORT: u64 = 256;

/// Motion with fixed steps from a start: step k begins at start + k step.
pub struct FixedSteps {
    evaluator: Evaluator,
    start: f64,
    step: f64,
    /// Number of steps taken.
    count: u64,
    /// Requested time, which may differ from the time of the step by rounding, s.
    reached: f64,
    state: Vec<f64>,
    memory: StepMemory,
}

impl Instance<'_> {
    /// Starts a motion with steps of the given length (s).
    ///
    /// # Errors
    /// A model whose motion needs events, a missing step length, and an invalid state.
    pub(crate) fn start_fixed(
        &self,
        (t, state): (f64, &[f64]),
        step: f64,
    ) -> Result<FixedSteps, Error> {
        if !(step.is_finite() && step > 0.0) {
            return Err(Error::Request(format!(
                "the solver fixed needs the step size: {} (s)",
                Argument::StepLength.with_number("1e-4")
            )));
        }
        let mut inputs = self.model().model().inputs.iter();
        if let Some(prescribed) = inputs.find(|input| input.rate.is_some()) {
            return Err(Error::Request(format!(
                "the solver fixed cannot be used: {}; use {}",
                describe_prescribed_motion(&prescribed.name),
                Argument::Solver.with_text("rk")
            )));
        }
        let count = self.model().program().states();
        if state.len() != count || state.iter().any(|entry| !entry.is_finite()) {
            return Err(Error::Request(format!(
                "a state has {count} finite entries"
            )));
        }
        let evaluator = self.stepper()?;
        Ok(FixedSteps {
            memory: evaluator.create_step_memory(),
            evaluator,
            start: t,
            step,
            count: 0,
            reached: t,
            state: state.to_vec(),
        })
    }
}

/// Returns the reason why fixed steps do not support prescribed motion.
pub(crate) fn describe_prescribed_motion(input: &str) -> String {
    format!("the input `{input}` is prescribed motion, which cannot be held during a step")
}

impl FixedSteps {
    /// Returns the last requested time, s.
    pub fn reached(&self) -> f64 {
        self.reached
    }

    /// Returns the time of the current step, s.
    pub fn time(&self) -> f64 {
        self.time_after(self.count)
    }

    fn time_after(&self, steps: u64) -> f64 {
        self.start + steps as f64 * self.step
    }

    pub fn state(&self) -> &[f64] {
        &self.state
    }

    /// Checks that the number of steps to `until` (s) is at most the limit of other solvers.
    ///
    /// # Errors
    /// A step that is too short for the time span.
    pub fn check_step_count(&self, until: f64) -> Result<(), Error> {
        let most = Settings::default().max_steps as f64;
        let steps = (until - self.reached) / self.step;
        match steps > most {
            true => Err(Error::Request(format!(
                "the step, {:e} s, needs {steps:.1e} steps up to the end, but the limit is {most:e}: give a longer \
                 step, or a shorter time",
                self.step
            ))),
            false => Ok(()),
        }
    }

    /// Continues to `until` (s) with output rows at `samples`. Inputs are evaluated at the start of each step and held.
    ///
    /// # Errors
    /// The time since the start is not a multiple of the step.
    pub fn advance(
        &mut self,
        (until, samples): (f64, &[f64]),
        inputs: &HeldInputs,
        trajectory: &mut Trajectory,
        names: &dyn Fn() -> Vec<String>,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Option<EarlyStop>, Error> {
        for row in samples
            .iter()
            .map(|row| (*row, true))
            .chain([(until, false)])
        {
            let (time, is_row) = row;
            let steps = self.steps_until(time)?;
            while self.count < steps {
                // An input that changes at the requested time has its new value, even if the time of the step is
                // smaller by rounding.
                let held = inputs.evaluate(self.time().max(self.reached));
                if let Some(place) = self.take_step(&held) {
                    let (t, names) = (self.time(), names());
                    let reason = format!(
                        "at t = {t:?} s the state `{}` is not finite: the steps are too long, the state diverged, a \
                         number overflowed, or a function left its domain",
                        names.get(place).map_or("", |name| name)
                    );
                    let cause = StopCause::NotFinite;
                    let t = Some(t);
                    return Ok(Some(EarlyStop { t, reason, cause }));
                }
                if self.count.is_multiple_of(STEPS_PER_REPORT) {
                    progress(self.time());
                }
                trajectory.statistics.steps += 1;
                trajectory.statistics.evaluations += 4;
            }
            self.reached = time;
            if is_row {
                trajectory.times.push(time);
                trajectory.states.push(self.state.clone());
            }
        }
        trajectory.final_state = self.state.clone();
        Ok(None)
    }

    /// Returns the number of steps from the start to a time.
    fn steps_until(&self, time: f64) -> Result<u64, Error> {
        let steps = ((time - self.start) / self.step).round();
        let distance = (time - self.time_after(steps as u64)).abs();
        let rounding = 8.0 * f64::EPSILON * time.abs();
        // A time before the first step does not count as the start, even if the step is long.
        let span = self.step.min((time - self.start).abs());
        match distance <= rounding.max(GRID_TOLERANCE * span) {
            true => Ok(steps as u64),
            false => Err(Error::Request(format!(
                "t = {time:?} s lies between two steps of {:?} s: with the solver fixed, the times of rows, of \
                 samples and of changes of inputs are multiples of the step",
                self.step
            ))),
        }
    }

    /// Takes a step. Returns the index of a state that is not finite, if there is one.
    fn take_step(&mut self, inputs: &[f64]) -> Option<usize> {
        let at = (self.time(), self.step);
        let Self {
            evaluator,
            state,
            memory,
            ..
        } = self;
        evaluator.step(at, state, inputs, memory);
        self.count += 1;
        self.state.iter().position(|entry| !entry.is_finite())
    }

    /// Writes the observables at the current time.
    pub fn write_observables(&mut self, inputs: &[f64], out: &mut [f64]) {
        let (t, state) = (self.time(), &self.state);
        self.evaluator.observables(Point { t, state, inputs }, out);
    }

    /// Writes the rates at the current time.
    pub fn write_rates(&mut self, inputs: &[f64], out: &mut [f64]) {
        let (t, state) = (self.time(), &self.state);
        self.evaluator.rates(Point { t, state, inputs }, out);
    }

    /// Continues from another state at the current time.
    pub fn set_state(&mut self, state: &[f64]) {
        self.state.copy_from_slice(state);
    }
}
