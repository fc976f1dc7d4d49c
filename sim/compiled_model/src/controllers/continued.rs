//! Simulations with controllers that continue over several calls.

use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::Trajectory;

use super::control_loop::{ControlLoop, LoopRecord, Plant, limit_steps};
use super::controller::SampledController;
use super::memory::ControlMemory;
use crate::error::Error;
use crate::instance::Instance;
use crate::motion::EarlyStop;
use crate::resumable::Simulation;
use crate::solver_options::SolverOptions;

impl<'m> Instance<'m> {
    /// Prepares a simulation with controllers from a time (s), a state and inputs. The samples at this time are not
    /// taken yet.
    ///
    /// # Errors
    /// Two controllers drive the same input; see also [`Instance::start_simulation`].
    pub(crate) fn prepare_controlled<'c>(
        &self,
        (start, inputs): ((f64, &[f64]), HeldInputs),
        options: SolverOptions,
        controllers: Vec<Box<dyn SampledController + 'c>>,
    ) -> Result<Simulation<'c>, Error>
    where
        'm: 'c,
    {
        self.check_driven_once(&controllers, &inputs)?;
        let schedules = controllers.iter().map(|own| own.schedule());
        let options = limit_steps(options, schedules);
        let mut simulation: Simulation<'c> = self.start_plant(start, inputs.clone(), options)?;
        simulation.controls = Some(self.create_loop((start.0, inputs), controllers));
        Ok(simulation)
    }

    /// Continues a simulation with the controllers of the specification at a time whose samples are already taken, with
    /// their memory and the present inputs.
    ///
    /// # Errors
    /// The memory belongs to other controllers; see also [`Instance::start_simulation`].
    pub fn continue_simulation(
        &self,
        (t, state): (f64, &[f64]),
        inputs: HeldInputs,
        options: SolverOptions,
        memory: &ControlMemory,
    ) -> Result<Simulation<'m>, Error> {
        let start = ((t, state), inputs);
        let mut simulation = self.prepare_controlled(start, options, self.boxed_controllers()?)?;
        if let Some(controls) = &mut simulation.controls {
            controls.resume(t, memory)?;
        }
        Ok(simulation)
    }

    /// Returns the controllers of the specification for a motion with steps made by an external solver, at a time (s)
    /// with the present inputs. They continue with a memory, or start before the samples at this time.
    ///
    /// # Errors
    /// The memory belongs to other controllers; see also [`Instance::controllers`].
    pub fn control_loop(
        &self,
        (t, inputs): (f64, HeldInputs),
        memory: Option<&ControlMemory>,
    ) -> Result<ControlLoop<'m>, Error> {
        let mut controls = self.create_loop((t, inputs), self.boxed_controllers()?);
        if let Some(memory) = memory {
            controls.resume(t, memory)?;
        }
        Ok(controls)
    }

    fn create_loop<'c>(
        &self,
        (t, inputs): (f64, HeldInputs),
        controllers: Vec<Box<dyn SampledController + 'c>>,
    ) -> ControlLoop<'c> {
        let program = self.model().program();
        let counts = (program.inputs.len(), program.observables.len());
        ControlLoop::new(controllers, inputs, t, counts)
    }

    /// Returns the controllers of the specification in their initial states.
    pub(crate) fn boxed_controllers(&self) -> Result<Vec<Box<dyn SampledController + 'm>>, Error> {
        let declared = self.controllers()?.into_iter();
        let boxed = declared.map(|own| Box::new(own) as Box<dyn SampledController>);
        Ok(boxed.collect())
    }

    fn check_driven_once(
        &self,
        controllers: &[Box<dyn SampledController + '_>],
        given: &HeldInputs,
    ) -> Result<(), Error> {
        let mut driven = Vec::new();
        for place in controllers.iter().flat_map(|own| own.driven_inputs()) {
            let inputs = &self.model().program().inputs;
            let name = inputs.get(*place).map_or("", |input| &input.name);
            if !given.is_held(*place) {
                return Err(Error::Request(format!(
                    "a controller drives the input `{name}`: remove the function of time of this input, or the output \
                     of the controller"
                )));
            }
            if driven.contains(place) {
                return Err(Error::Request(format!(
                    "two controllers drive the input `{name}`: let one controller compute the sum of both"
                )));
            }
            driven.push(*place);
        }
        Ok(())
    }
}

impl Simulation<'_> {
    /// Continues to a time (s) with the controllers and adds the rows to the record. Returns the reason of an early
    /// stop.
    ///
    /// # Errors
    /// Times that are not finite, not ascending or before the current time.
    pub(crate) fn follow(
        &mut self,
        (until, rows): (f64, &[f64]),
        record: &mut LoopRecord<'_>,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Option<EarlyStop>, Error> {
        self.check_step_count(until)?;
        let Some(mut controls) = self.controls.take() else {
            return self.advance_plant((until, rows), record.trajectory, progress);
        };
        let checked = self.check_times(until, rows);
        let ended = checked.and_then(|()| controls.follow(self, (until, rows), record, progress));
        self.controls = Some(controls);
        ended
    }

    /// Returns the states of the controllers after the samples so far, SI.
    pub fn controller_states(&self) -> Vec<f64> {
        let controls = self.controls.as_ref();
        controls.map_or_else(Vec::new, ControlLoop::states)
    }

    /// Returns the memory of the controllers, for [`Instance::continue_simulation`]; `None` without controllers.
    pub fn control_memory(&self) -> Option<ControlMemory> {
        self.controls.as_ref().map(ControlLoop::memory)
    }

    /// Returns the names of the states of the controllers.
    pub fn controller_state_names(&self) -> Vec<String> {
        let controls = self.controls.as_ref();
        controls.map_or_else(Vec::new, ControlLoop::state_names)
    }

    /// Returns the first controlled input whose value in `inputs` differs from the present one.
    pub(crate) fn find_driven(&self, inputs: &[f64]) -> Option<usize> {
        let controls = self.controls.as_ref()?;
        let mut pairs = self.inputs().iter().zip(inputs).enumerate();
        let found = pairs.find(|(place, (own, new))| own != new && controls.drives(*place));
        found.map(|(place, _)| place)
    }
}

impl Plant for Simulation<'_> {
    fn time(&self) -> f64 {
        Simulation::time(self)
    }

    fn evaluation_time(&self) -> f64 {
        self.step_time().unwrap_or_else(|| Simulation::time(self))
    }

    fn state(&self) -> &[f64] {
        Simulation::state(self)
    }

    fn write_observables(&mut self, out: &mut [f64]) {
        Simulation::write_observables(self, out);
    }

    fn change_inputs(
        &mut self,
        inputs: HeldInputs,
        trajectory: &mut Trajectory,
    ) -> Result<(), Error> {
        Simulation::change_inputs(self, inputs, trajectory)
    }

    fn continue_until(
        &mut self,
        asked: (f64, &[f64]),
        trajectory: &mut Trajectory,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Option<EarlyStop>, Error> {
        self.advance_plant(asked, trajectory, progress)
    }
}
