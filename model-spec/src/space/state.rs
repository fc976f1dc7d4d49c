//! State of the expansion of vectors, and the recognition of expressions that must be expanded.

use std::collections::{HashMap, HashSet};

use super::definitions::Definitions;
use super::frames::Frames;
use super::placement::Placements;
use super::requirements::Requirements;
use super::value::Value;
use crate::ast::{Syntax, SyntaxKind};
use crate::functions::VECTOR_FUNCTIONS;

pub struct ExpansionState {
    pub vectors: HashMap<String, Value>,
    pub frames: Frames,
    /// Names of all frames, including frames that are not yet expanded.
    pub frame_names: HashSet<String>,
    /// Positions of frames computed so far.
    pub placements: Placements,
    pub definitions: Definitions,
    pub requirements: Requirements,
    /// Names of multipliers and residuals of constraints.
    pub constraint_outputs: HashSet<String>,
    /// Definitions and frames with errors, which are not reported again.
    pub invalid_entries: HashSet<String>,
}

impl ExpansionState {
    /// Returns true if an expression contains vectors, directly or by name.
    pub fn contains_vectors(&self, syntax: &Syntax) -> bool {
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

    /// Returns true if an expression refers to an entry with an error.
    pub fn is_broken(&self, syntax: &Syntax) -> bool {
        let mut broken = false;
        syntax.visit(&mut |part| {
            if let SyntaxKind::Name(name) = &part.kind {
                broken |= self.invalid_entries.contains(name);
            }
        });
        broken
    }
}

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
