//! What is known while a specification is worked out, and which expressions have to be.

use std::collections::{HashMap, HashSet};

use super::definitions::Definitions;
use super::demands::Demands;
use super::frames::Frames;
use super::placement::Placements;
use super::value::Value;
use crate::ast::{Syntax, SyntaxKind};
use crate::functions::VECTOR_FUNCTIONS;

/// What is known while a specification is worked out.
pub struct Space {
    /// Vectors and rotations by their names.
    pub vectors: HashMap<String, Value>,
    /// The frames that are placed.
    pub frames: Frames,
    /// The names of all frames, placed or not yet.
    pub frame_names: HashSet<String>,
    /// Where they are, as far as somebody asked.
    pub placements: Placements,
    /// The definitions that are written.
    pub definitions: Definitions,
    /// What is checked later.
    pub demands: Demands,
    /// Multipliers and residuals of constraints.
    pub reported: HashSet<String>,
    /// Definitions and frames with mistakes, which are said once.
    pub broken: HashSet<String>,
}

impl Space {
    /// Whether an expression has to be worked out: it holds vectors, by themselves or by name.
    pub fn touches(&self, syntax: &Syntax) -> bool {
        let mut touches = is_spatial(syntax);
        syntax.visit(&mut |part| {
            if let SyntaxKind::Name(name) = &part.kind {
                let is_frame = self.frame_names.contains(name);
                touches |= self.vectors.contains_key(name)
                    || (is_frame && !self.definitions.is_declared(name));
            }
        });
        touches
    }

    /// Whether an expression refers to what is wrong already.
    pub fn is_broken(&self, syntax: &Syntax) -> bool {
        let mut broken = false;
        syntax.visit(&mut |part| {
            if let SyntaxKind::Name(name) = &part.kind {
                broken |= self.broken.contains(name);
            }
        });
        broken
    }
}

/// Whether an expression is written with vectors.
pub fn is_spatial(syntax: &Syntax) -> bool {
    let mut spatial = false;
    syntax.visit(&mut |part| {
        spatial |= match &part.kind {
            SyntaxKind::Vector(_) | SyntaxKind::Member { .. } => true,
            SyntaxKind::Call {
                function,
                arguments,
                ..
            } => {
                let is_product = function == "dot" && arguments.len() == 2;
                is_product || VECTOR_FUNCTIONS.contains(&function.as_str())
            }
            _ => false,
        }
    });
    spatial
}
