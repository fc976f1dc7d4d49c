//! Work of contacts. The force F of a contact whose distance g(q, t) depends on time has the power
//! F g_q q' = F (g' - g_t). Its impulse P does the work -P g_t, without the loss by restitution. Friction T along
//! the slip s(q, q', t) has the power T (s - s_0), with s_0 the slip at zero rates, and its impulse does the
//! work -P s_0 without the loss by friction.

use eomgen_codegen::program::evaluator::{Evaluator, FrictionValues, Point};

use super::Contacts;
use super::tangents::ContactForces;

/// Rates of the distances and slips at zero rates of the coordinates: motion of the contacts themselves.
pub(super) struct Drifts {
    pub normal: Vec<f64>,
    /// Rates of the slips of all contacts; 0 for those without friction.
    pub slips: Vec<f64>,
}

impl Drifts {
    /// Returns the work (J) of impulses at these contacts against their own motion.
    pub fn work_against(&self, places: &[usize], impulses: &ContactForces) -> f64 {
        let normal = places.iter().zip(&impulses.normal);
        let normal = normal.map(|(place, impulse)| impulse * self.normal[*place]);
        let slips = places.iter().zip(&impulses.tangential);
        let slips = slips.map(|(place, impulse)| impulse * self.slips[*place]);
        normal.chain(slips).sum()
    }

    /// Returns true if a contact does not move itself.
    pub fn is_still(&self, place: usize) -> bool {
        self.normal[place] == 0.0 && self.slips[place] == 0.0
    }
}

impl Contacts {
    /// Returns the power (W) of the forces of the closed contacts.
    pub fn power(&mut self, own: &mut Evaluator, point: Point<'_>) -> f64 {
        if self.closed.is_empty() {
            return 0.0;
        }
        let drifts = self.drifts(own, point);
        own.impacts(point, &mut self.at);
        let forces = self.forces();
        let normal = self.closed.iter().zip(&forces.normal);
        let normal =
            normal.map(|(place, force)| force * (self.at[*place].rate - drifts.normal[*place]));
        let along = self.closed.iter().zip(&forces.tangential);
        let along = along.map(|(place, force)| {
            let slip = self.at[*place]
                .friction
                .as_ref()
                .map_or(0.0, |one| one.slip);
            force * (slip - drifts.slips[*place])
        });
        normal.chain(along).sum()
    }

    /// Returns the work (J) of moving contacts in the last impact.
    pub fn impact_work(&self) -> f64 {
        self.impact_work
    }

    pub(super) fn drifts(&mut self, own: &mut Evaluator, point: Point<'_>) -> Drifts {
        let degrees = own.program().degrees_of_freedom();
        let mut state = point.state.to_vec();
        state[degrees..2 * degrees].fill(0.0);
        let still = Point {
            state: &state,
            ..point
        };
        own.impacts(still, &mut self.at);
        let slip = |friction: &FrictionValues| friction.slip;
        let slips = self.at.iter();
        Drifts {
            normal: self.at.iter().map(|impact| impact.rate).collect(),
            slips: slips
                .map(|impact| impact.friction.as_ref().map_or(0.0, slip))
                .collect(),
        }
    }
}
