//! Run of a solver that supports any model: the system that it integrates, and the reasons of early stops.

use std::cell::RefCell;

use eomgen_codegen::program::evaluator::Evaluator;
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::{Method, Settings, SolveError, Surface};

use crate::driven_model::DrivenModel;
use crate::error::Error;
use crate::motion::{EarlyStop, Solver, StopCause};
use crate::motion_model::MotionModel;
use crate::projection::InitialChange;
use crate::stop_reasons::{find_stop_cause, format_named};

/// System of one motion, with its start.
pub(crate) struct GeneralRun {
    pub system: DrivenModel<RefCell<Evaluator>, HeldInputs>,
    pub surfaces: Vec<Surface>,
    pub solver: Solver,
    /// Consistent initial state.
    pub initial: Vec<f64>,
    pub initial_changes: Vec<InitialChange>,
}

impl dyn MotionModel + '_ {
    /// Prepares a motion from a state over a time span, s.
    ///
    /// # Errors
    /// A model that the method does not support, or no consistent state near the given one.
    pub(crate) fn prepare_general_run(
        &self,
        (state, span): (&[f64], (f64, f64)),
        inputs: &HeldInputs,
        settings: &Settings,
    ) -> Result<GeneralRun, Error> {
        // This check precedes the evaluator, whose pivots give a less specific error for dependent constraints.
        let start = self.find_consistent_start(state, span, inputs);
        let (initial, initial_changes) = start.map_err(|error| {
            let infinite = self.find_infinite_function((span.0, span.0));
            let t = Some(span.0);
            infinite.map_or(error, |reason| Error::Stopped { t, reason })
        })?;
        let evaluator = RefCell::new(self.evaluator()?);
        let mut system = self.driven_model(evaluator, inputs.clone(), settings.tolerance)?;
        let solver = match settings.method {
            Method::DormandPrince853 => Solver::Rk,
            Method::Adams => Solver::Adams,
            Method::Radau => Solver::Radau,
        };
        if solver == Solver::Adams {
            // The Adams method uses the preceding steps, so it cannot continue after sticking. It reports the time of
            // sticking instead.
            system = system.without_holding();
        }
        if solver == Solver::Radau
            && let Some(jacobians) = self.jacobian_evaluator()?
        {
            system = system.with_jacobian(jacobians);
        }
        Ok(GeneralRun {
            surfaces: system.surfaces(),
            system,
            solver,
            initial,
            initial_changes,
        })
    }
}

impl GeneralRun {
    /// Returns time, cause and remedy of an error. The motion began at the time `begin` (s) and
    /// ended at `state`.
    pub fn describe_early_stop(
        &self,
        model: &dyn MotionModel,
        error: &SolveError,
        (begin, state): (f64, &[f64]),
    ) -> EarlyStop {
        let t = SolveError::time(error);
        let cause = find_stop_cause(model.labels(), error, &self.surfaces);
        let ended_at = t.unwrap_or(begin);
        let may_be = matches!(cause, StopCause::NotFinite | StopCause::Limit);
        let singular = may_be
            .then(|| self.system.find_singular_position((ended_at, state)))
            .flatten();
        let (t, singular) = match singular {
            Some((passed, reason)) => (Some(passed), Some(reason)),
            None => (t, None),
        };
        let infinite = may_be
            .then(|| model.find_infinite_function((begin, ended_at)))
            .flatten();
        let jump = matches!(error, SolveError::StepTooSmall { .. })
            .then(|| self.system.jump_message(ended_at))
            .flatten();
        let reason = if let Some(message) = infinite.or(jump) {
            message
        } else if let Some(overlap) = self.system.overlap_message() {
            format!("at t = {ended_at:?} s {overlap}")
        } else if let Some(corner) = self.system.corner_message() {
            corner
        } else if let Some(singular) = singular {
            singular
        } else {
            format_named(model.labels(), (&self.surfaces, self.solver), |names| {
                error.format_named(names)
            })
        };
        EarlyStop { t, reason, cause }
    }
}
