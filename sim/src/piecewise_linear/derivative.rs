//! Rates at one state, as computed by the exact solver.

use super::clock::Clock;
use super::dependents::{DecisionCause, StateAt};
use super::error::ExactError;
use super::parallel_guards::Cell;
use super::propagator::Propagator;
use crate::ode::SolveError;

/// Rates of the state with the magnitudes of their terms.
#[derive(Clone, Debug, PartialEq)]
pub struct Rates {
    /// Rates, one per state.
    pub values: Vec<f64>,
    /// Sum of the magnitudes of the terms of each rate.
    pub sizes: Vec<f64>,
}

impl Propagator {
    /// Returns the rates at a time (s), a state and inputs, in the regime of a motion that starts
    /// there. On a switching surface these are the rates of the lower side.
    ///
    /// # Errors
    /// A number of states or inputs that differs from the model's.
    pub fn evaluate_rates(
        &mut self,
        t: f64,
        state: &[f64],
        inputs: &[f64],
    ) -> Result<Rates, ExactError> {
        if state.len() != self.states || inputs.len() < self.inputs {
            let problem = format!("expected {} states and {} inputs", self.states, self.inputs);
            return Err(SolveError::Request { problem }.into());
        }
        let inputs = &inputs[..self.inputs];
        let phases = self.phases_at(Clock::new(t));
        let point = StateAt {
            state,
            inputs,
            phases: &phases,
        };
        let cells = if self.has_dependents() {
            let mut cells = vec![Cell::Between(0); self.families.len()];
            self.determine_cells(&mut cells, DecisionCause::Start, point);
            cells
        } else {
            self.find_cells_at(state, inputs, &phases).0
        };
        let outline = self.outline(&cells);
        Ok(self.outlines[outline].rates(point))
    }
}
