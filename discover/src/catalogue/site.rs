//! A place for effects, and how the specification writes what stands there. Which places a model has is
//! found in `sites`.

use std::collections::BTreeMap;

use eomgen_model_spec::edit::Section;
use eomgen_model_spec::model::{Expr, Model};

use crate::catalogue::effect::SiteKind;

/// A place for effects.
#[derive(Clone, Debug)]
pub struct Site {
    /// What kind of place it is.
    pub kind: SiteKind,
    /// Its name in results.
    pub name: String,
    /// What fills the placeholders.
    pub arguments: BTreeMap<&'static str, String>,
    /// The terms that make up a mesh or hold a spring, or those of the kinetic energy that move with a body.
    pub terms: Vec<(Section, Vec<String>)>,
    /// The dampers beside a spring.
    pub dampers: Vec<Damper>,
}

/// A damper that acts on the rate of a spring's deflection.
#[derive(Clone, Debug, PartialEq)]
pub struct Damper {
    /// Where it stands: in the dissipation or among the forces.
    pub section: Section,
    /// The term that it is a part of.
    pub term: String,
    /// The part, as the specification writes it.
    pub part: String,
}

/// An expression as the specification writes it.
pub(super) fn text(model: &Model, expr: &Expr) -> String {
    let span = expr.span;
    let written = model
        .source
        .text
        .get(span.start..span.end)
        .unwrap_or_default();
    written.trim().to_owned()
}
