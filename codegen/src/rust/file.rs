//! What the parts of an emitted file are written from.

use std::collections::HashMap;

use super::body::{Access, Body};
use super::emit_error::Emitted;
use super::functions::Needed;
use super::names::Names;
use super::roots::coefficient_values;
use crate::program::{Output, Program, ValueId};

/// What a file is written from.
pub(super) struct File<'p> {
    pub(super) program: &'p Program,
    /// Prepared values that the stages read, in the order of the program, by name.
    pub(super) fields: Vec<ValueId>,
    pub(super) field_names: HashMap<ValueId, String>,
}

impl<'p> File<'p> {
    pub(super) fn new(program: &'p Program) -> Emitted<Self> {
        let mut names = Names::new(program);
        let fields = coefficient_values(program);
        let mut field_names = HashMap::new();
        for id in &fields {
            field_names.insert(*id, names.of(program, *id, "c")?);
        }
        Ok(Self {
            program,
            fields,
            field_names,
        })
    }

    pub(super) fn guard_count(&self) -> usize {
        self.program
            .guards
            .iter()
            .map(|guard| self.program.value(guard.value).extent.length())
            .sum()
    }

    /// Whether every function is written a second time, for lanes.
    pub(super) fn for_lanes(&self) -> bool {
        self.program.outputs.kinds.contains(&Output::Lanes)
    }

    /// What the names of functions that emitted functions call begin with.
    pub(super) fn inlined(&self) -> &'static str {
        if self.for_lanes() { "inlined_" } else { "" }
    }
    /// The type of the parameters, of the inputs or of the coefficients: generic if a number
    /// stands in it.
    pub(super) fn generic(&self, name: &str) -> String {
        let numbers = match name {
            "Parameters" => self.program.parameters.len(),
            "Inputs" => self.program.inputs.len(),
            _ => self.fields.len(),
        };
        format!("{name}{}", if numbers > 0 { "<T>" } else { "" })
    }

    /// A stage that reads coefficients and computes `roots`.
    pub(super) fn body<'b>(
        &'b self,
        roots: &[ValueId],
        needed: &'b mut Needed,
    ) -> Emitted<Body<'b>> {
        let access = Access::Coefficients(&self.field_names);
        Body::new(self.program, access, roots, needed)
    }
}

/// Meaning, unit and origin of a quantity.
pub(super) fn quantity_line(text: &str, unit: &str, origin: &str) -> String {
    let mut line = if text.is_empty() {
        String::new()
    } else {
        format!("{text} ")
    };
    line.push_str(&format!("[{unit}]"));
    if !origin.is_empty() {
        line.push_str(&format!(" ({origin})"));
    }
    line
}
