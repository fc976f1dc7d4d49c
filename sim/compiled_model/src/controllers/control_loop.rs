//! Closed loop of controllers and a motion: samples, output actions and external inputs.

use eomgen_model_spec::schedule::Schedule;
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::Trajectory;

use super::clock::Clock;
use super::controller::{Sample, SampledController};
use super::memory::ControlMemory;
use crate::error::Error;
use crate::motion::{EarlyStop, Solver, StopCause};
use crate::solver_options::SolverOptions;

/// Motion whose inputs controllers drive.
pub(crate) trait Plant {
    /// Returns the current time, s.
    fn time(&self) -> f64;

    /// Returns the time (s) at which the rates are evaluated at the current time.
    fn evaluation_time(&self) -> f64 {
        self.time()
    }

    /// Returns the state at the current time, SI.
    fn state(&self) -> &[f64];

    /// Writes the observables at the current time.
    fn write_observables(&mut self, out: &mut [f64]);

    /// Changes the inputs from the current time on. Adds the events of the change to `trajectory`.
    ///
    /// # Errors
    /// The motion cannot follow the jump of the inputs.
    fn change_inputs(
        &mut self,
        inputs: HeldInputs,
        trajectory: &mut Trajectory,
    ) -> Result<(), Error>;

    /// Continues to a time (s) with the present inputs and the output rows (s) up to it. Returns the reason of an early
    /// stop.
    ///
    /// # Errors
    /// Times that are not finite, not ascending or before the current time.
    fn continue_until(
        &mut self,
        asked: (f64, &[f64]),
        trajectory: &mut Trajectory,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Option<EarlyStop>, Error>;
}

/// Trajectory and controller data of one call.
pub(crate) struct LoopRecord<'t> {
    pub trajectory: &'t mut Trajectory,
    /// Number of rows in the trajectory before the call.
    first: usize,
    /// States of the controllers at the rows of the call.
    pub states: Vec<Vec<f64>>,
    /// Times (s) at which held inputs change, with all held values from then on.
    pub changes: Vec<(f64, Vec<f64>)>,
}

impl<'t> LoopRecord<'t> {
    pub fn new(trajectory: &'t mut Trajectory) -> Self {
        Self {
            first: trajectory.times.len(),
            trajectory,
            states: Vec::new(),
            changes: Vec::new(),
        }
    }

    /// Returns the rows of a call that are not written yet.
    fn remaining_rows<'r>(&self, rows: &'r [f64]) -> &'r [f64] {
        &rows[self.trajectory.times.len() - self.first..]
    }

    fn complete_states(&mut self, controllers: &[Box<dyn SampledController + '_>]) {
        let rows = self.trajectory.times.len() - self.first;
        if self.states.len() < rows {
            self.states.resize(rows, collect_states(controllers));
        }
    }
}

fn collect_states(controllers: &[Box<dyn SampledController + '_>]) -> Vec<f64> {
    let states = controllers.iter().map(|controller| controller.states());
    states.collect::<Vec<_>>().concat()
}

/// Limits the steps of a solver to the shortest period. Longer steps would end at samples anyway and be less accurate
/// there.
pub(crate) fn limit_steps(
    options: SolverOptions,
    schedules: impl Iterator<Item = Schedule>,
) -> SolverOptions {
    let periods = schedules.map(|Schedule { period, .. }| period);
    match options.solver {
        Solver::Fixed => options,
        _ => SolverOptions {
            max_step: periods.fold(options.max_step, f64::min),
            ..options
        },
    }
}

/// Controllers, their clock and the inputs of a motion.
pub struct ControlLoop<'c> {
    /// Controllers in the order of their states and inputs.
    controllers: Vec<Box<dyn SampledController + 'c>>,
    clock: Clock,
    /// External inputs.
    given: HeldInputs,
    /// Held values of all inputs; controllers set the values of the inputs that they drive.
    held: Vec<f64>,
    /// Inputs of the motion at present.
    current: HeldInputs,
    /// For each input, true if a controller output has acted on it.
    has_acted: Vec<bool>,
    observables: Vec<f64>,
}

impl<'c> ControlLoop<'c> {
    /// Creates a loop at a time (s), before the samples at this time. An input has at most one controller, and no
    /// controller drives an input that is a function of time.
    pub(crate) fn new(
        controllers: Vec<Box<dyn SampledController + 'c>>,
        given: HeldInputs,
        t: f64,
        (inputs, observables): (usize, usize),
    ) -> Self {
        let schedules = controllers.iter().map(|own| own.schedule()).collect();
        Self {
            clock: Clock::new(schedules, t),
            controllers,
            held: given.last_sample(t).to_vec(),
            current: given.clone(),
            given,
            has_acted: vec![false; inputs],
            observables: vec![0.0; observables],
        }
    }

    /// Continues the motion to a time (s), including samples and input changes at this time, and adds the rows to the
    /// record. Rows at a sample have the values after it. Returns the reason of an early stop.
    ///
    /// # Errors
    /// Times that are not possible for the motion.
    pub(crate) fn follow(
        &mut self,
        plant: &mut dyn Plant,
        (until, rows): (f64, &[f64]),
        record: &mut LoopRecord<'_>,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Option<EarlyStop>, Error> {
        self.clock.check_sample_count((plant.time(), until))?;
        while let Some(next) =
            self.find_next_instant(plant.time(), (until, record.remaining_rows(rows)))
        {
            let rest = record.remaining_rows(rows);
            let before = &rest[..rest.partition_point(|row| *row < next)];
            let stop = self.continue_until(plant, (next, before), record, progress)?;
            if let Some(stop) = stop {
                return Ok(Some(stop));
            }
            if let Some(stop) = self.sample(plant, next, record)? {
                return Ok(Some(stop));
            }
            self.push_rows_at(plant, (next, rows), record);
        }
        self.push_rows_at(plant, (plant.time(), rows), record);
        let rest = record.remaining_rows(rows);
        let before = &rest[..rest.partition_point(|row| *row <= until)];
        self.continue_until(plant, (until, before), record, progress)
    }

    /// Returns the time (s) of the next sample, output action or input change from `now` to `until`. Samples and
    /// actions that differ from a row or the end only by rounding are moved to it.
    fn find_next_instant(&self, now: f64, (until, rows): (f64, &[f64])) -> Option<f64> {
        let within = self.clock.tolerance(now.abs().max(until.abs()));
        let instant = self.clock.next_instant().map(|instant| {
            let place = rows.partition_point(|row| *row < instant - within);
            let near = rows.get(place).copied().into_iter().chain([until]);
            let mut near = near.filter(|time| (time - instant).abs() <= within);
            near.next().unwrap_or(instant)
        });
        let change = self.given.next_change(now);
        let next = [instant, change].into_iter().flatten().reduce(f64::min);
        next.filter(|next| *next <= until).map(|next| next.max(now))
    }

    fn continue_until(
        &self,
        plant: &mut dyn Plant,
        asked: (f64, &[f64]),
        record: &mut LoopRecord<'_>,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Option<EarlyStop>, Error> {
        let stop = plant.continue_until(asked, record.trajectory, progress)?;
        record.complete_states(&self.controllers);
        Ok(stop)
    }

    /// Adds the rows at the current time.
    fn push_rows_at(
        &self,
        plant: &dyn Plant,
        (t, rows): (f64, &[f64]),
        record: &mut LoopRecord<'_>,
    ) {
        for row in record
            .remaining_rows(rows)
            .iter()
            .take_while(|row| **row <= t)
        {
            record.trajectory.times.push(*row);
            record.trajectory.states.push(plant.state().to_vec());
        }
        record.complete_states(&self.controllers);
    }

    /// Samples the controllers that are due at an instant, and changes the inputs.
    fn sample(
        &mut self,
        plant: &mut dyn Plant,
        instant: f64,
        record: &mut LoopRecord<'_>,
    ) -> Result<Option<EarlyStop>, Error> {
        let mut observables = std::mem::take(&mut self.observables);
        if !self.clock.due_samples(instant).is_empty() {
            plant.write_observables(&mut observables);
        }
        let at = Sample {
            t: plant.evaluation_time(),
            state: plant.state(),
            inputs: &self.current.evaluate_before(instant, &self.held),
            observables: &observables,
        };
        let taken = self.take_samples(instant, &at);
        self.observables = observables;
        match taken {
            Ok(()) => self.update_inputs(plant, instant, record),
            Err(stop) => Ok(Some(stop)),
        }
    }

    /// Samples the controllers that are due at an instant (s). Their outputs are pending until
    /// [`ControlLoop::apply_outputs`].
    ///
    /// # Errors
    /// An output or a state that is not finite.
    pub fn take_samples(&mut self, instant: f64, at: &Sample<'_>) -> Result<(), EarlyStop> {
        for place in self.clock.due_samples(instant) {
            let controller = &mut self.controllers[place];
            let mut outputs = vec![0.0; controller.driven_inputs().len()];
            let sampled = controller.sample(at, &mut outputs);
            sampled.map_err(|reason| EarlyStop {
                t: Some(instant),
                reason: format!("at t = {instant:?} s {reason}"),
                cause: StopCause::NotFinite,
            })?;
            self.clock.complete_sample(instant, place, outputs);
        }
        Ok(())
    }

    /// Applies the outputs that act at an instant (s), and the changes of the other inputs. Returns the held inputs from
    /// then on.
    pub fn apply_outputs(&mut self, instant: f64) -> &[f64] {
        self.hold_external_inputs(instant);
        for action in self.clock.take_actions(instant) {
            let driven = self.controllers[action.controller].driven_inputs();
            for (place, value) in driven.iter().zip(action.values) {
                self.held[*place] = value;
                self.has_acted[*place] = true;
            }
        }
        &self.held
    }

    /// Returns the time (s) of the next sample or output action.
    pub fn next_instant(&self) -> Option<f64> {
        self.clock.next_instant()
    }

    /// Changes the inputs of the motion at an instant.
    fn update_inputs(
        &mut self,
        plant: &mut dyn Plant,
        instant: f64,
        record: &mut LoopRecord<'_>,
    ) -> Result<Option<EarlyStop>, Error> {
        let before = self.held.clone();
        self.apply_outputs(instant);
        if self.held == before {
            return Ok(None);
        }
        record.changes.push((instant, self.held.clone()));
        self.current = self.given.with_held_step(instant, &before, &self.held);
        match plant.change_inputs(self.current.clone(), record.trajectory) {
            Ok(()) => Ok(None),
            Err(Error::Stopped { t, reason }) => Ok(Some(EarlyStop {
                t,
                reason,
                cause: StopCause::Switching,
            })),
            Err(error) => Err(error),
        }
    }

    /// Sets the external inputs to their values at a time (s), except inputs on which a controller output acts.
    fn hold_external_inputs(&mut self, t: f64) {
        let given = self.given.last_sample(t);
        for ((held, value), has_acted) in self.held.iter_mut().zip(given).zip(&self.has_acted) {
            if !has_acted {
                *held = *value;
            }
        }
    }

    /// Changes the external inputs at the current time. Returns the inputs of the motion from then on. Driven inputs
    /// keep the values of the controller outputs.
    pub(crate) fn change_external_inputs(&mut self, t: f64, inputs: HeldInputs) -> HeldInputs {
        let before = self.current.evaluate(t).into_owned();
        self.given = inputs;
        self.hold_external_inputs(t);
        self.current = self.given.with_held_step(t, &before, &self.held);
        self.current.clone()
    }

    /// Returns the memory of the controllers.
    pub fn memory(&self) -> ControlMemory {
        ControlMemory {
            states: self.states(),
            samples: self.clock.next_samples(),
            has_acted: self.has_acted.clone(),
            pending: self.clock.pending().cloned().collect(),
        }
    }

    /// Continues at a time (s) with a memory.
    ///
    /// # Errors
    /// The memory belongs to another model.
    pub(crate) fn resume(&mut self, t: f64, memory: &ControlMemory) -> Result<(), Error> {
        let outputs = |controller: usize| {
            let own = self.controllers.get(controller);
            own.map(|own| own.driven_inputs().len())
        };
        let mut pending = memory.pending.iter();
        let fits = memory.states.len() == self.states().len()
            && memory.samples.len() == self.controllers.len()
            && memory.has_acted.len() == self.has_acted.len()
            && pending.all(|own| outputs(own.controller) == Some(own.values.len()));
        if !fits {
            let message = "a memory of other controllers".to_owned();
            return Err(Error::Request(message));
        }
        let mut rest = &memory.states[..];
        for controller in &mut self.controllers {
            let (own, others) = rest.split_at(controller.states().len());
            controller.set_states(own);
            rest = others;
        }
        self.clock.resume(t, &memory.samples, &memory.pending);
        self.has_acted.copy_from_slice(&memory.has_acted);
        Ok(())
    }

    /// Returns true if a controller drives an input.
    pub(crate) fn drives(&self, input: usize) -> bool {
        let mut controllers = self.controllers.iter();
        controllers.any(|own| own.driven_inputs().contains(&input))
    }

    /// Returns the states of all controllers.
    pub(crate) fn states(&self) -> Vec<f64> {
        collect_states(&self.controllers)
    }

    /// Returns the names of the states of all controllers.
    pub(crate) fn state_names(&self) -> Vec<String> {
        let controllers = self.controllers.iter();
        controllers.flat_map(|own| own.state_names()).collect()
    }
}
