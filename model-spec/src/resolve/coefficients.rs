//! Builds the named coefficients of the derived equations.

use super::Builder;
use crate::ast::SyntaxKind;
use crate::diagnostic::Diagnostic;
use crate::expression::{Resolver, Scope};
use crate::ids::{CoefficientId, FieldId};
use crate::model::{Coefficient, CoefficientKind, Expr, ExprKind};
use crate::names::Symbol;
use crate::quantity::{Quantity, StringValue};
use crate::raw::{RawCoefficient, RawCoefficientKind};

impl Builder {
    pub(super) fn build_coefficients(&mut self, raw: Vec<RawCoefficient>) -> Vec<Coefficient> {
        let mut built = Vec::with_capacity(raw.len());
        let mut per_mode = Vec::with_capacity(raw.len());
        for entry in raw {
            let coefficient = self.build_coefficient(entry, &per_mode);
            per_mode.push(coefficient.as_ref().map_or_else(Vec::new, modes_of));
            built.extend(coefficient);
        }
        built
    }

    /// Builds one coefficient. `before` contains the fields of the earlier coefficients.
    fn build_coefficient(
        &mut self,
        raw: RawCoefficient,
        before: &[Vec<FieldId>],
    ) -> Option<Coefficient> {
        let each = match &raw.each {
            Some(written) => Some(self.parse_each(written)?),
            None => None,
        };
        let field = each.as_ref().map(|(_, field)| *field);
        let resolved = |quantity: &Quantity, scope: Scope, each: Option<(String, FieldId)>| {
            let resolver = Resolver::new(&self.names, scope).with_mode_index(each);
            quantity
                .syntax()
                .and_then(|syntax| resolver.with_coefficient_fields(before).resolve(&syntax))
        };
        let known = Scope::Coefficient(CoefficientId::new(before.len()));
        let kind = match &raw.kind {
            RawCoefficientKind::Value(value) => {
                resolved(value, known, each).map(CoefficientKind::Value)
            }
            RawCoefficientKind::Factor(of, by, times) => {
                let of = resolved(of, Scope::Factor, each.clone()).and_then(check_coordinate);
                of.and_then(|of| {
                    let by = resolved(by, Scope::Factor, each.clone())?;
                    // The equation of each mode may have its own factor.
                    let rows = rows_of(&of).map(|field| (String::new(), field));
                    let each = each.or(rows);
                    let times = times.as_ref().map(|times| resolved(times, known, each));
                    let times = times.transpose()?;
                    Ok(CoefficientKind::Factor { of, by, times })
                })
            }
        };
        Some(Coefficient {
            kind: self.found.push_error(kind)?,
            name: raw.name.text,
            each: field,
            doc: raw.doc,
            span: raw.name.span,
        })
    }

    /// Returns the index and the field of `each = "w[i]"`.
    fn parse_each(&mut self, written: &StringValue) -> Option<(String, FieldId)> {
        let syntax = self.found.push_error(written.syntax())?;
        if let SyntaxKind::Element { name, index, .. } = syntax.kind
            && let Some(Symbol::Field(field)) = self.names.get(&name)
        {
            return Some((index, field));
        }
        self.found.push(
            Diagnostic::error("`each` must name a field and an index")
                .with_span(syntax.span, "not a field with an index")
                .with_help("write each = \"w[i]\" to give a coefficient for each mode of w"),
        );
        None
    }
}

/// Checks that `of` is a coordinate or the modal coordinates of a field.
fn check_coordinate(of: Expr) -> Result<Expr, Diagnostic> {
    match of.kind {
        ExprKind::Coordinate(_) | ExprKind::ModeCoordinate(_) => Ok(of),
        _ => Err(Diagnostic::error(
            "`of` must be a coordinate or the modal coordinates of a field",
        )
        .with_span(of.span, "not a coordinate")
        .with_help(
            "name the coordinate of the equation, for example of = \"theta\" or of = \"q\"",
        )),
    }
}

/// Returns the field of a modal coordinate or its rate.
fn rows_of(expr: &Expr) -> Option<FieldId> {
    match &expr.kind {
        ExprKind::ModeCoordinate(field) => Some(*field),
        ExprKind::Dot(inner) => rows_of(inner),
        _ => None,
    }
}

fn modes_of(coefficient: &Coefficient) -> Vec<FieldId> {
    let mut fields: Vec<FieldId> = coefficient.each.into_iter().collect();
    if let CoefficientKind::Factor { of, by, .. } = &coefficient.kind {
        fields.extend(rows_of(of));
        fields.extend(rows_of(by));
    }
    fields
}
