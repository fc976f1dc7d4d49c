//! The Dormand-Prince method of order 8 (Hairer, Norsett and Wanner, "Solving Ordinary
//! Differential Equations I", section II.5), with and without control of the error.

use differential_equations::error::Error;
use differential_equations::interpolate::Interpolation;
use differential_equations::methods::{DormandPrince, ExplicitRungeKutta, Ordinary};
use differential_equations::ode::OrdinaryNumericalMethod;
use differential_equations::status::Status;
use differential_equations::tolerance::Tolerance;

use super::continuous_extension::{ContinuousExtension, Interior};
use super::error::SolveError;
use super::magnitudes::Magnitudes;
use super::stepper::{Outcome, Point, Stepper, rejection_error, split_step};
use super::system::System;
use super::watch::WatchedSystem;

type Method = ExplicitRungeKutta<Ordinary, DormandPrince, f64, Vec<f64>, 8, 12, 16>;

/// Steps of the method.
pub struct DormandPrince853 {
    method: Method,
    /// Where the last step began.
    last: Point,
    /// Where the next step begins.
    here: Point,
    /// The length of the next step, s.
    step: f64,
    magnitudes: Magnitudes,
    /// The method stands at `here`.
    ready: bool,
    /// The next step is no continuation of the method's last one: it would refuse one that is much
    /// shorter.
    anew: bool,
    /// The method's last step is that from `last` to `here`.
    made_last: bool,
    extension: ContinuousExtension,
    /// The last step's interior, once a state in it was asked for.
    interior: Option<Interior>,
}

impl Stepper for DormandPrince853 {
    const IS_EXPLICIT: bool = true;

    fn new(start: Point, step: f64, magnitudes: Magnitudes) -> Self {
        Self {
            method: Method::dop853(),
            magnitudes,
            last: start.clone(),
            here: start,
            step,
            ready: false,
            anew: true,
            made_last: false,
            extension: ContinuousExtension::new(),
            interior: None,
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
        // What the method knows of its last step stays until the next one begins.
        self.step = step;
        self.ready = false;
        self.anew = true;
    }

    fn restart(&mut self, point: Point, step: f64) {
        self.last = std::mem::replace(&mut self.here, point);
        self.set_step(step);
        self.made_last = false;
    }

    fn magnitudes(&self) -> &Magnitudes {
        &self.magnitudes
    }

    fn settle(&mut self, is_projected: bool) {
        self.magnitudes.raise(&self.here.y);
        if is_projected {
            self.magnitudes.include_rounding_of_others();
        }
        self.method.atol = Tolerance::Vector(self.magnitudes.floors());
    }

    fn advance<S: System + ?Sized>(
        &mut self,
        watched: &WatchedSystem<'_, S>,
        until: f64,
    ) -> Result<Outcome, SolveError> {
        let limit = until - self.here.t;
        let is_cut = limit <= self.step;
        let length = if is_cut { limit } else { self.step };
        self.interior = None;
        if !self.ready {
            self.begin(watched, length)?;
        }
        self.method.set_h(length);
        match self.method.step(watched) {
            Ok(_) => {}
            Err(Error::Stiffness { .. }) => {
                // Short steps are this solver's answer to stiffness; begin the count anew.
                self.ready = false;
                return Ok(Outcome {
                    is_accepted: false,
                    length,
                });
            }
            Err(_) => return Err(rejection_error(watched, &self.here, length)),
        }
        if matches!(self.method.status(), Status::RejectedStep) {
            self.step = self.method.h().min(0.9 * length);
            return Ok(Outcome {
                is_accepted: false,
                length,
            });
        }
        // A step cut short says nothing against the longer one.
        self.step = if is_cut {
            self.method.h().max(self.step)
        } else {
            self.method.h()
        };
        std::mem::swap(&mut self.last, &mut self.here);
        self.here.y.clone_from(self.method.y());
        self.here.t = if is_cut { until } else { self.method.t() };
        self.ready = !is_cut;
        self.made_last = true;
        Ok(Outcome {
            is_accepted: true,
            length,
        })
    }

    fn take_back(&mut self) {
        std::mem::swap(&mut self.last, &mut self.here);
        self.ready = false;
        self.made_last = false;
    }

    fn trial<S: System + ?Sized>(
        &mut self,
        watched: &WatchedSystem<'_, S>,
        length: f64,
    ) -> Option<Point> {
        make_step(watched, &self.here, length)
    }

    fn interpolated(&mut self, t: f64) -> Option<Vec<f64>> {
        if !self.made_last {
            return None;
        }
        let (begin, end) = (self.method.t_prev(), self.method.t());
        let part = ((t - begin) / (end - begin)).clamp(0.0, 1.0);
        let step = (&self.last.y[..], &self.here.y[..]);
        if self.interior.is_none() {
            let method = &mut self.method;
            let swapped = |part: f64| method.interpolate(begin + part * (end - begin)).ok();
            self.interior = self.extension.find_interior(step, swapped);
        }
        self.interior
            .as_ref()
            .map(|interior| interior.interpolate(part, step))
    }

    fn tells_interior<S: System + ?Sized>(&mut self, watched: &WatchedSystem<'_, S>) -> bool {
        let (begin, half) = (self.last.t, 0.5 * (self.here.t - self.last.t));
        let Some(middle) = make_step(watched, &self.last, half) else {
            return false;
        };
        let Some(told) = self.interpolated(begin + half) else {
            return false;
        };
        let errors = told.iter().zip(&middle.y).map(|(told, y)| told - y);
        self.magnitudes.norm(errors, &middle.y) <= 1.0
    }

    fn inside<S: System + ?Sized>(
        &mut self,
        watched: &WatchedSystem<'_, S>,
        t: f64,
    ) -> Option<Vec<f64>> {
        // The extension is of order 7; a step from the same start is of 8, and notices what
        // its stages run into.
        Some(make_steps_within(watched, &self.last, t - self.last.t, &self.magnitudes)?.y)
    }

    fn single_step<S: System + ?Sized>(
        &self,
        watched: &WatchedSystem<'_, S>,
        start: &Point,
        length: f64,
    ) -> Option<Point> {
        make_step(watched, start, length)
    }
}

impl DormandPrince853 {
    /// Initialises the method at the start.
    fn begin<S: System + ?Sized>(
        &mut self,
        watched: &WatchedSystem<'_, S>,
        length: f64,
    ) -> Result<(), SolveError> {
        self.made_last = false;
        if self.anew {
            let tolerance = self.magnitudes.tolerance();
            self.method = Method::dop853().rtol(tolerance).max_steps(usize::MAX);
            self.method.atol = Tolerance::Vector(self.magnitudes.floors());
            self.anew = false;
        }
        self.method.h0 = length;
        self.method
            .init(
                watched,
                self.here.t,
                horizon(&self.here, length),
                &self.here.y,
            )
            .map_err(|_| rejection_error(watched, &self.here, length))?;
        self.ready = true;
        Ok(())
    }
}

/// The state one step of exactly `length` s after `start`, whatever its error; `None` if the step
/// overflows or leaves the domain of the rates.
pub fn make_step<S: System + ?Sized>(
    watched: &WatchedSystem<'_, S>,
    start: &Point,
    length: f64,
) -> Option<Point> {
    /// Refuses nothing finite. A large number in its place does not: relative to it the
    /// square of an error can be subnormal, and the method divides by that.
    const ANY: f64 = f64::INFINITY;
    step_with(watched, start, length, Method::dop853().rtol(0.0).atol(ANY))
}

/// The state `length` s after `start` by steps that meet the tolerance, one if that does; `None` if
/// none are short enough.
pub fn make_steps_within<S: System + ?Sized>(
    watched: &WatchedSystem<'_, S>,
    start: &Point,
    length: f64,
    magnitudes: &Magnitudes,
) -> Option<Point> {
    let step = |start: &Point, length: f64, end: f64| {
        let method = Method::dop853().rtol(magnitudes.tolerance());
        let method = method.atol(Tolerance::Vector(magnitudes.floors()));
        let y = step_with(watched, start, length, method)?.y;
        Some(Point { t: end, y })
    };
    split_step(start, length, step, || false)
}

/// One step of `length` s by a new `method`; `None` if it refuses.
fn step_with<S: System + ?Sized>(
    watched: &WatchedSystem<'_, S>,
    start: &Point,
    length: f64,
    method: Method,
) -> Option<Point> {
    let mut method = method.h0(length);
    let end = horizon(start, length);
    method.init(watched, start.t, end, &start.y).ok()?;
    method.step(watched).ok()?;
    let is_made = !matches!(method.status(), Status::RejectedStep);
    let y = method.y();
    (is_made && y.iter().all(|y| y.is_finite())).then(|| Point {
        t: method.t(),
        y: y.clone(),
    })
}

/// An end of the integration beyond a step of `length`, which the method wants to know.
fn horizon(start: &Point, length: f64) -> f64 {
    start.t + 2.0 * length.max(f64::EPSILON * start.t.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// y' = y cos t depends on the nodes of the method: y = exp(sin t).
    struct Growth;

    impl System for Growth {
        fn state_count(&self) -> usize {
            1
        }

        fn rates(&self, t: f64, y: &[f64], out: &mut [f64]) {
            out[0] = y[0] * t.cos();
        }
    }

    /// Returns the error at t = 4 with steps of 4/`steps`.
    fn error(steps: u32) -> f64 {
        let mut point = Point {
            t: 0.0,
            y: vec![1.0],
        };
        let watched = WatchedSystem::new(&Growth, point.t, &point.y);
        for _ in 0..steps {
            point = make_step(&watched, &point, 4.0 / f64::from(steps)).expect("a step");
        }
        (point.y[0] - 4.0_f64.sin().exp()).abs()
    }

    #[test]
    fn single_step_has_order_8() {
        let order = (error(8) / error(16)).log2();
        assert!((7.5..9.5).contains(&order), "order {order}");
    }

    #[test]
    fn states_inside_step_have_order_7() {
        let error = |length: f64| {
            let start = Point {
                t: 0.0,
                y: vec![1.0],
            };
            let watched = WatchedSystem::new(&Growth, start.t, &start.y);
            let mut stepper = DormandPrince853::new(
                start.clone(),
                length,
                Magnitudes::new(&start.y, &[1.0], 1e-1),
            );
            assert!(stepper.interpolated(0.0).is_none());
            let outcome = stepper.advance(&watched, 10.0).expect("a step");
            assert!(outcome.is_accepted && outcome.length == length);
            let errors = (0..=20).map(|part| {
                let t = 0.05 * f64::from(part) * length;
                (stepper.interpolated(t).expect("a state")[0] - t.sin().exp()).abs()
            });
            errors.fold(0.0, f64::max)
        };
        // Within one step the error has one order more.
        let order = (error(1.0) / error(0.5)).log2();
        assert!((7.5..9.0).contains(&order), "order {order}");
    }

    #[test]
    fn single_step_ignores_its_error() {
        for exponent in 0..300 {
            let start = Point {
                t: 0.0,
                y: vec![10.0_f64.powi(exponent)],
            };
            let watched = WatchedSystem::new(&Growth, start.t, &start.y);
            let point = make_step(&watched, &start, 3.0);
            assert!(point.is_some(), "from {:e}: {point:?}", start.y[0]);
        }
    }

    #[test]
    fn step_with_large_error_is_rejected() {
        let start = Point {
            t: 0.0,
            y: vec![1.0],
        };
        let watched = WatchedSystem::new(&Growth, start.t, &start.y);
        let mut stepper =
            DormandPrince853::new(start.clone(), 3.0, Magnitudes::new(&start.y, &[1.0], 1e-10));
        let outcome = stepper.advance(&watched, 10.0).expect("a trial");
        assert_eq!(
            outcome,
            Outcome {
                is_accepted: false,
                length: 3.0
            }
        );
        assert!(stepper.step() < 3.0 && stepper.current_point().t == 0.0);
    }

    #[test]
    fn step_ends_exactly_at_given_time() {
        let start = Point {
            t: 0.1,
            y: vec![1.0],
        };
        let watched = WatchedSystem::new(&Growth, start.t, &start.y);
        let mut stepper =
            DormandPrince853::new(start.clone(), 0.5, Magnitudes::new(&start.y, &[1.0], 1e-3));
        let outcome = stepper.advance(&watched, 0.3).expect("a step");
        assert!(outcome.is_accepted && stepper.current_point().t == 0.3 && stepper.step() >= 0.5);
    }
}
