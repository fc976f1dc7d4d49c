//! States in the domain of a model and on its constraints, at fixed parameters.

use eomgen_codegen::program::evaluator::Evaluator;
use eomgen_compiled_model::Projection;
use eomgen_sim::inputs::HeldInputs;

use crate::model::estimation_model::EstimationModel;

/// Admissible states of a model at fixed parameters.
pub(crate) struct AdmissibleStates<'m> {
    model: &'m EstimationModel,
    constraints: Option<(Projection, Evaluator)>,
}

impl<'m> AdmissibleStates<'m> {
    /// Prepares a model at these values of its parameters.
    pub fn new(model: &'m EstimationModel, values: &[f64]) -> Self {
        let projection = model.create_projection(values);
        Self {
            model,
            constraints: projection.map(|own| (own, model.create_evaluator(values))),
        }
    }

    /// Moves a state at a time (s) into the declared ranges and then to the nearest state on the constraints. If there
    /// is none, it stays off the constraints, and a simulation from it fails.
    pub fn find_nearest(&mut self, state: Vec<f64>, (t, inputs): (f64, &HeldInputs)) -> Vec<f64> {
        let mut state = self.model.clamp_state(state);
        if let Some((projection, evaluator)) = &mut self.constraints {
            projection.move_onto_constraints(evaluator, (t, &inputs.evaluate(t)), &mut state);
        }
        state
    }
}
