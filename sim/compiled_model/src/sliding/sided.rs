//! A model with given sides of its surfaces: rates, observables and the sides that hold.

use eomgen_codegen::program::evaluator::{Evaluator, Point, SlidingAt};
use eomgen_sim::sliding_modes::{Arrival, Rates, Verdict, decide, least};
use nalgebra::{DMatrix, DVector};

/// Maximum number of Newton iterations if the rates are not linear in the sides.
const ITERATIONS: usize = 20;

/// Number of corrections of a state onto a surface; Newton's method squares the error.
pub(super) const CORRECTIONS: usize = 2;

/// Largest change of a side that counts as rounding.
const SETTLED: f64 = 1e-14;

/// Relative change of a state for its effect on a function.
const PART: f64 = 1e-6;

/// Rounding of a function, relative to the sum of its terms.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Smallest jump on a surface, relative to the jump near the surface, that counts as a jump.
const JUMP: f64 = 0.5;

pub(super) type At<'p> = (f64, &'p [f64]);

/// A model whose inputs include the sides of the surfaces that can hold a motion, at one set of
/// parameters; see [`Driven::with_sliding`](crate::Driven::with_sliding).
pub struct Sided {
    evaluator: Evaluator,
    own_inputs: usize,
    /// Inputs of the model, then the sides.
    inputs: Vec<f64>,
    at: Vec<SlidingAt>,
    guards: Vec<f64>,
    is_linear: bool,
}

impl Sided {
    /// Wraps an evaluator of a program with sides, prepared at its parameters.
    pub(crate) fn new(evaluator: Evaluator) -> Self {
        let program = evaluator.program();
        let sliding = &program.outputs.sliding;
        Self {
            own_inputs: program.inputs.len() - sliding.len(),
            inputs: vec![0.5; program.inputs.len()],
            at: Vec::new(),
            guards: vec![0.0; evaluator.guard_count()],
            is_linear: sliding.iter().all(|surface| surface.is_linear),
            evaluator,
        }
    }

    pub(super) fn count(&self) -> usize {
        self.inputs.len() - self.own_inputs
    }

    pub(super) fn guard(&self, surface: usize) -> usize {
        self.evaluator.program().outputs.sliding[surface].guard
    }

    pub(super) fn functions(&mut self, (t, state): At<'_>, inputs: &[f64]) -> Vec<f64> {
        self.inputs[..self.own_inputs].copy_from_slice(inputs);
        let inputs = &self.inputs;
        let point = Point { t, state, inputs };
        self.evaluator.guards(point, &mut self.guards);
        let sliding = &self.evaluator.program().outputs.sliding;
        let values = sliding.iter().map(|surface| self.guards[surface.guard]);
        values.collect()
    }

    /// Returns the rounding of these functions.
    pub(super) fn roundings(&mut self, (t, state): At<'_>, inputs: &[f64]) -> Vec<f64> {
        let here = self.functions((t, state), inputs);
        let mut moved = state.to_vec();
        let mut sums = vec![0.0; here.len()];
        for place in self.evaluator.program().degrees_of_freedom()..state.len() {
            if state[place] == 0.0 {
                continue;
            }
            moved[place] = state[place] * (1.0 + PART);
            let there = self.functions((t, &moved), inputs);
            for (sum, (a, b)) in sums.iter_mut().zip(there.iter().zip(&here)) {
                *sum += (a - b).abs() / PART;
            }
            moved[place] = state[place];
        }
        sums.iter()
            .map(|sum| f64::MIN_POSITIVE + ROUNDING * sum)
            .collect()
    }

    /// Returns the side, 0 to 1, of a surface whose function has this value.
    pub(super) fn side_of(&self, surface: usize, value: f64) -> f64 {
        let is_odd = self.evaluator.program().outputs.sliding[surface].is_odd;
        match value {
            value if value > 0.0 => 1.0,
            0.0 if is_odd => 0.5,
            _ => 0.0,
        }
    }

    /// Sets the sides, and computes those of `held` surfaces so that these hold.
    pub(super) fn hold(&mut self, at: At<'_>, inputs: &[f64], sides: &[f64], held: &[usize]) {
        self.inputs[..self.own_inputs].copy_from_slice(inputs);
        self.inputs[self.own_inputs..].copy_from_slice(sides);
        for _ in 0..self.iterations() {
            if held.is_empty() {
                return;
            }
            self.evaluate(at);
            let right = self.numbers(held, |surface| -surface.rate);
            let change = least(self.matrix(held), right);
            for (surface, change) in held.iter().zip(&change) {
                self.inputs[self.own_inputs + surface] += change;
            }
            if change.amax() <= SETTLED {
                return;
            }
        }
    }

    /// Sets the sides and evaluates the effects of the surfaces at a point.
    pub(super) fn look(&mut self, at: At<'_>, inputs: &[f64], sides: &[f64]) {
        self.inputs[..self.own_inputs].copy_from_slice(inputs);
        self.inputs[self.own_inputs..].copy_from_slice(sides);
        self.evaluate(at);
    }

    pub(super) fn sides(&self) -> &[f64] {
        &self.inputs[self.own_inputs..]
    }

    /// Writes the rates with these sides.
    pub(super) fn rates(&mut self, (t, state): At<'_>, inputs: &[f64], out: &mut [f64]) {
        self.inputs[..self.own_inputs].copy_from_slice(inputs);
        let inputs = &self.inputs;
        self.evaluator.rates(Point { t, state, inputs }, out);
    }

    /// Writes the observables with these sides.
    pub(super) fn observables(&mut self, (t, state): At<'_>, out: &mut [f64]) {
        let inputs = &self.inputs;
        self.evaluator.observables(Point { t, state, inputs }, out);
    }

    /// Decides the effect of the surfaces `touching` on a motion that is on them, with these sides
    /// of all others.
    pub(super) fn decide(
        &mut self,
        at: At<'_>,
        inputs: &[f64],
        (touching, arrivals): (&[usize], &[Arrival]),
        sides: &[f64],
    ) -> Option<Vec<Verdict>> {
        self.inputs[..self.own_inputs].copy_from_slice(inputs);
        self.inputs[self.own_inputs..].copy_from_slice(sides);
        let mut s = DVector::zeros(touching.len());
        for iteration in 0..self.iterations() {
            for (surface, s) in touching.iter().zip(&s) {
                self.inputs[self.own_inputs + surface] = 0.5 + 0.5 * s;
            }
            self.evaluate(at);
            let w = self.matrix(touching) * 0.5;
            let rates = Rates {
                c: self.numbers(touching, |surface| surface.rate) - &w * &s,
                w,
            };
            let found = decide(&rates, arrivals)?;
            let next = DVector::from_iterator(touching.len(), found.iter().map(|v| v.sign()));
            let is_last = self.is_linear || (&next - &s).amax() <= SETTLED;
            if is_last || iteration + 1 == ITERATIONS {
                return is_last.then_some(found);
            }
            s = next;
        }
        None
    }

    /// Returns true for each surface of `touching` on which the rates jump, with these sides of
    /// all others. The state is near these surfaces. A jump that vanishes on its surface, such as
    /// that of `sign(p)*sqrt(abs(p))`, cannot hold a motion.
    pub(super) fn jumps_on(
        &mut self,
        (t, state): At<'_>,
        inputs: &[f64],
        touching: &[usize],
        sides: &[f64],
    ) -> Vec<bool> {
        self.look((t, state), inputs, sides);
        let beside: Vec<f64> = touching.iter().map(|i| self.own_rate(*i)).collect();
        let mut on = state.to_vec();
        for _ in 0..CORRECTIONS {
            let values = self.functions((t, &on), inputs);
            self.put_on(t, &mut on, (touching, &values));
        }
        self.evaluate((t, &on));
        let jumps = touching.iter().zip(beside);
        jumps
            .map(|(surface, beside)| self.own_rate(*surface) > JUMP * beside)
            .collect()
    }

    /// Corrects a state, given these values of the functions, onto surfaces along the effects of
    /// their forces.
    pub(super) fn put_on(&mut self, t: f64, state: &mut [f64], (held, values): (&[usize], &[f64])) {
        self.evaluate((t, state));
        let right = DVector::from_iterator(held.len(), held.iter().map(|i| -values[*i]));
        let moved = least(self.matrix(held), right);
        let degrees = self.evaluator.program().degrees_of_freedom();
        for (surface, moved) in held.iter().zip(&moved) {
            let entries = state[degrees..].iter_mut().zip(&self.at[*surface].column);
            entries.for_each(|(entry, column)| *entry += column * moved);
        }
    }

    /// Returns the rate of a surface's function due to its own force, as last evaluated.
    pub(super) fn own_rate(&self, surface: usize) -> f64 {
        let at = self.at.get(surface);
        at.map_or(0.0, |at| at.by_sides[surface].abs())
    }

    fn evaluate(&mut self, (t, state): At<'_>) {
        let inputs = &self.inputs;
        self.evaluator
            .sliding(Point { t, state, inputs }, &mut self.at);
    }

    fn iterations(&self) -> usize {
        if self.is_linear { 1 } else { ITERATIONS }
    }

    fn matrix(&self, surfaces: &[usize]) -> DMatrix<f64> {
        DMatrix::from_fn(surfaces.len(), surfaces.len(), |row, column| {
            self.at[surfaces[row]].by_sides[surfaces[column]]
        })
    }

    fn numbers(&self, surfaces: &[usize], of: impl Fn(&SlidingAt) -> f64) -> DVector<f64> {
        DVector::from_iterator(
            surfaces.len(),
            surfaces.iter().map(|surface| of(&self.at[*surface])),
        )
    }
}
