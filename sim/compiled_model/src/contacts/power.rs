//! Work of moving contacts. The force F of a contact whose distance g(q, t) depends on time has
//! the power F g_q q' = F (g' - g_t). Its impulse P does the work -P g_t, without the loss by
//! restitution.

use eomgen_codegen::program::evaluator::{Evaluator, Point};

use super::Contacts;

impl Contacts {
    /// Returns the power (W) of the forces of the closed contacts.
    pub fn power(&mut self, own: &mut Evaluator, point: Point<'_>) -> f64 {
        if self.closed.is_empty() {
            return 0.0;
        }
        let drifts = self.distance_rates_at_rest(own, point);
        own.impacts(point, &mut self.at);
        let forces = self.closed.iter().zip(self.forces());
        forces
            .map(|(place, force)| force * (self.at[*place].rate - drifts[*place]))
            .sum()
    }

    /// Returns the work (J) of moving contacts in the last impact.
    pub fn impact_work(&self) -> f64 {
        self.impact_work
    }

    /// Returns the rate g_t of each distance at zero rates of the coordinates.
    pub(super) fn distance_rates_at_rest(
        &mut self,
        own: &mut Evaluator,
        point: Point<'_>,
    ) -> Vec<f64> {
        let degrees = own.program().degrees_of_freedom();
        let mut state = point.state.to_vec();
        state[degrees..2 * degrees].fill(0.0);
        let still = Point {
            state: &state,
            ..point
        };
        own.impacts(still, &mut self.at);
        self.at.iter().map(|impact| impact.rate).collect()
    }
}
