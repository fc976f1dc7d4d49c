//! Which names have a rate: coordinates, inputs, states, fields, the time, and definitions that hold one
//! of these.

use std::collections::{HashMap, HashSet};

use crate::ast::{Syntax, SyntaxKind};
use crate::raw::Document;

/// The names that have a rate.
pub struct Moving {
    names: HashSet<String>,
}

impl Moving {
    /// Those of a specification.
    pub fn of(document: &Document) -> Self {
        let mut open: Vec<String> = vec!["t".to_owned()];
        open.extend(document.coordinates.iter().map(|c| c.name.text.clone()));
        open.extend(document.inputs.iter().map(|input| input.name.text.clone()));
        open.extend(document.states.iter().map(|state| state.name.text.clone()));
        for field in &document.fields {
            open.extend([field.name.text.clone(), field.coordinates.text.clone()]);
        }
        let mut holders: HashMap<String, Vec<String>> = HashMap::new();
        if !document.frames.is_empty() {
            for definition in &document.definitions {
                // What cannot be parsed is reported where names are looked up.
                let Ok(syntax) = definition.value.syntax() else {
                    continue;
                };
                names(&syntax, &mut |name| {
                    let holder = definition.name.text.clone();
                    holders.entry(name.to_owned()).or_default().push(holder);
                });
            }
        }
        let mut moving = HashSet::new();
        while let Some(name) = open.pop() {
            open.extend(holders.remove(&name).unwrap_or_default());
            moving.insert(name);
        }
        Self { names: moving }
    }

    /// Whether an expression has a rate.
    pub fn holds(&self, syntax: &Syntax) -> bool {
        let mut holds = false;
        names(syntax, &mut |name| holds |= self.names.contains(name));
        holds
    }
}

/// Sees all names of an expression.
fn names(syntax: &Syntax, see: &mut impl FnMut(&str)) {
    match &syntax.kind {
        SyntaxKind::Number(_) => {}
        SyntaxKind::Name(name) | SyntaxKind::Element { name, .. } => see(name),
        SyntaxKind::Call { arguments, .. } => {
            for argument in arguments {
                names(argument, see);
            }
        }
        SyntaxKind::Negate(operand) => names(operand, see),
        SyntaxKind::Binary(_, left, right) => {
            names(left, see);
            names(right, see);
        }
    }
}
