//! Motion with sampled controllers.

use eomgen_model_spec::control::Schedule;
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::Trajectory;

use super::clock::Clock;
use super::controller::{Sample, SampledController};
use crate::error::Error;
use crate::instance::Instance;
use crate::motion::{ControllerStates, EarlyStop, Motion, Solver, StopCause};
use crate::resumable::Simulation;
use crate::simulation::{Request, with_early_stop};
use crate::solver_options::SolverOptions;

/// Controllers in the order of their states and inputs.
pub type Controllers<'c> = [&'c mut dyn SampledController];

impl Instance<'_> {
    /// Simulates a request with controllers, up to the time that the solver reaches. A row at the time of a sample has
    /// the values after it. Calls `progress` with the time reached, s. The motion has no energy audit.
    ///
    /// # Errors
    /// Two controllers that drive one input; same as [`Instance::simulate_until_stop`].
    pub fn simulate_controlled(
        &self,
        request: &Request<'_>,
        controllers: &mut Controllers<'_>,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Motion, Error> {
        self.check_driven_once(controllers)?;
        let (start, _) = request.time_span();
        let schedules = controllers.iter().map(|controller| controller.schedule());
        let schedules: Vec<Schedule> = schedules.collect();
        // Longer steps would end between samples, and lose digits there.
        let periods = schedules.iter().map(|schedule| schedule.period);
        let max_step = match request.solver {
            Solver::Fixed => request.max_step,
            _ => periods.fold(request.max_step, f64::min),
        };
        let options = SolverOptions {
            solver: request.solver,
            tolerance: request.tolerance,
            max_step,
        };
        let begin = (start, request.initial);
        let simulation = self.start_simulation(begin, request.inputs.clone(), options)?;
        let mut run = ControlledRun {
            clock: Clock::new(schedules, start),
            held: request.inputs.last_sample(start).to_vec(),
            current: request.inputs.clone(),
            request,
            simulation,
            controllers,
            trajectory: Trajectory::default(),
            states: Vec::new(),
            changes: Vec::new(),
            has_acted: vec![false; self.model().model().inputs.len()],
            observables: vec![0.0; self.model().program().observables.len()],
        };
        let stop = run.follow(progress)?;
        let motion = run.into_motion();
        match stop {
            None => Ok(motion),
            Some(stop) => with_early_stop(motion, stop),
        }
    }
}

impl Instance<'_> {
    fn check_driven_once(&self, controllers: &Controllers<'_>) -> Result<(), Error> {
        let mut driven = Vec::new();
        for place in controllers.iter().flat_map(|own| own.driven_inputs()) {
            if driven.contains(place) {
                let inputs = &self.model().program().inputs;
                let name = inputs.get(*place).map_or("", |input| &input.name);
                return Err(Error::Request(format!(
                    "two controllers drive the input `{name}`: let one controller compute the sum of both"
                )));
            }
            driven.push(*place);
        }
        Ok(())
    }
}

struct ControlledRun<'r, 'i, 'c> {
    request: &'r Request<'r>,
    simulation: Simulation<'i>,
    controllers: &'r mut Controllers<'c>,
    clock: Clock,
    /// Held values of all inputs; driven ones are those of the controllers.
    held: Vec<f64>,
    /// Inputs in use.
    current: HeldInputs,
    trajectory: Trajectory,
    /// States of the controllers at the rows.
    states: Vec<Vec<f64>>,
    /// Times of changes of the driven inputs, s, and all held values from then on.
    changes: Vec<(f64, Vec<f64>)>,
    /// For each input, true if a controller drives it by now.
    has_acted: Vec<bool>,
    observables: Vec<f64>,
}

impl ControlledRun<'_, '_, '_> {
    /// Follows the motion to the last row. Returns the reason of an early stop.
    fn follow(&mut self, progress: &mut dyn FnMut(f64)) -> Result<Option<EarlyStop>, Error> {
        let (_, end) = self.request.time_span();
        loop {
            let now = self.simulation.time();
            let instant = self.clock.next_instant();
            let change = self.request.inputs.next_change(now);
            let next = [instant, change].into_iter().flatten().reduce(f64::min);
            let within = self.clock.tolerance(now.abs().max(end.abs()));
            let Some(next) = next.filter(|next| *next <= end + within) else {
                return self.advance(end, progress);
            };
            let next = self.snap_to_row(next, within).max(now);
            if let Some(stop) = self.advance_before(next, progress)? {
                return Ok(Some(stop));
            }
            if let Some(stop) = self.sample(next)? {
                return Ok(Some(stop));
            }
            self.push_rows_at(next);
        }
    }

    /// Returns the time of the row at an instant, or the instant itself.
    fn snap_to_row(&self, instant: f64, within: f64) -> f64 {
        let rows = &self.request.times[self.trajectory.times.len()..];
        let place = rows.partition_point(|row| *row < instant - within);
        let row = rows.get(place).copied();
        row.filter(|row| *row <= instant + within)
            .unwrap_or(instant)
    }

    /// Continues to a time, with the rows before it.
    fn advance_before(
        &mut self,
        until: f64,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Option<EarlyStop>, Error> {
        let rows = &self.request.times[self.trajectory.times.len()..];
        let before = rows.partition_point(|row| *row < until);
        self.advance_through(until, before, progress)
    }

    /// Continues to a time, with the rows up to it.
    fn advance(
        &mut self,
        until: f64,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Option<EarlyStop>, Error> {
        self.push_rows_at(self.simulation.time());
        let rows = &self.request.times[self.trajectory.times.len()..];
        let before = rows.partition_point(|row| *row <= until);
        self.advance_through(until, before, progress)
    }

    fn advance_through(
        &mut self,
        until: f64,
        rows: usize,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Option<EarlyStop>, Error> {
        let first = self.trajectory.times.len();
        let rows = &self.request.times[first..first + rows];
        let asked = (until, rows);
        let stop = (self.simulation).advance_through(asked, &mut self.trajectory, progress)?;
        let states = self.controller_states();
        self.states.resize(self.trajectory.times.len(), states);
        Ok(stop)
    }

    /// Adds the rows at the time reached.
    fn push_rows_at(&mut self, t: f64) {
        let rows = &self.request.times[self.trajectory.times.len()..];
        let count = rows.iter().take_while(|row| **row <= t).count();
        for row in &rows[..count] {
            self.trajectory.times.push(*row);
            self.trajectory
                .states
                .push(self.simulation.state().to_vec());
        }
        let states = self.controller_states();
        self.states.resize(self.trajectory.times.len(), states);
    }

    fn controller_states(&self) -> Vec<f64> {
        let states = self
            .controllers
            .iter()
            .map(|controller| controller.states());
        states.collect::<Vec<_>>().concat()
    }

    /// Samples the controllers that are due at an instant and changes the inputs.
    fn sample(&mut self, instant: f64) -> Result<Option<EarlyStop>, Error> {
        let due = self.clock.take_samples(instant);
        if !due.is_empty() {
            self.simulation.write_observables(&mut self.observables);
        }
        let inputs = self.current.evaluate(instant).into_owned();
        for place in due {
            let at = Sample {
                t: self.simulation.evaluation_time(),
                state: self.simulation.state(),
                inputs: &inputs,
                observables: &self.observables,
            };
            let controller = &mut self.controllers[place];
            let mut outputs = vec![0.0; controller.driven_inputs().len()];
            if let Err(reason) = controller.sample(&at, &mut outputs) {
                return Ok(Some(EarlyStop {
                    t: Some(instant),
                    reason: format!("at t = {instant:?} s {reason}"),
                    cause: StopCause::NotFinite,
                }));
            }
            self.clock.add(instant, place, outputs);
        }
        self.change_inputs(instant)
    }

    /// Applies the outputs that act at an instant, and the changes of other inputs.
    fn change_inputs(&mut self, instant: f64) -> Result<Option<EarlyStop>, Error> {
        let before = self.held.clone();
        let own = self.request.inputs.last_sample(instant);
        for ((held, value), has_acted) in self.held.iter_mut().zip(own).zip(&self.has_acted) {
            if !has_acted {
                *held = *value;
            }
        }
        for action in self.clock.take_actions(instant) {
            let driven = self.controllers[action.controller].driven_inputs();
            for (place, value) in driven.iter().zip(action.values) {
                self.held[*place] = value;
                self.has_acted[*place] = true;
            }
        }
        if self.held == before {
            return Ok(None);
        }
        self.changes.push((instant, self.held.clone()));
        self.current = (self.request.inputs).with_held_step(instant, &before, &self.held);
        let changed = (self.simulation).change_inputs(self.current.clone(), &mut self.trajectory);
        match changed {
            Ok(()) => Ok(None),
            Err(Error::Stopped { t, reason }) => Ok(Some(EarlyStop {
                t,
                reason,
                cause: StopCause::Switching,
            })),
            Err(error) => Err(error),
        }
    }

    fn into_motion(mut self) -> Motion {
        self.trajectory.final_state = self.simulation.state().to_vec();
        let names = self.controllers.iter();
        let names = names.flat_map(|controller| controller.state_names());
        Motion {
            surfaces: self.simulation.surfaces().to_vec(),
            inputs: self.request.inputs.with_held_steps(&self.changes),
            solver: self.simulation.solver(),
            solver_choice: self.simulation.solver_choice().cloned(),
            early_stop: None,
            initial_changes: self.simulation.initial_changes().to_vec(),
            audit: None,
            controller_states: ControllerStates {
                names: names.collect(),
                rows: self.states,
            },
            trajectory: self.trajectory,
        }
    }
}
