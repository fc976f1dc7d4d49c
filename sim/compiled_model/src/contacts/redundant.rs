//! Redundant contacts: open contacts that touch at rest and whose distances depend on those of the closed contacts, for
//! example the second of two stops without play. Their distances stay zero while the others are closed, so step errors
//! around zero cause no impacts. If a closed contact would pull, redundant contacts may close instead.

use eomgen_codegen::program::evaluator::{Evaluator, Point};

use super::complementarity::MIN_INDEPENDENT_PIVOT;
use super::{Contacts, ROUNDING, solve_rows};

impl Contacts {
    /// Returns the closed contacts, then the redundant ones.
    pub(super) fn list_resting(&self) -> Vec<usize> {
        [&self.closed[..], &self.redundant].concat()
    }

    /// Returns true if a contact touches at rest.
    pub(super) fn rests(&self, place: usize) -> bool {
        self.closed.contains(&place) || self.redundant.contains(&place)
    }

    /// Records the redundant contacts at a point at which impacts are known. First closes contacts at rest that do not
    /// push but that other contacts prevent from opening.
    pub(super) fn note_redundant(
        &mut self,
        own: &mut Evaluator,
        point: Point<'_>,
        resting: &[usize],
    ) {
        self.close_confined(resting);
        self.redundant = (0..self.names.len())
            .filter(|place| !self.closed.contains(place))
            .collect();
        self.redundant = self.find_redundant(point.state);
        if self.redundant.is_empty() {
            return;
        }
        let mut rates = vec![0.0; point.state.len()];
        own.rates(point, &mut rates);
        let degrees = own.program().degrees_of_freedom();
        let (speeds, accelerations) = (
            &point.state[degrees..2 * degrees],
            &rates[degrees..2 * degrees],
        );
        let acceleration_sizes: Vec<f64> = (0..self.names.len())
            .map(|place| {
                self.compute_rate_size(place, accelerations) + self.at[place].acceleration.abs()
            })
            .collect();
        let moves_along = |place: &usize| {
            let follows = |quantity: &dyn Fn(usize) -> f64, size: &dyn Fn(usize) -> f64| {
                let (rest, all) = self.compare_with_closed(*place, quantity, size);
                rest.abs() <= ROUNDING * all
            };
            follows(&|place| self.at[place].rate, &|place| {
                self.compute_rate_size(place, speeds)
            }) && follows(&|place| self.at[place].acceleration, &|place| {
                acceleration_sizes[place]
            })
        };
        let redundant = self.redundant.iter().copied().filter(moves_along).collect();
        self.redundant = redundant;
        // A pulling force of rounding size does not separate bodies that a redundant contact holds.
        for place in self.closed.clone() {
            let delassus = &self.at[place].delassus;
            if self.redundant.iter().any(|other| delassus[*other] != 0.0) {
                let rounding = ROUNDING * acceleration_sizes[place] / delassus[place];
                let allowance = self.allowances[place].max(rounding);
                self.allowances[place] = allowance.max(f64::MIN_POSITIVE);
            }
        }
    }

    /// Closes the contacts at rest that other contacts at rest prevent from opening, if neither pushes.
    fn close_confined(&mut self, resting: &[usize]) {
        for place in resting {
            if self.closed.contains(place)
                || self.at[*place].friction.is_some()
                || self.find_coefficients(&self.closed, *place).is_some()
            {
                continue;
            }
            let last = self.closed.len();
            self.closed.push(*place);
            let confines = |other: &usize| {
                let parts = self.find_coefficients(&self.closed, *other);
                !self.closed.contains(other) && parts.is_some_and(|parts| parts[last] < 0.0)
            };
            if !resting.iter().any(confines) {
                self.closed.pop();
            }
        }
    }

    /// Returns the part of a quantity of a contact that is independent of the closed contacts, and the magnitude of its
    /// terms.
    fn compare_with_closed(
        &self,
        place: usize,
        quantity: &dyn Fn(usize) -> f64,
        size: &dyn Fn(usize) -> f64,
    ) -> (f64, f64) {
        let parts = self
            .find_coefficients(&self.closed, place)
            .unwrap_or_default();
        let start = (quantity(place), size(place));
        let closed = self.closed.iter().zip(&parts);
        closed.fold(start, |(rest, all), (other, part)| {
            (
                rest - part * quantity(*other),
                all + part.abs() * size(*other),
            )
        })
    }

    /// Returns true if the distance of a contact depends on those of the closed contacts and falls when one of them
    /// grows.
    pub(super) fn is_blocked_by(&self, closed: &[usize], place: usize) -> bool {
        let parts = self.find_coefficients(closed, place);
        parts.is_some_and(|parts| parts.iter().any(|part| *part < 0.0))
    }

    /// Releases the redundant contacts whose distances no longer depend on those of the closed contacts.
    pub(super) fn release_independent(&mut self, state: &[f64]) {
        if self.redundant.is_empty() {
            return;
        }
        let kept = self.find_redundant(state);
        let mut released = std::mem::replace(&mut self.redundant, kept);
        released.retain(|place| !self.redundant.contains(place));
        self.offset_distances(&released);
    }

    /// Returns the redundant contacts whose distances depend on those of the closed contacts and are zero to rounding.
    fn find_redundant(&self, state: &[f64]) -> Vec<usize> {
        let degrees = self.at.first().map_or(0, |impact| impact.row.len());
        let size = |place: usize| self.compute_distance_size(place, &state[..degrees]);
        let is_redundant = |place: &usize| {
            let distance = |place: usize| self.at[place].distance;
            let (rest, all) = self.compare_with_closed(*place, &distance, &size);
            self.find_coefficients(&self.closed, *place).is_some() && rest.abs() <= ROUNDING * all
        };
        let known = self.redundant.iter().copied();
        known.filter(is_redundant).collect()
    }

    /// Returns the coefficients of a contact's row in terms of the rows of closed contacts; `None` if it is
    /// independent.
    fn find_coefficients(&self, closed: &[usize], place: usize) -> Option<Vec<f64>> {
        let column = closed.iter().map(|other| -self.at[*other].delassus[place]);
        let column: Vec<f64> = column.collect();
        let rows: Vec<usize> = (0..closed.len()).collect();
        let mut parts = solve_rows(&self.compute_delassus(closed), &column, &rows);
        let terms = parts.iter().zip(&column);
        let follows: f64 = terms.map(|(part, entry)| -part * entry).sum();
        let whole = self.at[place].delassus[place];
        // The sign of a coefficient that is zero to rounding has no meaning.
        for (part, other) in parts.iter_mut().zip(closed) {
            let unit = (whole / self.at[*other].delassus[*other]).sqrt();
            if part.abs() <= MIN_INDEPENDENT_PIVOT * unit {
                *part = 0.0;
            }
        }
        (whole - follows <= MIN_INDEPENDENT_PIVOT * whole).then_some(parts)
    }
}
