//! Time derivatives of observables as additional observables, for sensors that measure rates and accelerations of
//! points. They are derived only if requested, because a specification contains no accelerations.

use crate::dimension::Dimension;
use crate::ids::DefinitionId;
use crate::model::{Expr, ExprKind, Model, Observable, ObservedRate};
use crate::unit::Unit;

impl ObservedRate {
    /// Returns the name of the observable with the suffix `_dot` or `_ddot`.
    pub fn name(self, model: &Model) -> String {
        let ending = if self.times == 1 { "_dot" } else { "_ddot" };
        format!("{}{ending}", model.observables[self.observable].name)
    }

    /// Returns the SI unit.
    pub fn unit(self, model: &Model) -> Unit {
        let unit = &model.observables[self.observable].unit;
        let over = if self.times == 1 { "s" } else { "s^2" };
        let rate = (0..self.times).try_fold(unit.dimension, |dimension, _| {
            dimension.divide(Dimension::TIME)
        });
        match Unit::parse(&format!("{}/{over}", unit.text)) {
            Ok(unit) if Some(unit.dimension) == rate => unit,
            _ => rate.map_or_else(|| unit.clone(), Unit::coherent),
        }
    }

    /// Returns the rate or acceleration with this name, if the name without its suffix is an observable.
    pub fn from_name(model: &Model, name: &str) -> Option<Self> {
        let of = |name: &str| model.observables.iter().position(|o| o.name == name);
        let within =
            |before: &str, after: &str| of(name.strip_prefix(before)?.strip_suffix(after)?);
        let found = |observable: usize, times: u8| Self { observable, times };
        if let Some(observable) = within("", "_ddot").or_else(|| within("dot(dot(", "))")) {
            return Some(found(observable, 2));
        }
        let observable = within("", "_dot").or_else(|| within("dot(", ")"))?;
        Some(found(observable, 1))
    }
}

impl Model {
    /// Adds a time derivative of an observable to the observables, if absent. Returns its index.
    pub fn observe_rate(&mut self, rate: ObservedRate) -> usize {
        let mut known = self.observables.iter();
        if let Some(place) = known.position(|known| known.rate_of == Some(rate)) {
            return place;
        }
        let of = &self.observables[rate.observable];
        let (value, span) = (of.value.clone(), of.span);
        let mut name = rate.name(self);
        while self.observables.iter().any(|known| known.name == name) {
            name.push('_');
        }
        self.observables.push(Observable {
            unit: rate.unit(self),
            doc: format!(
                "time derivative of {}",
                self.observables[rate.observable].name
            ),
            rate_of: Some(rate),
            value,
            span,
            name,
        });
        self.observables.len() - 1
    }

    /// Returns true if an expression contains a rate, directly or through definitions.
    pub fn contains_rate(&self, expr: &Expr) -> bool {
        let mut holds = false;
        let mut definitions: Vec<DefinitionId> = Vec::new();
        expr.visit(&mut |part| match part.kind {
            ExprKind::Dot(_) => holds = true,
            ExprKind::Definition(definition) => definitions.push(definition),
            _ => {}
        });
        // The recursion terminates, because definitions have no cycle.
        let mut inner = definitions.iter();
        holds || inner.any(|definition| self.contains_rate(&self.definitions[*definition].value))
    }
}
