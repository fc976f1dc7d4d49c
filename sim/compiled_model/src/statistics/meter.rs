//! Measurement of one quantity during a motion, step by step.

use eomgen_codegen::program::evaluator::Enclosure;

use super::polynomial::{DEGREES, MAX_DEGREE, Polynomial, chebyshev_point};
use super::step_quantities::QuantityInStep;
use super::{Measurement, Statistic};

/// Shortest panel, as a fraction of its step. A jump of the quantity inside a step is located with this accuracy.
const MIN_PANEL_PART: f64 = 1e-12;

/// Rounding error of a quantity, relative to its typical size.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Allowed error of the mean square of a panel, in tolerances. Errors of panels have both signs and partly cancel.
const MEAN_SQUARE_FACTOR: f64 = 10.0;

/// Maximum number of panels of a step that resolves all transients; it suffices to locate three jumps of the quantity.
const MAX_PANELS: usize = 128;

/// Largest peak between the points of a polynomial that a maximum may miss, relative to the largest magnitude.
const MAX_HIDDEN_PEAK_FRACTION: f64 = 1e-3;

/// Largest such peak for a root mean square, relative to the root mean square.
const MAX_HIDDEN_RMS_FRACTION: f64 = 0.25;

/// Maximum number of additional divisions for bounds of a step, per panel that polynomials need.
const MAX_DIVISIONS_PER_PANEL: usize = 16;

/// Tolerance of a quantity of an exact motion, relative to its largest magnitude.
const EXACT_TOLERANCE: f64 = 1e-7;

/// Test points, as fractions of a panel, that are far from the points of all polynomials.
const PROBES: [f64; 3] = [0.109, 0.4195, 0.7651];

/// Test point for a transient at the start of a step, as a fraction of the step.
const TRANSIENT_PART: f64 = 1e-7;

/// Part of a step between two times (s), with the values at both ends.
struct Panel {
    from: f64,
    to: f64,
    ends: [f64; 2],
    /// True if the panel is part of a panel that a polynomial represents.
    is_resolved: bool,
}

/// Interpolation of the quantity over a panel.
struct Interpolation {
    polynomial: Polynomial,
    /// True if the polynomial represents the quantity within the tolerance.
    is_resolved: bool,
    /// Value in the middle of the panel.
    middle: f64,
}

/// Meter of one quantity.
#[derive(Clone, Debug)]
pub(crate) struct Meter {
    pub measurement: Measurement,
    tolerance: f64,
    /// True if a transient much shorter than a step may follow its start, as in steps of the exact solver.
    has_transients: bool,
    greatest: Option<f64>,
    /// Largest magnitude of the quantity so far.
    size: f64,
    /// Integral of the squared quantity so far, and the time covered by it, s.
    square_integral: f64,
    duration: f64,
}

impl Meter {
    /// Creates a meter with a relative tolerance; `None` for an exact motion.
    pub fn new(measurement: Measurement, tolerance: Option<f64>) -> Self {
        Self {
            measurement,
            tolerance: tolerance.unwrap_or(EXACT_TOLERANCE),
            has_transients: tolerance.is_none(),
            greatest: None,
            size: 0.0,
            square_integral: 0.0,
            duration: 0.0,
        }
    }

    /// Continues with a solver of another relative tolerance.
    pub fn continue_with(&mut self, tolerance: f64) {
        (self.tolerance, self.has_transients) = (tolerance, false);
    }

    /// Returns the statistic of the motion so far; `None` before its first step.
    pub fn result(&self) -> Option<f64> {
        match self.measurement.statistic {
            Statistic::Maximum => self.greatest,
            Statistic::RootMeanSquare => (self.duration > 0.0).then(|| self.mean_square().sqrt()),
        }
    }

    fn mean_square(&self) -> f64 {
        self.square_integral / self.duration
    }

    /// Measures a step between two times (s).
    pub fn observe_step(
        &mut self,
        (start, end): (f64, f64),
        quantity: &mut QuantityInStep<'_, '_, '_>,
    ) {
        let begin = start.max(self.measurement.begin);
        if begin >= end {
            return;
        }
        let Some(last) = quantity.value(end) else {
            return;
        };
        let first = quantity.value(begin).unwrap_or(last);
        self.note(first);
        self.note(last);
        let mut open = vec![Panel {
            from: begin,
            to: end,
            ends: [first, last],
            is_resolved: false,
        }];
        let shortest = MIN_PANEL_PART * (end - begin);
        let most = match self.has_transients {
            true => usize::MAX,
            false => MAX_PANELS,
        };
        let mut panels = 0;
        let (mut resolved, mut divisions) = (1, 0);
        while let Some(panel) = open.pop() {
            panels += 1;
            let bound = quantity.bound((panel.from, panel.to));
            if bound.is_some_and(|bound| self.is_below_maximum(&panel, &bound)) {
                continue;
            }
            let length = panel.to - panel.from;
            let Some(found) = self.interpolate(&panel, bound.is_some(), quantity) else {
                continue;
            };
            let is_short = length <= shortest || panels + open.len() >= most;
            let probe = TRANSIENT_PART * (end - begin);
            let is_probed = self.has_transients && panel.from == begin && probe < length;
            let is_resolved = found.is_resolved
                && !(is_probed && self.is_transient(&panel, &found.polynomial, probe, quantity));
            resolved += usize::from(is_resolved && !panel.is_resolved);
            let may_divide = divisions < MAX_DIVISIONS_PER_PANEL * resolved;
            let hides_peak = || {
                let exceeds = |bound| self.exceeds_polynomial(&panel, &found.polynomial, &bound);
                may_divide && bound.is_some_and(exceeds)
            };
            if is_short || is_resolved && !hides_peak() {
                self.add_panel(&found.polynomial, &panel, quantity);
                continue;
            }
            divisions += usize::from(is_resolved);
            let half = panel.from + 0.5 * length;
            let Panel { from, to, ends, .. } = panel;
            open.push(Panel {
                from: half,
                to,
                ends: [found.middle, ends[1]],
                is_resolved,
            });
            open.push(Panel {
                from,
                to: half,
                ends: [ends[0], found.middle],
                is_resolved,
            });
        }
    }

    /// Returns true if the quantity cannot exceed the greatest value so far in a panel, within the tolerance.
    fn is_below_maximum(&self, panel: &Panel, bound: &Enclosure) -> bool {
        let is_maximum = self.measurement.statistic == Statistic::Maximum;
        let slack = self.tolerance * self.size + ROUNDING * self.measurement.typical_size;
        let (_, high) = bound_between(panel, bound);
        is_maximum
            && self
                .greatest
                .is_some_and(|greatest| high <= greatest + slack)
    }

    /// Returns true if the bounds of the quantity over a panel admit a peak that the polynomial does not have.
    fn exceeds_polynomial(
        &self,
        panel: &Panel,
        polynomial: &Polynomial,
        bound: &Enclosure,
    ) -> bool {
        let (low, high) = bound_between(panel, bound);
        let own = polynomial.bounds();
        let rounding = ROUNDING * self.measurement.typical_size;
        match self.measurement.statistic {
            Statistic::Maximum => {
                let reached = self.greatest.map_or(own.high, |most| most.max(own.high));
                high > reached + MAX_HIDDEN_PEAK_FRACTION * self.size + rounding
            }
            Statistic::RootMeanSquare => {
                let length = panel.to - panel.from;
                let square = polynomial.mean_square();
                let mean = (self.square_integral + square * length) / (self.duration + length);
                let hidden = MAX_HIDDEN_RMS_FRACTION * square.max(mean).sqrt() + rounding;
                high > own.high + hidden || low < own.low - hidden
            }
        }
    }

    /// Returns true if the quantity a short time (s) after the start of a panel does not match the polynomial.
    fn is_transient(
        &self,
        panel: &Panel,
        polynomial: &Polynomial,
        probe: f64,
        quantity: &mut QuantityInStep<'_, '_, '_>,
    ) -> bool {
        let expected = polynomial.value(probe / (panel.to - panel.from));
        let found = quantity.value(panel.from + probe);
        found.is_some_and(|found| (found - expected).abs() > self.tolerance * self.size)
    }

    fn note(&mut self, value: f64) {
        self.greatest = Some(self.greatest.map_or(value, |greatest| greatest.max(value)));
        if value.is_finite() {
            self.size = self.size.max(value.abs());
        }
    }

    /// Interpolates the quantity over a panel with the lowest degree that resolves it, or else the highest. If values
    /// inside the panel are unknown or not finite, measures the panel by its ends and returns `None`.
    fn interpolate(
        &mut self,
        panel: &Panel,
        is_bounded: bool,
        quantity: &mut QuantityInStep<'_, '_, '_>,
    ) -> Option<Interpolation> {
        let length = panel.to - panel.from;
        let mut values = [0.0; MAX_DEGREE + 1];
        (values[0], values[MAX_DEGREE]) = (panel.ends[0], panel.ends[1]);
        let mut known = MAX_DEGREE;
        let mut last = None;
        for degree in DEGREES {
            let stride = MAX_DEGREE / degree;
            for index in (stride..MAX_DEGREE).step_by(stride) {
                if index % known == 0 {
                    continue;
                }
                let part = chebyshev_point(index, MAX_DEGREE);
                let Some(inside) = quantity.value(panel.from + part * length) else {
                    self.add_chord(panel);
                    return None;
                };
                self.note(inside);
                values[index] = inside;
            }
            known = stride;
            let points: Vec<f64> = values.iter().step_by(stride).copied().collect();
            if points.iter().any(|point| !point.is_finite()) {
                let mean = points.iter().map(|point| point * point).sum::<f64>();
                self.add_square(mean / points.len() as f64, length);
                return None;
            }
            let polynomial = Polynomial::through(&points);
            let mut is_resolved = self.is_resolved(&polynomial, length);
            if is_resolved && self.has_transients && !is_bounded {
                is_resolved = self.matches_probes(&polynomial, panel, quantity);
            }
            last = Some(Interpolation {
                polynomial,
                is_resolved,
                middle: values[MAX_DEGREE / 2],
            });
            if is_resolved {
                break;
            }
        }
        last
    }

    /// Returns true if a polynomial matches the quantity between the interpolation points. Samples of a fast
    /// oscillation may look slow.
    fn matches_probes(
        &self,
        polynomial: &Polynomial,
        panel: &Panel,
        quantity: &mut QuantityInStep<'_, '_, '_>,
    ) -> bool {
        let length = panel.to - panel.from;
        PROBES.into_iter().all(|part| {
            let found = quantity.value(panel.from + part * length);
            found.is_none_or(|found| {
                let difference = (found - polynomial.value(part)).abs();
                difference <= MAX_HIDDEN_PEAK_FRACTION * self.size
            })
        })
    }

    /// Returns true if a polynomial represents the quantity over a panel of `length` s within the tolerance.
    fn is_resolved(&self, polynomial: &Polynomial, length: f64) -> bool {
        let error = match self.has_transients {
            false => polynomial.error(),
            // The coefficients of a fast oscillation with a small amplitude do not decay.
            true => polynomial.last_terms(),
        };
        if error <= ROUNDING * self.measurement.typical_size {
            return true;
        }
        match self.measurement.statistic {
            Statistic::Maximum => error <= self.tolerance * self.size,
            Statistic::RootMeanSquare => {
                let square = polynomial.mean_square();
                let error = polynomial.mean_square_error(error);
                let total = self.square_integral + square * length;
                let mean = total / (self.duration + length);
                error <= MEAN_SQUARE_FACTOR * self.tolerance * square.max(mean)
            }
        }
    }

    fn add_panel(
        &mut self,
        polynomial: &Polynomial,
        panel: &Panel,
        quantity: &mut QuantityInStep<'_, '_, '_>,
    ) {
        let length = panel.to - panel.from;
        match self.measurement.statistic {
            Statistic::RootMeanSquare => self.add_square(polynomial.mean_square(), length),
            Statistic::Maximum => {
                let bounds = polynomial.bounds();
                if self
                    .greatest
                    .is_some_and(|greatest| bounds.high <= greatest)
                {
                    return;
                }
                let place = polynomial.find_maximum_near(bounds.largest_place);
                if self
                    .greatest
                    .is_none_or(|greatest| polynomial.value(place) > greatest)
                    && let Some(found) = quantity.value(panel.from + place * length)
                {
                    self.note(found);
                }
            }
        }
    }

    /// Measures a panel whose interior values are unknown by its chord.
    fn add_chord(&mut self, panel: &Panel) {
        let [a, b] = panel.ends;
        self.add_square((a * a + a * b + b * b) / 3.0, panel.to - panel.from);
    }

    fn add_square(&mut self, mean: f64, length: f64) {
        self.square_integral += mean * length;
        self.duration += length;
    }
}

/// Returns the bounds of the quantity over a panel, from bounds of its values, or from bounds of its rate and the
/// values at the ends.
fn bound_between(panel: &Panel, bound: &Enclosure) -> (f64, f64) {
    let (value, rate) = (bound.value(), bound.rate());
    let [first, last] = panel.ends;
    let length = panel.to - panel.from;
    // The highest value is at the intersection of two lines from the ends with the steepest slopes.
    let highest = |low: f64, high: f64, first: f64, last: f64| {
        if low >= 0.0 {
            last
        } else if high <= 0.0 {
            first
        } else {
            (high * last - low * first - low * high * length) / (high - low)
        }
    };
    let by_high = highest(rate.low, rate.high, first, last);
    let by_low = -highest(-rate.high, -rate.low, -first, -last);
    let closer = |by_rate: f64, by_value: f64, pick: fn(f64, f64) -> f64| match by_rate.is_finite()
    {
        true => pick(by_rate, by_value),
        false => by_value,
    };
    (
        closer(by_low, value.low, f64::max),
        closer(by_high, value.high, f64::min),
    )
}
