//! Refuses a model whose constraints depend on each other wherever they hold: accelerations follow, but not
//! the multipliers, and what rounding leaves of a pivot is divided by. Several states that keep the constraints
//! are looked at, so that a singular position at the start alone is none.

use eomgen_model_spec::diagnostic::Diagnostic;
use eomgen_model_spec::model::{Constraint, Model};
use eomgen_model_spec::variant::ModelError;

use super::dependence::dependent_combination;
use super::projection::{Place, project};
use super::rows::{ConstraintGeometry, positive};
use super::vectors::norm;

/// Rows in parts of their largest lengths depend on each other if no more than this is left of one beside the
/// others. Searches for a state end where about 1e-6 is left.
const DEPENDENT: f64 = 1e-5;

/// Change of the scaled rows from the initial state to the start of another search.
const CHANGE: f64 = 0.1;

/// The least move of a coordinate in parts of its value, so that rounding does not hide what changes.
const LEAST_MOVE: f64 = 1e-2;

/// States that are looked at beside the initial one.
const OTHER_STATES: u64 = 4;

/// Factors of the moves from the initial state, in the metric of the inertias: each four times the last.
const FIRST_MOVE: f64 = 1e-12;
const MOVES: i32 = 40;

/// Constraints that take part in a combination by less than this beside the largest are not named.
const TAKES_PART: f64 = 1e-3;

/// Constraints contradict each other if their combination leaves this much of the largest residual.
const CONTRADICTION: f64 = 0.1;

/// Residuals of this size beside those that the searches began with are rounding.
const KEPT: f64 = 1e-6;

/// Refuses constraints that depend on each other wherever they hold, or that never hold, near the initial
/// state of a model with fields of these orders.
///
/// # Errors
/// A constraint that depends on others, at its place with those, and initial values that are not finite.
pub(crate) fn check_independence(
    model: &Model,
    orders: &[usize],
    rows: &mut dyn ConstraintGeometry,
) -> Result<(), Diagnostic> {
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
    let Some(mut found) = search.dependence(state) else {
        return Ok(());
    };
    for seed in 0..OTHER_STATES {
        let moved = search.moved(state, seed);
        match search.dependence(&moved) {
            Some(other) => found = other,
            None => return Ok(()),
        }
    }
    Err(found.diagnostic(model, &search.largest))
}

struct Search<'s> {
    rows: &'s mut dyn ConstraintGeometry,
    inputs: &'s [f64],
    holonomic: Vec<usize>,
    /// The longest that each row was so far.
    scales: Vec<f64>,
    /// The largest residual that a search began with.
    largest: Vec<f64>,
}

/// A combination of constraints without a derivative, at a state that keeps them as well as can be.
struct Dependence {
    /// The factor of each constraint in parts of the length of its row.
    parts: Vec<f64>,
    /// The factor of each constraint.
    factors: Vec<f64>,
    residuals: Vec<f64>,
}

impl Search<'_> {
    /// The combination of constraints that has no derivative near a state, if there is one.
    fn dependence(&mut self, from: &[f64]) -> Option<Dependence> {
        let inputs = self.inputs;
        let at = |state| Place { state, inputs };
        self.scaled_rows(from);
        let residuals = self.rows.residuals(at(from).point());
        for (largest, residual) in self.largest.iter_mut().zip(residuals) {
            *largest = residual.abs().max(*largest);
        }
        let scales: Vec<f64> = self.scales.iter().copied().map(positive).collect();
        let state = project(self.rows, at(from), &self.holonomic, &scales);
        let scaled = self.scaled_rows(&state);
        let parts = dependent_combination(&scaled, DEPENDENT)?;
        let scaled = parts.iter().zip(&self.scales);
        Some(Dependence {
            factors: scaled
                .map(|(part, scale)| part / positive(*scale))
                .collect(),
            parts,
            residuals: self.rows.residuals(at(&state).point()),
        })
    }

    /// The rows at a state in parts of their largest lengths.
    fn scaled_rows(&mut self, state: &[f64]) -> Vec<Vec<f64>> {
        let inputs = self.inputs;
        let mut rows = self.rows.rows(Place { state, inputs }.point());
        for (row, scale) in rows.iter_mut().zip(&mut self.scales) {
            *scale = scale.max(norm(row));
            row.iter_mut().for_each(|entry| *entry /= positive(*scale));
        }
        rows
    }

    /// A state so far from this one, in a direction by `seed`, that the rows change; the state itself if none
    /// ever does.
    fn moved(&mut self, state: &[f64], seed: u64) -> Vec<f64> {
        let inputs = self.inputs;
        let inertia = self.rows.inertia(Place { state, inputs }.point());
        let here = self.scaled_rows(state);
        let mut moved = state.to_vec();
        for power in 0..MOVES {
            let length = FIRST_MOVE * 4.0_f64.powi(power);
            for (degree, inertia) in inertia.iter().enumerate() {
                let part = symmetric(seed, degree as u64);
                moved[degree] = state[degree] + length * part / inertia.sqrt();
            }
            let there = self.scaled_rows(&moved);
            let entries = here.iter().flatten().zip(there.iter().flatten());
            let change = entries.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            let parts = moved.iter().zip(state);
            let is_seen = parts
                .filter(|(_, from)| **from != 0.0)
                .all(|(to, from)| (to - from).abs() > LEAST_MOVE * from.abs() || to == from);
            if change > CHANGE && is_seen {
                return moved;
            }
        }
        state.to_vec()
    }
}

/// A number between -1 and 1 that differs for every pair (splitmix64).
fn symmetric(seed: u64, place: u64) -> f64 {
    let mut bits = (seed << 32 | place)
        .wrapping_add(1)
        .wrapping_mul(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^= bits >> 31;
    (bits >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

impl Dependence {
    /// `began` are the largest residuals that searches began with.
    fn diagnostic(&self, model: &Model, began: &[f64]) -> Diagnostic {
        let last = self
            .parts
            .iter()
            .rposition(|part| *part != 0.0)
            .unwrap_or(0);
        let most = self
            .parts
            .iter()
            .fold(0.0_f64, |most, part| most.max(part.abs()));
        let own = &model.constraints[last];
        let others = (0..last).filter(|k| self.parts[*k].abs() > TAKES_PART * most);
        let others: Vec<&Constraint> = others.map(|k| &model.constraints[k]).collect();
        let names: Vec<String> = others
            .iter()
            .map(|other| format!("`{}`", other.name))
            .collect();
        let apart = self.apart(last, began);
        let (message, label, help) = words(own, &names.join(", "), apart);
        let found = Diagnostic::error(message)
            .at(own.zero.span, label)
            .help(help);
        let others = others.into_iter();
        others.fold(found, |found, other| {
            found.also(other.zero.span, "depends on it")
        })
    }

    /// The residual of the combination in the unit of the constraint `last`, if the constraints contradict each
    /// other: it is then not made of residuals that vanish.
    fn apart(&self, last: usize, began: &[f64]) -> Option<f64> {
        let part = |k: usize, residual: f64| self.factors[k] / self.factors[last] * residual;
        let all = 0..=last;
        let apart: f64 = all.clone().map(|k| part(k, self.residuals[k])).sum();
        let most = |residuals: &[f64]| {
            let parts = all.clone().map(|k| part(k, residuals[k]).abs());
            parts.fold(0.0, f64::max)
        };
        let largest = most(&self.residuals);
        (apart.abs() > CONTRADICTION * largest && largest > KEPT * most(began)).then_some(apart)
    }
}

/// Message, label and help.
fn words(
    own: &Constraint,
    others: &str,
    apart: Option<f64>,
) -> (String, &'static str, &'static str) {
    let (name, unit) = (&own.name, &own.unit);
    match (others.is_empty(), apart) {
        (true, Some(residual)) => (
            format!("the constraint `{name}` stays at {residual:.3e} {unit}"),
            "is never zero near the initial state",
            "correct it, or start nearer to where it holds",
        ),
        (true, None) => (
            format!(
                "the constraint `{name}` holds nothing: its derivatives are all 0 where it holds"
            ),
            "does not change its sign",
            "write it so that it changes its sign where it holds, or leave it out",
        ),
        (false, Some(residual)) => (
            format!(
                "the constraint `{name}` contradicts {others}: it holds what they hold, and asks for {:.3e} \
                 {unit} more",
                residual.abs()
            ),
            "contradicts the others",
            "leave one of them out, or correct it",
        ),
        (false, None) => (
            format!(
                "the constraint `{name}` is redundant: wherever the constraints hold, its derivative is a \
                 combination of the derivatives of {others}"
            ),
            "holds nothing that the others do not hold",
            "leave one of them out; how they share a force does not follow from the equations",
        ),
    }
}
