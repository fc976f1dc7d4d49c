//! A system with a tangent vector beside its state.

use std::cell::{Cell, RefCell};

use super::saltation::{Surfaces, delay};
use crate::ode::System;

/// A change of the rates over a switch that is smaller than this part of them is none: with a
/// kink the rates on both sides differ by what the step over the surface changes.
const NO_JUMP: f64 = 1e-9;

/// A system of n states y with a vector v beside them, v' = J(t, y) v with J the derivatives of the
/// rates by the state: the state is y and then v, 2 n numbers. Over a switching surface g(t, y) = 0
/// where the rates jump from f- to f+, v jumps by the saltation matrix,
///
/// ```text
/// v+ = v- + (f+ - f-) (dg/dy v-) / (dg/dt + dg/dy f-)
/// ```
///
/// (R. I. Leine and H. Nijmeijer, Dynamics and Bifurcations of Non-Smooth Mechanical Systems,
/// Springer 2004, section 7.3), with the derivatives of g by differences.
pub struct Beside<'s, S: System + ?Sized> {
    system: &'s S,
    /// How large each state is, for differences.
    sizes: Vec<f64>,
    jacobian: RefCell<Vec<f64>>,
    /// When the motion went over several surfaces at once, s.
    together: Cell<Option<f64>>,
}

impl<'s, S: System + ?Sized> Beside<'s, S> {
    /// Puts a vector beside a system whose states are about so large, 0 where that is not known.
    pub fn new(system: &'s S, sizes: Vec<f64>) -> Self {
        let states = system.states();
        Self {
            system,
            sizes,
            jacobian: RefCell::new(vec![0.0; states * states]),
            together: Cell::new(None),
        }
    }

    /// When the motion went over surfaces together, s, where v has no direction: which of them came
    /// first decides about it.
    pub fn together(&self) -> Option<f64> {
        self.together.get()
    }

    fn rates_of(&self, t: f64, y: &[f64]) -> Vec<f64> {
        let mut rates = vec![0.0; y.len()];
        self.system.rates(t, y, &mut rates);
        rates
    }
}

impl<S: System + ?Sized> System for Beside<'_, S> {
    fn states(&self) -> usize {
        2 * self.system.states()
    }

    fn typical_sizes(&self) -> Vec<f64> {
        let mut sizes = self.system.typical_sizes();
        sizes.resize(self.states(), 1.0);
        sizes
    }

    fn rates(&self, t: f64, y: &[f64], out: &mut [f64]) {
        let states = self.system.states();
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
        self.system.guards(t, &y[..self.system.states()], out);
    }

    fn indefinite(&self, t: f64, y: &[f64]) -> Option<usize> {
        self.system.indefinite(t, &y[..self.system.states()])
    }

    fn next_breakpoint(&self, t: f64) -> Option<f64> {
        self.system.next_breakpoint(t)
    }

    fn cross(&self, (before, start): (f64, &[f64]), t: f64, y: &mut [f64]) {
        let states = self.system.states();
        let (start, (y, v)) = (&start[..states], y.split_at_mut(states));
        // As far before the start as the end is behind it: the start itself may lie on the
        // surface to the last bit, where the rates are those of either side.
        let mirrored = start.iter().zip(&*y).map(|(start, end)| 2.0 * start - end);
        let near: Vec<f64> = mirrored.collect();
        let near = (2.0 * before - t, &*near);
        let (from, to) = (self.rates_of(near.0, near.1), self.rates_of(t, y));
        let jump = |index: usize| to[index] - from[index];
        let is_kink = (0..states)
            .all(|index| jump(index).abs() <= NO_JUMP * from[index].abs().max(to[index].abs()));
        if !is_kink {
            let surfaces = Surfaces {
                system: self.system,
                sizes: &self.sizes,
            };
            let delay = delay(&surfaces, near, (t, y), &from, v);
            match delay {
                Some(delay) => v
                    .iter_mut()
                    .enumerate()
                    .for_each(|(index, v)| *v -= jump(index) * delay),
                None => self.together.set(Some(t)),
            }
        }
        self.system.cross((before, start), t, y);
    }
}
