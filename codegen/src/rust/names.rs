//! Names of emitted variables and fields: the specification's where it has one, numbered
//! ones elsewhere, each used once.

use std::collections::{HashMap, HashSet};

use proc_macro2::Ident;

use super::EmitError;
use super::literals::identifier;
use crate::program::{Program, ValueId};

/// Names that emitted functions use for themselves.
const TAKEN: [&str; 14] = [
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
];

/// A supply of names, each handed out once.
pub struct Names {
    used: HashSet<String>,
    given: HashMap<ValueId, Ident>,
    next: HashMap<&'static str, usize>,
}

impl Names {
    /// A supply that avoids the names emitted functions use for themselves.
    pub fn new() -> Self {
        Self {
            used: TAKEN.iter().map(|name| (*name).to_owned()).collect(),
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
    ) -> Result<Ident, EmitError> {
        if let Some(known) = self.given.get(&id) {
            return Ok(known.clone());
        }
        let preferred = program.value(id).name.clone();
        let name = match preferred {
            Some(name) if !self.used.contains(&name) => name,
            _ => self.numbered(stem),
        };
        self.used.insert(name.clone());
        let name = identifier(&name)?;
        self.given.insert(id, name.clone());
        Ok(name)
    }

    /// Gives a value this very name, or a numbered one if it is taken.
    pub fn assign(
        &mut self,
        id: ValueId,
        name: &str,
        stem: &'static str,
    ) -> Result<Ident, EmitError> {
        let name = if self.used.contains(name) {
            self.numbered(stem)
        } else {
            name.to_owned()
        };
        self.used.insert(name.clone());
        let name = identifier(&name)?;
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
