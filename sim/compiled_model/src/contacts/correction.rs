//! Projection of states onto closed contacts, and detection of overlapping bodies.

use eomgen_codegen::program::evaluator::{Evaluator, Point};

use super::{CORRECTIONS, ContactFailure, Contacts, DISTANCE_ROUNDING};

/// A distance below zero by more than this fraction of its terms is no error of a step. For a closed contact, the same
/// fraction of its distance before the correction may remain after it.
const MAX_OVERLAP_FRACTION: f64 = 1e-6;

impl Contacts {
    /// Projects a state onto the closed contacts and returns the number of evaluations. If bodies overlap, the state is
    /// replaced by NaN, which stops the motion.
    pub fn correct_state(
        &mut self,
        own: &mut Evaluator,
        (t, inputs): (f64, &[f64]),
        state: &mut [f64],
    ) -> u64 {
        let degrees = own.program().degrees_of_freedom();
        if self.has_no_forces {
            state.fill(f64::NAN);
            return 1;
        }
        if state.iter().any(|value| value.is_nan()) {
            return 1;
        }
        // A rejected step may have ended with a distance below zero.
        self.failure = None;
        self.uncorrected_offsets.clone_from(&self.offsets);
        self.uncorrected_redundant.clone_from(&self.redundant);
        let mut arrived = vec![0.0; self.names.len()];
        own.distances(Point { t, state, inputs }, &mut arrived);
        let here = state.to_vec();
        let point = Point {
            t,
            state: &here,
            inputs,
        };
        let corrected = self.remove_drift(own, point, (&arrived, &mut state[..degrees]));
        if corrected > 0 {
            own.distances(Point { t, state, inputs }, &mut arrived);
        }
        for (size, distance) in self.sizes.iter_mut().zip(&arrived) {
            *size = size.max(distance.abs());
        }
        if let Some(place) =
            self.find_overlapping_contact(own, Point { t, state, inputs }, &arrived)
        {
            return self.stop_overlapping(place, state);
        }
        if self.closed.is_empty() {
            return corrected;
        }
        self.move_onto_closed(own, (t, inputs), state);
        self.note_sizes(state);
        self.note_slip_sizes();
        let is_left = |place: &&usize| {
            let (before, after) = (arrived[**place], self.at[**place].distance);
            is_below(
                after,
                MAX_OVERLAP_FRACTION * self.sizes[**place].max(before.abs()),
            )
        };
        if let Some(place) = self.closed.iter().find(is_left) {
            return self.stop_overlapping(*place, state);
        }
        self.release_independent(state);
        self.keep_open_sides(t, &arrived);
        corrected + CORRECTIONS as u64 + 1
    }

    /// Projects a state onto the closed contacts and evaluates the impacts at the result.
    pub(super) fn move_onto_closed(
        &mut self,
        own: &mut Evaluator,
        (t, inputs): (f64, &[f64]),
        state: &mut [f64],
    ) {
        let degrees = own.program().degrees_of_freedom();
        for _ in 0..CORRECTIONS {
            own.impacts(Point { t, state, inputs }, &mut self.at);
            let (coordinates, rates) = state.split_at_mut(degrees);
            let corrections = self.solve_balance(&self.closed, |impact| impact.distance);
            self.add_impulses(&self.closed, &corrections, coordinates);
            let corrections = self.solve_normal_stopping_impulses();
            self.add_forces(&self.closed, &corrections, rates);
        }
        own.impacts(Point { t, state, inputs }, &mut self.at);
    }

    /// Marks the coordinates and rates that the projection onto closed contacts changes.
    pub fn mark_corrected(&self, coordinates: &mut [bool], rates: &mut [bool]) {
        let mark = |states: &mut [bool], column: &[f64]| {
            for (is_corrected, entry) in states.iter_mut().zip(column) {
                *is_corrected |= *entry != 0.0;
            }
        };
        for place in &self.closed {
            let contact = &self.at[*place];
            mark(coordinates, &contact.column);
            mark(rates, &contact.column);
            if let Some(friction) = &contact.friction {
                mark(rates, &friction.column);
            }
        }
    }

    /// Discards the notes of the last projection.
    pub fn forget_correction(&mut self) {
        self.failure = None;
        self.offsets.clone_from(&self.uncorrected_offsets);
        self.redundant.clone_from(&self.uncorrected_redundant);
    }

    /// Offsets the distances of open contacts that a projection makes zero or negative, because the motion has not hit
    /// these contacts yet. Event location needs a positive distance before an impact.
    fn keep_open_sides(&mut self, t: f64, before: &[f64]) {
        let was_passed = |place: &usize| {
            let offset = self.offset(*place, t);
            let was_open = !self.closed.contains(place) && before[*place] + offset >= 0.0;
            was_open && self.at[*place].distance + offset <= 0.0
        };
        let passed: Vec<usize> = (0..before.len()).filter(was_passed).collect();
        for place in passed {
            self.offsets[place] = (-self.at[place].distance).next_up();
        }
    }

    /// Returns the first open contact whose distance is below zero by more than step errors and rounding. Rounding
    /// includes that of the state, of the time and of the distance travelled since the start.
    fn find_overlapping_contact(
        &mut self,
        own: &mut Evaluator,
        point: Point<'_>,
        distances: &[f64],
    ) -> Option<usize> {
        let deepest = |contacts: &Self, place: usize| MAX_OVERLAP_FRACTION * contacts.sizes[place];
        let mut open = (0..distances.len()).filter(|place| !self.rests(*place));
        open.find(|place| is_below(distances[*place], deepest(self, *place)))?;
        own.impacts(point, &mut self.at);
        self.note_sizes(point.state);
        let elapsed = point.t - self.start.unwrap_or(point.t);
        let rounding = |place: usize| {
            let impact = &self.at[place];
            let covered = elapsed * (impact.rate.abs() + elapsed * impact.acceleration.abs());
            self.compute_distance_rounding(place, (point.t, point.state))
                + DISTANCE_ROUNDING * covered
        };
        let allowed = |place: usize| deepest(self, place) + rounding(place);
        let mut open = (0..distances.len()).filter(|place| !self.rests(*place));
        open.find(|place| is_below(distances[*place], allowed(*place)))
    }

    fn stop_overlapping(&mut self, place: usize, state: &mut [f64]) -> u64 {
        self.failure = Some((place, ContactFailure::Penetrated));
        state.fill(f64::NAN);
        1
    }
}

/// Returns true if a distance is below zero by more than `allowed`, or is NaN.
fn is_below(distance: f64, allowed: f64) -> bool {
    distance < -allowed || distance.is_nan()
}
