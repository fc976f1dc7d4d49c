//! Projection of states onto the constraints.
//!
//! With the stabilisation rate w the accelerations are a(w) = a(0) - 2 w P r - w^2 P g. Here P = M^-1 A^T (A M^-1
//! A^T)^-1, g are the residuals of the holonomic constraints, and r are their rates and the residuals of the
//! nonholonomic constraints. Two more evaluations, at w and -w for a large w, give P g and P r. These are the smallest
//! corrections of coordinates and rates in the norm of the kinetic energy. The method is Newton's method with the mass
//! matrix as its metric (E. Hairer, C. Lubich, G. Wanner, *Geometric Numerical Integration*, IV.4). The computation
//! time per mode equals that of the rates.

use std::cell::RefCell;

use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::UNMOVED_SIZE_FRACTION;

use crate::singular_positions::SingularityWatch;

/// Stabilisation rate w, 1/s. It is so large that rounding errors of the accelerations are negligible compared with w^2
/// times a residual worth correcting.
pub(crate) const LARGE_RATE_PER_S: f64 = 1_048_576.0;

/// Relative size of the last correction. Newton's method squares the error, so the next correction would be rounding.
const LAST_CORRECTION_FRACTION: f64 = 1e-8;

/// Maximum number of corrections after a step, which starts on the constraints.
const MAX_STEP_CORRECTIONS: usize = 8;

/// Golden ratio; the fractional parts of its multiples all differ.
const GOLDEN_RATIO: f64 = 1.618_033_988_749_895;

/// Maximum number of corrections of a state that may be far from the constraints.
pub(crate) const MAX_INITIAL_CORRECTIONS: usize = 100;

/// Projection of states onto the constraints, at one set of parameters.
pub struct Projection {
    /// Model with the stabilisation rate w.
    pub(crate) positive_rate_model: RefCell<Evaluator>,
    /// Model with the stabilisation rate -w.
    pub(crate) negative_rate_model: RefCell<Evaluator>,
    /// Stabilisation rate of the model itself, 1/s.
    pub(crate) stabilisation_rate: f64,
    /// Largest typical size of the coordinates, and of the rates, used until they move.
    pub(crate) unmoved_sizes: [f64; 2],
    /// Detector of singular positions, if the motion stops there.
    pub(crate) singularity_watch: Option<RefCell<SingularityWatch>>,
}

/// Maximum number of changed initial values in a message.
const MAX_LISTED_CHANGES: usize = 8;

/// Initial value that was changed to satisfy the constraints.
#[derive(Clone, Debug, PartialEq)]
pub struct InitialChange {
    /// Name of the coordinate, mode or rate.
    pub name: String,
    /// SI unit.
    pub unit: String,
    /// Requested value.
    pub requested: f64,
    /// Value used.
    pub used: f64,
}

impl InitialChange {
    /// Returns a sentence about the changes of a state, which is called `what`, for example `initial state`; `None`
    /// without changes.
    pub fn describe_all(what: &str, all: &[Self]) -> Option<String> {
        let listed = all.iter().take(MAX_LISTED_CHANGES).map(Self::describe);
        let mut listed: Vec<String> = listed.collect();
        match all.len() {
            0 => return None,
            count if count > MAX_LISTED_CHANGES => {
                listed.push(format!("{} more", count - MAX_LISTED_CHANGES));
            }
            _ => {}
        }
        Some(format!(
            "the {what} was moved onto the constraints: {}",
            listed.join(", ")
        ))
    }

    fn describe(&self) -> String {
        let [from, to] = [self.requested, self.used].map(round_to_six_digits);
        format!("{} from {from} to {to} {}", self.name, self.unit)
    }
}

fn round_to_six_digits(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

/// Callback that receives the states before corrections.
type StateObserver<'o> = &'o mut dyn FnMut(&[f64]);

impl Projection {
    /// Moves a state at a time (s) to the nearest state on the constraints, in the norm of the kinetic energy. Returns
    /// the number of evaluations of the rates. `own` evaluates the model itself. Returns `None` and leaves the state
    /// unchanged if no state nearby satisfies the constraints.
    pub fn move_onto_constraints(
        &self,
        own: &mut Evaluator,
        at: (f64, &[f64]),
        state: &mut [f64],
    ) -> Option<u64> {
        let mut found = state.to_vec();
        let evaluations =
            self.correct(own, at, &mut found, (MAX_INITIAL_CORRECTIONS, &mut |_| {}))?;
        state.copy_from_slice(&found);
        Some(evaluations)
    }

    /// Corrects a state in place with at most `most` corrections. Calls `observe` with the state before each
    /// correction. Returns the number of evaluations of the rates, or `None` if the corrections do not converge. A
    /// finite state stays finite.
    pub(crate) fn correct(
        &self,
        own: &mut Evaluator,
        (t, inputs): (f64, &[f64]),
        state: &mut [f64],
        (most, observe): (usize, StateObserver<'_>),
    ) -> Option<u64> {
        let degrees = own.program().degrees_of_freedom();
        let mut rates = [(); 3].map(|()| vec![0.0; state.len()]);
        for correction in 1..=most as u64 {
            observe(state);
            let [largest, largest_rate] = [0, 1].map(|kind| {
                let entries = state[kind * degrees..(kind + 1) * degrees].iter();
                entries.fold(self.unmoved_sizes[kind], |most, entry| {
                    most.max(entry.abs())
                })
            });
            let point = Point { t, state, inputs };
            let [_, of_values, of_rates] = self.evaluate_corrections(own, point, &mut rates)?;
            let mut relative = 0.0_f64;
            for row in 0..degrees {
                let (of_value, of_rate) = (of_values[row], of_rates[row]);
                relative = relative.max(of_value.abs() / largest);
                relative = relative.max(of_rate.abs() / largest_rate.max(largest));
                state[row] -= of_value;
                state[degrees + row] -= of_rate;
            }
            if relative <= LAST_CORRECTION_FRACTION {
                return Some(3 * correction);
            }
        }
        None
    }

    /// Computes the corrections P g of the coordinates and P r of their rates. They are the second and third of the
    /// three returned rate vectors. Returns `None` if a correction is not finite.
    fn evaluate_corrections<'r>(
        &self,
        own: &mut Evaluator,
        point: Point<'_>,
        rates: &'r mut [Vec<f64>; 3],
    ) -> Option<&'r [Vec<f64>; 3]> {
        let degrees = own.program().degrees_of_freedom();
        self.compute_corrections(own, point, rates);
        if is_finite(rates, degrees) {
            return Some(rates);
        }
        // A force along v/norm(v) is undefined at rest. P g and P r do not depend on forces, and r is linear in the
        // rates. Therefore two points with other rates determine both.
        let mut moved = point.state.to_vec();
        let mut compute_near = |multiple: f64, rates: &mut [Vec<f64>; 3]| {
            for row in 0..degrees {
                let part = 1.0 + (GOLDEN_RATIO * row as f64).fract();
                moved[degrees + row] =
                    point.state[degrees + row] + multiple * part * self.unmoved_sizes[1];
            }
            let state = &moved;
            self.compute_corrections(own, Point { state, ..point }, rates);
        };
        compute_near(2.0, rates);
        let far = rates.clone();
        compute_near(1.0, rates);
        for (near, far) in rates.iter_mut().flatten().zip(far.iter().flatten()) {
            *near = 2.0 * *near - far;
        }
        is_finite(rates, degrees).then_some(rates)
    }

    fn compute_corrections(
        &self,
        own: &mut Evaluator,
        point: Point<'_>,
        rates: &mut [Vec<f64>; 3],
    ) {
        let degrees = own.program().degrees_of_freedom();
        let [here, plus, minus] = rates;
        own.rates(point, here);
        self.positive_rate_model.borrow_mut().rates(point, plus);
        self.negative_rate_model.borrow_mut().rates(point, minus);
        for row in 0..degrees {
            let place = degrees + row;
            let of_rate = (minus[place] - plus[place]) / (4.0 * LARGE_RATE_PER_S);
            let mean = 0.5 * (plus[place] + minus[place]);
            let of_value = (here[place] + 2.0 * self.stabilisation_rate * of_rate - mean)
                / (LARGE_RATE_PER_S * LARGE_RATE_PER_S
                    - self.stabilisation_rate * self.stabilisation_rate);
            (plus[row], minus[row]) = (of_value, of_rate);
        }
    }

    /// Corrects a state after a step and returns the number of evaluations. If the correction fails or the step passes
    /// a singular position, the state is filled with NaN, which stops the motion.
    pub(crate) fn correct_after_step(
        &self,
        own: &mut Evaluator,
        t: f64,
        inputs: &HeldInputs,
        state: &mut [f64],
    ) -> u64 {
        let arrived = state.to_vec();
        let given = inputs.evaluate(t);
        let evaluations =
            self.correct(own, (t, &given), state, (MAX_STEP_CORRECTIONS, &mut |_| {}));
        let reached = match evaluations {
            Some(_) => &*state,
            None => &arrived,
        };
        let watch = self.singularity_watch.as_ref();
        let passes =
            watch.is_some_and(|watch| watch.borrow_mut().passes_singularity(t, reached, inputs));
        if passes || evaluations.is_none() {
            state.fill(f64::NAN);
        }
        evaluations.unwrap_or(1)
    }
}

/// Returns the largest typical size of the coordinates and of the rates.
pub(crate) fn find_unmoved_sizes(typical_sizes: &[f64], degrees: usize) -> [f64; 2] {
    [0, 1].map(|kind| {
        let sizes = typical_sizes[kind * degrees..(kind + 1) * degrees].iter();
        UNMOVED_SIZE_FRACTION * sizes.fold(f64::MIN_POSITIVE, |most, size| most.max(*size))
    })
}

fn is_finite(corrections: &[Vec<f64>; 3], degrees: usize) -> bool {
    let [_, of_values, of_rates] = corrections;
    let mut all = of_values[..degrees].iter().chain(&of_rates[..degrees]);
    all.all(|correction| correction.is_finite())
}
