//! A system extended by a tangent vector.

use std::cell::{Cell, RefCell};

use eomgen_codegen::program::evaluator::Enclosure;

use super::saltation::{Surfaces, find_delay};
use crate::ode::System;

/// Largest change of the rates over a surface, relative to the rates, that does not count as a jump: at a kink
/// the rates differ only by their change over the step.
const MAX_KINK_JUMP_FRACTION: f64 = 1e-9;

/// A system with a tangent vector. Its state of 2 n entries is the state y of a system, then a vector v with v'
/// = J(t, y) v; J is the Jacobian of the rates with respect to the state. On a switching surface g(t, y) = 0 at
/// which the rates jump from f- to f+, the saltation matrix transforms v:
///
/// ```text
/// v+ = v- + (f+ - f-) (dg/dy v-) / (dg/dt + dg/dy f-)
/// ```
///
/// (R. I. Leine and H. Nijmeijer, *Dynamics and Bifurcations of Non-Smooth Mechanical Systems*,
/// Springer 2004, section 7.3). The derivatives of g are finite differences.
pub struct TangentSystem<'s> {
    system: &'s dyn System,
    sizes: Vec<f64>,
    jacobian: RefCell<Vec<f64>>,
    /// Fixed sides of the switching functions.
    sides: RefCell<Option<Vec<f64>>>,
    /// Time at which the motion crossed several surfaces at once, s.
    together: Cell<Option<f64>>,
}

impl<'s> TangentSystem<'s> {
    /// Adds a tangent vector to a system. `sizes` are the magnitudes of its states for finite differences, 0 if
    /// unknown.
    pub fn new(system: &'s dyn System, sizes: Vec<f64>) -> Self {
        let states = system.state_count();
        Self {
            system,
            sizes,
            jacobian: RefCell::new(vec![0.0; states * states]),
            sides: RefCell::new(None),
            together: Cell::new(None),
        }
    }

    /// Returns the time (s) at which the motion crossed several surfaces at once, if it did. The order of the
    /// crossings, and thus v, is then undetermined.
    pub fn simultaneous_crossing_time(&self) -> Option<f64> {
        self.together.get()
    }

    /// Returns the rates on the side of the surface on which the state is.
    fn evaluate_rates(&self, t: f64, y: &[f64]) -> Vec<f64> {
        let mut rates = vec![0.0; y.len()];
        self.system.rates(t, y, &mut rates);
        rates
    }
}

impl System for TangentSystem<'_> {
    fn state_count(&self) -> usize {
        2 * self.system.state_count()
    }

    fn typical_sizes(&self) -> Vec<f64> {
        let mut sizes = self.system.typical_sizes();
        sizes.resize(self.state_count(), 1.0);
        sizes
    }

    fn rates(&self, t: f64, y: &[f64], out: &mut [f64]) {
        let states = self.system.state_count();
        let (y, v) = y.split_at(states);
        let (rates, tangent) = out.split_at_mut(states);
        self.system.rates(t, y, rates);
        let mut jacobian = self.jacobian.borrow_mut();
        self.system.jacobian(t, y, &mut jacobian);
        for (slot, row) in tangent.iter_mut().zip(jacobian.chunks_exact(states)) {
            *slot = row.iter().zip(v).map(|(entry, v)| entry * v).sum();
        }
    }

    fn guard_count(&self) -> usize {
        self.system.guard_count()
    }

    fn guards(&self, t: f64, y: &[f64], out: &mut [f64]) {
        self.system.guards(t, &y[..self.system.state_count()], out);
    }

    fn bound_guards(&self, t: (f64, f64), state: &[Enclosure], out: &mut [Enclosure]) {
        let states = self.system.state_count();
        self.system.bound_guards(t, &state[..states], out);
    }

    fn is_singular(&self, guard: usize) -> bool {
        self.system.is_singular(guard)
    }

    fn has_energy_jump(&self, guard: usize) -> bool {
        self.system.has_energy_jump(guard)
    }

    fn find_indefinite_coordinate(&self, t: f64, y: &[f64]) -> Option<usize> {
        self.system
            .find_indefinite_coordinate(t, &y[..self.system.state_count()])
    }

    fn next_breakpoint(&self, t: f64) -> Option<f64> {
        self.system.next_breakpoint(t)
    }

    fn fix_sides(&self, sides: Option<&[f64]>) {
        self.sides.replace(sides.map(<[f64]>::to_vec));
        self.system.fix_sides(sides);
    }

    fn apply_event(&self, (before, start): (f64, &[f64]), t: f64, y: &mut [f64]) -> bool {
        let states = self.system.state_count();
        let (start, (y, v)) = (&start[..states], y.split_at_mut(states));
        // The start of the step can be on the surface up to rounding, with the rates of either side. The rates
        // are evaluated at the mirror image of the end instead.
        let mirrored = start.iter().zip(&*y).map(|(start, end)| 2.0 * start - end);
        let near: Vec<f64> = mirrored.collect();
        let near = (2.0 * before - t, &*near);
        self.system.fix_sides(None);
        let (from, to) = (
            self.evaluate_rates(near.0, near.1),
            self.evaluate_rates(t, y),
        );
        self.system.fix_sides(self.sides.borrow().as_deref());
        let jump = |index: usize| to[index] - from[index];
        let is_kink = (0..states).all(|index| {
            jump(index).abs() <= MAX_KINK_JUMP_FRACTION * from[index].abs().max(to[index].abs())
        });
        if !is_kink {
            let surfaces = Surfaces {
                system: self.system,
                sizes: &self.sizes,
            };
            let delay = find_delay(&surfaces, near, (t, y), &from, v);
            match delay {
                Some(delay) => v
                    .iter_mut()
                    .enumerate()
                    .for_each(|(index, v)| *v -= jump(index) * delay),
                None => self.together.set(Some(t)),
            }
        }
        self.system.apply_event((before, start), t, y)
    }
}
