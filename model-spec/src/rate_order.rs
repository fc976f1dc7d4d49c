//! Sorts definitions and rates of states for expansion; `dot(z)` expands to the rate of the state z. Reports cycles:
//! a rate that depends on itself would be an implicit equation.

use std::collections::BTreeMap;

use crate::ids::{DefinitionId, StateId};
use crate::model::{Expr, ExprKind, Model};
use crate::order::{Reference, sort_by_references};
use crate::span::Span;

/// Expression that is expanded at its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expanded {
    Definition(DefinitionId),
    /// Rate of a state, for `dot(z)`.
    Rate(StateId),
    /// Rates of all states in a definition, for `dot` of that definition.
    RatesWithin(DefinitionId),
}

/// Returns definitions and rates in dependency order.
///
/// # Errors
/// The rates have a cycle. The error contains its entries, starting with the rate of a state, each with the position
/// of the reference to the next entry.
pub fn rate_order(model: &Model) -> Result<Vec<Expanded>, Vec<(Expanded, Span)>> {
    let sizes = Sizes {
        definitions: model.definitions.len(),
        states: model.states.len(),
    };
    let held = |expr: &Expr| references(expr, sizes);
    let values = model.definitions.iter().map(|known| held(&known.value));
    let rates = model.states.iter().map(|state| held(&state.rate));
    let within = model.definitions.iter().map(|known| {
        let mut found = BTreeMap::new();
        collect_rates(&known.value, sizes, &mut found);
        found.into_iter().collect()
    });
    let all: Vec<Vec<Reference>> = values.chain(rates).chain(within).collect();
    match sort_by_references(&all) {
        Ok(sorted) => Ok(sorted
            .into_iter()
            .map(|place| sizes.entry_at(place))
            .collect()),
        Err(circle) => {
            let mut circle: Vec<_> = circle
                .into_iter()
                .map(|(place, span)| (sizes.entry_at(place), span))
                .collect();
            let is_rate = |(known, _): &(Expanded, Span)| matches!(known, Expanded::Rate(_));
            let first = circle.iter().position(is_rate).unwrap_or(0);
            circle.rotate_left(first);
            Err(circle)
        }
    }
}

/// Sizes of the three parts of a list: values of definitions, rates of states, rates of all states in a definition.
#[derive(Clone, Copy)]
struct Sizes {
    definitions: usize,
    states: usize,
}

impl Sizes {
    fn rate(self, state: StateId) -> usize {
        self.definitions + state.index()
    }

    fn within(self, definition: DefinitionId) -> usize {
        self.definitions + self.states + definition.index()
    }

    fn entry_at(self, place: usize) -> Expanded {
        match place.checked_sub(self.definitions) {
            None => Expanded::Definition(DefinitionId::new(place)),
            Some(after) => match after.checked_sub(self.states) {
                None => Expanded::Rate(StateId::new(after)),
                Some(last) => Expanded::RatesWithin(DefinitionId::new(last)),
            },
        }
    }
}

/// Returns the references of an expression, each with its first position.
fn references(expr: &Expr, sizes: Sizes) -> Vec<Reference> {
    let mut found = BTreeMap::new();
    expr.visit(&mut |part| match &part.kind {
        ExprKind::Definition(index) => {
            found.entry(index.index()).or_insert(part.span);
        }
        ExprKind::Dot(operand) => collect_rates(operand, sizes, &mut found),
        _ => {}
    });
    found.into_iter().collect()
}

fn collect_rates(expr: &Expr, sizes: Sizes, found: &mut BTreeMap<usize, Span>) {
    expr.visit(&mut |part| {
        let place = match part.kind {
            ExprKind::State(state) => sizes.rate(state),
            ExprKind::Definition(definition) => sizes.within(definition),
            _ => return,
        };
        found.entry(place).or_insert(part.span);
    });
}
