//! Impulses of contacts with friction. Restitution at a single contact is energetic (W. J. Stronge). Contacts that are
//! hit together receive simultaneous impulses, with a common limit of their restitutions.

use eomgen_codegen::independence::vectors::find_max_magnitude;
use eomgen_sim::contact_friction::{SingleImpact, energetic_impulse};

use super::super::Contacts;
use super::super::impulses::{ENERGY_GAIN_ROUNDING, RESTITUTION_HALVINGS};
use super::super::tangents::ContactForces;

/// Rates below this fraction of the largest rate count as zero.
const RATE_ROUNDING: f64 = 1e-12;

impl Contacts {
    /// Returns the impulses of contacts that touch and were hit `time_since_hit` s before; `None` if no impulses keep the bodies
    /// apart.
    pub(in super::super) fn solve_friction_impulses(
        &self,
        touching: &[usize],
        time_since_hit: f64,
    ) -> Option<ContactForces> {
        let required = touching.iter();
        let required: Vec<f64> = required
            .map(|place| self.compute_required_rate_change(*place, time_since_hit, 1.0))
            .collect();
        let small = RATE_ROUNDING * find_max_magnitude(&required);
        // The rate of a closed contact is only rounding and must not count as a hit.
        let is_hit = |index: &usize| !self.rests(touching[*index]) && required[*index] < -small;
        let mut hit = (0..touching.len()).filter(is_hit);
        if let (Some(index), None) = (hit.next(), hit.next())
            && let Some(impulses) = self.solve_single(touching, index, time_since_hit)
            && self.leaves_apart(touching, &impulses, time_since_hit)
        {
            return Some(impulses);
        }
        self.solve_together(touching, time_since_hit)
    }

    /// Returns the magnitude of the terms in the acceleration of each slip, including the forces of closed contacts.
    pub(in super::super) fn compute_slip_acceleration_sizes(&self) -> Vec<f64> {
        if !self.has_friction() {
            return Vec::new();
        }
        let forces = self.compute_friction_forces();
        let impacts = self.names.len();
        let size = |place: usize| {
            let friction = self.friction_values(place)?;
            let pushes = self.closed.iter().enumerate().map(|(index, other)| {
                let tangent = self.tangent_index(*other);
                let along = tangent.map_or(0.0, |tangent| {
                    friction.delassus[impacts + tangent] * forces.tangential[index]
                });
                (friction.delassus[*other] * forces.normal[index]).abs() + along.abs()
            });
            Some(friction.acceleration.abs() + pushes.sum::<f64>())
        };
        let tangents = self.tangents.iter();
        tangents
            .map(|tangent| size(tangent.place).unwrap_or(0.0))
            .collect()
    }

    fn compute_hit_slip(&self, place: usize, time_since_hit: f64) -> f64 {
        let friction = self.friction_values(place);
        friction.map_or(0.0, |friction| {
            friction.slip - time_since_hit * friction.acceleration
        })
    }

    /// Returns the impulses if only one of the contacts receives one.
    fn solve_single(
        &self,
        touching: &[usize],
        index: usize,
        time_since_hit: f64,
    ) -> Option<ContactForces> {
        let place = touching[index];
        let w = self.compute_full_delassus(&[place]);
        let friction = self.friction_values(place);
        let [normal, tangential] = energetic_impulse(&SingleImpact {
            w: [[w[0], w[1]], [w[2], w[3]]],
            rates: [
                self.compute_hit_rate(place, time_since_hit),
                self.compute_hit_slip(place, time_since_hit),
            ],
            friction: friction.map_or(0.0, |friction| friction.coefficient),
            restitution: self.restitution(place),
        })?;
        let mut impulses = ContactForces {
            normal: vec![0.0; touching.len()],
            tangential: vec![0.0; touching.len()],
        };
        (impulses.normal[index], impulses.tangential[index]) = (normal, tangential);
        Some(impulses)
    }

    /// Returns the rates of the distances, then of the slips, at the time of the hit.
    fn compute_hit_rates(&self, touching: &[usize], time_since_hit: f64) -> Vec<f64> {
        let normal = touching
            .iter()
            .map(|place| self.compute_hit_rate(*place, time_since_hit));
        let slips = touching
            .iter()
            .map(|place| self.compute_hit_slip(*place, time_since_hit));
        normal.chain(slips).collect()
    }

    /// Returns true if no distance decreases after the given impulses.
    fn leaves_apart(
        &self,
        touching: &[usize],
        impulses: &ContactForces,
        time_since_hit: f64,
    ) -> bool {
        let before = self.compute_hit_rates(touching, time_since_hit);
        let changes = self.compute_rate_changes(touching, impulses);
        let small = RATE_ROUNDING * find_max_magnitude(&before);
        let mut after = touching.iter().zip(before.iter().zip(&changes));
        after.all(|(place, (before, change))| match self.rests(*place) {
            true => *change >= -small,
            false => before + change >= -small,
        })
    }

    /// Returns the changes of the rates of distances, then of slips, by the given impulses.
    pub(super) fn compute_rate_changes(
        &self,
        touching: &[usize],
        impulses: &ContactForces,
    ) -> Vec<f64> {
        let all: Vec<f64> = impulses
            .normal
            .iter()
            .chain(&impulses.tangential)
            .copied()
            .collect();
        let w = self.compute_full_delassus(touching);
        let rows = w.chunks_exact(all.len().max(1));
        rows.map(|row| row.iter().zip(&all).map(|(w, p)| w * p).sum())
            .collect()
    }

    /// Returns the impulses of contacts that are hit together: Newton's law in Moreau's form with Coulomb's law
    /// of friction. The restitutions are limited so that the energy above that of the plastic impact is
    /// at most e^2 times as large as before the impact.
    fn solve_together(&self, touching: &[usize], time_since_hit: f64) -> Option<ContactForces> {
        let before = self.compute_hit_rates(touching, time_since_hit);
        let with = |most: f64| {
            let mut rates = before.clone();
            for (rate, place) in rates.iter_mut().zip(touching) {
                *rate = self.compute_required_rate_change(*place, time_since_hit, most);
            }
            let decided = self.problem(touching, |_| None, &rates).decide(None, &[])?;
            Some(ContactForces::from_directions(decided.impulses))
        };
        // Returns the energy gain and the magnitude of its terms.
        let gain = |impulses: &ContactForces| {
            let changes = self.compute_rate_changes(touching, impulses);
            let all = impulses.normal.iter().chain(&impulses.tangential);
            let rates = before.iter().zip(&changes);
            all.zip(rates)
                .fold((0.0, 0.0), |(gained, exchanged), (p, (before, change))| {
                    let size: f64 = p.abs() * (before.abs() + 0.5 * change.abs());
                    (gained + p * (before + 0.5 * change), exchanged + size)
                })
        };
        let plastic = with(0.0)?;
        let restitutions = touching.iter().map(|place| self.restitution(*place));
        let largest = restitutions.fold(0.0, f64::max);
        if largest == 0.0 {
            return Some(plastic);
        }
        let bound = gain(&plastic).0 * (1.0 - largest * largest);
        let is_energetic = |impulses: &ContactForces| {
            let (sum, size) = gain(impulses);
            sum <= bound + ENERGY_GAIN_ROUNDING * size
        };
        let elastic = with(1.0);
        if let Some(impulses) = elastic.filter(|impulses| is_energetic(impulses)) {
            return Some(impulses);
        }
        let (mut most, mut found) = (0.0, plastic);
        let mut part = 0.5;
        for _ in 0..RESTITUTION_HALVINGS {
            if let Some(trial) = with(most + part).filter(|trial| is_energetic(trial)) {
                (most, found) = (most + part, trial);
            }
            part *= 0.5;
        }
        Some(found)
    }
}
