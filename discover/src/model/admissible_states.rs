//! Admissible states of a model with fixed parameters: states within the ranges of the model and on
//! its constraints.

use eomgen_codegen::program::evaluator::Evaluator;
use eomgen_compiled_model::Projection;
use eomgen_sim::inputs::HeldInputs;

use crate::model::estimation_model::EstimationModel;

/// Finds admissible states of a model with fixed parameters.
pub(crate) struct AdmissibleStates<'m> {
    model: &'m EstimationModel,
    constraints: Option<(Projection, Evaluator)>,
}

impl<'m> AdmissibleStates<'m> {
    /// Prepares a model with given parameter values.
    pub fn new(model: &'m EstimationModel, values: &[f64]) -> Self {
        let projection = model.create_projection(values);
        Self {
            model,
            constraints: projection.map(|own| (own, model.create_evaluator(values))),
        }
    }

    /// Returns the admissible state near a state at a time (s). The state is first clamped to the
    /// declared ranges, then moved to the nearest state on the constraints. If no near state
    /// satisfies the constraints, the clamped state is returned, and a simulation from it fails.
    pub fn find_nearest(&mut self, state: Vec<f64>, (t, inputs): (f64, &HeldInputs)) -> Vec<f64> {
        let mut state = self.model.clamp_state(state);
        if let Some((projection, evaluator)) = &mut self.constraints {
            projection.move_onto_constraints(evaluator, (t, &inputs.evaluate(t)), &mut state);
        }
        state
    }
}
