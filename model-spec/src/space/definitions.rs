//! Definitions that short forms write: what is used more than once gets a name, so that nothing is
//! written out twice and texts grow with what is written in the file.

use std::collections::{HashMap, HashSet};

use super::moving::Moving;
use super::scalar::{call, expansion, is_plain, name, negate, number};
use super::vector::{AXES, Vector};
use crate::ast::{Syntax, SyntaxKind};
use crate::raw::{Document, RawTerm};
use crate::table::Name;

/// An entry that a definition is written for: it bears the entry's place and documentation.
#[derive(Clone, Debug)]
pub struct Owner {
    /// The entry's key.
    pub name: Name,
    /// Its documentation.
    pub doc: String,
}

impl Owner {
    /// The owner of this name.
    pub fn new(name: &Name, doc: &str) -> Self {
        Self {
            name: name.clone(),
            doc: doc.to_owned(),
        }
    }

    /// The name of what belongs to it.
    pub fn named(&self, what: &str) -> String {
        format!("{}_{what}", self.name.text)
    }
}

/// The definitions that are written, and what of all names moves.
pub struct Definitions {
    written: Vec<RawTerm>,
    taken: HashSet<String>,
    /// The number of the last part of each entry.
    parts: HashMap<String, usize>,
    /// What has a rate.
    pub moving: Moving,
}

impl Definitions {
    /// None yet; what moves is known of coordinates, inputs, states and fields.
    pub fn of(document: &Document) -> Self {
        Self {
            written: Vec::new(),
            taken: declared(document),
            parts: HashMap::new(),
            moving: Moving::of(document),
        }
    }

    /// Whether the specification declares a scalar of this name.
    pub fn is_declared(&self, name: &str) -> bool {
        self.taken.contains(name)
    }

    /// What was written.
    pub fn take(&mut self) -> Vec<RawTerm> {
        std::mem::take(&mut self.written)
    }

    /// Writes a definition and gives its name.
    pub fn define(&mut self, owner: &Owner, text: String, value: Syntax) -> Syntax {
        let span = value.span;
        let defined = name(&text, span);
        self.moving.learn(&text, &value);
        self.written.push(RawTerm {
            name: Name {
                text,
                span: owner.name.span,
            },
            value: expansion(value),
            doc: owner.doc.clone(),
            origin: String::new(),
        });
        defined
    }

    /// The expression, by this name if it is more than a number, a name or a rate.
    pub fn named(&mut self, owner: &Owner, what: &str, value: Syntax) -> Syntax {
        if is_plain(&value) {
            return value;
        }
        self.define(owner, owner.named(what), value)
    }

    /// The components, each by a name if it is more than a number, a name or a rate.
    pub fn name_each(&mut self, owner: &Owner, what: &str, vector: Vector) -> Vector {
        let mut axes = AXES.into_iter();
        vector.map(|component| {
            let axis = axes.next().unwrap_or_default();
            self.named(owner, &format!("{what}_{axis}"), component)
        })
    }

    /// A name for a part of an entry that no other part has.
    pub fn part(&mut self, owner: &Owner) -> String {
        let last = self.parts.entry(owner.name.text.clone()).or_default();
        loop {
            *last += 1;
            let part = format!("part_{last}");
            if self.taken.insert(owner.named(&part)) {
                return part;
            }
        }
    }

    /// The rate of an expression, 0 if it does not move; what is no name gets one, for `dot` takes
    /// names.
    pub fn rate(&mut self, owner: &Owner, what: &str, value: Syntax) -> Syntax {
        let span = value.span;
        if !self.moving.holds(&value) {
            return number(0.0, span);
        }
        match value.kind {
            SyntaxKind::Negate(operand) => negate(self.rate(owner, what, *operand)),
            _ => {
                let value = match value.kind {
                    SyntaxKind::Name(_) => value,
                    _ => self.define(owner, owner.named(what), value),
                };
                Syntax {
                    span,
                    ..call("dot", value)
                }
            }
        }
    }
}

/// The names that a specification declares for scalars and definitions.
pub fn declared(document: &Document) -> HashSet<String> {
    let mut names: HashSet<String> = ["t", "pi"].map(str::to_owned).into();
    let mut add = |name: &Name| {
        names.insert(name.text.clone());
    };
    document.parameters.iter().for_each(|p| add(&p.name));
    document.coordinates.iter().for_each(|c| add(&c.name));
    document.inputs.iter().for_each(|input| add(&input.name));
    document.states.iter().for_each(|state| add(&state.name));
    document.definitions.iter().for_each(|d| add(&d.name));
    for field in &document.fields {
        add(&field.name);
        add(&field.coordinates);
        add(&field.along);
    }
    names
}
