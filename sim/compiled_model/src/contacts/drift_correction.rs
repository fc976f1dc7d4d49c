//! Distances of open contacts at bodies that surfaces hold. Held rates have rounding errors, which move such a body
//! over time. If a distance becomes negative by this drift, the body is moved back without an impact.

use eomgen_codegen::program::evaluator::{Enclosure, Evaluator, Point};
use eomgen_model_spec::interval::Interval;

use super::drift::{Drift, HeldDirection};
use super::{Contacts, ROUNDING};

impl Contacts {
    /// Records the drifts of open contacts at bodies that surfaces hold in the `held` directions, at a point between
    /// steps.
    pub fn note_drifts(&mut self, own: &mut Evaluator, point: Point<'_>, held: &[HeldDirection]) {
        if held.is_empty() && self.drifts.iter().all(Vec::is_empty) {
            return;
        }
        own.impacts(point, &mut self.at);
        let degrees = own.program().degrees_of_freedom();
        let rates = self.compute_rate_magnitudes(own, point.state);
        for place in 0..self.names.len() {
            let drifts = match self.rests(place) {
                true => Vec::new(),
                false => self.find_drifts(place, held),
            };
            let distance: f64 = drifts.iter().map(|drift| drift.distance(point.t)).sum();
            let rate: f64 = drifts.iter().map(|drift| drift.rate(point.t)).sum();
            let size =
                self.sizes[place].max(self.compute_distance_size(place, &point.state[..degrees]));
            let touches = self.at[place].distance <= ROUNDING * size + distance;
            let rests = self.at[place].rate.abs()
                <= ROUNDING * self.compute_rate_size(place, &rates) + rate;
            let before = std::mem::take(&mut self.drifts[place]);
            if touches && rests && !drifts.is_empty() {
                self.drifts[place] = drifts;
            } else if !before.is_empty() && !self.rests(place) {
                let offset = &mut self.offsets[place];
                *offset = offset.max((-self.at[place].distance).next_up());
            }
        }
    }

    fn find_drifts(&self, place: usize, held: &[HeldDirection]) -> Vec<Drift> {
        let drift = |held: &HeldDirection| {
            let terms = self.at[place].row.iter().zip(&held.column);
            let effect = terms.map(|(row, column)| row * column).sum::<f64>().abs();
            let [rate, growth] = held.roundings.map(|rounding| rounding * effect);
            Drift {
                since: held.since,
                rate,
                growth,
            }
        };
        let drifts = held.iter().map(drift);
        let moves = |drift: &Drift| drift.rate + drift.growth > 0.0;
        drifts.filter(moves).collect()
    }

    /// Returns true if an open contact touches a body that surfaces hold.
    pub(super) fn touches_held_body(&self, place: usize) -> bool {
        !self.drifts[place].is_empty()
    }

    /// Returns the offset that the guard of an open contact adds to its distance at a time (s).
    pub(super) fn offset(&self, place: usize, t: f64) -> f64 {
        let drifts = self.drifts[place].iter();
        self.offsets[place] + drifts.map(|drift| drift.distance(t)).sum::<f64>()
    }

    /// Returns bounds of the offset from `begin` to `end`, s.
    pub(super) fn bound_offset(&self, place: usize, begin: f64, end: f64) -> Enclosure {
        if self.drifts[place].is_empty() {
            return Enclosure::constant(self.offsets[place]);
        }
        let rate = |t: f64| self.drifts[place].iter().map(|drift| drift.rate(t)).sum();
        let value = Interval {
            low: self.offset(place, begin),
            high: self.offset(place, end),
        };
        let rate = Interval {
            low: 0.0,
            high: rate(end),
        };
        Enclosure::from_bounds(value, rate)
    }

    /// Projects a state onto the contacts whose distances became negative by drift. Returns the number of evaluations.
    pub(super) fn remove_drift(
        &mut self,
        own: &mut Evaluator,
        point: Point<'_>,
        (distances, coordinates): (&[f64], &mut [f64]),
    ) -> u64 {
        let has_drifted = |place: &usize| {
            let distance = distances[*place];
            !self.drifts[*place].is_empty()
                && distance < 0.0
                && distance + self.offset(*place, point.t) >= 0.0
        };
        let drifted: Vec<usize> = (0..distances.len()).filter(has_drifted).collect();
        if drifted.is_empty() {
            return 0;
        }
        own.impacts(point, &mut self.at);
        let corrections = self.solve_balance(&drifted, |impact| impact.distance);
        self.add_impulses(&drifted, &corrections, coordinates);
        1
    }
}
