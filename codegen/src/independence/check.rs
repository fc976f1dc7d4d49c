//! Constraints that depend on each other at every state that satisfies them. Such a model has unique accelerations,
//! but its multipliers are not unique. Several states are tested, because additional constraints depend on each other
//! at a singular position. Constraints that contradict each other or have no effect are rejected.

use std::collections::BTreeSet;

use eomgen_model_spec::diagnostic::Diagnostic;
use eomgen_model_spec::model::{Constraint, Model};
use eomgen_model_spec::variant::ModelError;

use super::dependence::find_dependent_combinations;
use super::geometry::ConstraintGeometry;
use super::projection::{EvaluationPoint, project};
use super::rows::replace_nonpositive_by_one;
use super::vectors::norm;
use crate::mechanics::redundancy::{DependentGroup, Redundancy};

/// Largest remainder of a dependent row, relative to the row's largest length. The projection onto the constraints is
/// accurate to about 1e-6.
const MAX_DEPENDENT_REMAINDER: f64 = 1e-5;

/// Smallest change of the scaled rows between the initial state and the start of another projection.
const MIN_ROW_CHANGE: f64 = 0.1;

/// Smallest relative change of a coordinate; smaller ones are hidden by rounding.
const MIN_RELATIVE_MOVE: f64 = 1e-2;

/// Number of states tested in addition to the initial one.
const OTHER_STATES: u64 = 4;

/// First distance from the initial state, in the metric of the inertias; each following distance is four times
/// larger.
const FIRST_MOVE: f64 = 1e-12;
const MOVE_COUNT: i32 = 40;

/// Smallest factor of a constraint in a dependent combination, relative to the largest factor; smaller ones are errors
/// of the projection.
const MIN_RELATIVE_FACTOR: f64 = 1e-4;

/// Constraints contradict each other if the residual of their combination exceeds this fraction of the
/// largest residual.
const MIN_RELATIVE_RESIDUAL: f64 = 0.1;

/// Residuals below this fraction of the initial ones are rounding errors.
const MAX_ROUNDING_RESIDUAL: f64 = 1e-6;

/// Returns the constraints that depend on each other at every tested state near the initial one. `orders` are the
/// truncation orders of the fields.
///
/// # Errors
/// Constraints without effect, constraints that contradict each other, and constraints on rates that depend on
/// constraints on coordinates, with the locations of the other constraints; initial values that are not finite.
pub(crate) fn find_redundancy(
    model: &Model,
    orders: &[usize],
    rows: &mut dyn ConstraintGeometry,
) -> Result<Redundancy, Diagnostic> {
    let refused = |error: ModelError| error.diagnostic();
    let state = &model.initial_state(orders).map_err(refused)?;
    let inputs = &model.typical_inputs(1.0).map_err(refused)?;
    let mut search = Search {
        holonomic: (0..model.constraints.len())
            .filter(|k| !model.constraints[*k].is_nonholonomic)
            .collect(),
        scales: vec![0.0; model.constraints.len()],
        largest: vec![0.0; model.constraints.len()],
        rows,
        inputs,
    };
    let initial = search.dependence(state);
    let mut found = initial.clone();
    for seed in 0..OTHER_STATES {
        if found.combinations.is_empty() {
            break;
        }
        let moved = search.move_state(state, seed);
        let other = search.dependence(&moved);
        let counts = [&other, &found].map(|one| one.combinations.len());
        let is_closer = search.size(&other) < search.size(&found);
        if counts[0] < counts[1] || counts[0] == counts[1] && is_closer {
            found = other;
        }
    }
    let groups = found.find_groups(model, &search.largest)?;
    let is_singular = initial.combinations.len() > found.combinations.len();
    Ok(Redundancy {
        groups,
        singular_start: match is_singular {
            true => initial.find_members(),
            false => Vec::new(),
        },
    })
}

struct Search<'s> {
    rows: &'s mut dyn ConstraintGeometry,
    inputs: &'s [f64],
    holonomic: Vec<usize>,
    /// Largest length of each row at the states tested so far.
    scales: Vec<f64>,
    /// Largest residual of each constraint at the starts of the projections so far.
    largest: Vec<f64>,
}

/// Combinations of constraints whose derivatives are zero at the nearest state that satisfies them.
#[derive(Clone)]
struct Dependence {
    combinations: Vec<Combination>,
    residuals: Vec<f64>,
}

#[derive(Clone)]
struct Combination {
    /// Factor of each scaled row.
    parts: Vec<f64>,
    factors: Vec<f64>,
}

impl Search<'_> {
    /// Finds the dependent combinations of constraints at the projection of `from`.
    fn dependence(&mut self, from: &[f64]) -> Dependence {
        let inputs = self.inputs;
        let at = |state| EvaluationPoint { state, inputs };
        self.scaled_rows(from);
        let residuals = self.rows.residuals(at(from).point());
        for (largest, residual) in self.largest.iter_mut().zip(residuals) {
            *largest = residual.abs().max(*largest);
        }
        let scales: Vec<f64> = self
            .scales
            .iter()
            .copied()
            .map(replace_nonpositive_by_one)
            .collect();
        let state = project(self.rows, at(from), &self.holonomic, &scales);
        let scaled = self.scaled_rows(&state);
        let combinations =
            find_dependent_combinations(&scaled, MAX_DEPENDENT_REMAINDER).into_iter();
        let combinations = combinations.map(|parts| {
            let scaled = parts.iter().zip(&self.scales);
            Combination {
                factors: scaled
                    .map(|(part, scale)| part / replace_nonpositive_by_one(*scale))
                    .collect(),
                parts,
            }
        });
        Dependence {
            combinations: combinations.collect(),
            residuals: self.rows.residuals(at(&state).point()),
        }
    }

    /// Returns the norm of the residuals after the projection, each divided by the largest length of its row so far.
    fn size(&self, found: &Dependence) -> f64 {
        let scaled = found.residuals.iter().zip(&self.scales);
        let scaled: Vec<f64> = scaled
            .map(|(residual, scale)| residual / replace_nonpositive_by_one(*scale))
            .collect();
        norm(&scaled)
    }

    /// Returns the rows at `state`, divided by their largest lengths so far.
    fn scaled_rows(&mut self, state: &[f64]) -> Vec<Vec<f64>> {
        let inputs = self.inputs;
        let mut rows = self.rows.rows(EvaluationPoint { state, inputs }.point());
        for (row, scale) in rows.iter_mut().zip(&mut self.scales) {
            *scale = scale.max(norm(row));
            row.iter_mut()
                .for_each(|entry| *entry /= replace_nonpositive_by_one(*scale));
        }
        rows
    }

    /// Returns a state at which the rows differ from those at `state`, in a direction given by `seed`;
    /// `state` itself if the rows are constant.
    fn move_state(&mut self, state: &[f64], seed: u64) -> Vec<f64> {
        let inputs = self.inputs;
        let inertia = self.rows.inertia(EvaluationPoint { state, inputs }.point());
        let here = self.scaled_rows(state);
        let mut moved = state.to_vec();
        for power in 0..MOVE_COUNT {
            let length = FIRST_MOVE * 4.0_f64.powi(power);
            for (degree, inertia) in inertia.iter().enumerate() {
                let part = pseudorandom_number(seed, degree as u64);
                moved[degree] = state[degree] + length * part / inertia.sqrt();
            }
            let there = self.scaled_rows(&moved);
            let entries = here.iter().flatten().zip(there.iter().flatten());
            let change = entries.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            let parts = moved.iter().zip(state);
            let is_seen = parts
                .filter(|(_, from)| **from != 0.0)
                .all(|(to, from)| (to - from).abs() > MIN_RELATIVE_MOVE * from.abs() || to == from);
            if change > MIN_ROW_CHANGE && is_seen {
                return moved;
            }
        }
        state.to_vec()
    }
}

/// Returns element `index` of a pseudorandom sequence between -1 and 1 (splitmix64).
fn pseudorandom_number(seed: u64, index: u64) -> f64 {
    let mut bits = (seed << 32 | index)
        .wrapping_add(1)
        .wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^= bits >> 31;
    (bits >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

impl Dependence {
    /// Returns the constraints of all combinations, ascending.
    fn find_members(&self) -> Vec<usize> {
        let all = self.combinations.iter().flat_map(Combination::find_members);
        let all: BTreeSet<usize> = all.collect();
        all.into_iter().collect()
    }

    /// Returns the groups of dependent constraints. `initial_residuals` are the largest initial residuals.
    fn find_groups(
        &self,
        model: &Model,
        initial_residuals: &[f64],
    ) -> Result<Vec<DependentGroup>, Diagnostic> {
        let mut groups: Vec<DependentGroup> = Vec::new();
        for combination in &self.combinations {
            let members = combination.find_members();
            if let Some(error) =
                self.describe_contradiction(model, combination, &members, initial_residuals)
            {
                return Err(error);
            }
            let shares = |group: &DependentGroup| {
                let mut own = group.constraints.iter();
                own.any(|place| members.contains(place))
            };
            let (connected, others): (Vec<_>, Vec<_>) = groups.into_iter().partition(shares);
            let mut constraints = members;
            let mut excess = 1;
            for group in connected {
                excess += group.constraints.len() - group.rank;
                constraints.extend(group.constraints);
            }
            constraints.sort_unstable();
            constraints.dedup();
            groups = others;
            groups.push(DependentGroup {
                rank: constraints.len() - excess,
                constraints,
            });
        }
        groups.sort_by(|a, b| a.constraints.cmp(&b.constraints));
        Ok(groups)
    }

    /// Returns the error for a dependent combination of constraints; `None` if the constraints are redundant.
    fn describe_contradiction(
        &self,
        model: &Model,
        combination: &Combination,
        members: &[usize],
        initial_residuals: &[f64],
    ) -> Option<Diagnostic> {
        let (last, others) = members.split_last()?;
        let own = &model.constraints[*last];
        let others: Vec<&Constraint> = others.iter().map(|k| &model.constraints[*k]).collect();
        let kind = own.is_nonholonomic;
        let is_mixed = others.iter().any(|other| other.is_nonholonomic != kind);
        let apart = match is_mixed {
            true => None,
            false => self.find_contradiction_residual(combination, members, initial_residuals),
        };
        if apart.is_none() && !is_mixed && !others.is_empty() {
            return None;
        }
        let names: Vec<String> = others
            .iter()
            .map(|other| format!("`{}`", other.name))
            .collect();
        let (message, label, help) = describe_dependence(own, &names.join(", "), apart);
        let found = Diagnostic::error(message)
            .with_span(own.zero.span, label)
            .with_help(help);
        let others = others.into_iter();
        Some(others.fold(found, |found, other| {
            found.with_related_span(other.zero.span, "depends on it")
        }))
    }

    /// Returns the residual of a combination, in the unit of its last constraint, if the constraints contradict each
    /// other. They contradict each other if the residual of the combination exceeds rounding and the fraction
    /// [`MIN_RELATIVE_RESIDUAL`] of its largest contribution.
    fn find_contradiction_residual(
        &self,
        combination: &Combination,
        members: &[usize],
        initial_residuals: &[f64],
    ) -> Option<f64> {
        let factors = &combination.factors;
        let last = members.last()?;
        let part = |k: usize, residual: f64| factors[k] / factors[*last] * residual;
        let all = members.iter().copied();
        let apart: f64 = all.clone().map(|k| part(k, self.residuals[k])).sum();
        let most = |residuals: &[f64]| {
            let parts = all.clone().map(|k| part(k, residuals[k]).abs());
            parts.fold(0.0, f64::max)
        };
        let largest = most(&self.residuals);
        (apart.abs() > MIN_RELATIVE_RESIDUAL * largest
            && largest > MAX_ROUNDING_RESIDUAL * most(initial_residuals))
        .then_some(apart)
    }
}

impl Combination {
    /// Returns the constraints of the combination, ascending.
    fn find_members(&self) -> Vec<usize> {
        let parts = self.parts.iter();
        let most = parts.fold(0.0_f64, |most, part| most.max(part.abs()));
        let is_member = |place: &usize| self.parts[*place].abs() > MIN_RELATIVE_FACTOR * most;
        (0..self.parts.len()).filter(is_member).collect()
    }
}

fn describe_dependence(
    own: &Constraint,
    others: &str,
    apart: Option<f64>,
) -> (String, &'static str, &'static str) {
    let (name, unit) = (&own.name, &own.unit);
    match (others.is_empty(), apart) {
        (true, Some(residual)) => (
            format!("the residual of the constraint `{name}` stays at {residual:.3e} {unit}"),
            "is never zero near the initial state",
            "correct its expression, or choose an initial state that satisfies it more closely",
        ),
        (true, None) => (
            format!(
                "the constraint `{name}` has no effect: all its derivatives are 0 at the states that satisfy it"
            ),
            "does not change sign",
            "write an expression that changes sign at its zeros, or remove the constraint",
        ),
        (false, Some(residual)) => (
            format!(
                "the constraint `{name}` contradicts {others}: they restrict the same motion, but a residual of \
                 {:.3e} {unit} remains",
                residual.abs()
            ),
            "contradicts the others",
            "remove one of them, or correct its expression",
        ),
        (false, None) => (
            format!(
                "the constraint `{name}` is redundant: constraints on coordinates and on rates restrict the same \
                 motion, because at every state that satisfies them, its derivative is a linear combination of the \
                 derivatives of {others}"
            ),
            "adds no restriction to the others",
            "remove the constraint on the rates: the one on the coordinates implies it",
        ),
    }
}
