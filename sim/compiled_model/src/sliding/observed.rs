//! Observables and rates of a motion with sticking. During sticking the friction is the force that
//! holds, not that of sign(0) = 0.

use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::Trajectory;
use eomgen_sim::sliding_modes::Arrival;

use super::Sided;

/// Largest distance of a state on a surface, relative to the largest value of the function in the
/// motion.
const ON: f64 = 1e-10;

/// Additional distance, relative to the effect of the surface's own force over the time of the
/// motion.
const ON_BY_A_FORCE: f64 = 1e-11;

pub(crate) struct Observed {
    own: Evaluator,
    rest: Option<Rest>,
}

impl Observed {
    /// Combines an evaluator with the model with sides, if surfaces can hold the motion.
    pub fn new(
        own: Evaluator,
        sided: Option<Sided>,
        trajectory: &Trajectory,
        inputs: &HeldInputs,
    ) -> Self {
        let motion = (&trajectory.times[..], &trajectory.states[..]);
        Self {
            own,
            rest: sided.map(|sided| Rest::along(sided, motion, inputs)),
        }
    }

    /// Writes the observables at a point of the motion.
    pub fn observables(&mut self, point: Point<'_>, out: &mut [f64]) {
        let rest = self.rest.as_mut();
        if !rest.is_some_and(|rest| rest.observables(point, out)) {
            self.own.observables(point, out);
        }
    }
}

/// Forces and rates during sticking, along a motion.
pub struct Rest {
    sided: Sided,
    /// Largest value of each function, and the duration of the motion, s.
    sizes: Vec<f64>,
    duration: f64,
}

impl Rest {
    /// Prepares a motion with these times (s) and states.
    pub fn along(
        mut sided: Sided,
        (times, states): (&[f64], &[Vec<f64>]),
        inputs: &HeldInputs,
    ) -> Self {
        let mut sizes = vec![0.0_f64; sided.count()];
        for (t, state) in times.iter().zip(states) {
            let functions = sided.functions((*t, state), &inputs.at(*t));
            for (size, value) in sizes.iter_mut().zip(functions) {
                *size = size.max(value.abs());
            }
        }
        let duration = match (times.first(), times.last()) {
            (Some(first), Some(last)) => last - first,
            _ => 0.0,
        };
        Self {
            sided,
            sizes,
            duration,
        }
    }

    /// Writes the rates at a point of the motion and returns true, if surfaces hold it there.
    pub fn rates(&mut self, point: Point<'_>, out: &mut [f64]) -> bool {
        let is_held = self.holds(point);
        if is_held {
            let Point { t, state, inputs } = point;
            self.sided.rates((t, state), inputs, out);
        }
        is_held
    }

    /// Writes the observables at a point of the motion and returns true, if surfaces hold it
    /// there.
    pub fn observables(&mut self, point: Point<'_>, out: &mut [f64]) -> bool {
        let is_held = self.holds(point);
        if is_held {
            self.sided.observables((point.t, point.state), out);
        }
        is_held
    }

    /// Returns the model with sides, for use with another motion.
    pub fn into_sided(self) -> Sided {
        self.sided
    }

    fn holds(&mut self, Point { t, state, inputs }: Point<'_>) -> bool {
        let reach: Vec<f64> = self.sizes.iter().map(|size| ON * size).collect();
        hold(&mut self.sided, (t, state), inputs, (&reach, self.duration))
    }
}

/// Computes the sides that hold a motion at a state; returns false if it is on no surface.
fn hold(
    sided: &mut Sided,
    at: (f64, &[f64]),
    inputs: &[f64],
    (reach, duration): (&[f64], f64),
) -> bool {
    let functions = sided.functions(at, inputs);
    let mut sides: Vec<f64> = (0..functions.len())
        .map(|surface| sided.side_of(surface, functions[surface]))
        .collect();
    sided.look(at, inputs, &sides);
    let touching: Vec<usize> = (0..functions.len())
        .filter(|surface| {
            let by_force = ON_BY_A_FORCE * sided.own_rate(*surface) * duration;
            functions[*surface].abs() <= reach[*surface] + by_force
        })
        .collect();
    if touching.is_empty() {
        return false;
    }
    let arrival = |surface: &usize| Arrival {
        side: if functions[*surface] < 0.0 { -1.0 } else { 1.0 },
        is_overcome: false,
    };
    let arrivals: Vec<Arrival> = touching.iter().map(arrival).collect();
    let Some(verdicts) = sided.decide(at, inputs, (&touching, &arrivals), &sides) else {
        return false;
    };
    for (surface, verdict) in touching.iter().zip(verdicts) {
        sides[*surface] = 0.5 + 0.5 * verdict.sign();
    }
    sided.hold(at, inputs, &sides, &[]);
    true
}
