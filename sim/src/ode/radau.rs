//! Radau IIA method of order 5, an implicit Runge-Kutta method for stiff systems: fast decaying components do
//! not limit its steps. The step size control follows Hairer and Wanner, "Solving Ordinary Differential
//! Equations II", section IV.8; `collocation` makes a single step.
//!
//! The error estimate and the polynomial for states inside a step are of order 3. Both must meet the tolerance,
//! so the end of a step is more accurate than requested.

use nalgebra::DMatrix;

use super::collocation::{LinearFactors, MAX_NEWTON_ITERATIONS, Stages};
use super::error::SolveError;
use super::magnitudes::Magnitudes;
use super::stepper::{Outcome, Point, Stepper, split_step};
use super::system::System;
use super::watch::WatchedSystem;

/// Safety factor of the step size that the error estimate proposes.
const SAFETY_FACTOR: f64 = 0.9;

/// Largest and smallest ratio of successive step sizes.
const STEP_RATIO_RANGE: (f64, f64) = (8.0, 0.2);

/// Smallest growth of the step size that is worth a new LU factorisation; for less growth the step size stays
/// the same.
const MIN_USEFUL_GROWTH: f64 = 1.2;

/// Contraction of Newton's method below which the next step uses the same Jacobian.
const MAX_REUSE_CONTRACTION: f64 = 1e-3;

/// Size and error of the step before the last one, for the prediction of the next step size.
#[derive(Clone, Copy)]
struct AcceptedStep {
    length: f64,
    error: f64,
}

/// Steps of the method.
pub struct Radau {
    /// Start of the last step.
    last: Point,
    /// Start of the next step.
    here: Point,
    /// Rates at `here`, if known.
    rates: Option<Vec<f64>>,
    /// Length of the next step, s.
    step: f64,
    magnitudes: Magnitudes,
    jacobian: Option<DMatrix<f64>>,
    factors: Option<LinearFactors>,
    /// Stages of the last step, if it ends at `here`.
    stages: Option<Stages>,
    /// Stages of the last trial.
    last_trial: Option<Stages>,
    accepted: Option<AcceptedStep>,
    /// True if the last trial was rejected.
    is_rejected: bool,
    /// True if the right-hand side may have jumped at the start of the next step.
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
            last_trial: None,
            accepted: None,
            is_rejected: false,
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
        self.discard_history();
        self.step = step;
    }

    /// The stages and the error of the last step still predict the next step.
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
            self.magnitudes.include_projection_rounding();
        }
    }

    fn advance<S: System + ?Sized>(
        &mut self,
        watched: &WatchedSystem<'_, S>,
        until: f64,
    ) -> Result<Outcome, SolveError> {
        if std::mem::take(&mut self.is_starting) {
            self.limit_first_step(watched);
        }
        let (length, is_cut) = self.here.choose_length(self.step, until);
        let jacobian = (self.jacobian).get_or_insert_with(|| jacobian(watched, &self.here));
        let factors = match self.factors.take() {
            Some(factors) if factors.length == length => factors,
            _ => LinearFactors::new(jacobian, length),
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
                self.reject_step(0.5 * length);
                return Ok(outcome(false));
            }
        };
        let rates = self.rates.take();
        let rates = rates.unwrap_or_else(|| rates_at(watched, &self.here));
        let is_doubted = self.is_rejected || self.accepted.is_none();
        let by = (&factors, &self.magnitudes);
        let error = stages.estimate_error(watched, &self.here, &rates, by, is_doubted);
        let inside = (self.stages.as_ref()).map_or(0.0, |before| {
            stages.estimate_interior_error(before, &self.here, &self.magnitudes)
        });
        let error = error.max(inside);
        if error.is_nan() || error >= 1.0 {
            let next = length * propose_growth(error, stages.iterations);
            self.rates = Some(rates);
            self.reject_step(next.min(SAFETY_FACTOR * length));
            return Ok(outcome(false));
        }
        let end = Point {
            t: if is_cut { until } else { self.here.t + length },
            y: stages.end_state(&self.here.y),
        };
        let next = length * self.predict_growth(length, error, stages.iterations);
        // A step that was cut short does not shorten the next one.
        self.step = if is_cut { next.max(self.step) } else { next };
        self.last = std::mem::replace(&mut self.here, end);
        if stages.contraction > MAX_REUSE_CONTRACTION {
            self.jacobian = None;
        } else if (1.0..=MIN_USEFUL_GROWTH).contains(&(self.step / length)) {
            self.step = length;
            self.factors = Some(factors);
        }
        self.stages = Some(stages);
        let error = error.max(1e-2);
        self.accepted = Some(AcceptedStep { length, error });
        self.is_rejected = false;
        self.is_starting = is_cut;
        Ok(outcome(true))
    }

    fn undo_step(&mut self) {
        std::mem::swap(&mut self.last, &mut self.here);
        self.discard_history();
    }

    fn trial<S: System + ?Sized>(
        &mut self,
        watched: &WatchedSystem<'_, S>,
        length: f64,
    ) -> Option<(Point, Vec<f64>)> {
        let length = self.here.exact_length(length);
        let jacobian = (self.jacobian).get_or_insert_with(|| jacobian(watched, &self.here));
        let factors = LinearFactors::new(jacobian, length);
        self.last_trial = Stages::solve(watched, &self.here, &factors, None, &self.magnitudes);
        let end = match &self.last_trial {
            Some(stages) => Point {
                t: self.here.t + length,
                y: stages.end_state(&self.here.y),
            },
            None => self.make_step(watched, &self.here, length)?,
        };
        let rates = rates_at(watched, &end);
        Some((end, rates))
    }

    fn end_trial(&mut self, point: Point) {
        let last_trial = self.last_trial.take();
        let step = self.step;
        self.restart(point, step);
        self.stages = last_trial;
    }

    fn interpolate<S: System + ?Sized>(
        &mut self,
        _watched: &WatchedSystem<'_, S>,
        t: f64,
    ) -> Option<Vec<f64>> {
        let stages = self.stages.as_ref()?;
        Some(stages.interpolate(&self.last.y, t - self.last.t))
    }

    fn compute_state_at<S: System + ?Sized>(
        &mut self,
        watched: &WatchedSystem<'_, S>,
        t: f64,
    ) -> Option<Vec<f64>> {
        if let Some(state) = self.interpolate(watched, t) {
            return Some(state);
        }
        let after = t - self.last.t;
        Some(self.make_step(watched, &self.last, after)?.y)
    }
}

impl Radau {
    /// Returns the point after a step of exactly `length` s from `start`, without error control. The step is
    /// split if Newton's method does not converge. Returns `None` if the parts get too short.
    fn make_step<S: System + ?Sized>(
        &self,
        watched: &WatchedSystem<'_, S>,
        start: &Point,
        length: f64,
    ) -> Option<Point> {
        let mut magnitudes = self.magnitudes.reset_copy();
        let step = |point: &Point, length: f64, t: f64| {
            magnitudes.raise(&point.y);
            let factors = LinearFactors::new(&jacobian(watched, point), length);
            let stages = Stages::solve(watched, point, &factors, None, &magnitudes)?;
            let y = stages.end_state(&point.y);
            Some(Point { t, y })
        };
        split_step(start, length, step)
    }

    /// Discards stages and step sizes that apply only at the end of the last step.
    fn discard_history(&mut self) {
        self.rates = None;
        self.jacobian = None;
        self.factors = None;
        self.stages = None;
        self.accepted = None;
        self.is_starting = true;
    }

    /// Limits the first step by the rates and their change. The error estimate fails there: it accepts a step
    /// so long that the method damps a fast vibration. The rule is taken from Hairer, Norsett and Wanner,
    /// "Solving Ordinary Differential Equations I", section II.4, for an error of order 3.
    fn limit_first_step<S: System + ?Sized>(&mut self, watched: &WatchedSystem<'_, S>) {
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

    /// Prepares a shorter step after a rejection, with a Jacobian at its start.
    fn reject_step(&mut self, step: f64) {
        self.step = step;
        self.is_rejected = true;
        self.factors = None;
        if self.stages.is_some() {
            // The Jacobian may belong to an earlier point.
            self.jacobian = None;
        }
    }

    /// Returns the growth factor of the step size after a step with this length and error. The prediction of
    /// Gustafsson also uses the preceding step.
    fn predict_growth(&self, length: f64, error: f64, iterations: u32) -> f64 {
        let growth = propose_growth(error, iterations);
        let growth = if self.is_rejected {
            growth.min(1.0)
        } else {
            growth
        };
        let Some(before) = self.accepted else {
            return growth;
        };
        let predicted =
            SAFETY_FACTOR * length / before.length * (before.error / (error * error)).powf(0.25);
        growth.min(predicted.clamp(STEP_RATIO_RANGE.1, STEP_RATIO_RANGE.0))
    }
}

/// Returns the growth factor of the step size from the error of this step and its number of Newton iterations.
fn propose_growth(error: f64, iterations: u32) -> f64 {
    let most = f64::from(2 * MAX_NEWTON_ITERATIONS);
    let safety = SAFETY_FACTOR * (most + 1.0) / (most + f64::from(iterations));
    let growth = safety / error.powf(0.25);
    if growth.is_nan() {
        return STEP_RATIO_RANGE.1;
    }
    growth.clamp(STEP_RATIO_RANGE.1, STEP_RATIO_RANGE.0)
}

fn rates_at<S: System + ?Sized>(watched: &WatchedSystem<'_, S>, point: &Point) -> Vec<f64> {
    let mut rates = vec![0.0; point.y.len()];
    watched.rates(point.t, &point.y, &mut rates);
    rates
}

/// Returns the Jacobian at a point. An infinite or undefined derivative, such as that of a root at zero, is
/// replaced by 0. Newton's method then contracts less, and the step is shortened if it does not converge.
fn jacobian<S: System + ?Sized>(watched: &WatchedSystem<'_, S>, point: &Point) -> DMatrix<f64> {
    let states = point.y.len();
    let mut entries = vec![0.0; states * states];
    watched.jacobian(point.t, &point.y, &mut entries);
    let finite = |entry: &f64| if entry.is_finite() { *entry } else { 0.0 };
    DMatrix::from_row_iterator(states, states, entries.iter().map(finite))
}
