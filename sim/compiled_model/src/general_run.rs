//! A motion with a solver that supports any model: the system that it integrates, and the reasons of
//! early stops.

use std::cell::RefCell;

use eomgen_codegen::program::evaluator::Evaluator;
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::{Method, Settings, SolveError, Surface};

use crate::audit::Auditor;
use crate::driven_model::DrivenModel;
use crate::error::Error;
use crate::infinite_inputs::find_infinite_function;
use crate::instance::Instance;
use crate::model::CompiledModel;
use crate::motion::{EarlyStop, Solver, StopCause};
use crate::projection::InitialChange;
use crate::stop_reasons::{find_stop_cause, format_named};

/// The system of one motion and its start.
pub(crate) struct GeneralRun {
    pub system: DrivenModel<RefCell<Evaluator>, HeldInputs>,
    pub surfaces: Vec<Surface>,
    pub solver: Solver,
    /// Consistent state at the start.
    pub initial: Vec<f64>,
    pub initial_changes: Vec<InitialChange>,
    /// All parameters of the specification, SI.
    values: Vec<f64>,
}

impl Instance<'_> {
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
        if settings.method == Method::Adams {
            self.check_adams()?;
        }
        // Before the evaluator, whose pivots give a less specific error for dependent constraints.
        let values = self.values().to_vec();
        let start = self.find_consistent_start(state, span, inputs);
        let (initial, initial_changes) = start.map_err(|error| {
            let infinite = find_infinite_function(self.model(), &values, (span.0, span.0));
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
            // The Adams method uses the preceding steps, so it cannot continue from sticking; it
            // reports the time of sticking instead.
            system = system.without_holding();
        }
        if solver == Solver::Radau {
            system = system.with_jacobian(self.jacobian_evaluator()?);
        }
        Ok(GeneralRun {
            surfaces: system.surfaces(),
            system,
            solver,
            initial,
            initial_changes,
            values,
        })
    }

    /// Rejects models in which states or rates jump.
    fn check_adams(&self) -> Result<(), Error> {
        let jumps = if !self.model().model().impacts.is_empty() {
            "impacts of this model invalidate".to_owned()
        } else if let Some(surface) = self.model().first_corner() {
            format!(
                "jumps of the rates invalidate, and the energies of this model jump where `{surface}` is zero"
            )
        } else if !self.model().model().constraints.is_empty() {
            "the projection onto the constraints invalidates".to_owned()
        } else if self.sided_model()?.is_some_and(|sided| sided.has_discs()) {
            "a stop under friction along v/norm(v) invalidates".to_owned()
        } else {
            return Ok(());
        };
        Err(Error::Request(format!(
            "the solver adams uses the preceding steps, which {jumps}: use --solver rk or radau"
        )))
    }
}

impl GeneralRun {
    pub fn with_auditor(mut self, auditor: Option<Auditor>) -> Self {
        self.system = self.system.with_auditor(auditor);
        self
    }

    /// Returns time, cause and cure of an error. The motion began at a time (s) and reached a state.
    pub fn early_stop(
        &self,
        model: &CompiledModel,
        error: &SolveError,
        (begin, state): (f64, &[f64]),
    ) -> EarlyStop {
        let t = SolveError::time(error);
        let cause = find_stop_cause(model, error, &self.surfaces);
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
            .then(|| find_infinite_function(model, &self.values, (begin, ended_at)))
            .flatten();
        let reason = if let Some(infinite) = infinite {
            infinite
        } else if let Some(overlap) = self.system.overlap_message() {
            format!("at t = {ended_at:?} s {overlap}")
        } else if let Some(corner) = self.system.corner_message() {
            corner
        } else if let Some(singular) = singular {
            singular
        } else {
            format_named(model, (&self.surfaces, self.solver), |names| {
                error.format_named(names)
            })
        };
        EarlyStop { t, reason, cause }
    }
}
