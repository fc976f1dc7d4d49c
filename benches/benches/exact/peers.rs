//! General solvers (peers). Each simulates one second from rest with a given tolerance and returns x_sp on a grid of
//! times.

use differential_equations::methods::{Adaptive, DormandPrince, ExplicitRungeKutta, Ordinary};
use differential_equations::ode::{ODE, OrdinaryNumericalMethod};
use differential_equations::status::Status;
use eomgen_sim::ode::{Method, Settings};

use crate::arm::{Located, Momentum, STATES};

/// First step size in s; the error estimate corrects it.
const FIRST_STEP: f64 = 1e-6;

type State = [f64; STATES];
type Dop853 = ExplicitRungeKutta<Ordinary, DormandPrince, f64, State, 8, 12, 16>;
type Dopri5 = ExplicitRungeKutta<Ordinary, DormandPrince, f64, State, 5, 7, 7>;
type Verner6 = ExplicitRungeKutta<Ordinary, Adaptive, f64, State, 6, 9, 10>;
type Verner7 = ExplicitRungeKutta<Ordinary, Adaptive, f64, State, 7, 10, 13>;

/// All peers of the benchmark.
pub const ALL: [Peer; 6] = [
    Peer::Located(Method::DormandPrince853),
    Peer::Located(Method::Adams),
    Peer::Continuous(Scheme::Dop853),
    Peer::Continuous(Scheme::Dopri5),
    Peer::Continuous(Scheme::Verner6),
    Peer::Continuous(Scheme::Verner7),
];

/// General solver and its treatment of switches.
#[derive(Clone, Copy)]
pub enum Peer {
    /// Solver of this project with the compiled model; every switch is located.
    Located(Method),
    /// Crate `differential-equations`, with momentum-like variables. Its error control treats switches as
    /// discontinuities of the second derivative.
    Continuous(Scheme),
}

/// Embedded Runge-Kutta pair.
#[derive(Clone, Copy)]
pub enum Scheme {
    /// Method of Dormand and Prince of order 8(5,3).
    Dop853,
    /// Method of Dormand and Prince of order 5(4).
    Dopri5,
    /// Verner's "most efficient" method of order 6(5).
    Verner6,
    /// Verner's "most efficient" method of order 7(6).
    Verner7,
}

/// Equations of the arm for the peers.
pub struct Problem {
    located: Located,
    momentum: Momentum,
    /// Largest magnitude of each state, used as the scale of the tolerance. Users of a general solver do not know it in
    /// advance.
    pub magnitudes: State,
}

impl Problem {
    /// Creates the reference case with these magnitudes of the states.
    pub fn new(magnitudes: State) -> Self {
        Self {
            located: Located::new(),
            momentum: Momentum::new(),
            magnitudes,
        }
    }
}

impl Peer {
    /// Returns the name in the table.
    pub fn name(self) -> &'static str {
        match self {
            Self::Located(Method::DormandPrince853) => "DOP853, located",
            Self::Located(Method::Adams) => "Adams, located",
            Self::Located(Method::Radau) => "Radau, located",
            Self::Continuous(Scheme::Dop853) => "DOP853, continuous",
            Self::Continuous(Scheme::Dopri5) => "Dopri5, continuous",
            Self::Continuous(Scheme::Verner6) => "Verner 6(5), continuous",
            Self::Continuous(Scheme::Verner7) => "Verner 7(6), continuous",
        }
    }

    /// Returns x_sp (m) after one second, or `None` if the solver fails.
    pub fn end(self, problem: &Problem, tolerance: f64) -> Option<f64> {
        self.run(problem, tolerance, &[]).map(|(end, _)| end)
    }

    /// Returns x_sp (m) at `times` (s, ascending up to 1).
    pub fn samples(self, problem: &Problem, tolerance: f64, times: &[f64]) -> Option<Vec<f64>> {
        self.run(problem, tolerance, times)
            .map(|(_, samples)| samples)
    }

    fn run(self, problem: &Problem, tolerance: f64, times: &[f64]) -> Option<(f64, Vec<f64>)> {
        match self {
            Self::Located(method) => locate(&problem.located, method, tolerance, times),
            Self::Continuous(scheme) => scheme.run(problem, tolerance, times),
        }
    }
}

impl Scheme {
    fn run(self, problem: &Problem, tolerance: f64, times: &[f64]) -> Option<(f64, Vec<f64>)> {
        let floors = problem.magnitudes.map(|magnitude| magnitude * tolerance);
        macro_rules! tuned {
            ($method:expr) => {
                $method
                    .rtol(tolerance)
                    .atol(floors.to_vec())
                    .h0(FIRST_STEP)
                    .max_steps(usize::MAX)
            };
        }
        let arm = &problem.momentum;
        match self {
            Self::Dop853 => drive(arm, tuned!(Dop853::dop853()), times),
            Self::Dopri5 => drive(arm, tuned!(Dopri5::dopri5()), times),
            Self::Verner6 => drive(arm, tuned!(Verner6::rkv655e()), times),
            Self::Verner7 => drive(arm, tuned!(Verner7::rkv766e()), times),
        }
    }
}

/// Simulates one second from rest with event location. Returns x_sp at the end and at `times`.
fn locate(arm: &Located, method: Method, tolerance: f64, times: &[f64]) -> Option<(f64, Vec<f64>)> {
    let settings = Settings {
        method,
        ..Settings::with_tolerance(tolerance)
    };
    let found = arm.simulate(times, &settings)?;
    let samples = found.states.iter().map(|state| state[0]).collect();
    Some((found.final_state[0], samples))
}

impl ODE<f64, State> for Momentum {
    #[inline]
    fn diff(&self, t: f64, y: &State, rates: &mut State) {
        *rates = self.rates(t, y);
    }
}

/// Simulates one second from rest. Returns x_sp at the end and at `times`.
fn drive<M: OrdinaryNumericalMethod<f64, State>>(
    arm: &Momentum,
    mut method: M,
    times: &[f64],
) -> Option<(f64, Vec<f64>)> {
    method.init(arm, 0.0, 1.0, &[0.0; STATES]).ok()?;
    let mut samples = Vec::with_capacity(times.len());
    while method.t() < 1.0 {
        let last = 1.0 - method.t();
        let is_last = method.h() >= last;
        if is_last {
            method.set_h(last);
        }
        method.step(arm).ok()?;
        if matches!(method.status(), Status::RejectedStep) {
            continue;
        }
        method.set_status(Status::Solving);
        let until = if is_last { 1.0 } else { method.t() };
        while let Some(&time) = times.get(samples.len()).filter(|time| **time <= until) {
            samples.push(interpolate(arm, method.t_prev(), method.y_prev(), time)?);
        }
        if is_last {
            break;
        }
    }
    Some((method.y()[0], samples))
}

/// Returns x_sp at `time` within a step that starts at `t`. A shorter step of order 8 is used, because the dense output
/// of the crate has a lower order.
fn interpolate(arm: &Momentum, t: f64, y: &State, time: f64) -> Option<f64> {
    let length = time - t;
    if length <= 0.0 {
        return Some(y[0]);
    }
    let mut method = Dop853::dop853().rtol(0.0).atol(f64::INFINITY).h0(length);
    method.init(arm, t, t + 2.0 * length, y).ok()?;
    method.step(arm).ok()?;
    Some(method.y()[0])
}
