//! Sites of effects; `sites` finds the sites of a model.

use std::collections::BTreeMap;

use eomgen_model_spec::edit::Section;
use eomgen_model_spec::model::{Expr, Model};

use crate::catalogue::effect::SiteKind;

/// Site of an effect.
#[derive(Clone, Debug)]
pub struct Site {
    /// Kind of the site.
    pub kind: SiteKind,
    /// Name in results.
    pub name: String,
    /// Values of the placeholders.
    pub arguments: BTreeMap<&'static str, String>,
    /// Terms of a mesh or spring, or the kinetic energy terms of a body and its load.
    pub terms: Vec<(Section, Vec<String>)>,
    /// Dampers parallel to a spring.
    pub dampers: Vec<Damper>,
}

/// Damper that acts on the rate of the deflection of a spring.
#[derive(Clone, Debug, PartialEq)]
pub struct Damper {
    /// Section of the damper: the dissipation or the forces.
    pub section: Section,
    /// Name of the term that contains the damper.
    pub term: String,
    /// Summand of the term, in the notation of the specification.
    pub part: String,
}

/// Returns an expression in the notation of the specification.
pub(super) fn format_expression(model: &Model, expr: &Expr) -> String {
    let span = expr.span;
    let written = model
        .source
        .text
        .get(span.start..span.end)
        .unwrap_or_default();
    written.trim().to_owned()
}
