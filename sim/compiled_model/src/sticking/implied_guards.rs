//! Switching functions that vanish whenever held functions and rates of closed contacts do: dot(y) - dot(x) if dot(x)
//! and dot(y) are held. Their values are rounding, so their signs have no meaning.
//!
//! Such a function is a linear combination of the held functions with constant coefficients. Equality at random points
//! proves this, except for a set of points of measure zero (J. T. Schwartz, J. ACM 27 (1980) 701-717).

use eomgen_analysis::qr_iteration;
use eomgen_codegen::program::evaluator::{ImpactValues, Point};
use eomgen_sim::random_numbers::Numbers;
use nalgebra::{DMatrix, DVector};

use super::sided_model::SidedModel;

/// Number of random points beyond the number of functions that can be held.
const ADDITIONAL_POINTS: usize = 4;

/// Largest difference from the linear combination, relative to the largest value of the function.
const MAX_DIFFERENCE: f64 = 1e-10;

impl SidedModel {
    /// Finds the guards and contact rates that vanish with the functions of the `held` rows and the rates of closed
    /// contacts.
    pub(super) fn find_implied_guards(&mut self, held: &[usize]) {
        self.implied_guards.clear();
        self.implied_contacts.clear();
        let first_rate = self.guards.len();
        let rates = self.closed_contacts().iter();
        let rates = rates.map(|(contact, _)| first_rate + contact);
        let own: Vec<usize> = held
            .iter()
            .map(|row| self.guard_index(*row))
            .chain(rates)
            .collect();
        if own.is_empty() {
            return;
        }
        if self.drawn_values.is_empty() {
            self.drawn_values = self.evaluate_at_random_points();
        }
        let values = &self.drawn_values;
        let column =
            |place: usize| DVector::from_iterator(values.len(), values.iter().map(|at| at[place]));
        let columns: Vec<DVector<f64>> = own.iter().map(|place| column(*place)).collect();
        let Some(functions) = qr_iteration::svd(&DMatrix::from_columns(&columns)) else {
            return;
        };
        let least = MAX_DIFFERENCE * functions.singular_values.max();
        let is_implied = |guard: &usize| {
            let wanted = column(*guard);
            let size = wanted.amax();
            let factors = functions.solve(&wanted, least).ok();
            let rest = factors.map(|factors| {
                let terms = columns.iter().zip(&factors);
                terms.fold(wanted, |rest, (column, factor)| rest - column * *factor)
            });
            size > 0.0 && rest.is_some_and(|rest| rest.amax() <= MAX_DIFFERENCE * size)
        };
        let others = (0..self.guard_count()).filter(|guard| !own.contains(guard));
        let implied_guards = others.filter(is_implied).collect();
        let contacts = 0..values[0].len() - first_rate;
        let is_held = |contact: &usize| is_implied(&(first_rate + contact));
        let implied_contacts = contacts.filter(is_held).collect();
        (self.implied_guards, self.implied_contacts) = (implied_guards, implied_contacts);
    }

    /// Returns the guards and the rates of the contacts at random points.
    fn evaluate_at_random_points(&mut self) -> Vec<Vec<f64>> {
        let mut numbers = Numbers::new(1);
        let mut draw = |count: usize| (0..count).map(|_| numbers.draw()).collect::<Vec<f64>>();
        let count = self.evaluator.program().states();
        let contacts = self.evaluator.program().impacts.len();
        let mut rates: Vec<ImpactValues> = Vec::new();
        let points = 0..self.side_count() + contacts + ADDITIONAL_POINTS;
        let values = points.map(|_| {
            let (t, state, inputs) = (draw(1)[0], draw(count), draw(self.inputs.len()));
            let (state, inputs) = (&state[..], &inputs[..]);
            let mut values = vec![0.0; self.guards.len()];
            self.evaluator
                .guards(Point { t, state, inputs }, &mut values);
            self.evaluator
                .impacts(Point { t, state, inputs }, &mut rates);
            values.extend(rates.iter().map(|impact| impact.rate));
            values
        });
        values.collect()
    }
}
