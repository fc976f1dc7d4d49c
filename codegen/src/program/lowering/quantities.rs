//! Named quantities of a program, in SI units.

use eomgen_model_spec::model::{Model, ParameterValue, Range};
use eomgen_model_spec::unit::Unit;

use crate::program::{Domain, ProgramParameter, Quantity};

/// Range of a quantity without declared bounds.
const UNBOUNDED: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

pub(super) fn quantity(name: &str, unit: &str, doc: &str) -> Quantity {
    Quantity {
        name: name.to_owned(),
        unit: unit.to_owned(),
        doc: doc.to_owned(),
    }
}

/// Returns the unit as written in the specification if it is a coherent SI unit, else the equivalent SI unit.
pub(super) fn si_unit(unit: &Unit) -> String {
    if unit.is_coherent() {
        unit.text.clone()
    } else {
        unit.dimension.to_string()
    }
}

pub(super) fn program_parameters(model: &Model, values: &[f64]) -> Vec<ProgramParameter> {
    model
        .parameters
        .iter()
        .zip(values)
        .filter(|(parameter, _)| matches!(parameter.value, ParameterValue::Number(_)))
        .map(|(parameter, value)| ProgramParameter {
            quantity: quantity(&parameter.name, &si_unit(&parameter.unit), &parameter.doc),
            origin: parameter.origin.clone(),
            value: *value,
        })
        .collect()
}

pub(super) fn program_observables(model: &Model) -> Vec<Quantity> {
    let mut all: Vec<Quantity> = model
        .observables
        .iter()
        .map(|o| quantity(&o.name, &si_unit(&o.unit), &o.doc))
        .collect();
    all.push(quantity("energy", "J", "kinetic plus potential energy"));
    all.push(quantity(
        "power",
        "W",
        "power of all non-conservative forces: the rate of the energy",
    ));
    all
}

/// Returns units, initial state and ranges for these values of all parameters. Modes and rates have no range.
pub(super) fn domain(model: &Model, orders: &[usize], parameter_values: &[f64]) -> Domain {
    let ends = |range: &Option<Range>| {
        range.as_ref().map_or(UNBOUNDED, |range| {
            let (low, high) = range.ends(parameter_values);
            [low, high]
        })
    };
    let units = model.state_units(orders);
    let states = units.len();
    let mut state_ranges = vec![UNBOUNDED; states];
    let coordinates = state_ranges.iter_mut().zip(&model.coordinates);
    coordinates.for_each(|(range, coordinate)| *range = ends(&coordinate.range));
    let first_order = state_ranges.iter_mut().rev().zip(model.states.iter().rev());
    first_order.for_each(|(range, state)| *range = ends(&state.range));
    Domain {
        state_units: units.iter().map(si_unit).collect(),
        // Initial values that are not finite are errors of the derivation.
        initial_state: model.initial_state(orders).unwrap_or(vec![0.0; states]),
        state_ranges,
        input_ranges: model
            .inputs
            .iter()
            .map(|input| ends(&input.range))
            .collect(),
    }
}
