//! Simulation of a request with sampled controllers.

use eomgen_sim::ode::Trajectory;

use super::clock::Clock;
use super::control_loop::LoopRecord;
use super::controller::SampledController;
use crate::error::Error;
use crate::instance::Instance;
use crate::motion::{ControllerStates, Motion};
use crate::observers::Results;
use crate::simulation::{ObservedRequest, Request, with_early_stop};
use crate::solver_options::SolverOptions;

/// Controllers in the order of their states and inputs.
pub type Controllers<'c> = [&'c mut dyn SampledController];

impl Instance<'_> {
    /// Simulates a request with controllers until the end or an early stop. A row at the time of a sample has the
    /// values after it. Calls `progress` with the current time, s. Jumps of held inputs at samples do no work.
    ///
    /// # Errors
    /// Two controllers drive the same input; see also [`Instance::simulate_until_stop`].
    pub fn simulate_controlled(
        &self,
        request: &Request<'_>,
        controllers: &mut Controllers<'_>,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Motion, Error> {
        self.simulate_with_controllers(ObservedRequest::new(request), controllers, progress)
    }

    /// Simulates like [`Instance::simulate_controlled`] and evaluates meters.
    pub(crate) fn simulate_with_controllers(
        &self,
        ObservedRequest {
            request,
            measurements,
        }: ObservedRequest<'_>,
        controllers: &mut Controllers<'_>,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Motion, Error> {
        let (start, end) = request.time_span();
        let options = SolverOptions {
            solver: request.solver,
            tolerance: request.tolerance,
            max_step: request.max_step,
        };
        // The error message would otherwise name the step size, which the periods limit.
        let schedules = controllers.iter().map(|own| own.schedule()).collect();
        Clock::new(schedules, start).check_sample_count((start, end))?;
        let controllers = controllers.iter_mut();
        let controllers =
            controllers.map(|own| Box::new(&mut **own) as Box<dyn SampledController + '_>);
        let mut simulation = self.prepare_controlled(
            ((start, request.initial), request.inputs.clone()),
            options,
            controllers.collect(),
        )?;
        simulation.observe(request.audit, measurements)?;
        let mut trajectory = Trajectory::default();
        let mut record = LoopRecord::new(&mut trajectory);
        let stop = simulation.follow((end, request.times), &mut record, progress)?;
        let LoopRecord {
            states, changes, ..
        } = record;
        trajectory.final_state = simulation.state().to_vec();
        let Results { audit, measured } = simulation.observed_results();
        let motion = Motion {
            surfaces: simulation.surfaces().to_vec(),
            inputs: request.inputs.with_held_steps(&changes),
            solver: simulation.solver(),
            solver_choice: simulation.solver_choice().cloned(),
            early_stop: None,
            initial_changes: simulation.initial_changes().to_vec(),
            friction_choices: simulation.friction_choices(),
            audit,
            measured,
            controller_states: ControllerStates {
                names: simulation.controller_state_names(),
                rows: states,
            },
            trajectory,
        };
        match stop {
            None => Ok(motion),
            Some(stop) => with_early_stop(motion, stop),
        }
    }
}
