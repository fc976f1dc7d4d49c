//! Readings of the channels at a known initial state. They determine the period in which a wrapped column starts.

use eomgen_model_spec::evaluate::evaluate;
use eomgen_model_spec::model::{Expr, ExprKind, Model};

use crate::dataset::{Channel, Dataset, Initial, Quantity};

/// Returns the reading of each channel at the start of a file, in SI. `None` if the initial state is unknown, or if the
/// quantity depends on more than parameters and state.
pub(crate) fn compute_initial_readings(dataset: &Dataset, model: &Model) -> Vec<Option<f64>> {
    let start = KnownStart::new(&dataset.initial, model);
    let reading = |channel: &Channel| {
        let value = start.as_ref()?.evaluate_quantity(channel.quantity)?;
        let mean = |prior: Option<crate::dataset::PriorInSi>, usual: f64| {
            prior.and_then(|prior| prior.mean).unwrap_or(usual)
        };
        let (gain, bias) = (
            mean(channel.priors.gain, 1.0),
            mean(channel.priors.bias, 0.0),
        );
        Some(gain * value + bias).filter(|reading| reading.is_finite())
    };
    dataset.channels.iter().map(reading).collect()
}

struct KnownStart<'m> {
    model: &'m Model,
    parameters: Vec<f64>,
    /// Coordinates and modes, their rates, and the first-order states.
    state: Vec<f64>,
    /// Number of coordinates and modes.
    degrees: usize,
}

impl<'m> KnownStart<'m> {
    fn new(initial: &Initial, model: &'m Model) -> Option<Self> {
        let orders: Vec<usize> = model.fields.iter().map(|field| field.order).collect();
        let mut state = model.initial_state(&orders).ok()?;
        match initial {
            Initial::Estimate => return None,
            Initial::Rest => {}
            Initial::Values(values) => {
                for (name, slot) in model.state_names(&orders).iter().zip(&mut state) {
                    if let Some((_, value)) = values.iter().find(|(given, _)| given == name) {
                        *slot = *value;
                    }
                }
            }
        }
        Some(Self {
            model,
            parameters: model.parameter_values().ok()?,
            state,
            degrees: model.coordinates.len() + orders.iter().sum::<usize>(),
        })
    }

    fn evaluate_quantity(&self, quantity: Quantity) -> Option<f64> {
        match quantity {
            Quantity::Coordinate(place) => self.state.get(place).copied(),
            Quantity::Rate(place) => self.state.get(self.degrees + place).copied(),
            Quantity::State(place) => self.state.get(2 * self.degrees + place).copied(),
            Quantity::Observable(place) => {
                let value = self.insert_state(&self.model.observables[place].value)?;
                Some(evaluate(&value, &self.parameters))
            }
            Quantity::Acceleration(_) | Quantity::ObservedRate(_) | Quantity::Input(_) => None,
        }
    }

    /// Replaces the state in an expression by its values; `None` if other variables remain.
    fn insert_state(&self, expr: &Expr) -> Option<Expr> {
        let part = |expr: &Expr| self.insert_state(expr);
        let number = |quantity: Quantity| self.evaluate_quantity(quantity).map(ExprKind::Number);
        let kind = match &expr.kind {
            kind @ (ExprKind::Number(_) | ExprKind::Pi | ExprKind::Parameter(_)) => kind.clone(),
            ExprKind::Coordinate(id) => number(Quantity::Coordinate(id.index()))?,
            ExprKind::State(id) => number(Quantity::State(id.index()))?,
            ExprKind::Dot(inner) => match &inner.kind {
                ExprKind::Coordinate(id) => number(Quantity::Rate(id.index()))?,
                _ => return None,
            },
            ExprKind::Definition(id) => return part(&self.model.definitions[*id].value),
            ExprKind::Negate(operand) => ExprKind::Negate(Box::new(part(operand)?)),
            ExprKind::Binary(operator, left, right) => {
                ExprKind::Binary(*operator, Box::new(part(left)?), Box::new(part(right)?))
            }
            ExprKind::Call(function, arguments) => ExprKind::Call(
                *function,
                arguments.iter().map(part).collect::<Option<_>>()?,
            ),
            _ => return None,
        };
        Some(Expr {
            kind,
            ..expr.clone()
        })
    }
}
