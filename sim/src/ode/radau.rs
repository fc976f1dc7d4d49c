//! Radau IIA of order 5, an implicit Runge-Kutta method for stiff systems: what decays fast does
//! not keep its steps short. The control of steps follows Hairer and Wanner, "Solving Ordinary
//! Differential Equations II", section IV.8; what a single step does is in `collocation`.
//!
//! The error estimate is of order 3, and so is the polynomial that gives states inside a step. Both
//! are held to the tolerance, so that the end of a step is more accurate than was asked.

use nalgebra::DMatrix;

use super::collocation::{Factors, MAX_ITERATIONS, Stages};
use super::error::SolveError;
use super::magnitudes::Magnitudes;
use super::stepper::{Outcome, Point, Stepper, split_step};
use super::system::System;
use super::watch::WatchedSystem;

/// The step that the error estimate proposes is shortened by this.
const SAFETY: f64 = 0.9;

/// From step to step the length grows by this at most, and shrinks by this at most.
const GROWTH: (f64, f64) = (8.0, 0.2);

/// A step is left as it is where it would grow by no more: that saves the factors.
const WORTH_NEW_FACTORS: f64 = 1.2;

/// A Jacobian that lets Newton's method contract as fast serves the next step as well.
const GOOD_JACOBIAN: f64 = 1e-3;

/// The step and its error before the last one, for the prediction of the next.
#[derive(Clone, Copy)]
struct Accepted {
    length: f64,
    error: f64,
}

/// Steps of the method.
pub struct Radau {
    /// Start of the last step.
    last: Point,
    /// Start of the next step.
    here: Point,
    /// The rates there, if they are known.
    rates: Option<Vec<f64>>,
    /// The length of the next step, s.
    step: f64,
    magnitudes: Magnitudes,
    jacobian: Option<DMatrix<f64>>,
    factors: Option<Factors>,
    /// Those of the last step, if it led here.
    stages: Option<Stages>,
    /// Stages of the last trial.
    tried: Option<Stages>,
    accepted: Option<Accepted>,
    /// The last try was refused.
    is_refused: bool,
    /// The next step begins where the right-hand side may have jumped.
    is_starting: bool,
}

impl Stepper for Radau {
    const IS_EXPLICIT: bool = false;

    fn new(start: Point, step: f64, magnitudes: Magnitudes) -> Self {
        Self {
            last: start.clone(),
            here: start,
            rates: None,
            step,
            magnitudes,
            jacobian: None,
            factors: None,
            stages: None,
            tried: None,
            accepted: None,
            is_refused: false,
            is_starting: true,
        }
    }

    fn current_point(&self) -> &Point {
        &self.here
    }

    fn step_start(&self) -> &Point {
        &self.last
    }

    fn step(&self) -> f64 {
        self.step
    }

    fn set_step(&mut self, step: f64) {
        self.step = step;
    }

    fn restart(&mut self, point: Point, step: f64) {
        self.last = std::mem::replace(&mut self.here, point);
        self.forget();
        self.step = step;
    }

    /// The stages of the last step still predict those of the next one, and its error the length.
    fn correct(&mut self, y: Vec<f64>) {
        self.here.y = y;
        self.rates = None;
    }

    fn magnitudes(&self) -> &Magnitudes {
        &self.magnitudes
    }

    fn magnitudes_mut(&mut self) -> &mut Magnitudes {
        &mut self.magnitudes
    }

    fn settle(&mut self, is_projected: bool) {
        self.magnitudes.raise(&self.here.y);
        if is_projected {
            self.magnitudes.include_rounding_of_others();
        }
    }

    fn advance<S: System + ?Sized>(
        &mut self,
        watched: &WatchedSystem<'_, S>,
        until: f64,
    ) -> Result<Outcome, SolveError> {
        if std::mem::take(&mut self.is_starting) {
            self.begin(watched);
        }
        let (length, is_cut) = self.here.choose_length(self.step, until);
        let jacobian = (self.jacobian).get_or_insert_with(|| jacobian(watched, &self.here));
        let factors = match self.factors.take() {
            Some(factors) if factors.length == length => factors,
            _ => Factors::new(jacobian, length),
        };
        let (here, before) = (&self.here, self.stages.as_ref());
        let solved = Stages::solve(watched, here, &factors, before, &self.magnitudes);
        let outcome = |is_accepted| Outcome {
            is_accepted,
            length,
        };
        let stages = match solved {
            Some(stages) => stages,
            None => {
                self.refuse(0.5 * length);
                return Ok(outcome(false));
            }
        };
        let rates = self.rates.take();
        let rates = rates.unwrap_or_else(|| rates_at(watched, &self.here));
        let is_doubted = self.is_refused || self.accepted.is_none();
        let by = (&factors, &self.magnitudes);
        let error = stages.estimate_error(watched, &self.here, &rates, by, is_doubted);
        let inside = (self.stages.as_ref()).map_or(0.0, |before| {
            stages.estimate_interior_error(before, &self.here, &self.magnitudes)
        });
        let error = error.max(inside);
        if error.is_nan() || error >= 1.0 {
            let next = length * proposed(error, stages.iterations);
            self.rates = Some(rates);
            self.refuse(next.min(SAFETY * length));
            return Ok(outcome(false));
        }
        let end = Point {
            t: if is_cut { until } else { self.here.t + length },
            y: stages.end_state(&self.here.y),
        };
        let next = length * self.growth(length, error, stages.iterations);
        // A step cut short says nothing against the longer one.
        self.step = if is_cut { next.max(self.step) } else { next };
        self.last = std::mem::replace(&mut self.here, end);
        if stages.contraction > GOOD_JACOBIAN {
            self.jacobian = None;
        } else if (1.0..=WORTH_NEW_FACTORS).contains(&(self.step / length)) {
            self.step = length;
            self.factors = Some(factors);
        }
        self.stages = Some(stages);
        let error = error.max(1e-2);
        self.accepted = Some(Accepted { length, error });
        self.is_refused = false;
        self.is_starting = is_cut;
        Ok(outcome(true))
    }

    fn take_back(&mut self) {
        std::mem::swap(&mut self.last, &mut self.here);
        self.forget();
    }

    fn trial<S: System + ?Sized>(
        &mut self,
        watched: &WatchedSystem<'_, S>,
        length: f64,
    ) -> Option<(Point, Vec<f64>)> {
        let length = self.here.exact_length(length);
        let jacobian = (self.jacobian).get_or_insert_with(|| jacobian(watched, &self.here));
        let factors = Factors::new(jacobian, length);
        self.tried = Stages::solve(watched, &self.here, &factors, None, &self.magnitudes);
        let end = match &self.tried {
            Some(stages) => Point {
                t: self.here.t + length,
                y: stages.end_state(&self.here.y),
            },
            None => self.step_from(watched, &self.here, length)?,
        };
        let rates = rates_at(watched, &end);
        Some((end, rates))
    }

    fn end_trial(&mut self, point: Point) {
        let tried = self.tried.take();
        let step = self.step;
        self.restart(point, step);
        self.stages = tried;
    }

    fn interpolated<S: System + ?Sized>(
        &mut self,
        _watched: &WatchedSystem<'_, S>,
        t: f64,
    ) -> Option<Vec<f64>> {
        let stages = self.stages.as_ref()?;
        Some(stages.interpolate(&self.last.y, t - self.last.t))
    }

    fn inside<S: System + ?Sized>(
        &mut self,
        watched: &WatchedSystem<'_, S>,
        t: f64,
    ) -> Option<Vec<f64>> {
        if let Some(state) = self.interpolated(watched, t) {
            return Some(state);
        }
        let after = t - self.last.t;
        Some(self.step_from(watched, &self.last, after)?.y)
    }
}

impl Radau {
    /// Returns the point after a step of exactly `length` s from `start`, whatever its error, in parts if Newton's
    /// method does not converge; `None` if parts get too short.
    fn step_from<S: System + ?Sized>(
        &self,
        watched: &WatchedSystem<'_, S>,
        start: &Point,
        length: f64,
    ) -> Option<Point> {
        let mut magnitudes = self.magnitudes.reset_copy();
        let step = |point: &Point, length: f64, t: f64| {
            magnitudes.raise(&point.y);
            let factors = Factors::new(&jacobian(watched, point), length);
            let stages = Stages::solve(watched, point, &factors, None, &magnitudes)?;
            let y = stages.end_state(&point.y);
            Some(Point { t, y })
        };
        split_step(start, length, step)
    }

    /// Forgets all that holds only where the last step led.
    fn forget(&mut self) {
        self.rates = None;
        self.jacobian = None;
        self.factors = None;
        self.stages = None;
        self.accepted = None;
        self.is_starting = true;
    }

    /// Limits the first step by the rates and their change. The error estimate fails there: it
    /// accepts a step so long that the method damps a fast vibration. The rule is that of Hairer,
    /// Norsett and Wanner, "Solving Ordinary Differential Equations I", section II.4, for an error
    /// of order 3.
    fn begin<S: System + ?Sized>(&mut self, watched: &WatchedSystem<'_, S>) {
        let here = &self.here;
        let norm = |values: &[f64]| self.magnitudes.norm(values.iter().copied(), &here.y);
        let rates = rates_at(watched, here);
        let (size, speed) = (norm(&here.y), norm(&rates));
        let short = if size > 0.0 && speed > 0.0 {
            (0.01 * size / speed).min(self.step)
        } else {
            self.step
        };
        let near = here.y.iter().zip(&rates).map(|(y, rate)| y + short * rate);
        let near = Point {
            t: here.t + short,
            y: near.collect(),
        };
        let later = rates_at(watched, &near);
        let change: Vec<f64> = later
            .iter()
            .zip(&rates)
            .map(|(b, a)| (b - a) / short)
            .collect();
        let fastest = speed.max(norm(&change));
        let first = (0.01 / fastest).powf(0.25);
        if first > 0.0 {
            self.step = self.step.min(first);
        }
        self.rates = Some(rates);
    }

    /// After a step was refused: a shorter one, with a Jacobian of its start.
    fn refuse(&mut self, step: f64) {
        self.step = step;
        self.is_refused = true;
        self.factors = None;
        if self.stages.is_some() {
            // It may be one of an earlier point.
            self.jacobian = None;
        }
    }

    /// By how much the next step is longer than this one, which had this error: the prediction of
    /// Gustafsson looks at the step before as well.
    fn growth(&self, length: f64, error: f64, iterations: u32) -> f64 {
        let growth = proposed(error, iterations);
        let growth = if self.is_refused {
            growth.min(1.0)
        } else {
            growth
        };
        let Some(before) = self.accepted else {
            return growth;
        };
        let predicted =
            SAFETY * length / before.length * (before.error / (error * error)).powf(0.25);
        growth.min(predicted.clamp(GROWTH.1, GROWTH.0))
    }
}

/// By how much a next step may be longer, from the error of this one and the work it was to solve it.
fn proposed(error: f64, iterations: u32) -> f64 {
    let most = f64::from(2 * MAX_ITERATIONS);
    let safety = SAFETY * (most + 1.0) / (most + f64::from(iterations));
    let growth = safety / error.powf(0.25);
    if growth.is_nan() {
        return GROWTH.1;
    }
    growth.clamp(GROWTH.1, GROWTH.0)
}

fn rates_at<S: System + ?Sized>(watched: &WatchedSystem<'_, S>, point: &Point) -> Vec<f64> {
    let mut rates = vec![0.0; point.y.len()];
    watched.rates(point.t, &point.y, &mut rates);
    rates
}

/// The Jacobian at a point. A derivative without a value, as that of a root at zero, is replaced by 0:
/// Newton's method then contracts less, and the step is shortened if it does not.
fn jacobian<S: System + ?Sized>(watched: &WatchedSystem<'_, S>, point: &Point) -> DMatrix<f64> {
    let states = point.y.len();
    let mut entries = vec![0.0; states * states];
    watched.jacobian(point.t, &point.y, &mut entries);
    let finite = |entry: &f64| if entry.is_finite() { *entry } else { 0.0 };
    DMatrix::from_row_iterator(states, states, entries.iter().map(finite))
}
