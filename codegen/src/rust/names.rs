//! Names of emitted variables and fields: the specification's where it has one, numbered
//! ones elsewhere, each used once.

use std::collections::{HashMap, HashSet};

use super::emit_error::EmitError;
use super::literals::identifier;
use crate::program::{Program, ValueId};

/// Names that emitted functions use for themselves: variables, helpers, constants, fields,
/// and what Rust's prelude gives a value of.
const TAKEN: [&str; 58] = [
    "t",
    "state",
    "inputs",
    "coefficients",
    "parameters",
    "rates",
    "values",
    "total",
    "i",
    "j",
    "k",
    "row",
    "column",
    "rest",
    "sum",
    "sum_of_few",
    "paired",
    "pow",
    "exp_minus_one",
    "cholesky",
    "cholesky_solve",
    "cholesky_solve_matrix",
    "converted",
    "converted_matrix",
    "read_array",
    "read_matrix",
    "accelerations",
    "direction",
    "input_direction",
    "weights",
    "product",
    "input_product",
    "pattern",
    "INPUTS",
    "INPUT_NAMES",
    "PARAMETERS",
    "PARAMETER_NAMES",
    "guards",
    "deadzone_on_side",
    "touching",
    "either",
    "chosen",
    "positive",
    "pivot_reciprocal",
    "positive_definite",
    "ORDERS",
    "DEGREES_OF_FREEDOM",
    "STATES",
    "STATE_NAMES",
    "OBSERVABLES",
    "OBSERVABLE_NAMES",
    "GUARDS",
    "SPECIFICATION_SHA256",
    "GENERATOR_VERSION",
    "Some",
    "None",
    "Ok",
    "Err",
];

/// A supply of names, each handed out once.
pub struct Names {
    used: HashSet<String>,
    given: HashMap<ValueId, String>,
    next: HashMap<&'static str, usize>,
}

impl Names {
    /// A supply that avoids the names emitted functions use for themselves, those of the
    /// tables and of the flags `positive_1` and so on, one per pivot.
    pub fn new(program: &Program) -> Self {
        let tables = program.tables.iter().map(|table| table.name.clone());
        let flags = (1..=program.pivots.len()).map(|number| format!("positive_{number}"));
        let patterns = program.outputs.jacobians.iter().flat_map(|jacobian| {
            let name = jacobian.name.to_uppercase();
            [format!("{name}_NONZEROS"), name]
        });
        let taken = TAKEN.iter().map(|name| (*name).to_owned());
        Self {
            used: taken.chain(tables).chain(flags).chain(patterns).collect(),
            given: HashMap::new(),
            next: HashMap::new(),
        }
    }

    /// The name of a value: the preferred one if it is free, else numbered after `stem`.
    pub fn of(
        &mut self,
        program: &Program,
        id: ValueId,
        stem: &'static str,
    ) -> Result<String, EmitError> {
        if let Some(known) = self.given.get(&id) {
            return Ok(known.clone());
        }
        let preferred = program.value(id).name.clone();
        let name = match preferred {
            Some(name) if !self.used.contains(&name) => name,
            _ => self.numbered(stem),
        };
        self.used.insert(name.clone());
        let name = identifier(&name)?.to_owned();
        self.given.insert(id, name.clone());
        Ok(name)
    }

    /// Gives a value this very name, or a numbered one if it is taken.
    pub fn assign(
        &mut self,
        id: ValueId,
        name: &str,
        stem: &'static str,
    ) -> Result<String, EmitError> {
        let name = if self.used.contains(name) {
            self.numbered(stem)
        } else {
            name.to_owned()
        };
        self.used.insert(name.clone());
        let name = identifier(&name)?.to_owned();
        self.given.insert(id, name.clone());
        Ok(name)
    }

    fn numbered(&mut self, stem: &'static str) -> String {
        let next = self.next.entry(stem).or_insert(0);
        loop {
            *next += 1;
            let name = format!("{stem}_{next}");
            if !self.used.contains(&name) {
                return name;
            }
        }
    }
}
