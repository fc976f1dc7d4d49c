//! Backward pass over the corrections of a requested state that violates the constraints.
//!
//! Newton's method corrects coordinates and rates: x_(k+1) = x_k - (P g, P r)(x_k). P g and P r are linear combinations
//! of accelerations at three stabilisation rates (`projection`), so their derivatives follow from those of
//! accelerations. The derivatives include the curvature of the constraints, and the change of the mass matrix along the
//! corrections.

use eomgen_model_spec::model::STABILISATION_RATE;

use super::mode_evaluator::ModeEvaluator;
use super::pull_back::{BackwardPass, add_product, no_gradient};
use crate::error::Error;
use crate::evaluation::prepare_evaluator;
use crate::instance::Instance;
use crate::motion_model::MotionModel;
use crate::projection::LARGE_RATE_PER_S;

impl BackwardPass<'_, '_> {
    /// Converts the derivatives with respect to the consistent initial state into derivatives with respect to the
    /// requested one.
    pub fn propagate_over_corrections(&mut self) -> Result<(), Error> {
        let recorded = self.recorded;
        if recorded.motion.initial_changes.is_empty() {
            return Ok(());
        }
        let Some(first) = recorded.recording.parts.first() else {
            return Ok(());
        };
        let (t, instance) = (first.start.0, &recorded.instance);
        let model: &dyn MotionModel = instance;
        let start = (t, &recorded.requested[..]);
        let states = model.list_corrected_states(start, recorded.inputs())?;
        let names = instance.model().parameter_names();
        let rate = names.iter().position(|name| name == STABILISATION_RATE);
        let by_rate = rate.map(|place| self.parameters[place]);
        let mut corrections = Corrections::new(instance)?;
        for state in states.iter().rev() {
            self.propagate_over_correction((t, state), &mut corrections)?;
        }
        // The corrections do not depend on the stabilisation rate.
        if let (Some(place), Some(by_rate)) = (rate, by_rate) {
            self.parameters[place] = by_rate;
        }
        match self.adjoint.iter().all(|number| number.is_finite()) {
            true => Ok(()),
            false => Err(no_gradient(
                t,
                "a derivative of the correction onto the constraints is not finite",
            )),
        }
    }

    /// Converts the derivatives with respect to the state after a correction into derivatives with respect to the state
    /// before it.
    fn propagate_over_correction(
        &mut self,
        at: (f64, &[f64]),
        corrections: &mut Corrections,
    ) -> Result<(), Error> {
        let inputs = self.recorded.inputs();
        let (given, row) = (inputs.evaluate(at.0), inputs.last_sample_index(at.0));
        let adjoint = self.adjoint.clone();
        for (evaluator, weights) in corrections.compute_weights(&adjoint) {
            let mut products = evaluator.zeros();
            evaluator.pull_back_rates(at, &given, &weights, &mut products)?;
            for (sums, parts) in [
                (&mut self.adjoint, &products.state),
                (&mut self.parameters, &products.parameters),
                (&mut self.inputs[row], &products.inputs),
            ] {
                add_product(sums, -1.0, parts);
            }
        }
        Ok(())
    }
}

/// Evaluators of the accelerations at three stabilisation rates: that of the model, a large one and its negative.
struct Corrections {
    stabilisation_rate: f64,
    degrees: usize,
    evaluators: [ModeEvaluator; 3],
}

impl Corrections {
    fn new(instance: &Instance<'_>) -> Result<Self, Error> {
        let program = instance.model().gradient_program()?;
        let at = |rate: f64| {
            let instance = instance.with_stabilisation_rate(rate);
            ModeEvaluator::new(prepare_evaluator(
                &program.program,
                program.machine_code(),
                instance.parameters(),
            ))
        };
        let stabilisation_rate = MotionModel::stabilisation_rate(instance);
        Ok(Self {
            stabilisation_rate,
            degrees: program.program.degrees_of_freedom(),
            evaluators: [
                at(stabilisation_rate)?,
                at(LARGE_RATE_PER_S)?,
                at(-LARGE_RATE_PER_S)?,
            ],
        })
    }

    /// Returns, for each evaluator, the weights of its rates in the product of `adjoint` with a correction.
    fn compute_weights(
        &mut self,
        adjoint: &[f64],
    ) -> impl Iterator<Item = (&mut ModeEvaluator, Vec<f64>)> {
        let (own, large, degrees) = (self.stabilisation_rate, LARGE_RATE_PER_S, self.degrees);
        let mut weights = [(); 3].map(|()| vec![0.0; adjoint.len()]);
        for row in 0..degrees {
            let of_value = adjoint[row] / (large * large - own * own);
            let of_rate = (adjoint[degrees + row] + 2.0 * own * of_value) / (4.0 * large);
            let place = degrees + row;
            weights[0][place] = of_value;
            weights[1][place] = -of_rate - 0.5 * of_value;
            weights[2][place] = of_rate - 0.5 * of_value;
        }
        self.evaluators.iter_mut().zip(weights)
    }
}
