//! What the stages of a file are written from.

use std::collections::HashMap;

use super::body::{Access, Body};
use super::emit_error::Emitted;
use super::names::{Names, Words};
use super::needed::Needed;
use super::roots::coefficient_values;
use super::sides::Switches;
use crate::program::{Program, ValueId};

/// What the stages of a file are written from.
pub struct File<'p> {
    /// The program.
    pub program: &'p Program,
    /// Names that the language of the file leaves to the model.
    pub words: &'static Words,
    /// Prepared values that the stages read, in the order of the program.
    pub fields: Vec<ValueId>,
    /// Their names.
    pub field_names: HashMap<ValueId, String>,
}

impl<'p> File<'p> {
    /// A file of this program.
    ///
    /// # Errors
    /// If a name is none in the language of `words`.
    pub fn new(program: &'p Program, words: &'static Words) -> Emitted<Self> {
        let mut names = Names::new(program, words);
        let fields = coefficient_values(program);
        let mut field_names = HashMap::new();
        for id in &fields {
            field_names.insert(*id, names.of(program, *id, "c")?);
        }
        Ok(Self {
            program,
            words,
            fields,
            field_names,
        })
    }

    /// How many numbers the guards are.
    pub fn guard_count(&self) -> usize {
        self.program
            .guards
            .iter()
            .map(|guard| self.program.value(guard.value).extent.length())
            .sum()
    }

    /// A stage that reads coefficients and computes `roots`.
    pub(super) fn body<'b>(
        &'b self,
        roots: &[ValueId],
        needed: &'b mut Needed,
    ) -> Emitted<Body<'b>> {
        self.body_in_regime(roots, needed, Switches::new())
    }

    /// The same where a regime decides about these values.
    pub(super) fn body_in_regime<'b>(
        &'b self,
        roots: &[ValueId],
        needed: &'b mut Needed,
        switches: Switches,
    ) -> Emitted<Body<'b>> {
        let access = Access::Coefficients(&self.field_names);
        Body::new(self.program, self.words, access, roots, needed, switches)
    }
}

/// Meaning, unit and origin of a quantity.
pub fn quantity_line(text: &str, unit: &str, origin: &str) -> String {
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
