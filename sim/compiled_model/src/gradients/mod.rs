//! Gradients of trajectories with respect to initial state, parameters and held inputs, through events.
//!
//! - `recorder` keeps the steps and events of a motion.
//! - `pull_back` follows them backwards (discrete adjoint): it repeats every step and multiplies by the transposed
//!   Jacobians of its stages.
//! - `events` multiplies by the transposed saltation matrix of every event (R. I. Leine and H. Nijmeijer, *Dynamics and
//!   Bifurcations of Non-Smooth Mechanical Systems*, Springer 2004, section 7.3).
//! - `surfaces` rejects motions that touch a surface without crossing it.
//! - `start` and `moved_start` follow the projection of the initial state onto the constraints, from near and from far.
//! - `mode_evaluator` evaluates rates and products in the mode of a step: with its fixed sides, and with the sides of
//!   surfaces that hold the motion.
//!
//! The computation time does not depend on the number of parameters.

mod derivatives;
mod events;
mod mode_evaluator;
mod moved_start;
mod pull_back;
mod recorder;
mod start;
mod support;
mod surfaces;

use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::{Method, Settings, Trajectory, simulate_into};

use crate::error::Error;
use crate::instance::Instance;
use crate::motion::{Motion, Solver};
use crate::motion_model::MotionModel;
use crate::observers::Results;
use crate::simulation::{Request, new_motion, with_early_stop};

use recorder::{Recorder, Recording};
use support::check_support;

/// Motion with its steps and events, for gradients.
pub struct RecordedMotion<'m> {
    instance: Instance<'m>,
    motion: Motion,
    /// Requested initial state.
    requested: Vec<f64>,
    /// Initial state on the constraints.
    initial: Vec<f64>,
    tolerance: f64,
    recording: Recording,
}

/// Derivatives of a number L with respect to the states and observables of each sample.
#[derive(Clone, Debug, Default)]
pub struct SampleWeights {
    /// Derivatives with respect to the states, SI: one row per sample, or no rows.
    pub states: Vec<Vec<f64>>,
    /// Derivatives with respect to the observables, SI: one row per sample, or no rows.
    pub observables: Vec<Vec<f64>>,
}

/// Gradient of a number L that depends on the samples of a motion, SI.
#[derive(Clone, Debug, PartialEq)]
pub struct TrajectoryGradient {
    /// Derivatives with respect to the requested initial state, which is projected onto the constraints. `None` if
    /// friction holds the motion at the start, because the speed cannot change then.
    pub initial_state: Option<Vec<f64>>,
    /// Derivatives with respect to the independent parameters at constant initial state, in the order of
    /// [`CompiledModel::parameter_names`](crate::CompiledModel::parameter_names).
    pub parameters: Vec<f64>,
    /// Derivatives with respect to the held inputs: one row per sample of the inputs. Prescribed inputs and functions
    /// of time have NaN.
    pub inputs: Vec<Vec<f64>>,
}

impl<'m> Instance<'m> {
    /// Simulates a request with the Runge-Kutta method and records it for gradients. The motion equals that of
    /// [`Instance::simulate_until_stop`]. It may stop early, and then has no gradient. Calls `progress` with the
    /// current time, s.
    ///
    /// # Errors
    /// Errors of a simulation, and models without gradients: controllers, friction of contacts, jumps of the energies,
    /// friction along v/norm(v), and switching functions over modes.
    pub fn record_motion(
        &self,
        request: &Request<'_>,
        progress: &mut dyn FnMut(f64),
    ) -> Result<RecordedMotion<'m>, Error> {
        if !matches!(request.solver, Solver::Rk | Solver::Auto) {
            let solver = request.solver;
            return Err(Error::Request(format!(
                "gradients are available only with the solver rk, not with {solver}"
            )));
        }
        check_support(self)?;
        let settings = Settings {
            max_step: request.max_step,
            method: Method::DormandPrince853,
            ..Settings::with_tolerance(request.tolerance)
        };
        settings
            .check()
            .map_err(|error| Error::Request(error.to_string()))?;
        self.check_held_inputs(request.inputs, request.time_span())?;
        let span = request.time_span();
        let run = (self as &dyn MotionModel).prepare_general_run(
            (request.initial, span),
            request.inputs,
            &settings,
        )?;
        let recorder = Recorder::new(&run.system);
        let mut trajectory = Trajectory::default();
        let asked = (&run.initial[..], span, request.times);
        let ended = simulate_into(&mut trajectory, &recorder, asked, &settings, progress);
        let recording = recorder.finish();
        let found = (trajectory, run.surfaces.clone());
        let motion = Motion {
            initial_changes: run.initial_changes.clone(),
            ..new_motion(found, request, Solver::Rk, (None, Results::default()))
        };
        let motion = match ended {
            Ok(()) => motion,
            Err(error) => {
                let reached = (span.0, &motion.trajectory.final_state[..]);
                let stop = run.describe_early_stop(self, &error, reached);
                with_early_stop(motion, stop)?
            }
        };
        Ok(RecordedMotion {
            instance: self.clone(),
            motion,
            requested: request.initial.to_vec(),
            initial: run.initial.clone(),
            tolerance: request.tolerance,
            recording,
        })
    }
}

impl RecordedMotion<'_> {
    /// Returns the motion.
    pub fn motion(&self) -> &Motion {
        &self.motion
    }

    /// Returns the gradient of a number L whose derivatives with respect to the samples are `weights`.
    ///
    /// # Errors
    /// [`Error::Stopped`] for a motion that stopped early; weights of wrong shape; weights or derivatives that are not
    /// finite. No gradient exists if the motion touches a switching surface, crosses several at once, or rests in a
    /// contact.
    pub fn gradient(&self, weights: &SampleWeights) -> Result<TrajectoryGradient, Error> {
        match &self.motion.early_stop {
            Some(stop) => Err(stop.clone().into()),
            None => pull_back::pull_back(self, weights),
        }
    }

    fn inputs(&self) -> &HeldInputs {
        &self.motion.inputs
    }
}
