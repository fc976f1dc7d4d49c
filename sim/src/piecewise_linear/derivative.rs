//! The rates of the state at one state, as the exact solver has them.

use super::clock::Clock;
use super::dependents::{Asking, Standing};
use super::error::ExactError;
use super::parallel_guards::Cell;
use super::propagator::Propagator;
use crate::ode::SolveError;

/// Rates of the state with their sizes.
#[derive(Clone, Debug, PartialEq)]
pub struct Rates {
    /// The rates, one per state.
    pub values: Vec<f64>,
    /// The sum of the magnitudes of what each is made of.
    pub sizes: Vec<f64>,
}

impl Propagator {
    /// The rates at a time, s, a state and inputs, in the regime that a motion from there
    /// begins in; on a switching surface, where the sides differ, those of its lower side.
    ///
    /// # Errors
    /// If there are not as many states and inputs as the model has.
    pub fn rates(&mut self, t: f64, state: &[f64], inputs: &[f64]) -> Result<Rates, ExactError> {
        if state.len() != self.states || inputs.len() < self.inputs {
            let problem = format!("expected {} states and {} inputs", self.states, self.inputs);
            return Err(SolveError::Request { problem }.into());
        }
        let inputs = &inputs[..self.inputs];
        let phases = self.phases_at(Clock::at(t));
        let standing = Standing {
            state,
            inputs,
            phases: &phases,
        };
        let cells = if self.has_dependents() {
            let mut cells = vec![Cell::Between(0); self.families.len()];
            self.settle(&mut cells, Asking::Start, standing);
            cells
        } else {
            self.cells_at(state, inputs, &phases).0
        };
        let outline = self.outline(&cells);
        Ok(self.outlines[outline].rates(standing))
    }
}
