//! Open contacts at bodies that surfaces held. The bodies touch and do not move. When the surfaces release them, these
//! contacts close without an impact.

use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_sim::contact_friction::ContactMode;

use super::Contacts;

impl Contacts {
    /// Returns the open contacts at bodies that surfaces hold, from the last call of `note_drifts`.
    pub fn at_held_bodies(&self) -> Vec<usize> {
        let open = (0..self.names.len()).filter(|place| !self.rests(*place));
        open.filter(|place| self.touches_held_body(*place))
            .collect()
    }

    /// Closes contacts that touch at rest at a point. Returns the state of the point without the rounding errors of
    /// their distances and rates.
    pub fn close_at_rest(
        &mut self,
        own: &mut Evaluator,
        point: Point<'_>,
        places: &[usize],
    ) -> Vec<f64> {
        let roundings = self.compute_slip_roundings(own, point);
        for place in places {
            self.closed.push(*place);
            self.allowances[*place] = 0.0;
            let Some(index) = self.tangent_index(*place) else {
                continue;
            };
            let slip = self.slip(*place);
            self.tangents[index].mode = match slip.abs() <= roundings[index] {
                true => ContactMode::Sticks,
                false => ContactMode::Slides(slip.signum()),
            };
        }
        let mut state = point.state.to_vec();
        self.move_onto_closed(own, (point.t, point.inputs), &mut state);
        state
    }

    /// Returns those of the given closed contacts that push at a point.
    pub fn find_pushing(
        &mut self,
        own: &mut Evaluator,
        point: Point<'_>,
        places: &[usize],
    ) -> Vec<usize> {
        own.impacts(point, &mut self.at);
        let forces = self.compute_forces().normal;
        let pushing = self.closed.iter().zip(forces);
        let pushing = pushing.filter(|(place, force)| *force > 0.0 && places.contains(place));
        pushing.map(|(place, _)| *place).collect()
    }

    /// Opens the given closed contacts.
    pub fn reopen(&mut self, places: &[usize]) {
        self.closed.retain(|place| !places.contains(place));
    }
}
