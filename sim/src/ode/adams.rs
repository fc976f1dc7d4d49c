//! The Adams method: predict, evaluate, correct, evaluate (PECE), with variable step size and order (Shampine
//! and Gordon, "Computer Solution of Ordinary Differential Equations", 1975).
//!
//! A step of any order takes two evaluations of the right-hand side, a trial step one, and a state inside a
//! step none. Without history the method starts at order 1 with short steps, and both grow step by step. It
//! restarts after every switching surface and every breakpoint of the inputs.
//!
//! The formulas of a step are in `history`.

use super::attempt::{Attempt, Errors};
use super::dormand_prince::make_steps_within;
use super::error::SolveError;
use super::history::{History, MAX_ORDER};
use super::magnitudes::Magnitudes;
use super::stepper::{Outcome, Point, Stepper, rejection_error};
use super::system::System;
use super::watch::WatchedSystem;

/// Target error of the next step, as a fraction of the allowed error.
const TARGET_ERROR_FRACTION: f64 = 0.5;

/// Number of rejections at one point after which the method discards its history.
const MAX_REJECTIONS: u32 = 3;

/// Current state and history of the method.
#[derive(Clone)]
struct MultistepState {
    point: Point,
    history: History,
    /// Order of the predictor; the order of the corrector is higher by one.
    order: usize,
    /// True while step size and order grow after a start.
    is_starting: bool,
    /// Number of preceding steps of the same length.
    equal_steps: usize,
}

impl MultistepState {
    fn new(point: Point) -> Self {
        Self {
            point,
            history: History::new(),
            order: 1,
            is_starting: true,
            equal_steps: 0,
        }
    }

    /// Makes a step of `length` s from the current state.
    fn make_attempt<S: System + ?Sized>(
        &self,
        watched: &WatchedSystem<'_, S>,
        length: f64,
    ) -> Attempt {
        Attempt::new(watched, &self.point, &self.history, self.order, length)
    }
}

/// Steps of the method.
pub struct Adams {
    now: MultistepState,
    before: MultistepState,
    /// Step from `before` to `now`; `None` if another method or a jump led to `now`.
    last: Option<Attempt>,
    /// Last trial step.
    last_trial: Option<Attempt>,
    /// Length of the next step, s.
    step: f64,
    magnitudes: Magnitudes,
    /// Number of rejected steps at the current point.
    rejections: u32,
}

impl Stepper for Adams {
    const IS_EXPLICIT: bool = true;

    fn new(start: Point, step: f64, magnitudes: Magnitudes) -> Self {
        Self {
            before: MultistepState::new(start.clone()),
            now: MultistepState::new(start),
            last: None,
            last_trial: None,
            step,
            magnitudes,
            rejections: 0,
        }
    }

    fn current_point(&self) -> &Point {
        &self.now.point
    }

    fn step_start(&self) -> &Point {
        &self.before.point
    }

    fn step(&self) -> f64 {
        self.step
    }

    fn set_step(&mut self, step: f64) {
        self.step = step;
        self.rejections = 0;
    }

    fn restart(&mut self, point: Point, step: f64) {
        self.last = None;
        self.before = std::mem::replace(&mut self.now, MultistepState::new(point));
        self.set_step(step);
    }

    fn magnitudes(&self) -> &Magnitudes {
        &self.magnitudes
    }

    fn magnitudes_mut(&mut self) -> &mut Magnitudes {
        &mut self.magnitudes
    }

    fn settle(&mut self, is_projected: bool) {
        self.magnitudes.raise(&self.now.point.y);
        if is_projected {
            self.magnitudes.include_projection_rounding();
        }
    }

    fn advance<S: System + ?Sized>(
        &mut self,
        watched: &WatchedSystem<'_, S>,
        until: f64,
    ) -> Result<Outcome, SolveError> {
        self.evaluate_start(watched)?;
        let (length, is_cut) = self.now.point.choose_length(self.step, until);
        let mut outcome = Outcome {
            is_accepted: false,
            length,
        };
        let attempt = self.now.make_attempt(watched, length);
        let errors = attempt.estimate_errors(&self.now.history, &self.magnitudes);
        outcome.is_accepted = errors.same_order <= 1.0;
        if !outcome.is_accepted {
            self.reject_step(errors, length);
            return Ok(outcome);
        }
        let step = self.step;
        self.accept(watched, attempt, errors);
        if is_cut {
            // A step that `until` cut short does not shorten the next one, and the rates before `until` do not
            // predict those after it.
            let point = Point {
                t: until,
                y: self.now.point.y.clone(),
            };
            self.now = MultistepState::new(point);
            self.step = self.step.max(step);
        }
        Ok(outcome)
    }

    fn undo_step(&mut self) {
        std::mem::swap(&mut self.now, &mut self.before);
    }

    fn trial<S: System + ?Sized>(
        &mut self,
        watched: &WatchedSystem<'_, S>,
        length: f64,
    ) -> Option<(Point, Vec<f64>)> {
        let length = self.now.point.exact_length(length);
        self.evaluate_start(watched).ok()?;
        let attempt = self.now.make_attempt(watched, length);
        let end = attempt.end.clone();
        if end.y.iter().any(|y| !y.is_finite()) {
            return None;
        }
        let mut rates = vec![0.0; end.y.len()];
        watched.rates(end.t, &end.y, &mut rates);
        self.last_trial = Some(attempt);
        Some((end, rates))
    }

    fn end_trial(&mut self, point: Point) {
        let step = self.step;
        self.restart(point, step);
        self.last = self.last_trial.take();
    }

    fn interpolate<S: System + ?Sized>(
        &mut self,
        _watched: &WatchedSystem<'_, S>,
        t: f64,
    ) -> Option<Vec<f64>> {
        let MultistepState { point, history, .. } = &self.before;
        let last = self.last.as_ref()?;
        let weights = history.weights(t - point.t);
        let mut y = point.y.clone();
        history.predict(&weights, last.order, &mut y);
        let factor = history.correction_inside(&weights, last.order, last.weights.length);
        for (y, surprise) in y.iter_mut().zip(&last.difference) {
            *y += factor * surprise;
        }
        Some(y)
    }

    fn compute_state_at<S: System + ?Sized>(
        &mut self,
        watched: &WatchedSystem<'_, S>,
        t: f64,
    ) -> Option<Vec<f64>> {
        if let Some(state) = self.interpolate(watched, t) {
            return Some(state);
        }
        // The driver stepped over a surface: the history does not apply beyond it.
        let start = &self.before.point;
        Some(make_steps_within(watched, start, t - start.t, &self.magnitudes)?.y)
    }
}

impl Adams {
    /// Evaluates the rates at a start and limits the first step by these rates.
    fn evaluate_start<S: System + ?Sized>(
        &mut self,
        watched: &WatchedSystem<'_, S>,
    ) -> Result<(), SolveError> {
        if self.now.history.points() > 0 {
            return Ok(());
        }
        let here = &self.now.point;
        let Point { t, y } = here;
        let mut rates = vec![0.0; y.len()];
        watched.rates(*t, y, &mut rates);
        let norm = self.magnitudes.norm(rates.iter().copied(), y);
        if !norm.is_finite() {
            return Err(rejection_error(watched, here, self.step));
        }
        // Initial step of Shampine and Gordon; if it is rejected at order 1, it is corrected at once.
        self.step = self.step.min(0.25 / norm.sqrt());
        self.now.history.begin(&rates);
        Ok(())
    }

    /// Shortens the step after a rejection, and lowers the order if a lower order has a similar error.
    fn reject_step(&mut self, errors: Errors, length: f64) {
        self.rejections += 1;
        self.now.equal_steps = 0;
        if self.now.order == 1 {
            // The error of order 1 is known well enough to compute the step size from it.
            let factor = (TARGET_ERROR_FRACTION / errors.same_order).sqrt();
            let factor = if factor.is_finite() { factor } else { 0.0 };
            self.step = length * factor.clamp(1e-3, 0.5);
            return;
        }
        self.step = 0.5 * length;
        self.now.is_starting = false;
        if self.rejections >= MAX_REJECTIONS {
            self.now.order = 1;
            self.now.is_starting = true;
        } else if errors.is_lower_enough {
            self.now.order -= 1;
        }
    }

    /// Moves to the end of an accepted step and selects the next step.
    fn accept<S: System + ?Sized>(
        &mut self,
        watched: &WatchedSystem<'_, S>,
        attempt: Attempt,
        errors: Errors,
    ) {
        let end = &attempt.end;
        let mut rates = vec![0.0; end.y.len()];
        watched.rates(end.t, &end.y, &mut rates);
        std::mem::swap(&mut self.now, &mut self.before);
        let Attempt { weights, order, .. } = &attempt;
        let (now, before) = (&mut self.now, &self.before);
        (now.history).follow(&before.history, weights, *order, &rates);
        now.point.clone_from(end);
        let is_even =
            (self.last.as_ref()).is_some_and(|last| last.weights.length == weights.length);
        now.equal_steps = if is_even { before.equal_steps + 1 } else { 1 };
        now.is_starting = before.is_starting;
        now.order = *order;
        self.rejections = 0;
        self.select_next_step(&attempt, errors);
        self.last = Some(attempt);
    }

    /// Selects order and length of the next step after an accepted step.
    fn select_next_step(&mut self, attempt: &Attempt, errors: Errors) {
        let length = attempt.weights.length;
        let stand = &mut self.now;
        let order = stand.order;
        if stand.is_starting && !errors.is_lower_enough && order < MAX_ORDER {
            stand.order += 1;
            self.step = 2.0 * length;
            return;
        }
        stand.is_starting = false;
        let mut error = errors.same_order;
        if errors.is_lower_enough {
            stand.order -= 1;
            error = errors.lower_order;
        } else if order < MAX_ORDER && stand.equal_steps > order {
            // Difference of the next higher order, which is known only after steps of equal length.
            let higher = stand.history.difference(order + 1);
            let higher = attempt.error_norm(order + 1, higher, &self.magnitudes);
            if order > 1 && errors.lower_order <= errors.same_order.min(higher) {
                stand.order -= 1;
                error = errors.lower_order;
            } else if higher < errors.same_order * if order > 1 { 1.0 } else { 0.5 } {
                stand.order += 1;
                error = higher;
            }
        }
        let exponent = (stand.order + 1) as f64;
        let factor = (TARGET_ERROR_FRACTION / error).powf(1.0 / exponent);
        self.step = if factor >= 2.0 {
            2.0 * length
        } else if factor >= 1.0 {
            length
        } else {
            length * factor.clamp(0.5, 0.9)
        };
    }
}
