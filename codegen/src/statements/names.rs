//! Names of emitted variables and fields: the specification's where it has one, numbered
//! ones elsewhere, each used once.

use std::collections::{HashMap, HashSet};

use super::emit_error::EmitError;
use crate::program::{Program, ValueId};

/// Which names a language leaves to a model.
#[derive(Debug)]
pub struct Words {
    /// The language, for messages.
    pub language: &'static str,
    /// Words that are no names.
    pub keywords: &'static [&'static str],
    /// Names that emitted functions use for themselves.
    pub taken: &'static [&'static str],
    /// Whether the names of functions and constants begin with the model's and `_`.
    pub prefixed: bool,
}

impl Words {
    /// The name, if it is an identifier.
    ///
    /// # Errors
    /// If it is none.
    pub fn identifier<'n>(&self, name: &'n str) -> Result<&'n str, EmitError> {
        let mut letters = name.bytes();
        let starts = letters
            .next()
            .is_some_and(|b| b.is_ascii_alphabetic() || b == b'_');
        if starts
            && letters.all(|b| b.is_ascii_alphanumeric() || b == b'_')
            && !self.keywords.contains(&name)
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

/// A supply of names, each handed out once.
pub struct Names {
    words: &'static Words,
    prefix: Option<String>,
    used: HashSet<String>,
    given: HashMap<ValueId, String>,
    next: HashMap<&'static str, usize>,
}

impl Names {
    /// A supply that avoids the names emitted functions use for themselves, those of the
    /// tables and of the flags `positive_1` and so on, one per pivot.
    pub fn new(program: &Program, words: &'static Words) -> Self {
        let tables = program.tables.iter().map(|table| table.name.clone());
        let flags = (1..=program.pivots.len()).map(|number| format!("positive_{number}"));
        let patterns = program.outputs.jacobians.iter().flat_map(|jacobian| {
            let name = jacobian.name.to_uppercase();
            [format!("{name}_NONZEROS"), name]
        });
        let taken = words.taken.iter().map(|name| (*name).to_owned());
        Self {
            words,
            prefix: words.prefixed.then(|| format!("{}_", program.name)),
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
            Some(name) if self.is_free(&name) => name,
            _ => self.numbered(stem),
        };
        self.used.insert(name.clone());
        let name = self.identifier(&name)?.to_owned();
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
        let name = if self.is_free(name) {
            name.to_owned()
        } else {
            self.numbered(stem)
        };
        self.used.insert(name.clone());
        let name = self.identifier(&name)?.to_owned();
        self.given.insert(id, name.clone());
        Ok(name)
    }

    /// The name, if it is an identifier in the language of the names.
    pub fn identifier<'n>(&self, name: &'n str) -> Result<&'n str, EmitError> {
        self.words.identifier(name)
    }

    fn is_free(&self, name: &str) -> bool {
        let prefixed = |prefix: &String| name.starts_with(prefix.as_str());
        !self.used.contains(name) && !self.prefix.as_ref().is_some_and(prefixed)
    }

    fn numbered(&mut self, stem: &'static str) -> String {
        loop {
            let next = self.next.entry(stem).or_insert(0);
            *next += 1;
            let name = format!("{stem}_{next}");
            if self.is_free(&name) {
                return name;
            }
        }
    }
}
