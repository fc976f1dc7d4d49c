//! Steps of fixed length with constant inputs: the classical Runge-Kutta method of order 4, with reactions of
//! frictions and contacts that act over the whole step. Emitted code uses the same method with the same order of
//! operations.
//!
//! A friction is constant over the step. At the end of the step, its velocity is zero, or has the sign of the
//! friction; therefore sticking is exact. Contacts that are closed at the end of the step receive impulses by
//! Newton's law of restitution, and frictions of contacts obey Coulomb's law. As in time-stepping methods, the
//! conditions apply to the velocities at the end of the step (J. J. Moreau, Unilateral contact and dry friction in
//! finite freedom dynamics, CISM 302, 1988; V. Acary, B. Brogliato, *Numerical Methods for Nonsmooth Dynamical
//! Systems*, chapter 10), solved by projected Gauss-Seidel sweeps. A step with an event has an error proportional to
//! the step size; without events, the order of the method is 4.

use super::{Evaluator, Point, Stage};
use crate::program::{Argument, ProgramReactions, Reactions, ValueId};

/// Largest number of sweeps over the reactions.
pub(crate) const MAX_SWEEPS: usize = 1000;

/// Number of sweeps between two searches for further contacts.
pub(crate) const SWEEPS_BETWEEN_CONTACTS: usize = 10;

/// Sweeps end if no function changes by more than this number of rounding errors of the sum of its changes by all
/// reactions.
pub(crate) const MAX_SETTLED_ROUNDINGS: f64 = 64.0;

/// The reactions are accepted if the last sweep changes no function by more than this fraction of the sum of its
/// changes by all reactions.
pub(crate) const MAX_LAST_CHANGE: f64 = 1.0 / 1024.0;

/// Work arrays for the steps of one model.
#[derive(Clone, Debug, Default)]
pub struct StepMemory {
    rates: [Vec<f64>; 4],
    stage: Vec<f64>,
    next: Vec<f64>,
    sides: Vec<f64>,
    before: Vec<f64>,
    functions: Vec<f64>,
    effects: Vec<f64>,
    reactions: Vec<f64>,
    applied: Vec<f64>,
    targets: Vec<f64>,
    delays: Vec<f64>,
    sizes: Vec<f64>,
}

impl Evaluator {
    /// Allocates the work arrays for [`Evaluator::step`].
    pub fn create_step_memory(&self) -> StepMemory {
        let states = vec![0.0; self.program.states()];
        let known = self.program.outputs.reactions.as_ref();
        let count = known.map_or(0, |known| known.functions.len());
        let sides = known.map_or(0, Reactions::sides);
        let [functions, effects] = self.program.reaction_sizes();
        let reactions = || vec![0.0; count];
        StepMemory {
            rates: std::array::from_fn(|_| states.clone()),
            stage: states.clone(),
            next: states,
            sides: vec![0.5; sides],
            before: vec![0.0; functions],
            functions: vec![0.0; functions],
            effects: vec![0.0; effects],
            reactions: reactions(),
            applied: reactions(),
            targets: reactions(),
            delays: reactions(),
            sizes: reactions(),
        }
    }

    /// Advances a state by a step of length `h` (s) with constant inputs. The state becomes NaN if the iteration for
    /// the reactions of frictions and contacts does not converge. A program without the output `step` ignores
    /// contacts and computes the signs of frictions from the state. An evaluator in single precision computes the
    /// step in single precision.
    pub fn step(
        &mut self,
        (t, h): (f64, f64),
        state: &mut [f64],
        inputs: &[f64],
        memory: &mut StepMemory,
    ) {
        match self.single {
            Some(_) => {
                let round = |number: f64| f64::from(number as f32);
                self.step_with_rounding((t, h), (state, inputs), memory, round);
            }
            None => self.step_with_rounding((t, h), (state, inputs), memory, |number| number),
        }
    }

    /// Takes a step; `round` is applied to the result of every operation.
    fn step_with_rounding(
        &mut self,
        at: (f64, f64),
        (state, inputs): (&mut [f64], &[f64]),
        memory: &mut StepMemory,
        round: impl Fn(f64) -> f64 + Copy,
    ) {
        let Some(known) = self.program.outputs.reactions.take() else {
            self.take_runge_kutta_step(at, (state, inputs), (None, memory), round);
            state.copy_from_slice(&memory.next);
            return;
        };
        self.take_step_with_reactions(at, (state, inputs), (&known, memory), round);
        self.program.outputs.reactions = Some(known);
    }

    fn take_step_with_reactions(
        &mut self,
        (t, h): (f64, f64),
        (state, inputs): (&mut [f64], &[f64]),
        (known, memory): (&ProgramReactions, &mut StepMemory),
        round: impl Fn(f64) -> f64 + Copy,
    ) {
        let sides = known.sides();
        fn at<'p>(t: f64, state: &'p [f64], inputs: &'p [f64]) -> Point<'p> {
            Point { t, state, inputs }
        }
        let end = round(t + h);
        let degrees = self.program.degrees_of_freedom();
        self.write_reaction_functions(at(t, state, inputs), known, &mut memory.before);
        memory.reactions.fill(0.0);
        memory.delays.fill(round(0.5 * h));
        open_contacts(known, memory);
        if sides > 0 {
            self.write_reaction_effects(at(t, state, inputs), known, &mut memory.effects);
            drive_by_signs(h, known, memory);
            set_sides(h, memory, round);
            let rates = &mut memory.rates[0];
            self.write_rates_with_sides(at(t, state, inputs), known, &memory.sides, rates);
            advance(state, h, rates, &mut memory.next, round);
            self.write_reaction_functions(
                at(end, &memory.next, inputs),
                known,
                &mut memory.functions,
            );
            memory.applied.copy_from_slice(&memory.reactions);
            close_contacts(h, known, memory, round);
            find_reactions(h, known, (memory, MAX_SWEEPS), round);
            set_sides(h, memory, round);
            memory.reactions[sides..].fill(0.0);
            open_contacts(known, memory);
        }
        let held = (sides > 0).then_some(known);
        self.take_runge_kutta_step((t, h), (state, inputs), (held, memory), round);
        self.write_reaction_functions(at(end, &memory.next, inputs), known, &mut memory.functions);
        if sides == 0 {
            let distances = &memory.functions[known.functions.len()..];
            if distances.iter().all(|distance| *distance > 0.0) {
                state.copy_from_slice(&memory.next);
                return;
            }
            self.write_reaction_effects(at(t, state, inputs), known, &mut memory.effects);
        }
        memory.applied.copy_from_slice(&memory.reactions);
        // Impulses can close further contacts.
        for _ in 0..known.distances.len() {
            if !close_contacts(h, known, memory, round) {
                break;
            }
            find_reactions(h, known, (memory, SWEEPS_BETWEEN_CONTACTS), round);
        }
        find_reactions(h, known, (memory, MAX_SWEEPS), round);
        apply_reactions(degrees, known, memory, round);
        self.write_reaction_functions(at(end, &memory.next, inputs), known, &mut memory.functions);
        separate_contacts(degrees, known, memory, round);
        // Correct the reactions: they were computed with the positions and forces at the start, which differ from
        // those at the end.
        memory.applied.copy_from_slice(&memory.reactions);
        let is_found = find_reactions(h, known, (memory, MAX_SWEEPS), round);
        memory.delays.fill(0.0);
        apply_reactions(degrees, known, memory, round);
        match is_found {
            true => state.copy_from_slice(&memory.next),
            false => state.fill(f64::NAN),
        }
    }

    /// Writes the state after a Runge-Kutta step to `next`; the sides of the reactions are used if there are any.
    fn take_runge_kutta_step(
        &mut self,
        (t, h): (f64, f64),
        (state, inputs): (&[f64], &[f64]),
        (held, memory): (Option<&ProgramReactions>, &mut StepMemory),
        round: impl Fn(f64) -> f64 + Copy,
    ) {
        let StepMemory {
            rates: [k1, k2, k3, k4],
            stage,
            next,
            sides,
            ..
        } = memory;
        let mut rates = |t: f64, state: &[f64], out: &mut [f64]| {
            let point = Point { t, state, inputs };
            match held {
                Some(known) => self.write_rates_with_sides(point, known, sides, out),
                None => self.rates(point, out),
            }
        };
        let half = round(0.5 * h);
        let middle = round(t + half);
        rates(t, state, k1);
        advance(state, half, k1, stage, round);
        rates(middle, stage, k2);
        advance(state, half, k2, stage, round);
        rates(middle, stage, k3);
        advance(state, h, k3, stage, round);
        rates(round(t + h), stage, k4);
        let sixth = round(h / 6.0);
        for (index, next) in next.iter_mut().enumerate() {
            let inner = round(k2[index] + k3[index]);
            let sum = round(round(k1[index] + k4[index]) + 2.0 * inner);
            *next = round(state[index] + round(sixth * sum));
        }
    }

    fn write_rates_with_sides(
        &mut self,
        point: Point<'_>,
        known: &ProgramReactions,
        sides: &[f64],
        out: &mut [f64],
    ) {
        self.set_argument(Argument::Sides, &[], sides);
        self.compute(Stage::RatesWithSides, &point);
        let degrees = self.program.degrees_of_freedom();
        let (velocities, rest) = out.split_at_mut(degrees);
        velocities.copy_from_slice(&point.state[degrees..2 * degrees]);
        let (accelerations, first_order) = rest.split_at_mut(degrees);
        let rows = &known.accelerations;
        self.copy_rows(&rows.scalars, &rows.modal, accelerations);
        self.copy_scalars(&known.first_order_rates, first_order);
    }

    /// Writes the functions of the reactions, then the distances.
    fn write_reaction_functions(
        &mut self,
        point: Point<'_>,
        known: &ProgramReactions,
        out: &mut [f64],
    ) {
        self.compute(Stage::ReactionFunctions, &point);
        let (functions, distances) = out.split_at_mut(known.functions.len());
        self.copy_scalars(&known.functions, functions);
        self.copy_scalars(&known.distances, distances);
    }

    /// Writes the effects, the coefficients of the contacts and the columns of the reactions.
    fn write_reaction_effects(
        &mut self,
        point: Point<'_>,
        known: &ProgramReactions,
        out: &mut [f64],
    ) {
        self.compute(Stage::ReactionEffects, &point);
        let degrees = self.program.degrees_of_freedom();
        let (effects, rest) = out.split_at_mut(known.effects.len());
        self.copy_scalars(&known.effects, effects);
        let (restitutions, rest) = rest.split_at_mut(known.restitutions.len());
        self.copy_scalars(&known.restitutions, restitutions);
        let (coefficients, columns) = rest.split_at_mut(known.coefficients.len());
        let ids = known.coefficients.iter().map(|(_, id)| *id);
        self.copy_scalars(&ids.collect::<Vec<_>>(), coefficients);
        let length = self.program.states() - degrees;
        for ((rates, first_order), column) in
            known.columns.iter().zip(columns.chunks_exact_mut(length))
        {
            let (own_rates, own_first_order) = column.split_at_mut(degrees);
            self.copy_rows(&rates.scalars, &rates.modal, own_rates);
            self.copy_scalars(first_order, own_first_order);
        }
    }

    fn copy_scalars(&self, ids: &[ValueId], out: &mut [f64]) {
        for (slot, id) in out.iter_mut().zip(ids) {
            *slot = self.element(*id, 0);
        }
    }
}

fn advance(from: &[f64], h: f64, rates: &[f64], to: &mut [f64], round: impl Fn(f64) -> f64 + Copy) {
    for ((to, from), rate) in to.iter_mut().zip(from).zip(rates) {
        *to = round(from + round(h * rate));
    }
}

/// Sets the frictions that accelerate their own velocity (negative damping) to the sign of this velocity, and all
/// other frictions to 0.
fn drive_by_signs(h: f64, known: &ProgramReactions, memory: &mut StepMemory) {
    let count = known.functions.len();
    for own in 0..known.sides() {
        let before = memory.before[own];
        let sign = select(before, 0.0, h, select(0.0, before, -h, 0.0));
        memory.reactions[own] = select(0.0, memory.effects[own * count + own], 0.0, sign);
    }
}

fn set_sides(h: f64, memory: &mut StepMemory, round: impl Fn(f64) -> f64 + Copy) {
    for (side, reaction) in memory.sides.iter_mut().zip(&memory.reactions) {
        *side = round(0.5 + 0.5 * round(reaction / h));
    }
}

/// Opens all contacts; open contacts have no impulse.
fn open_contacts(known: &ProgramReactions, memory: &mut StepMemory) {
    memory.targets.fill(0.0);
    memory.targets[known.sides()..][..known.distances.len()].fill(f64::NEG_INFINITY);
}

/// Closes the open contacts whose distance is not positive with the present reactions. Sets, for each of them, the
/// smallest rate of the distance after the step, and the time since the distance was zero, for which the impulse
/// acts. Returns true if a contact closes.
fn close_contacts(
    h: f64,
    known: &ProgramReactions,
    memory: &mut StepMemory,
    round: impl Fn(f64) -> f64 + Copy,
) -> bool {
    let (count, sides) = (known.functions.len(), known.sides());
    let mut closes = 0.0;
    for contact in 0..known.distances.len() {
        let own = sides + contact;
        let before = memory.before[count + contact];
        let mut after = memory.functions[count + contact];
        for index in 0..count {
            let change = round(memory.reactions[index] - memory.applied[index]);
            let moved = round(memory.effects[own * count + index] * change);
            after = round(after + round(memory.delays[index] * moved));
        }
        let (rate_before, rate) = (memory.before[own], memory.functions[own]);
        let restitution = memory.effects[known.effects.len() + contact];
        let crossing = select(before, 0.0, round(before / round(before - after)), 0.0);
        let change = round(rate - rate_before);
        let approach = round(rate_before + round(crossing * change));
        let bounce = select(0.0, approach, -round(restitution * approach), 0.0);
        // The forces change the rate after the bounce by the same amount as without the bounce. A contact that would
        // close again within the step stays closed.
        let rebound = round(bounce + round(rate - approach));
        let target = select(rebound, 0.0, select(bounce, 0.0, rebound, 0.0), 0.0);
        let delay = select(
            -round(rate * h),
            -after,
            round(after / rate),
            round(0.5 * h),
        );
        let is_closed = select(memory.targets[own], f64::NEG_INFINITY, 1.0, 0.0);
        let own_closes = select(after, 0.0, 0.0, 1.0 - is_closed);
        memory.targets[own] = select(own_closes, 0.5, target, memory.targets[own]);
        memory.delays[own] = select(own_closes, 0.5, delay, memory.delays[own]);
        closes = select(own_closes, 0.5, 1.0, closes);
    }
    let first = sides + known.distances.len();
    for (index, (contact, _)) in known.coefficients.iter().enumerate() {
        memory.delays[first + index] = memory.delays[sides + contact];
    }
    closes > 0.5
}

/// Corrects the reactions, and the functions with them, until the conditions on the functions are satisfied. Returns
/// false if the iteration does not converge.
fn find_reactions(
    h: f64,
    known: &ProgramReactions,
    (memory, most_sweeps): (&mut StepMemory, usize),
    round: impl Fn(f64) -> f64 + Copy,
) -> bool {
    let StepMemory {
        functions,
        effects,
        reactions,
        targets,
        sizes,
        ..
    } = memory;
    let (count, sides) = (known.functions.len(), known.sides());
    let contacts = known.distances.len();
    let coefficients = &effects[known.effects.len() + contacts..];
    let third = round(round(4.0 / 3.0) - 1.0);
    let settled = MAX_SETTLED_ROUNDINGS * magnitude(round(round(3.0 * third) - 1.0));
    for own in 0..count {
        let mut size = magnitude(functions[own]);
        for (index, reaction) in reactions.iter().enumerate() {
            let part = round(effects[own * count + index] * reaction);
            size = round(size + magnitude(part));
        }
        sizes[own] = size;
    }
    let mut is_found = false;
    for _ in 0..most_sweeps {
        let (mut unsettled, mut lost) = (0.0, 0.0);
        for own in 0..count {
            let effect = effects[own * count + own];
            let lack = round(round(functions[own] - targets[own]) / effect);
            let wanted = round(reactions[own] - lack);
            let next = if own < sides {
                select(0.0, effect, clamp(wanted, -h, h), reactions[own])
            } else if own < sides + contacts {
                select(effect, 0.0, select(wanted, 0.0, wanted, 0.0), 0.0)
            } else {
                let index = own - sides - contacts;
                let contact = known.coefficients[index].0;
                let limit = round(coefficients[index] * reactions[sides + contact]);
                select(effect, 0.0, clamp(wanted, -limit, limit), 0.0)
            };
            let change = round(next - reactions[own]);
            reactions[own] = next;
            for (index, function) in functions[..count].iter_mut().enumerate() {
                let moved = round(effects[index * count + own] * change);
                *function = round(*function + moved);
                sizes[index] = round(sizes[index] + magnitude(moved));
            }
            let moved = magnitude(round(change * effect));
            unsettled = select(moved, round(settled * sizes[own]), 1.0, unsettled);
            lost = select(moved, round(MAX_LAST_CHANGE * sizes[own]), 1.0, lost);
        }
        if 0.5 > unsettled {
            return true;
        }
        is_found = 0.5 > lost;
    }
    is_found
}

/// Moves the positions until closed contacts do not overlap.
fn separate_contacts(
    degrees: usize,
    known: &ProgramReactions,
    memory: &mut StepMemory,
    round: impl Fn(f64) -> f64 + Copy,
) {
    let (count, sides) = (known.functions.len(), known.sides());
    let length = memory.next.len() - degrees;
    for contact in 0..known.distances.len() {
        let own = sides + contact;
        let effect = memory.effects[own * count + own];
        let distance = memory.functions[count + contact];
        let overlap = select(0.0, distance, round(-distance / effect), 0.0);
        let push = select(memory.targets[own], f64::NEG_INFINITY, overlap, 0.0);
        let first = known.first_column() + own * length;
        for index in 0..degrees {
            let moved = round(memory.effects[first + index] * push);
            memory.next[index] = round(memory.next[index] + moved);
        }
        for other in 0..known.distances.len() {
            let moved = round(memory.effects[(sides + other) * count + own] * push);
            let distance = memory.functions[count + other];
            memory.functions[count + other] = round(distance + moved);
        }
    }
}

/// Adds the effect of the changes of the reactions since `applied` to the state.
fn apply_reactions(
    degrees: usize,
    known: &ProgramReactions,
    memory: &mut StepMemory,
    round: impl Fn(f64) -> f64 + Copy,
) {
    let first = known.first_column();
    let length = memory.next.len() - degrees;
    for own in 0..known.functions.len() {
        let change = round(memory.reactions[own] - memory.applied[own]);
        for index in 0..length {
            let moved = round(memory.effects[first + own * length + index] * change);
            memory.next[degrees + index] = round(memory.next[degrees + index] + moved);
            if index < degrees {
                let moved = round(memory.delays[own] * moved);
                memory.next[index] = round(memory.next[index] + moved);
            }
        }
    }
}

fn select(a: f64, b: f64, then: f64, otherwise: f64) -> f64 {
    if a > b { then } else { otherwise }
}

fn magnitude(a: f64) -> f64 {
    select(0.0, a, -a, a)
}

fn clamp(a: f64, lowest: f64, highest: f64) -> f64 {
    let below = select(a, highest, highest, a);
    select(lowest, below, lowest, below)
}
