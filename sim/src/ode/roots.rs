//! Rates that grow as a root of a switching function near its surface, such as sign(v)*sqrt(abs(v)).
//!
//! Their derivative is unbounded at the surface. With a huge derivative the first change of Newton's method is
//! small for any residual, and an implicit method would accept a wrong state. If a change of the states within
//! the tolerance can change the sign of the switching function, the rates are therefore interpolated between
//! the two edges of this band. This changes no state by more than the tolerance.

use super::root_band::{GuardHistory, RootBand, RootDecision};
use super::system::System;
use super::watch::WatchedSystem;

/// Largest number of surfaces at one point whose rates are interpolated. Each surface doubles the number of
/// evaluations.
const MAX_BANDS: usize = 4;

/// Largest ratio of the rate differences at the two distances of [`WatchedSystem::rate_differences`] that
/// counts as a root. It corresponds to the distance to the power 0.9.
const MAX_ROOT_GROWTH: f64 = 12.0;

/// Ratio of the two distances at which rates on both sides are compared.
const DISTANCE_RATIO: f64 = 16.0;

/// Smallest ratio of the rate differences at the two distances for a difference that vanishes at the surface.
/// For a square root the ratio is 4.
const MIN_GROWTH: f64 = 1.5;

/// Differences below this fraction of the rates are rounding.
const RATE_ROUNDING: f64 = 1e-12;

/// Difference of one rate between both sides of a surface.
struct RateDifference {
    /// Difference at the distance divided by [`DISTANCE_RATIO`].
    near: f64,
    /// Difference at the whole distance.
    far: f64,
    /// Magnitude of the rate.
    size: f64,
}

impl RateDifference {
    /// Returns true if the difference vanishes towards the surface.
    fn is_continuous(&self) -> bool {
        self.is_rounding() || self.far >= MIN_GROWTH * self.near
    }

    fn is_rounding(&self) -> bool {
        self.near <= RATE_ROUNDING * self.size
    }
}

impl<S: System + ?Sized> WatchedSystem<'_, S> {
    /// Finds the surfaces near which rates grow as a root and which are within the errors `allowed` to the
    /// states at `t` and `y`. `histories` has an entry per switching function with its earlier points.
    pub(super) fn find_root_bands(
        &self,
        histories: &mut [GuardHistory],
        (t, y): (f64, &[f64]),
        allowed: &[f64],
    ) -> Vec<RootBand> {
        let here = self.evaluate_guards(t, y);
        let near = histories.iter_mut().zip(&here).enumerate();
        let near: Vec<usize> = near
            .filter_map(|(guard, (history, value))| history.follow(value.abs()).then_some(guard))
            // Distances of impacts have no bands: bodies do not penetrate each other, and a surface with a band
            // has no events.
            .filter(|guard| !self.system().is_distance(*guard))
            .collect();
        if near.is_empty() {
            return Vec::new();
        }
        let gradients = self.guard_gradients((t, y), allowed, &here);
        let mut bands = Vec::new();
        for guard in near {
            let (value, history) = (here[guard], &mut histories[guard]);
            let band = RootBand::new(guard, &gradients[guard], allowed);
            let Some(band) = band.filter(|band| value.abs() <= band.width) else {
                continue;
            };
            let decision = history.decision.get_or_insert_with(|| {
                let on_surface = band.state_on_surface(y, value);
                RootDecision {
                    is_root: self.grow_as_root((t, &on_surface), &band.to_edge, allowed),
                    width: band.width,
                }
            });
            if decision.is_root && bands.len() < MAX_BANDS {
                bands.push(band);
            }
        }
        bands
    }

    /// Returns true if the rates have no jump at the surface `guard` near `y`.
    pub(super) fn has_continuous_rates(
        &self,
        guard: usize,
        (t, y): (f64, &[f64]),
        allowed: &[f64],
    ) -> bool {
        let here = self.evaluate_guards(t, y);
        let gradients = self.guard_gradients((t, y), allowed, &here);
        RootBand::new(guard, &gradients[guard], allowed).is_some_and(|band| {
            let on_surface = band.state_on_surface(y, here[guard]);
            let differences = self.rate_differences((t, &on_surface), &band.to_edge);
            differences.iter().all(RateDifference::is_continuous)
        })
    }

    /// Returns the derivatives of the switching functions with respect to the states, as differences with the steps
    /// `allowed`.
    fn guard_gradients(
        &self,
        (t, y): (f64, &[f64]),
        allowed: &[f64],
        here: &[f64],
    ) -> Vec<Vec<f64>> {
        let mut gradients = vec![vec![0.0; y.len()]; here.len()];
        let mut beside = y.to_vec();
        for (state, allowed) in allowed.iter().enumerate() {
            beside[state] = y[state] + allowed;
            let step = beside[state] - y[state];
            if step > 0.0 {
                let guards = self.evaluate_guards(t, &beside);
                for ((gradient, there), here) in gradients.iter_mut().zip(guards).zip(here) {
                    gradient[state] = (there - here) / step;
                }
            }
            beside[state] = y[state];
        }
        gradients
    }

    /// Returns true if the rates at `y` are continuous at the surface and their differences grow as a root up
    /// to the distance `to_edge`. Differences are relative to the errors `allowed` to the states. A root grows
    /// in this way on every scale, in contrast to rates that are steep near the surface.
    fn grow_as_root(&self, at: (f64, &[f64]), to_edge: &[f64], allowed: &[f64]) -> bool {
        let nearer: Vec<f64> = to_edge.iter().map(|step| step / DISTANCE_RATIO).collect();
        [to_edge, &nearer].iter().all(|to_edge| {
            let differences = self.rate_differences(at, to_edge);
            let growing = differences.iter().zip(allowed);
            let growing = growing.filter(|(difference, _)| !difference.is_rounding());
            let (near, far) = growing.fold((0.0, 0.0), |(near, far), (difference, allowed)| {
                (
                    f64::hypot(near, difference.near / allowed),
                    f64::hypot(far, difference.far / allowed),
                )
            });
            near > 0.0
                && (MIN_GROWTH..=MAX_ROOT_GROWTH).contains(&(far / near))
                && differences.iter().all(RateDifference::is_continuous)
        })
    }

    /// Returns the differences of the rates between both sides of a surface at `y`, one per state: at the
    /// distance `to_edge`, and at this distance divided by [`DISTANCE_RATIO`].
    fn rate_differences(&self, (t, y): (f64, &[f64]), to_edge: &[f64]) -> Vec<RateDifference> {
        self.fix_sides(false);
        let rates = |distance: f64| {
            let beside = y.iter().zip(to_edge);
            let beside: Vec<f64> = beside.map(|(y, step)| y + distance * step).collect();
            let mut rates = vec![0.0; y.len()];
            self.evaluate_rates(t, &beside, &mut rates);
            rates
        };
        let [below, above] = [-1.0, 1.0].map(|edge| rates(edge / DISTANCE_RATIO));
        let [far_below, far_above] = [-1.0, 1.0].map(rates);
        self.fix_sides(true);
        let difference = |row: usize| RateDifference {
            near: (above[row] - below[row]).abs(),
            far: (far_above[row] - far_below[row]).abs(),
            size: above[row].abs().max(below[row].abs()),
        };
        (0..y.len()).map(difference).collect()
    }

    /// Writes the rates at `t` and `y`, interpolated within these bands.
    pub(super) fn interpolate_rates(
        &self,
        bands: &[RootBand],
        (t, y): (f64, &[f64]),
        out: &mut [f64],
    ) {
        let Some((band, others)) = bands.split_first() else {
            self.evaluate_rates(t, y, out);
            return;
        };
        let position = band.position(self.evaluate_guards(t, y)[band.guard]);
        if position.abs() == 1.0 {
            return self.interpolate_rates(others, (t, y), out);
        }
        let [below, above] = band.edges(y, position);
        let mut rates = vec![0.0; out.len()];
        self.interpolate_rates(others, (t, &below), &mut rates);
        self.interpolate_rates(others, (t, &above), out);
        for (above, below) in out.iter_mut().zip(rates) {
            *above = 0.5 * ((1.0 - position) * below + (1.0 + position) * *above);
        }
    }

    /// Writes the derivatives of the rates of [`WatchedSystem::interpolate_rates`] by the states, row by row.
    pub(super) fn interpolate_jacobian(
        &self,
        bands: &[RootBand],
        (t, y): (f64, &[f64]),
        out: &mut [f64],
    ) {
        let Some((band, others)) = bands.split_first() else {
            self.system().jacobian(t, y, out);
            return;
        };
        let position = band.position(self.evaluate_guards(t, y)[band.guard]);
        if position.abs() == 1.0 {
            return self.interpolate_jacobian(others, (t, y), out);
        }
        let states = y.len();
        let edges = band.edges(y, position);
        let rates = edges.each_ref().map(|edge| {
            let mut rates = vec![0.0; states];
            self.interpolate_rates(others, (t, edge), &mut rates);
            rates
        });
        let [below, above] = edges.each_ref().map(|edge| {
            let mut jacobian = vec![0.0; out.len()];
            self.interpolate_jacobian(others, (t, edge), &mut jacobian);
            jacobian
        });
        let shares = [0.5 * (1.0 - position), 0.5 * (1.0 + position)];
        let differences = rates[0].iter().zip(&rates[1]);
        let differences = differences.map(|(below, above)| 0.5 * (above - below));
        for (row, difference) in differences.enumerate() {
            let first = row * states;
            let mean =
                |state: usize| shares[0] * below[first + state] + shares[1] * above[first + state];
            // An edge has a fixed distance from the surface for all states.
            let along: f64 = (0..states)
                .map(|state| mean(state) * band.to_edge[state])
                .sum();
            for state in 0..states {
                let slope = band.gradient[state] / band.width;
                out[first + state] = mean(state) + (difference - along) * slope;
            }
        }
    }
}
