//! Fields with their mode shapes.

use std::sync::Arc;

use super::Builder;
use crate::diagnostic::Diagnostic;
use crate::expression::Scope;
use crate::model::{Basis, Field, MAX_ORDER};
use crate::raw::{RawBasis, RawField};
use crate::shape_table::ShapeTable;
use crate::span::Span;

impl Builder {
    /// Builds the mode shapes of a field with this order.
    fn build_basis(&mut self, raw: RawBasis, (order, span): (i64, Span)) -> Option<Basis> {
        let file = match raw {
            RawBasis::Named(basis) => return Some(basis),
            RawBasis::Table(file) => file,
        };
        let folder = self.found.source().folder.clone();
        let table = self.found.push_error(ShapeTable::read(
            folder.as_deref(),
            file.span,
            &file.text,
            MAX_ORDER,
        ))?;
        let shapes = table.shapes.len();
        if usize::try_from(order).is_ok_and(|order| order > shapes && order <= MAX_ORDER) {
            let message = format!(
                "the order {order} needs more mode shapes than {}",
                file.text
            );
            self.found.push(
                Diagnostic::error(message)
                    .with_span(span, "too high")
                    .with_help(format!("the table has {shapes}")),
            );
            return None;
        }
        Some(Basis::Table {
            table: Arc::new(table),
            span: file.span,
        })
    }

    pub(super) fn build_field(&mut self, raw: RawField) -> Option<Field> {
        let unit = self.parse_coherent_unit(raw.unit);
        let from = self.resolve_expression(&raw.from, Scope::Parameters);
        let to = self.resolve_expression(&raw.to, Scope::Parameters);
        let basis = self.build_basis(raw.basis, raw.order);
        let order = self.found.push_error(check_field_order(raw.order));
        Some(Field {
            name: raw.name.text,
            unit: unit?,
            along: raw.along.text,
            from: from?,
            to: to?,
            basis: basis?,
            coordinates: raw.coordinates.text,
            order: order?,
            doc: raw.doc,
            span: raw.name.span,
        })
    }
}

fn check_field_order((order, span): (i64, Span)) -> Result<usize, Diagnostic> {
    match usize::try_from(order) {
        Ok(order) if order <= MAX_ORDER => Ok(order),
        Ok(_) => Err(
            Diagnostic::error(format!("the order {order} is above the limit"))
                .with_span(span, "too high")
                .with_help(format!("the highest order is {MAX_ORDER}")),
        ),
        Err(_) => Err(Diagnostic::error(format!("the order {order} is negative"))
            .with_span(span, "negative")
            .with_help("give the number of modes, or 0 for a rigid body")),
    }
}
