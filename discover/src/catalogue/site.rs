//! Sites of effects. The sites of a model are found in `sites`.

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
    /// Terms that make up a mesh or a spring, or terms of the kinetic energy that move with a body.
    pub terms: Vec<(Section, Vec<String>)>,
    /// Dampers parallel to a spring.
    pub dampers: Vec<Damper>,
}

/// Damper that acts on the rate of the deflection of a spring.
#[derive(Clone, Debug, PartialEq)]
pub struct Damper {
    /// Section of the damper: the dissipation or the forces.
    pub section: Section,
    /// Term that contains it.
    pub term: String,
    /// The part in the notation of the specification.
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
