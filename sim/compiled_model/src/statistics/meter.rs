//! Measurement of a motion in progress, step by step.

use super::polynomial::{DEGREES, MAX_DEGREE, Polynomial, chebyshev_point};
use super::{Measurement, Statistic};

/// Shortest panel, as a part of its step: a jump of the quantity inside a step is located to this part.
const MIN_PANEL_PART: f64 = 1e-12;

/// Rounding of a quantity, relative to its typical size.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Error of the mean square of a panel, in tolerances. Errors of panels have both signs.
const MEAN_SQUARE_FACTOR: f64 = 10.0;

/// Maximum number of panels of a step that resolves all transients: enough to locate three jumps of the quantity.
const MAX_PANELS: usize = 128;

/// Tolerance of a quantity of an exact motion, relative to its largest magnitude.
const EXACT_TOLERANCE: f64 = 1e-7;

/// Place, as a part of a step, at which a transient from its start shows.
const TRANSIENT_PART: f64 = 1e-7;

/// Part of a step between two times (s), with the values there.
struct Panel {
    from: f64,
    to: f64,
    ends: [f64; 2],
}

/// Interpolation of the quantity over a panel.
struct Interpolation {
    polynomial: Polynomial,
    /// True if the polynomial represents the quantity well enough.
    is_resolved: bool,
    /// Value in the middle.
    middle: f64,
}

/// Meter of one quantity.
#[derive(Clone, Debug)]
pub(crate) struct Meter {
    pub measurement: Measurement,
    tolerance: f64,
    /// True if a transient much shorter than a step may follow its start, as in exact steps.
    has_transients: bool,
    greatest: Option<f64>,
    /// Largest magnitude so far.
    size: f64,
    /// Integral of the square so far, and the time over which it was taken, s.
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

    /// Continues with a solver of a relative tolerance.
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

    /// Measures a step between two times (s). `value` returns the quantity at a time, or `None` if it is unknown.
    pub fn observe_step(
        &mut self,
        (start, end): (f64, f64),
        value: &mut dyn FnMut(f64) -> Option<f64>,
    ) {
        let begin = start.max(self.measurement.begin);
        if begin >= end {
            return;
        }
        let Some(last) = value(end) else { return };
        let first = value(begin).unwrap_or(last);
        self.note(first);
        self.note(last);
        let mut open = vec![Panel {
            from: begin,
            to: end,
            ends: [first, last],
        }];
        let shortest = MIN_PANEL_PART * (end - begin);
        let most = match self.has_transients {
            true => usize::MAX,
            false => MAX_PANELS,
        };
        let mut panels = 0;
        while let Some(panel) = open.pop() {
            panels += 1;
            let length = panel.to - panel.from;
            let Some(found) = self.interpolate(&panel, value) else {
                continue;
            };
            let is_short = length <= shortest || panels + open.len() >= most;
            let probe = TRANSIENT_PART * (end - begin);
            let is_probed = self.has_transients && panel.from == begin && probe < length;
            let is_measured = is_short
                || found.is_resolved
                    && !(is_probed && self.is_transient(&panel, &found.polynomial, probe, value));
            if is_measured {
                self.add_panel(&found.polynomial, &panel, value);
                continue;
            }
            let half = panel.from + 0.5 * length;
            let Panel { from, to, ends } = panel;
            open.push(Panel {
                from: half,
                to,
                ends: [found.middle, ends[1]],
            });
            open.push(Panel {
                from,
                to: half,
                ends: [ends[0], found.middle],
            });
        }
    }

    /// Returns true if the quantity at a short time (s) after the start of a panel does not match the polynomial.
    fn is_transient(
        &self,
        panel: &Panel,
        polynomial: &Polynomial,
        probe: f64,
        value: &mut dyn FnMut(f64) -> Option<f64>,
    ) -> bool {
        let expected = polynomial.value(probe / (panel.to - panel.from));
        let found = value(panel.from + probe);
        found.is_some_and(|found| (found - expected).abs() > self.tolerance * self.size)
    }

    fn note(&mut self, value: f64) {
        self.greatest = Some(self.greatest.map_or(value, |greatest| greatest.max(value)));
        if value.is_finite() {
            self.size = self.size.max(value.abs());
        }
    }

    /// Interpolates the quantity over a panel with the lowest degree that resolves it, or else the highest. Measures a panel
    /// whose interior is unknown or not finite, and returns `None`.
    fn interpolate(
        &mut self,
        panel: &Panel,
        value: &mut dyn FnMut(f64) -> Option<f64>,
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
                let Some(inside) = value(panel.from + part * length) else {
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
            let is_resolved = self.is_resolved(&polynomial, length);
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

    /// Returns true if a polynomial represents the quantity over a panel of this length (s) well enough.
    fn is_resolved(&self, polynomial: &Polynomial, length: f64) -> bool {
        let error = match self.has_transients {
            false => polynomial.error(),
            // A fast oscillation of small amplitude does not decay.
            true => polynomial.last_terms(),
        };
        if error <= ROUNDING * self.measurement.typical_size {
            return true;
        }
        match self.measurement.statistic {
            Statistic::Maximum => {
                error <= self.tolerance * self.size
                    || self
                        .greatest
                        .is_some_and(|most| polynomial.bound().0 + error <= most)
            }
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
        value: &mut dyn FnMut(f64) -> Option<f64>,
    ) {
        let length = panel.to - panel.from;
        match self.measurement.statistic {
            Statistic::RootMeanSquare => self.add_square(polynomial.mean_square(), length),
            Statistic::Maximum => {
                let (bound, part) = polynomial.bound();
                if self.greatest.is_some_and(|greatest| bound <= greatest) {
                    return;
                }
                let place = polynomial.maximum_near(part);
                if self
                    .greatest
                    .is_none_or(|greatest| polynomial.value(place) > greatest)
                    && let Some(found) = value(panel.from + place * length)
                {
                    self.note(found);
                }
            }
        }
    }

    /// Measures a panel whose interior is unknown by its chord.
    fn add_chord(&mut self, panel: &Panel) {
        let [a, b] = panel.ends;
        self.add_square((a * a + a * b + b * b) / 3.0, panel.to - panel.from);
    }

    fn add_square(&mut self, mean: f64, length: f64) {
        self.square_integral += mean * length;
        self.duration += length;
    }
}
