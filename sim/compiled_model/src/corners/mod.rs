//! Corners of a motion: jumps of the energies at a surface g(q, t) = 0, or when inputs jump.
//!
//! Position and time are continuous; momenta and energy satisfy the corner conditions of Weierstrass and Erdmann
//! ([`law`]). The motion passes the surface, or returns from it if its energy does not suffice. Closed contacts act if
//! they push ([`contacts`]). Surfaces that are crossed at one instant are tried in every order, and all orders must
//! agree.

mod contacts;
mod law;
mod sided_point;

use eomgen_codegen::program::evaluator::{CornerValues, Evaluator, Point};
use law::{apply_corner_conditions, keep_momenta, sides};
use nalgebra::DVector;
use sided_point::SidedPoint;
pub(crate) use sided_point::TouchingContact;

/// Maximum number of surfaces crossed at one instant.
const MAX_COINCIDENT: usize = 4;

/// Largest difference between the rates of two orders of surfaces that agree, relative to the largest rate.
const ORDER_AGREEMENT: f64 = 1e-9;

/// Maximum number of attempts to move a state to the near side of a surface; the distance doubles each time.
const RETURN_ATTEMPTS: usize = 60;

/// First distance to move, relative to the magnitude of the terms of the function.
const RETURN_FRACTION: f64 = 4.0 * f64::EPSILON;

/// Corners along a motion.
pub(crate) struct Corners {
    evaluator: Evaluator,
    /// Side of each surface on which the motion is, 0 or 1; `None` if the motion has always been on the surface.
    sides: Vec<Option<f64>>,
    guards: Vec<f64>,
    /// Cause of a stop.
    failure: Option<String>,
}

/// Energies at a corner.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CornerEnergy {
    /// Energy before the corner, J.
    pub before: f64,
    /// Work of moving surfaces and constraints, J.
    pub work: f64,
}

/// Surfaces that a motion crosses at one instant, and the sides of all surfaces before and after.
struct CrossedSurfaces {
    from: Vec<f64>,
    to: Vec<f64>,
    crossed: Vec<usize>,
}

/// Rates and sides after the motion has crossed surfaces at one instant.
struct CornerOutcome {
    state: Vec<f64>,
    sides: Vec<f64>,
}

impl Corners {
    /// Wraps an evaluator of a program with corner quantities, prepared at its parameters.
    pub fn new(evaluator: Evaluator) -> Self {
        Self {
            sides: vec![None; sides(&evaluator)],
            guards: vec![0.0; evaluator.guard_count()],
            failure: None,
            evaluator,
        }
    }

    /// Returns the cause if the motion stopped at a corner.
    pub fn failure(&self) -> Option<&str> {
        self.failure.as_deref()
    }

    /// Returns true if the energies jump at the surface of this switching function.
    pub fn contains(&self, guard: usize) -> bool {
        (0..self.sides.len()).any(|place| self.guard(place) == guard)
    }

    /// Updates the side of each surface. A state on a surface keeps the last side; without one it has the side of
    /// `above(0) = 0`.
    pub fn update(&mut self, (t, state): (f64, &[f64]), inputs: &[f64]) {
        let values = self.evaluate_functions((t, state), inputs);
        for (side, value) in self.sides.iter_mut().zip(values) {
            *side = side_of(value).or(*side).or(Some(0.0));
        }
    }

    /// Returns the energy (J) of a state, evaluated on the last sides of the motion.
    pub fn energy(&mut self, at: (f64, &[f64]), inputs: &[f64]) -> Option<f64> {
        let functions = self.evaluate_functions(at, inputs);
        let sides = self.determine_last_sides(&functions);
        Some(self.point(at, inputs, &sides).values()?.energy)
    }

    /// Applies the corner conditions to the rates of a state just beyond surfaces; `before` is on their near side. If
    /// the motion returns, the state is moved to the near side. Returns the energies if the motion has a corner.
    pub fn apply(
        &mut self,
        (t_before, before): (f64, &[f64]),
        (t, state): (f64, &mut [f64]),
        [inputs_before, inputs]: [&[f64]; 2],
        contacts: &[TouchingContact],
    ) -> Option<CornerEnergy> {
        self.failure = None;
        let CrossedSurfaces { from, to, crossed } =
            self.find_crossed((t_before, before), (t, state), [inputs_before, inputs]);
        if crossed.is_empty() {
            return None;
        }
        match self.find_outcome((t, state), inputs, (&from, &to, &crossed), contacts) {
            Ok(outcome) => {
                let energy = self.compute_energies(
                    (t, state),
                    inputs,
                    (&from, &crossed),
                    &outcome,
                    contacts,
                );
                state.copy_from_slice(&outcome.state);
                let sides = &outcome.sides;
                self.return_to_sides((t, state), inputs, (sides, &crossed), contacts);
                for place in crossed {
                    let side = outcome.sides[place];
                    self.sides[place] = Some(side);
                }
                energy
            }
            Err(cause) => {
                self.failure = Some(cause);
                state.fill(f64::NAN);
                None
            }
        }
    }

    /// Returns true if the motion crosses a surface between two states.
    pub fn crosses(
        &mut self,
        before: (f64, &[f64]),
        at: (f64, &[f64]),
        inputs: [&[f64]; 2],
    ) -> bool {
        !self.find_crossed(before, at, inputs).crossed.is_empty()
    }

    /// Returns the last sides of the motion; sides that are unknown follow from the signs of `functions`.
    fn determine_last_sides(&self, functions: &[f64]) -> Vec<f64> {
        let known = self.sides.iter().zip(functions);
        known
            .map(|(side, function)| side.or(side_of(*function)).unwrap_or(0.0))
            .collect()
    }

    fn find_crossed(
        &mut self,
        before: (f64, &[f64]),
        at: (f64, &[f64]),
        [inputs_before, inputs]: [&[f64]; 2],
    ) -> CrossedSurfaces {
        let near = self.evaluate_functions(before, inputs_before);
        let beyond = self.evaluate_functions(at, inputs);
        let from = self.determine_last_sides(&near);
        let to = determine_sides(&beyond, &from);
        let crossed = (0..to.len()).filter(|place| to[*place] != from[*place]);
        CrossedSurfaces {
            crossed: crossed.collect(),
            from,
            to,
        }
    }

    /// Changes the rates of a state when inputs jump, at constant momenta. Returns the energies if the rates change.
    pub fn apply_input_jump(
        &mut self,
        (t, state): (f64, &mut [f64]),
        [inputs_before, inputs]: [&[f64]; 2],
        contacts: &[TouchingContact],
    ) -> Option<CornerEnergy> {
        if inputs_before == inputs {
            return None;
        }
        let values = self.evaluate_functions((t, state), inputs);
        let known = self.determine_last_sides(&values);
        let to = determine_sides(&values, &known);
        let mut near = self.point((t, state), inputs_before, &known);
        let before = near.build_balance()?.values;
        let mut far = self.point((t, state), inputs, &to);
        let Some(balance) = far.build_balance() else {
            self.failure = Some(singular_corner_message(t));
            state.fill(f64::NAN);
            return None;
        };
        let momenta = DVector::from_column_slice(&before.momenta);
        if balance.values.momenta == before.momenta
            && balance.values.constraints == before.constraints
        {
            return None;
        }
        let mut far = far.with_contacts(contacts);
        if keep_momenta(&mut far, &momenta).is_none() {
            self.failure = Some(singular_corner_message(t));
            state.fill(f64::NAN);
            return None;
        }
        let after = far.values()?.energy;
        state.copy_from_slice(&far.state);
        Some(CornerEnergy {
            before: before.energy,
            work: after - before.energy,
        })
    }

    /// Returns rates and sides after the surfaces `crossed`. Tries every order of the surfaces.
    fn find_outcome(
        &mut self,
        (t, state): (f64, &[f64]),
        inputs: &[f64],
        (from, to, crossed): (&[f64], &[f64], &[usize]),
        contacts: &[TouchingContact],
    ) -> Result<CornerOutcome, String> {
        if crossed.len() > MAX_COINCIDENT {
            return Err(format!(
                "{} surfaces at which the energies jump meet",
                crossed.len()
            ));
        }
        let mut found: Option<CornerOutcome> = None;
        for order in list_permutations(crossed) {
            let point = self.point((t, state), inputs, from);
            let mut point = point.with_contacts(contacts);
            for place in order {
                apply_corner_conditions(&mut point, place, to[place])
                    .ok_or_else(|| singular_corner_message(t))?;
            }
            let first_side = point.inputs.len() - from.len();
            let outcome = CornerOutcome {
                sides: point.inputs[first_side..].to_vec(),
                state: point.state,
            };
            match &found {
                Some(known) if !known.agrees(&outcome) => {
                    return Err(self.format_meeting(t, crossed));
                }
                Some(_) => {}
                None => found = Some(outcome),
            }
        }
        found.ok_or_else(|| singular_corner_message(t))
    }

    /// Returns the energies at a corner. The work follows from the corner conditions: the change of T + V minus the
    /// change of the Hamiltonian, plus the change of the Hamiltonian at moving surfaces.
    fn compute_energies(
        &mut self,
        at: (f64, &[f64]),
        inputs: &[f64],
        (from, crossed): (&[f64], &[usize]),
        outcome: &CornerOutcome,
        contacts: &[TouchingContact],
    ) -> Option<CornerEnergy> {
        let near = self.point(at, inputs, from).values()?;
        let far = self
            .point((at.0, &outcome.state), inputs, &outcome.sides)
            .values()?;
        let degrees = self.evaluator.program().degrees_of_freedom();
        let speed = |values: &CornerValues, state: &[f64]| -> Vec<f64> {
            let rates = &state[degrees..2 * degrees];
            let surfaces = crossed.iter().map(|place| &values.surfaces[*place]);
            let rows = surfaces.chain(&values.constraints);
            rows.map(|(rate, row)| rate - dot(row, rates)).collect()
        };
        let moves = speed(&near, at.1)
            .iter()
            .chain(&speed(&far, &outcome.state))
            .chain(contacts.iter().map(|contact| &contact.drift))
            .any(|own| own.abs() > 0.0);
        let change = far.energy - near.energy;
        let work = match moves {
            true => change,
            false => change - (far.hamiltonian - near.hamiltonian),
        };
        Some(CornerEnergy {
            before: near.energy,
            work,
        })
    }

    /// Moves a state just beyond surfaces to the near side of the surfaces from which the motion returns.
    fn return_to_sides(
        &mut self,
        (t, state): (f64, &mut [f64]),
        inputs: &[f64],
        (sides, crossed): (&[f64], &[usize]),
        contacts: &[TouchingContact],
    ) {
        let degrees = self.evaluator.program().degrees_of_freedom();
        for place in crossed {
            let direction = 2.0 * sides[*place] - 1.0;
            let value = self.evaluate_functions((t, state), inputs)[*place];
            if direction * value > 0.0 {
                continue;
            }
            let point = self.point((t, state), inputs, sides);
            let Some(balance) = point.with_contacts(contacts).build_balance() else {
                return;
            };
            let row = DVector::from_column_slice(&balance.values.surfaces[*place].1);
            let Some((column, _)) = balance.column(&row) else {
                return;
            };
            let terms = row
                .iter()
                .zip(&*state)
                .map(|(slope, entry)| (slope * entry).abs());
            let mut distance = (2.0 * value.abs())
                .max(RETURN_FRACTION * terms.sum::<f64>())
                .max(f64::MIN_POSITIVE);
            let start = state[..degrees].to_vec();
            for _ in 0..RETURN_ATTEMPTS {
                let moved = direction * distance / row.dot(&column);
                for (entry, (start, column)) in
                    state.iter_mut().zip(start.iter().zip(column.iter()))
                {
                    *entry = start + column * moved;
                }
                if direction * self.evaluate_functions((t, state), inputs)[*place] > 0.0 {
                    break;
                }
                distance *= 2.0;
            }
        }
    }

    fn point(
        &mut self,
        (t, state): (f64, &[f64]),
        inputs: &[f64],
        sides: &[f64],
    ) -> SidedPoint<'_> {
        SidedPoint {
            evaluator: &mut self.evaluator,
            t,
            state: state.to_vec(),
            inputs: [inputs, sides].concat(),
            contacts: &[],
            acts: Vec::new(),
        }
    }

    /// Returns the values of the switching functions of the surfaces.
    fn evaluate_functions(&mut self, (t, state): (f64, &[f64]), inputs: &[f64]) -> Vec<f64> {
        let inputs = [inputs, &vec![0.0; self.sides.len()]].concat();
        let inputs = &inputs[..];
        self.evaluator
            .guards(Point { t, state, inputs }, &mut self.guards);
        (0..self.sides.len())
            .map(|place| self.guards[self.guard(place)])
            .collect()
    }

    /// Returns the index of a surface among all guard values.
    fn guard(&self, place: usize) -> usize {
        let corners = self.evaluator.program().outputs.corners.as_ref();
        corners.map_or(0, |corners| corners.surfaces[place].place)
    }

    fn format_meeting(&self, t: f64, crossed: &[usize]) -> String {
        let program = self.evaluator.program();
        let mut formulas = Vec::new();
        for guard in &program.guards {
            let count = program.value(guard.value).extent.length();
            formulas.extend(std::iter::repeat_n(&guard.formula, count));
        }
        let names: Vec<String> = crossed
            .iter()
            .map(|place| format!("`{}`", formulas[self.guard(*place)]))
            .collect();
        format!(
            "at t = {t:?} s the motion meets at one instant the surfaces where {} are zero and the energies \
             jump, and the motion afterwards depends on which surface is crossed first: move one of the surfaces",
            names.join(" and ")
        )
    }
}

impl CornerOutcome {
    fn agrees(&self, other: &Self) -> bool {
        let size = self
            .state
            .iter()
            .fold(0.0_f64, |most, entry| most.max(entry.abs()));
        let mut entries = self.state.iter().zip(&other.state);
        let is_near = entries.all(|(a, b)| (a - b).abs() <= ORDER_AGREEMENT * size);
        is_near && self.sides == other.sides
    }
}

/// Returns the sides at the given function values; on a surface the side in `otherwise`.
fn determine_sides(functions: &[f64], otherwise: &[f64]) -> Vec<f64> {
    let sides = functions.iter().zip(otherwise);
    sides
        .map(|(function, side)| side_of(*function).unwrap_or(*side))
        .collect()
}

fn side_of(value: f64) -> Option<f64> {
    if value > 0.0 {
        Some(1.0)
    } else if value < 0.0 {
        Some(0.0)
    } else {
        None
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn singular_corner_message(t: f64) -> String {
    format!(
        "at t = {t:?} s the energies jump, and beyond a coordinate has no inertia, or constraints and closed contacts \
         do not determine the rates: give every coordinate inertia on both sides, and remove contacts that others \
         replace"
    )
}

/// Returns all permutations of `places`.
fn list_permutations(places: &[usize]) -> Vec<Vec<usize>> {
    if places.len() <= 1 {
        return vec![places.to_vec()];
    }
    let mut all = Vec::new();
    for (index, first) in places.iter().enumerate() {
        let mut rest = places.to_vec();
        rest.remove(index);
        all.extend(
            list_permutations(&rest)
                .into_iter()
                .map(|order| [vec![*first], order].concat()),
        );
    }
    all
}
