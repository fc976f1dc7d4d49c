//! Unique names of emitted variables and fields: those of the specification if possible, else names by content.

use std::collections::{HashMap, HashSet};
use std::rc::Rc;

use super::emit_error::EmitError;
use crate::program::content::Contents;
use crate::program::{Program, ValueId};

/// Rules for names in an emitted language.
#[derive(Debug)]
pub struct Words {
    /// Name of the language, for messages.
    pub language: &'static str,
    /// Keywords of the language, separated by spaces.
    pub keywords: &'static str,
    /// Names reserved by the emitted functions, separated by spaces.
    pub taken: &'static str,
    /// True if the names of functions and constants begin with the model's name and `_`.
    pub prefixed: bool,
}

impl Words {
    /// Returns `name` if it is an identifier.
    ///
    /// # Errors
    /// The name is not an identifier of the language.
    pub fn identifier<'n>(&self, name: &'n str) -> Result<&'n str, EmitError> {
        let mut letters = name.bytes();
        let starts = letters
            .next()
            .is_some_and(|b| b.is_ascii_alphabetic() || b == b'_');
        if starts
            && letters.all(|b| b.is_ascii_alphanumeric() || b == b'_')
            && self.keywords.split(' ').all(|keyword| keyword != name)
        {
            Ok(name)
        } else {
            Err(EmitError::Name {
                name: name.to_owned(),
                language: self.language,
            })
        }
    }
}

/// Names assigned to values; no name is assigned twice.
pub struct Names {
    words: &'static Words,
    prefix: Option<String>,
    used: HashSet<String>,
    given: HashMap<ValueId, String>,
    contents: Rc<Contents>,
}

impl Names {
    /// Reserves the names used by emitted functions, by tables, by Jacobians, and by the flags `positive_1`
    /// and so on, one for each pivot.
    pub fn new(program: &Program, words: &'static Words, contents: &Rc<Contents>) -> Self {
        let tables = program.tables.iter().map(|table| table.name.clone());
        let flags = (1..=program.pivots.len()).map(|number| format!("positive_{number}"));
        let patterns = program.outputs.jacobians.iter().flat_map(|jacobian| {
            let name = jacobian.name.to_uppercase();
            [format!("{name}_NONZEROS"), name]
        });
        let taken = words.taken.split(' ').map(str::to_owned);
        Self {
            words,
            prefix: words.prefixed.then(|| format!("{}_", program.name)),
            used: taken.chain(tables).chain(flags).chain(patterns).collect(),
            given: HashMap::new(),
            contents: Rc::clone(contents),
        }
    }

    /// Returns the name of a value: its preferred name if that is free, else `stem` with its content.
    pub fn value_name(
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
            Some(name) if self.is_free(&name) => name,
            _ => self.name_by_content(program, id, stem)?,
        };
        self.used.insert(name.clone());
        let name = self.identifier(&name)?.to_owned();
        self.given.insert(id, name.clone());
        Ok(name)
    }

    /// Assigns `name` to a value, or `stem` with its content if `name` is taken.
    pub fn assign(
        &mut self,
        program: &Program,
        id: ValueId,
        name: &str,
        stem: &'static str,
    ) -> Result<String, EmitError> {
        let name = if self.is_free(name) {
            name.to_owned()
        } else {
            self.name_by_content(program, id, stem)?
        };
        self.used.insert(name.clone());
        let name = self.identifier(&name)?.to_owned();
        self.given.insert(id, name.clone());
        Ok(name)
    }

    /// Returns `name` if it is an identifier of the emitted language.
    pub fn identifier<'n>(&self, name: &'n str) -> Result<&'n str, EmitError> {
        self.words.identifier(name)
    }

    fn is_free(&self, name: &str) -> bool {
        let prefixed = |prefix: &String| name.starts_with(prefix.as_str());
        !self.used.contains(name) && !self.prefix.as_ref().is_some_and(prefixed)
    }

    fn name_by_content(
        &self,
        program: &Program,
        id: ValueId,
        stem: &str,
    ) -> Result<String, EmitError> {
        // All names of a model `s` begin with `s_` in C.
        let is_prefix = |stem: &str| self.prefix.as_deref() == Some(&format!("{stem}_"));
        let stem = if is_prefix(stem) { "v" } else { stem };
        let names = self.contents.names(program, id);
        let mut names = names.map(|name| format!("{stem}_{name}"));
        let free = names.find(|name| self.is_free(name));
        free.ok_or_else(|| EmitError::Value(format!("value {} has no free name", id.index())))
    }
}
