//! States brought onto the constraints of a model.
//!
//! With the stabilisation rate w the accelerations are a(w) = a(0) - 2 w P r - w^2 P g, where
//! P = M^-1 A^T (A M^-1 A^T)^-1, g are the residuals of the holonomic constraints, and r the rates of
//! these and the residuals of the nonholonomic ones. So two evaluations more, at
//! w and -w for a large w, give P g and P r: the corrections of coordinates and rates that are the
//! smallest by the kinetic energy (Newton's method with the mass matrix as its metric; E. Hairer,
//! C. Lubich, G. Wanner, *Geometric Numerical Integration*, IV.4). They cost as much per mode as the
//! rates do.

use std::cell::RefCell;

use eomgen_codegen::program::evaluator::{Evaluator, Point};
use eomgen_sim::inputs::HeldInputs;

use crate::singular::SingularityWatch;

/// The rate w, 1/s: so large that rounding of the accelerations is nothing beside w^2 times a residual
/// worth correcting.
pub(crate) const LARGE_RATE: f64 = 1_048_576.0;

/// Corrections that are this small beside the state leave less than rounding: those of Newton's
/// method are squared from one to the next.
const LAST_CORRECTION: f64 = 1e-8;

/// Corrections after a step, which begins on the constraints.
const MOST_AFTER_A_STEP: usize = 8;

/// What corrects states, at one set of parameters.
pub(crate) struct Projection {
    /// The model at the stabilisation rate w.
    pub plus: RefCell<Evaluator>,
    /// At -w.
    pub minus: RefCell<Evaluator>,
    /// The stabilisation rate of the model itself, 1/s.
    pub own_rate: f64,
    /// Finds singular positions that the motion passes.
    pub watch: RefCell<SingularityWatch>,
}

/// An initial value that was moved so that the constraints hold.
#[derive(Clone, Debug, PartialEq)]
pub struct Moved {
    /// The coordinate, mode or rate.
    pub name: String,
    /// Its SI unit.
    pub unit: String,
    /// The value that was asked for.
    pub from: f64,
    /// The value that was taken.
    pub to: f64,
}

impl Projection {
    /// Corrects a state in place, at most so many times; how many evaluations of the rates that
    /// took, nothing if it came to no end. The state is made of numbers as long as it was.
    pub(crate) fn correct(
        &self,
        own: &mut Evaluator,
        (t, inputs): (f64, &[f64]),
        state: &mut [f64],
        most: usize,
    ) -> Option<u64> {
        let degrees = own.program().degrees_of_freedom();
        let mut rates = [(); 3].map(|()| vec![0.0; state.len()]);
        for correction in 1..=most as u64 {
            {
                let [here, plus, minus] = &mut rates;
                let point = Point { t, state, inputs };
                own.rates(point, here);
                self.plus.borrow_mut().rates(point, plus);
                self.minus.borrow_mut().rates(point, minus);
            }
            let [largest, largest_rate] = [0, degrees].map(|first| {
                let entries = state[first..first + degrees].iter();
                entries.fold(f64::MIN_POSITIVE, |most, entry| most.max(entry.abs()))
            });
            let mut relative = 0.0_f64;
            let [here, plus, minus] = &mut rates;
            for row in 0..degrees {
                let (here, plus, minus) = (
                    here[degrees + row],
                    &mut plus[degrees + row],
                    &mut minus[degrees + row],
                );
                let of_rate = (*minus - *plus) / (4.0 * LARGE_RATE);
                let mean = 0.5 * (*plus + *minus);
                let of_value = (here + 2.0 * self.own_rate * of_rate - mean)
                    / (LARGE_RATE * LARGE_RATE - self.own_rate * self.own_rate);
                relative = relative.max(of_value.abs() / largest);
                relative = relative.max(of_rate.abs() / largest_rate.max(largest));
                if !(of_value.is_finite() && of_rate.is_finite()) {
                    return None;
                }
                (*plus, *minus) = (of_value, of_rate);
            }
            for row in 0..degrees {
                state[row] -= plus[degrees + row];
                state[degrees + row] -= minus[degrees + row];
            }
            if relative <= LAST_CORRECTION {
                return Some(3 * correction);
            }
        }
        None
    }

    /// The same after a step. A state that cannot be corrected, or lies behind a singular position, is made
    /// of no numbers then, which stops the motion.
    pub(crate) fn after_a_step(
        &self,
        own: &mut Evaluator,
        t: f64,
        inputs: &HeldInputs,
        state: &mut [f64],
    ) -> u64 {
        let arrived = state.to_vec();
        let evaluations = self.correct(own, (t, &inputs.at(t)), state, MOST_AFTER_A_STEP);
        let reached = match evaluations {
            Some(_) => &*state,
            None => &arrived,
        };
        let passes = self.watch.borrow_mut().passes(t, reached, inputs);
        if passes || evaluations.is_none() {
            state.fill(f64::NAN);
        }
        evaluations.unwrap_or(1)
    }
}
