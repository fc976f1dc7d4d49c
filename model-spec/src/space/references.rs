//! References between definitions and frames, and their order of evaluation. A definition may
//! use members of a frame, and the position of a frame may use a definition.

use std::collections::{HashMap, HashSet};

use crate::ast::{Syntax, SyntaxKind};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::order::{Reference, cycle_error, sort_by_references};
use crate::raw::{Document, RawFrame};
use crate::span::Span;

use super::definitions::declared_names;
use super::frames::unknown_frame_error;

pub struct FrameExpressions {
    pub origin: Option<Syntax>,
    pub rotation: Option<Syntax>,
}

/// Expressions that are evaluated in dependency order.
pub struct Expressions {
    pub definitions: Vec<Syntax>,
    pub frames: Vec<FrameExpressions>,
}

impl Expressions {
    /// Parses the expressions of definitions and frames; `None` after an error.
    pub fn read(document: &Document, found: &mut Diagnostics) -> Option<Self> {
        let before = found.list().len();
        let definitions = document.definitions.iter();
        let definitions: Vec<Syntax> = definitions
            .filter_map(|definition| found.push_error(definition.value.syntax()))
            .collect();
        let frames = document.frames.iter().map(|frame| FrameExpressions {
            origin: frame
                .origin
                .as_ref()
                .and_then(|o| found.push_error(o.syntax())),
            rotation: frame
                .rotation
                .as_ref()
                .and_then(|r| found.push_error(r.syntax())),
        });
        let frames = frames.collect();
        (found.list().len() == before).then_some(Self {
            definitions,
            frames,
        })
    }
}

#[derive(Clone, Copy)]
pub enum Entry {
    /// Index into `[definitions]`.
    Definition(usize),
    /// Index into `[frames]`.
    Frame(usize),
}

pub fn sort_entries(
    document: &Document,
    expressions: &Expressions,
    found: &mut Diagnostics,
) -> Option<Vec<Entry>> {
    let count = document.definitions.len();
    let names = Names::of(document);
    let mut references: Vec<Vec<Reference>> = Vec::new();
    for definition in &expressions.definitions {
        references.push(names.references(definition));
    }
    for (frame, own) in document.frames.iter().zip(&expressions.frames) {
        let mut list = Vec::new();
        if let Some(parent) = &frame.parent {
            match names.frames.get(parent.text.as_str()) {
                Some(&index) => list.push((count + index, parent.span)),
                None => {
                    found.push_with(|| unknown_frame_error(parent, names.frames.keys().copied()))
                }
            }
        }
        for syntax in own.origin.iter().chain(&own.rotation) {
            list.extend(names.references(syntax));
        }
        references.push(list);
    }
    if !found.is_empty() {
        return None;
    }
    let sorted = sort_by_references(&references).map_err(|circle| {
        let first = circle.iter().position(|(entry, _)| *entry >= count);
        found.push(match first {
            Some(first) => cyclic_frame_error(&circle, first, document),
            None => {
                let named = |index: usize| document.definitions[index].name.text.as_str();
                cycle_error("definition", &circle, named)
            }
        });
    });
    let entry = |index: usize| match index.checked_sub(count) {
        Some(frame) => Entry::Frame(frame),
        None => Entry::Definition(index),
    };
    Some(sorted.ok()?.into_iter().map(entry).collect())
}

struct Names<'d> {
    definitions: HashMap<&'d str, usize>,
    frames: HashMap<&'d str, usize>,
    declared: HashSet<String>,
}

impl<'d> Names<'d> {
    fn of(document: &'d Document) -> Self {
        let definitions = document.definitions.iter().enumerate();
        let frames = document.frames.iter().enumerate();
        Self {
            definitions: definitions
                .map(|(i, definition)| (definition.name.text.as_str(), i))
                .collect(),
            frames: frames.map(|(i, f)| (f.name.text.as_str(), i)).collect(),
            declared: declared_names(document),
        }
    }

    fn references(&self, syntax: &Syntax) -> Vec<Reference> {
        let mut list = Vec::new();
        let count = self.definitions.len();
        let mut see = |name: &str, is_member: bool, span: Span| {
            // A frame may have the name of a scalar. A member access then refers to the frame.
            let is_frame = is_member || !self.declared.contains(name);
            let frame = self.frames.get(name).filter(|_| is_frame);
            list.extend(frame.map(|index| (count + index, span)));
            let definition = self.definitions.get(name);
            list.extend(definition.map(|index| (*index, span)));
        };
        syntax.visit(&mut |part| match &part.kind {
            SyntaxKind::Name(name) => see(name, false, part.span),
            SyntaxKind::Member { of, .. } => {
                if let SyntaxKind::Name(name) = &of.kind {
                    see(name, true, of.span);
                }
            }
            _ => {}
        });
        list
    }
}

fn cyclic_frame_error(circle: &[Reference], first: usize, document: &Document) -> Diagnostic {
    let frame = |index: usize| -> Option<&RawFrame> {
        let frame = index.checked_sub(document.definitions.len())?;
        document.frames.get(frame)
    };
    let name = |index: usize| match frame(index) {
        Some(frame) => frame.name.text.as_str(),
        None => document.definitions[index].name.text.as_str(),
    };
    let turned = circle.iter().cycle().skip(first).take(circle.len());
    let named: Vec<&str> = turned.take(8).map(|(index, _)| name(*index)).collect();
    let place = circle
        .get(first)
        .map_or(Span::default(), |(_, place)| *place);
    let own = named.first().copied().unwrap_or_default();
    let help = match circle.iter().all(|(index, _)| frame(*index).is_some()) {
        true => "place one of them in the fixed axes: remove its `in`",
        false => "one of them must not depend on the others",
    };
    Diagnostic::error(format!("the frame `{own}` is placed in itself"))
        .with_span(place, format!("here: {} -> ...", named.join(" -> ")))
        .with_help(help)
}
