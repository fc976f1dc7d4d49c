//! Model with given sides of its surfaces: rates, observables and the sides that hold the motion.

use std::ops::Range;

use eomgen_codegen::mechanics::outputs::Side;
use eomgen_codegen::program::evaluator::{Evaluator, ImpactValues, Point, SlidingValues};
use eomgen_sim::contact_friction::ContactMode;
use eomgen_sim::friction_discs::{DiscArrival, DiscVerdict, decide_with_discs};
use eomgen_sim::sliding_modes::{
    Arrival, Rates, Sharing, Verdict, reduce_largest, solve_holding, solve_least_squares,
};
use nalgebra::{DMatrix, DVector};

/// Maximum number of Newton iterations if the rates are not linear in the sides.
pub(crate) const MAX_SIDE_ITERATIONS: usize = 20;

/// Number of corrections of a state onto a surface; Newton's method squares the error.
pub(super) const CORRECTION_COUNT: usize = 2;

/// Largest change of a side that counts as rounding.
pub(crate) const MAX_SETTLED_CHANGE: f64 = 1e-14;

/// Relative change of a state, for a difference quotient of a function.
const RELATIVE_CHANGE: f64 = 1e-6;

/// Rounding error of a function, relative to the sum of its terms.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Smallest jump on a surface that counts as a jump, relative to the jump near the surface.
const MIN_JUMP_FRACTION: f64 = 0.5;

pub(super) type TimeAndState<'p> = (f64, &'p [f64]);

/// Model whose inputs include the sides of switching surfaces, at one set of parameters; see
/// [`DrivenModel::with_sides`](crate::DrivenModel::with_sides). The sides of surfaces that can hold a motion are set;
/// the other sides are fixed or follow from the state.
pub struct SidedModel {
    pub(super) evaluator: Evaluator,
    model_input_count: usize,
    /// Index of the first side of a surface that can hold a motion, among the inputs.
    first_side: usize,
    /// Inputs of the model, followed by the sides: surfaces that cannot hold a motion, surfaces that can, and the
    /// components of the unit vectors of discs (-1 to 1).
    pub(super) inputs: Vec<f64>,
    /// Surfaces that cannot hold a motion; true if the side is fixed.
    others: Vec<(Side, bool)>,
    /// Rows of the components of each disc among the sides.
    discs: Vec<Range<usize>>,
    pub(super) at: Vec<SlidingValues>,
    pub(super) guards: Vec<f64>,
    is_linear: bool,
    /// Closed contacts with their modes; their forces depend on the sides.
    pub(super) closed_contacts: Vec<(usize, ContactMode)>,
    pub(super) impacts: Vec<ImpactValues>,
    /// Effect of each surface's force on its own function, without contact forces.
    pub(super) own_effects: Vec<f64>,
    /// Guards and rates of the contacts at random points; empty before the first use.
    pub(super) drawn_values: Vec<Vec<f64>>,
    /// Guards that vanish with the held functions and the rates of closed contacts.
    pub(super) implied_guards: Vec<usize>,
    /// Contacts whose rates vanish with the held functions and the rates of closed contacts.
    pub(super) implied_contacts: Vec<usize>,
}

impl SidedModel {
    /// Wraps an evaluator of a program with sides, prepared at its parameters.
    pub(crate) fn new(evaluator: Evaluator) -> Self {
        let program = evaluator.program();
        let sliding = &program.outputs.sliding;
        let disc_count = sliding.iter().filter_map(|row| row.disc).max();
        let discs = (0..disc_count.map_or(0, |last| last + 1)).map(|disc| {
            let is_own = |row: &usize| sliding[*row].disc == Some(disc);
            let mut own = (0..sliding.len()).filter(is_own);
            let first = own.next().unwrap_or(0);
            first..first + 1 + own.count()
        });
        let others = program.outputs.sides.iter().map(|side| (*side, false));
        let first_side = program.inputs.len() - sliding.len();
        Self {
            discs: discs.collect(),
            model_input_count: first_side - others.len(),
            first_side,
            others: others.collect(),
            inputs: vec![0.5; program.inputs.len()],
            at: Vec::new(),
            guards: vec![0.0; evaluator.guard_count()],
            is_linear: sliding.iter().all(|surface| surface.is_linear),
            closed_contacts: Vec::new(),
            impacts: Vec::new(),
            own_effects: Vec::new(),
            drawn_values: Vec::new(),
            implied_guards: Vec::new(),
            implied_contacts: Vec::new(),
            evaluator,
        }
    }

    /// Returns the number of functions with a side: surfaces and components of discs.
    pub fn side_count(&self) -> usize {
        self.inputs.len() - self.first_side
    }

    pub(super) fn degrees_of_freedom(&self) -> usize {
        self.evaluator.program().degrees_of_freedom()
    }

    /// Returns true if there are surfaces that can hold a motion.
    pub fn can_hold_motion(&self) -> bool {
        self.side_count() > 0
    }

    /// Fixes the sides of surfaces that cannot hold a motion. `sides` has one entry per guard: -1, 1, or 0 (unknown).
    /// With `None` the sides follow from the state.
    pub(super) fn fix_other_sides(&mut self, sides: Option<&[f64]>) {
        for (other, (surface, is_fixed)) in self.others.iter_mut().enumerate() {
            let side = sides.map_or(0.0, |sides| sides[surface.guard]);
            *is_fixed = side != 0.0;
            self.inputs[self.model_input_count + other] = 0.5 + 0.5 * side;
        }
    }

    /// Makes the sides of surfaces that cannot hold the motion follow from the state. Returns the previous sides.
    pub(super) fn release_other_sides(&mut self) -> Vec<(bool, f64)> {
        let first = self.model_input_count;
        let others = self.others.iter_mut().zip(&self.inputs[first..]);
        let released = others.map(|((_, is_fixed), side)| (std::mem::take(is_fixed), *side));
        released.collect()
    }

    /// Restores the sides that `release_other_sides` returned.
    pub(super) fn restore_other_sides(&mut self, sides: Vec<(bool, f64)>) {
        for (other, (is_fixed, side)) in sides.into_iter().enumerate() {
            self.others[other].1 = is_fixed;
            self.inputs[self.model_input_count + other] = side;
        }
    }

    /// Sets the inputs of the model; the sides are unchanged.
    pub(super) fn set_model_inputs(&mut self, inputs: &[f64]) {
        self.inputs[..self.model_input_count].copy_from_slice(inputs);
    }

    /// Returns true if no side follows from the state.
    pub(super) fn are_other_sides_fixed(&self) -> bool {
        self.others.iter().all(|(_, is_fixed)| *is_fixed)
    }

    /// Returns true if the sides at a point equal the `kept` sides (-1, 1, or 0 if unknown) and the fixed ones.
    pub(super) fn has_own_sides(
        &mut self,
        (t, state): TimeAndState<'_>,
        inputs: &[f64],
        kept: &[f64],
    ) -> bool {
        self.set_inputs((t, state), inputs);
        let inputs = &self.inputs;
        let point = Point { t, state, inputs };
        self.evaluator.guards(point, &mut self.guards);
        let sliding = self.evaluator.program().outputs.sliding.iter();
        let sliding = sliding
            .zip(kept)
            .map(|(surface, side)| (surface.guard, *side));
        let others = self
            .others
            .iter()
            .zip(&self.inputs[self.model_input_count..]);
        let others = others.filter(|((_, is_fixed), _)| *is_fixed);
        let others = others.map(|((surface, _), side)| (surface.guard, 2.0 * side - 1.0));
        let mut all = others.chain(sliding);
        all.all(|(guard, side)| side * self.guards[guard] >= 0.0)
    }

    /// Sets the inputs of the model at a point, and the sides that follow from the state.
    fn set_inputs(&mut self, (t, state): TimeAndState<'_>, inputs: &[f64]) {
        self.inputs[..self.model_input_count].copy_from_slice(inputs);
        if self.are_other_sides_fixed() {
            return;
        }
        let inputs = &self.inputs;
        let point = Point { t, state, inputs };
        self.evaluator.guards(point, &mut self.guards);
        for (other, (surface, is_fixed)) in self.others.iter().enumerate() {
            if !is_fixed {
                let is_implied = self.implied_guards.contains(&surface.guard);
                let value = if is_implied {
                    0.0
                } else {
                    self.guards[surface.guard]
                };
                self.inputs[self.model_input_count + other] = side_of(value, surface.is_odd);
            }
        }
    }

    pub(super) fn surface_count(&self) -> usize {
        self.side_count() - self.discs.iter().map(Range::len).sum::<usize>()
    }

    /// Returns true if the model has friction opposite to the sliding velocity, along v/norm(v).
    pub(crate) fn has_discs(&self) -> bool {
        !self.discs.is_empty()
    }

    pub(super) fn discs(&self) -> &[Range<usize>] {
        &self.discs
    }

    /// Returns the number of guards of the model. Guards of disc components follow them.
    pub(super) fn guard_count(&self) -> usize {
        self.guards.len() + self.surface_count() - self.side_count()
    }

    /// Returns the formula of the speed of each disc.
    pub(super) fn disc_formulas(&self) -> Vec<String> {
        let program = self.evaluator.program();
        let first = program.guards.len() + self.surface_count() - self.side_count();
        let component = |row: usize| &*program.guards[first + row - self.surface_count()].formula;
        let formula = |rows: &Range<usize>| {
            let components: Vec<&str> = rows.clone().map(component).collect();
            format!("norm([{}])", components.join(", "))
        };
        self.discs.iter().map(formula).collect()
    }

    pub(super) fn guard_index(&self, surface: usize) -> usize {
        self.evaluator.program().outputs.sliding[surface].guard
    }

    pub(super) fn evaluate_functions(
        &mut self,
        (t, state): TimeAndState<'_>,
        inputs: &[f64],
    ) -> Vec<f64> {
        self.inputs[..self.model_input_count].copy_from_slice(inputs);
        let inputs = &self.inputs;
        let point = Point { t, state, inputs };
        self.evaluator.guards(point, &mut self.guards);
        let sliding = &self.evaluator.program().outputs.sliding;
        let values = sliding.iter().map(|surface| self.guards[surface.guard]);
        values.collect()
    }

    /// Returns the rounding errors of the given functions.
    pub(super) fn function_roundings(
        &mut self,
        (t, state): TimeAndState<'_>,
        inputs: &[f64],
    ) -> Vec<f64> {
        let here = self.evaluate_functions((t, state), inputs);
        let mut moved = state.to_vec();
        let mut sums = vec![0.0; here.len()];
        for place in self.evaluator.program().degrees_of_freedom()..state.len() {
            if state[place] == 0.0 {
                continue;
            }
            moved[place] = state[place] * (1.0 + RELATIVE_CHANGE);
            let there = self.evaluate_functions((t, &moved), inputs);
            for (sum, (a, b)) in sums.iter_mut().zip(there.iter().zip(&here)) {
                *sum += (a - b).abs() / RELATIVE_CHANGE;
            }
            moved[place] = state[place];
        }
        sums.iter()
            .map(|sum| f64::MIN_POSITIVE + ROUNDING * sum)
            .collect()
    }

    /// Returns the side, 0 to 1, of a surface whose function has the given value.
    pub(super) fn side_at_value(&self, surface: usize, value: f64) -> f64 {
        let is_odd = self.evaluator.program().outputs.sliding[surface].is_odd;
        side_of(value, is_odd)
    }

    /// Sets the sides. Computes the sides of the `held` surfaces so that they hold the motion.
    pub(super) fn find_holding_sides(
        &mut self,
        at: TimeAndState<'_>,
        inputs: &[f64],
        sides: &[f64],
        held: &[usize],
    ) {
        self.set_inputs(at, inputs);
        self.inputs[self.first_side..].copy_from_slice(sides);
        for _ in 0..self.iterations() {
            if held.is_empty() {
                return;
            }
            self.evaluate(at);
            let right = self.surface_values(held, |surface| -surface.rate);
            let (change, can_hold) = solve_holding(&self.matrix(held), &right);
            for (surface, change) in held.iter().zip(&change) {
                self.inputs[self.first_side + surface] += change;
            }
            if can_hold {
                self.share_forces(held);
            }
            if change.amax() <= MAX_SETTLED_CHANGE {
                return;
            }
        }
    }

    /// Moves the sides of linearly dependent held surfaces as far from their limits as possible.
    fn share_forces(&mut self, held: &[usize]) {
        let first = self.first_side;
        let signs = held
            .iter()
            .map(|row| self.sign(*row, self.inputs[first + row]));
        let mut signs: Vec<f64> = signs.collect();
        reduce_largest(
            &self.compute_matrix_by_signs(held),
            &mut signs,
            &self.groups(held),
        );
        for (row, sign) in held.iter().zip(signs) {
            self.inputs[first + row] = self.side_of_sign(*row, sign);
        }
    }

    /// Returns the index range of each surface and disc among held rows.
    fn groups(&self, held: &[usize]) -> Vec<Range<usize>> {
        let disc = |row: &usize| self.discs.iter().position(|rows| rows.contains(row));
        let mut end = 0;
        let groups = held.chunk_by(|a, b| disc(a).is_some() && disc(a) == disc(b));
        groups
            .map(|group| {
                let begin = end;
                end += group.len();
                begin..end
            })
            .collect()
    }

    /// Sets the sides and evaluates the effects of the surfaces at a point.
    pub(super) fn set_sides(&mut self, at: TimeAndState<'_>, inputs: &[f64], sides: &[f64]) {
        self.set_inputs(at, inputs);
        self.inputs[self.first_side..].copy_from_slice(sides);
        self.evaluate(at);
    }

    pub(super) fn sides(&self) -> &[f64] {
        &self.inputs[self.first_side..]
    }

    /// Writes the rates with the present sides.
    pub(super) fn write_rates(
        &mut self,
        (t, state): TimeAndState<'_>,
        inputs: &[f64],
        out: &mut [f64],
    ) {
        self.set_inputs((t, state), inputs);
        let inputs = &self.inputs;
        self.evaluator.rates(Point { t, state, inputs }, out);
    }

    /// Writes the observables with the present sides.
    pub(super) fn write_observables(&mut self, (t, state): TimeAndState<'_>, out: &mut [f64]) {
        let inputs = &self.inputs;
        self.evaluator.observables(Point { t, state, inputs }, out);
    }

    /// Determines the effect of the surfaces `touching` and of discs on a motion that is on them, with the given sides
    /// of all others. The rows of an arrival at a disc count all sides.
    pub(super) fn decide(
        &mut self,
        at: TimeAndState<'_>,
        inputs: &[f64],
        (touching, arrivals, discs): (&[usize], &[Arrival], &[DiscArrival]),
        sides: &[f64],
    ) -> Option<(Vec<Verdict>, Vec<DiscVerdict>)> {
        self.set_inputs(at, inputs);
        self.inputs[self.first_side..].copy_from_slice(sides);
        let mut rows = touching.to_vec();
        let mut packed = Vec::with_capacity(discs.len());
        for disc in discs {
            packed.push(DiscArrival {
                rows: rows.len()..rows.len() + disc.rows.len(),
                ..disc.clone()
            });
            rows.extend(disc.rows.clone());
        }
        let mut s = DVector::zeros(rows.len());
        for iteration in 0..self.iterations() {
            for (row, s) in rows.iter().zip(&s) {
                self.inputs[self.first_side + row] = self.side_of_sign(*row, *s);
            }
            self.evaluate(at);
            let w = self.compute_matrix_by_signs(&rows);
            let rates = Rates {
                c: self.surface_values(&rows, |surface| surface.rate) - &w * &s,
                w,
                sharing: Sharing::LeastMaximum,
            };
            let found = decide_with_discs(&rates, arrivals, &packed)?;
            let scalars = found.0.iter().map(|verdict| verdict.sign());
            let vectors = found.1.iter().flat_map(DiscVerdict::vector);
            let next: Vec<f64> = scalars.chain(vectors.copied()).collect();
            let next = DVector::from_vec(next);
            let is_last = self.is_linear || (&next - &s).amax() <= MAX_SETTLED_CHANGE;
            if is_last || iteration + 1 == MAX_SIDE_ITERATIONS {
                return is_last.then_some(found);
            }
            s = next;
        }
        None
    }

    /// Returns, for each surface of `touching`, true if the rates jump on it, with the given sides of all others. The
    /// state is near these surfaces. A jump that vanishes on its surface, such as that of `sign(p)*sqrt(abs(p))`,
    /// cannot hold a motion.
    pub(super) fn has_jumps(
        &mut self,
        (t, state): TimeAndState<'_>,
        inputs: &[f64],
        touching: &[usize],
        sides: &[f64],
    ) -> Vec<bool> {
        self.set_sides((t, state), inputs, sides);
        let beside: Vec<f64> = touching.iter().map(|i| self.own_effects[*i]).collect();
        let mut on = state.to_vec();
        for _ in 0..CORRECTION_COUNT {
            let values = self.evaluate_functions((t, &on), inputs);
            self.move_onto_surfaces(t, &mut on, (touching, &values));
        }
        self.evaluate((t, &on));
        let jumps = touching.iter().zip(beside);
        jumps
            .map(|(surface, beside)| self.own_effects[*surface] > MIN_JUMP_FRACTION * beside)
            .collect()
    }

    /// Corrects a state onto surfaces whose functions have the given values, along the effects of the surface forces.
    pub(super) fn move_onto_surfaces(
        &mut self,
        t: f64,
        state: &mut [f64],
        (held, values): (&[usize], &[f64]),
    ) {
        self.evaluate((t, state));
        let right = DVector::from_iterator(held.len(), held.iter().map(|i| -values[*i]));
        let moved = solve_least_squares(&self.matrix(held), right);
        let degrees = self.evaluator.program().degrees_of_freedom();
        for (surface, moved) in held.iter().zip(&moved) {
            let entries = state[degrees..].iter_mut().zip(&self.at[*surface].column);
            entries.for_each(|(entry, column)| *entry += column * moved);
        }
    }

    /// Adds the rounding error of the rates by a surface's own force, from the last evaluation.
    pub(super) fn add_rate_rounding(&self, row: usize, out: &mut [f64]) {
        let degrees = self.evaluator.program().degrees_of_freedom();
        let columns = self.at.get(row).into_iter().flat_map(|at| &at.column);
        for (slot, column) in out[degrees..].iter_mut().zip(columns) {
            *slot += f64::EPSILON * column.abs();
        }
    }

    /// Returns the rate of a surface's function due to its own force, from the last evaluation.
    pub(super) fn own_force_rate(&self, surface: usize) -> f64 {
        let at = self.at.get(surface);
        at.map_or(0.0, |at| at.by_sides[surface].abs())
    }

    fn evaluate(&mut self, (t, state): TimeAndState<'_>) {
        let inputs = &self.inputs;
        self.evaluator
            .sliding(Point { t, state, inputs }, &mut self.at);
        self.add_contact_forces((t, state));
    }

    fn iterations(&self) -> usize {
        if self.is_linear {
            1
        } else {
            MAX_SIDE_ITERATIONS
        }
    }

    fn matrix(&self, surfaces: &[usize]) -> DMatrix<f64> {
        DMatrix::from_fn(surfaces.len(), surfaces.len(), |row, column| {
            self.at[surfaces[row]].by_sides[surfaces[column]]
        })
    }

    /// Returns the effects of the signs of surfaces (-1 to 1) and of the components of discs.
    fn compute_matrix_by_signs(&self, rows: &[usize]) -> DMatrix<f64> {
        let mut matrix = self.matrix(rows);
        for (mut column, row) in matrix.column_iter_mut().zip(rows) {
            column *= self.side_of_sign(*row, 1.0) - self.side_of_sign(*row, 0.0);
        }
        matrix
    }

    /// Returns the side of a surface for a sign from -1 to 1; sides of discs are components of unit vectors.
    fn side_of_sign(&self, row: usize, sign: f64) -> f64 {
        match row < self.surface_count() {
            true => 0.5 + 0.5 * sign,
            false => sign,
        }
    }

    /// Returns the sign of a surface, -1 to 1, for a side.
    fn sign(&self, row: usize, side: f64) -> f64 {
        match row < self.surface_count() {
            true => 2.0 * side - 1.0,
            false => side,
        }
    }

    fn surface_values(
        &self,
        surfaces: &[usize],
        of: impl Fn(&SlidingValues) -> f64,
    ) -> DVector<f64> {
        DVector::from_iterator(
            surfaces.len(),
            surfaces.iter().map(|surface| of(&self.at[*surface])),
        )
    }
}

/// Returns the side, 0 to 1, of a surface whose function has the given value.
pub(crate) fn side_of(value: f64, is_odd: bool) -> f64 {
    match value {
        value if value > 0.0 => 1.0,
        0.0 if is_odd => 0.5,
        _ => 0.0,
    }
}
