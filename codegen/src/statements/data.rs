//! Constant data of an emitted file for its callers: units, initial state and ranges, in the order of the names.

use crate::program::{Program, Quantity};

/// Constant array of an emitted file.
pub struct DataArray {
    /// Name, in lower case.
    pub name: &'static str,
    /// Name of the constant with its length.
    pub length: &'static str,
    /// Description.
    pub doc: &'static str,
    /// Elements.
    pub elements: DataElements,
}

/// Elements of a constant array.
pub enum DataElements {
    /// Texts.
    Texts(Vec<String>),
    /// Numbers; ends of ranges can be infinite.
    Numbers(Vec<f64>),
}

/// Returns all arrays.
pub fn list_data_arrays(program: &Program) -> Vec<DataArray> {
    let domain = &program.domain;
    let units =
        |quantities: Vec<&Quantity>| quantities.into_iter().map(|of| of.unit.clone()).collect();
    let ends =
        |ranges: &[[f64; 2]], end: usize| ranges.iter().map(|range| range[end]).collect::<Vec<_>>();
    let texts = [
        (
            "state_units",
            "STATES",
            "SI units of the states.",
            domain.state_units.clone(),
        ),
        (
            "input_units",
            "INPUTS",
            "SI units of the inputs.",
            units(program.inputs.iter().collect()),
        ),
        (
            "parameter_units",
            "PARAMETERS",
            "SI units of the parameters.",
            units(program.parameters.iter().map(|p| &p.quantity).collect()),
        ),
        (
            "observable_units",
            "OBSERVABLES",
            "SI units of the observables.",
            units(program.observables.iter().collect()),
        ),
    ];
    let numbers = [
        (
            "initial_state",
            "STATES",
            "Initial state of the specification, at its parameters.",
            domain.initial_state.clone(),
        ),
        (
            "state_lower",
            "STATES",
            "Lower ends of the ranges of the states, -infinity if the specification gives none.",
            ends(&domain.state_ranges, 0),
        ),
        (
            "state_upper",
            "STATES",
            "Upper ends of the ranges of the states, infinity if the specification gives none.",
            ends(&domain.state_ranges, 1),
        ),
        (
            "input_lower",
            "INPUTS",
            "Lower ends of the ranges of the inputs, -infinity if the specification gives none.",
            ends(&domain.input_ranges, 0),
        ),
        (
            "input_upper",
            "INPUTS",
            "Upper ends of the ranges of the inputs, infinity if the specification gives none.",
            ends(&domain.input_ranges, 1),
        ),
    ];
    let texts = texts.map(|(name, length, doc, texts)| DataArray {
        name,
        length,
        doc,
        elements: DataElements::Texts(texts),
    });
    let numbers = numbers.map(|(name, length, doc, numbers)| DataArray {
        name,
        length,
        doc,
        elements: DataElements::Numbers(numbers),
    });
    texts.into_iter().chain(numbers).collect()
}
