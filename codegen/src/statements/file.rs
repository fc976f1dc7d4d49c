//! Program, names and coefficients that the stages of a file share.

use std::collections::HashMap;
use std::rc::Rc;

use super::body::{Access, Body};
use super::emit_error::EmitResult;
use super::names::{Names, Words};
use super::needed::RequiredFunctions;
use super::roots::collect_coefficients;
use super::sides::Switches;
use crate::program::content::Contents;
use crate::program::{Program, ValueId};

/// Program, names and coefficients that the stages of a file share.
pub struct File<'p> {
    /// Program of the file.
    pub program: &'p Program,
    /// Rules for names in the language of the file.
    pub words: &'static Words,
    /// Coefficients that the stages read, in the order of the program.
    pub fields: Vec<ValueId>,
    /// Names of the coefficients.
    pub field_names: HashMap<ValueId, String>,
    contents: Rc<Contents>,
}

impl<'p> File<'p> {
    /// Collects and names the coefficients of `program`.
    ///
    /// # Errors
    /// A name that is not an identifier in the language of `words`.
    pub fn new(program: &'p Program, words: &'static Words) -> EmitResult<Self> {
        let contents = Rc::new(Contents::new(program));
        let mut names = Names::new(program, words, &contents);
        let fields = collect_coefficients(program);
        let mut field_names = HashMap::new();
        for id in &fields {
            field_names.insert(*id, names.value_name(program, *id, "c")?);
        }
        Ok(Self {
            program,
            words,
            fields,
            field_names,
            contents,
        })
    }

    /// Returns the number of guards; each element of a vector counts.
    pub fn guard_count(&self) -> usize {
        self.program
            .guards
            .iter()
            .map(|guard| self.program.value(guard.value).extent.length())
            .sum()
    }

    /// Starts a stage that reads coefficients and computes `roots`.
    pub(super) fn body<'b>(
        &'b self,
        roots: &[ValueId],
        needed: &'b mut RequiredFunctions,
    ) -> EmitResult<Body<'b>> {
        self.body_in_regime(roots, needed, Switches::new())
    }

    /// Starts a stage in which the regime decides the branches of the values in `switches`.
    pub(super) fn body_in_regime<'b>(
        &'b self,
        roots: &[ValueId],
        needed: &'b mut RequiredFunctions,
        switches: Switches,
    ) -> EmitResult<Body<'b>> {
        let access = Access::Coefficients(&self.field_names);
        Body::new(self.program, self.names(), access, roots, needed, switches)
    }

    /// Returns the names of a new stage.
    pub(super) fn names(&self) -> Names {
        Names::new(self.program, self.words, &self.contents)
    }
}

/// Joins meaning, unit and origin of a quantity.
pub fn describe_quantity(text: &str, unit: &str, origin: &str) -> String {
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
