//! Named quantities of a program, in SI units.

use eomgen_model_spec::model::{Model, ParameterValue};
use eomgen_model_spec::unit::Unit;

use crate::program::{ProgramParameter, Quantity};

pub(super) fn quantity(name: &str, unit: &str, doc: &str) -> Quantity {
    Quantity {
        name: name.to_owned(),
        unit: unit.to_owned(),
        doc: doc.to_owned(),
    }
}

/// Returns the unit as written in the specification if it is coherent, else its SI equivalent.
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
