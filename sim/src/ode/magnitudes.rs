//! Scales of the error estimates, which define the allowed error of each component; see the module
//! documentation of `ode`.

use super::settings::UNMOVED_SIZE_FRACTION;

/// Rounding error of a state, in units of the last place.
pub const ROUNDING_FACTOR: f64 = 10.0;

/// Largest change by a projection onto invariants, in allowed errors of a step, that is consistent with the
/// error estimate.
const MAX_PROJECTION_ERRORS: f64 = 100.0;

/// Rounding of a projection, in units of the last place of the largest corrected state, relative to typical
/// sizes.
const PROJECTION_ROUNDINGS: f64 = 1000.0;

/// Largest magnitude of each component so far, and the relative tolerance.
pub struct Magnitudes {
    largest: Vec<f64>,
    /// Smallest magnitude of each component.
    smallest: Vec<f64>,
    /// Typical size of each component.
    typical_sizes: Vec<f64>,
    /// True for components that projections onto constraints correct, also by less than their rounding.
    is_corrected: Vec<bool>,
    /// Largest magnitude of a corrected component so far, relative to its typical size.
    largest_corrected: f64,
    tolerance: f64,
    /// Rounding error of each component in a step, which the error control ignores.
    roundings: Vec<f64>,
}

impl Magnitudes {
    /// Initial scales, from the state at the start and the typical sizes of its components.
    pub fn new(y: &[f64], typical_sizes: &[f64], tolerance: f64) -> Self {
        let smallest: Vec<f64> = typical_sizes
            .iter()
            .map(|size| UNMOVED_SIZE_FRACTION * size)
            .collect();
        let largest = y
            .iter()
            .zip(&smallest)
            .map(|(y, smallest)| y.abs().max(*smallest));
        Self {
            largest: largest.collect(),
            smallest,
            typical_sizes: typical_sizes.to_vec(),
            is_corrected: vec![false; y.len()],
            largest_corrected: 0.0,
            tolerance,
            roundings: vec![0.0; y.len()],
        }
    }

    /// Returns a copy without history. The scale of each component is at least the rounding error of its
    /// largest value so far: a component at rest is small, but its rounding error is not.
    pub fn reset_copy(&self) -> Self {
        let roundings = ROUNDING_FACTOR * f64::EPSILON / self.tolerance;
        let largest = self.largest.iter().zip(&self.smallest);
        let largest = largest.map(|(largest, smallest)| smallest.max(roundings * largest));
        Self {
            largest: largest.collect(),
            smallest: self.smallest.clone(),
            typical_sizes: self.typical_sizes.clone(),
            is_corrected: self.is_corrected.clone(),
            largest_corrected: self.largest_corrected,
            tolerance: self.tolerance,
            roundings: self.roundings.clone(),
        }
    }

    /// Returns the relative tolerance.
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// Sets the rounding error of each component in a step of `length` s from the rounding errors of the rates.
    pub fn set_rate_roundings(&mut self, rates: &[f64], length: f64) {
        for (slot, rate) in self.roundings.iter_mut().zip(rates) {
            *slot = ROUNDING_FACTOR * length * rate;
        }
    }

    /// Updates the largest magnitudes from a state of the trajectory.
    pub fn raise(&mut self, y: &[f64]) {
        for (largest, y) in self.largest.iter_mut().zip(y) {
            *largest = largest.max(y.abs());
        }
        self.raise_largest_corrected(y);
    }

    fn raise_largest_corrected(&mut self, y: &[f64]) {
        let sizes = y.iter().zip(&self.typical_sizes).zip(&self.is_corrected);
        let corrected = sizes.filter(|(_, is_corrected)| **is_corrected);
        let relative = corrected.map(|((y, size), _)| y.abs() / size);
        self.largest_corrected = relative.fold(self.largest_corrected, f64::max);
    }

    /// Marks the components of a state `y` that a projection onto constraints changes.
    pub fn mark_corrections(&mut self, changed: &[bool], y: &[f64]) {
        for (is_corrected, is_changed) in self.is_corrected.iter_mut().zip(changed) {
            *is_corrected |= is_changed;
        }
        self.raise_largest_corrected(y);
    }

    /// Adds the rounding of projections onto constraints: each corrected component has the rounding error of
    /// the largest one. The error control ignores this rounding.
    pub fn include_projection_rounding(&mut self) {
        // `largest` is not raised: below a tolerance of 2e-13 it would grow with every call.
        let rounding =
            PROJECTION_ROUNDINGS * f64::EPSILON / self.tolerance * self.largest_corrected;
        let sizes = self.typical_sizes.iter().zip(&self.is_corrected);
        let entries = self.largest.iter_mut().zip(sizes);
        for (largest, (size, _)) in entries.filter(|(_, (_, is_corrected))| **is_corrected) {
            *largest = largest.max(rounding * size);
        }
    }

    /// Returns true if all changes of a state `y` by a projection are consistent with the error estimate.
    /// Rounding of other components is ignored for a state that has not moved.
    pub fn allow(&self, changes: impl Iterator<Item = f64>, y: &[f64]) -> bool {
        let rounding = PROJECTION_ROUNDINGS * f64::EPSILON * self.largest_corrected;
        let allowed = self.allowed(y).zip(&self.typical_sizes);
        changes.zip(allowed).all(|(change, (allowed, size))| {
            change.abs() <= MAX_PROJECTION_ERRORS * allowed + rounding * size
        })
    }

    /// Returns changes of a state `y` with those within the tolerance set to 0.
    pub fn round_to_tolerance(&self, changes: impl Iterator<Item = f64>, y: &[f64]) -> Vec<f64> {
        let changes = changes.zip(self.allowed(y));
        let rounded = changes.map(|(change, allowed)| match change.abs() > allowed {
            true => change,
            false => 0.0,
        });
        rounded.collect()
    }

    /// Returns the largest error of a component at `y`, as a multiple of its tolerance. NaN if an error is NaN.
    pub fn max_norm(&self, errors: &[f64], y: &[f64]) -> f64 {
        let errors = errors.iter().zip(self.allowed(y));
        let relative = errors.map(|(error, allowed)| (error / allowed).abs());
        relative.fold(0.0, |largest_corrected, error| {
            if error <= largest_corrected {
                largest_corrected
            } else {
                error
            }
        })
    }

    /// Returns the root mean square of the errors at `y`, each as a multiple of its tolerance.
    pub fn norm(&self, errors: impl Iterator<Item = f64>, y: &[f64]) -> f64 {
        let squares = errors.zip(self.allowed(y)).map(|(error, allowed)| {
            let relative = error / allowed;
            relative * relative
        });
        (squares.sum::<f64>() / y.len() as f64).sqrt()
    }

    /// Returns the error allowed to each component at `y`, in its own unit.
    pub(super) fn allowed(&self, y: &[f64]) -> impl Iterator<Item = f64> {
        let sizes = self.largest.iter().zip(y).zip(&self.roundings);
        sizes.map(|((largest, y), rounding)| self.tolerance * (largest + y.abs()) + rounding)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn components_without_corrections_leave_the_others_unchanged() {
        let mut magnitudes = Magnitudes::new(&[1.0, 1e10], &[1.0, 1.0], 1e-9);
        magnitudes.mark_corrections(&[true, false], &[1.0, 1e10]);
        magnitudes.raise(&[1.0, 1e10]);
        magnitudes.include_projection_rounding();
        assert_eq!(magnitudes.largest, [1.0, 1e10]);
        assert!(!magnitudes.allow([1e-5, 0.0].into_iter(), &[1.0, 1e10]));
    }

    #[test]
    fn rounding_of_others_does_not_grow_from_step_to_step() {
        for tolerance in [1e-9, 1e-13, 1e-14] {
            let mut magnitudes = Magnitudes::new(&[100.0, 1e-3], &[1.0, 1.0], tolerance);
            magnitudes.mark_corrections(&[true, true], &[100.0, 1e-3]);
            let mut floors = Vec::new();
            for _ in 0..50 {
                magnitudes.raise(&[100.0, 1e-3]);
                magnitudes.include_projection_rounding();
                floors.push(magnitudes.largest.clone());
            }
            assert_eq!(floors[0], floors[49], "{tolerance:e}");
        }
    }
}
