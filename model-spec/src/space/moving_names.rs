//! Names with a rate: coordinates, inputs, states, fields, the time, and definitions of these.

use std::collections::HashSet;

use crate::ast::{Syntax, SyntaxKind};
use crate::raw::Document;

pub struct MovingNames {
    names: HashSet<String>,
}

impl MovingNames {
    /// Collects the names of a specification, without its definitions.
    pub fn from_document(document: &Document) -> Self {
        let mut names: HashSet<String> = ["t".to_owned()].into();
        names.extend(document.coordinates.iter().map(|c| c.name.text.clone()));
        names.extend(document.inputs.iter().map(|input| input.name.text.clone()));
        names.extend(document.states.iter().map(|state| state.name.text.clone()));
        for field in &document.fields {
            names.extend([field.name.text.clone(), field.coordinates.text.clone()]);
        }
        Self { names }
    }

    /// Adds a definition, after those that it refers to.
    pub fn add_definition(&mut self, name: &str, value: &Syntax) {
        if self.has_rate(value) {
            self.names.insert(name.to_owned());
        }
    }

    pub fn has_rate(&self, syntax: &Syntax) -> bool {
        let mut holds = false;
        syntax.visit(&mut |part| {
            if let SyntaxKind::Name(name) | SyntaxKind::Element { name, .. } = &part.kind {
                holds |= self.names.contains(name);
            }
        });
        holds
    }
}
