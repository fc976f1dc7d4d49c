//! Parameters, coordinates, inputs and first-order states.

use super::Builder;
use crate::diagnostic::Diagnostic;
use crate::dimension::Dimension;
use crate::expression::Scope;
use crate::ids::InputId;
use crate::model::{Coordinate, Input, Parameter, ParameterValue, Range, State, Uncertainty};
use crate::names::Symbol;
use crate::quantity::{Number, Quantity};
use crate::raw::{RawCoordinate, RawInput, RawParameter, RawRange, RawState, RawUncertainty};
use crate::unit::Unit;

impl Builder {
    pub(super) fn build_parameter(&mut self, raw: RawParameter) -> Option<Parameter> {
        let unit = self.parse_unit(raw.unit);
        let value = match &raw.value {
            Quantity::Number(number) => {
                let unit = unit.as_ref()?;
                ParameterValue::Number(self.convert_to_si(unit, *number)?)
            }
            Quantity::Expression(_) | Quantity::Vector(..) | Quantity::Expansion(_) => {
                ParameterValue::Expression(self.resolve_expression(&raw.value, Scope::Parameters)?)
            }
        };
        let unit = unit?;
        let mut bound = |number: Option<Number>| number.and_then(|n| self.convert_to_si(&unit, n));
        let (min, max) = (bound(raw.min), bound(raw.max));
        if let (Some(low), Some(high), Some(number)) = (min, max, raw.max)
            && low > high
        {
            self.found.push(
                Diagnostic::error(format!("`{}` has no admissible value", raw.name.text))
                    .with_span(number.span, "max is less than min"),
            );
        }
        let uncertainty = raw
            .uncertainty
            .and_then(|raw| self.build_uncertainty(&unit, &raw));
        Some(Parameter {
            name: raw.name.text,
            unit,
            doc: raw.doc,
            origin: raw.origin,
            value,
            min,
            max,
            uncertainty,
            span: raw.name.span,
        })
    }

    fn build_uncertainty(&mut self, unit: &Unit, raw: &RawUncertainty) -> Option<Uncertainty> {
        Some(match *raw {
            RawUncertainty::Relative(part) => Uncertainty::Relative(part.value),
            RawUncertainty::StandardDeviation(sd) => {
                Uncertainty::StandardDeviation(self.convert_to_si(unit, sd)?)
            }
            RawUncertainty::Between([low, high]) => Uncertainty::Between([
                self.convert_to_si(unit, low)?,
                self.convert_to_si(unit, high)?,
            ]),
        })
    }

    fn convert_to_si(&mut self, unit: &Unit, number: Number) -> Option<f64> {
        let value = unit.to_si(number.value);
        let size = match value {
            _ if !value.is_finite() => "large",
            0.0 if number.value != 0.0 => "small",
            _ => return Some(value),
        };
        let message = format!("{:?} {unit} is too {size} in SI units", number.value);
        self.found
            .push(Diagnostic::error(message).with_span(number.span, "here"));
        None
    }

    pub(super) fn build_coordinate(&mut self, raw: RawCoordinate) -> Option<Coordinate> {
        let unit = self.parse_coherent_unit(raw.unit);
        let mut initial = |quantity: Option<Quantity>| match quantity {
            Some(quantity) => self
                .resolve_expression(&quantity, Scope::Parameters)
                .map(Some),
            None => Some(None),
        };
        let (value, rate) = (initial(raw.initial), initial(raw.initial_rate));
        let range = self.build_range(raw.range);
        Some(Coordinate {
            name: raw.name.text,
            unit: unit?,
            doc: raw.doc,
            initial: value?,
            initial_rate: rate?,
            range: range?,
            span: raw.name.span,
        })
    }

    /// Builds a range, `Some(None)` if absent, `None` after an error.
    fn build_range(&mut self, raw: Option<RawRange>) -> Option<Option<Range>> {
        let Some(raw) = raw else {
            return Some(None);
        };
        let low = self.resolve_expression(&raw.low, Scope::Parameters);
        let high = self.resolve_expression(&raw.high, Scope::Parameters);
        Some(Some(Range {
            low: low?,
            high: high?,
            span: raw.span,
        }))
    }

    pub(super) fn build_input(&mut self, raw: RawInput) -> Option<Input> {
        let known = |name: &str| match self.names.get(name) {
            Some(Symbol::Input(input)) => Some(input),
            _ => None,
        };
        let own = known(&raw.name.text);
        let before = own.and_then(|own| own.index().checked_sub(1));
        let rate_of = before.filter(|_| raw.rate_order > 0).map(InputId::new);
        let rate = own.and_then(|own| self.names.input_rate(own));
        let unit = match raw.rate_order {
            // An error in the unit is reported for the input, not for its rates.
            0 => self.parse_coherent_unit(raw.unit)?,
            order => per_seconds(&Unit::parse(&raw.unit?.text).ok()?, order)?,
        };
        Some(Input {
            unit,
            rate,
            rate_of,
            range: self.build_range(raw.range)?,
            name: raw.name.text,
            doc: raw.doc,
            span: raw.name.span,
        })
    }

    pub(super) fn build_state(&mut self, raw: RawState) -> Option<State> {
        let unit = self.parse_coherent_unit(raw.unit);
        let rate = self.resolve_expression(&raw.rate, Scope::Motion);
        let initial = match raw.initial {
            Some(quantity) => self
                .resolve_expression(&quantity, Scope::Parameters)
                .map(Some),
            None => Some(None),
        };
        let range = self.build_range(raw.range);
        Some(State {
            name: raw.name.text,
            unit: unit?,
            doc: raw.doc,
            rate: rate?,
            initial: initial?,
            range: range?,
            span: raw.name.span,
        })
    }
}

/// Returns a unit per s or per s^2; `None` if an exponent overflows.
fn per_seconds(unit: &Unit, order: u8) -> Option<Unit> {
    let mut dimension = unit.dimension;
    for _ in 0..order {
        dimension = dimension.divide(Dimension::TIME)?;
    }
    let text = match order {
        1 => format!("{unit}/s"),
        _ => format!("{unit}/s^{order}"),
    };
    let mut unit = Unit::coherent(dimension);
    unit.text = text;
    Some(unit)
}
