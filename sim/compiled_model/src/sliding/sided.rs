//! A model with the sides of its surfaces given: what holds it there, and the rates, power and
//! observables that follow.

use eomgen_codegen::program::evaluator::{Evaluator, Point, SlidingAt};
use eomgen_sim::sliding_modes::{Arrival, Rates, Verdict, decide, least};
use nalgebra::{DMatrix, DVector};

/// Newton's iterations where the rates are not of first degree in the sides.
const ITERATIONS: usize = 20;

/// Corrections of a state that a surface catches; each squares what is left.
pub(super) const CORRECTIONS: usize = 2;

/// A change of a side that is no more than rounding.
const SETTLED: f64 = 1e-14;

/// Over this part of a state its effect on a surface's function is found.
const PART: f64 = 1e-6;

/// Rounding of a function, beside the sum of its terms.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// A jump on a surface exceeds this part of the jump near the surface.
const JUMP: f64 = 0.5;

/// A time and a state.
pub(super) type At<'p> = (f64, &'p [f64]);

/// A model with the sides of surfaces that may hold a motion as inputs, at one set of parameters; see
/// [`Driven::with_sliding`](crate::Driven::with_sliding).
pub struct Sided {
    evaluator: Evaluator,
    /// How many inputs the model has.
    own_inputs: usize,
    /// The inputs of the model, then the sides.
    inputs: Vec<f64>,
    at: Vec<SlidingAt>,
    guards: Vec<f64>,
    is_linear: bool,
}

impl Sided {
    /// Of a program with sides, prepared at the parameters to be used.
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

    /// How many surfaces there are.
    pub(super) fn count(&self) -> usize {
        self.inputs.len() - self.own_inputs
    }

    /// The place of a surface's function among the guards.
    pub(super) fn guard(&self, surface: usize) -> usize {
        self.evaluator.program().outputs.sliding[surface].guard
    }

    /// The functions of the surfaces.
    pub(super) fn functions(&mut self, (t, state): At<'_>, inputs: &[f64]) -> Vec<f64> {
        self.inputs[..self.own_inputs].copy_from_slice(inputs);
        let inputs = &self.inputs;
        let point = Point { t, state, inputs };
        self.evaluator.guards(point, &mut self.guards);
        let sliding = &self.evaluator.program().outputs.sliding;
        let values = sliding.iter().map(|surface| self.guards[surface.guard]);
        values.collect()
    }

    /// By how much rounding changes these functions.
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

    /// The side of a surface whose function has this value, 0 to 1.
    pub(super) fn side_of(&self, surface: usize, value: f64) -> f64 {
        let is_odd = self.evaluator.program().outputs.sliding[surface].is_odd;
        match value {
            value if value > 0.0 => 1.0,
            0.0 if is_odd => 0.5,
            _ => 0.0,
        }
    }

    /// Sets the sides, but for those of `held` surfaces, which are found so that they hold.
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

    /// Sets the sides and finds what the surfaces do at a point.
    pub(super) fn look(&mut self, at: At<'_>, inputs: &[f64], sides: &[f64]) {
        self.inputs[..self.own_inputs].copy_from_slice(inputs);
        self.inputs[self.own_inputs..].copy_from_slice(sides);
        self.evaluate(at);
    }

    /// The sides, as last set or found.
    pub(super) fn sides(&self) -> &[f64] {
        &self.inputs[self.own_inputs..]
    }

    /// The rates with the sides as last found.
    pub(super) fn rates(&mut self, (t, state): At<'_>, inputs: &[f64], out: &mut [f64]) {
        self.inputs[..self.own_inputs].copy_from_slice(inputs);
        let inputs = &self.inputs;
        self.evaluator.rates(Point { t, state, inputs }, out);
    }

    /// The observables with the sides as last found.
    pub(super) fn observables(&mut self, (t, state): At<'_>, out: &mut [f64]) {
        let inputs = &self.inputs;
        self.evaluator.observables(Point { t, state, inputs }, out);
    }

    /// What the surfaces `touching` do to a motion that came to stand on them, with these sides of all
    /// others.
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

    /// Returns true if the rates jump on each of the surfaces `touching`, near which a state is, with these sides
    /// of all others. A jump that vanishes on its surface, as that of `sign(p)*sqrt(abs(p))` does, holds
    /// nothing there, though it may seem to beside the surface.
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

    /// Brings a state, of functions with these values, onto surfaces. Its rates move as the forces
    /// there move them.
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

    /// How fast a surface's own force changes its function, as last evaluated.
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
