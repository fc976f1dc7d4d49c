//! Resolves the special forms: rates, derivatives and integrals along a field, sums over its
//! modes.

use super::{ResolvedKind, Resolver, Scope, argument_count_error};
use crate::ast::{Syntax, SyntaxKind};
use crate::diagnostic::{Diagnostic, quote};
use crate::foreign::NO_ACCELERATION;
use crate::ids::FieldId;
use crate::model::{Expr, ExprKind};
use crate::names::Symbol;
use crate::span::Span;

const MAX_DERIVATIVE: f64 = 4.0;

impl Resolver<'_> {
    pub(super) fn resolve_form(
        &mut self,
        name: &str,
        name_span: Span,
        span: Span,
        arguments: &[Syntax],
    ) -> ResolvedKind {
        let motion = matches!(self.scope, Scope::Motion | Scope::Factor);
        if self.scope == Scope::Parameters || (name == "dot" && !motion) {
            let what = format!("{name}(...)");
            return Err(self.out_of_scope_error(&quote(&what), "not a constant", name_span));
        }
        match (name, arguments) {
            ("dot", [operand]) => self.resolve_dot(operand),
            ("dot", _) => Err(argument_count_error(name, span, arguments.len(), "dot(x)")),
            ("diff", [value, along]) => self.resolve_diff(value, along, 1),
            ("diff", [value, along, times]) => {
                self.resolve_diff(value, along, read_derivative_order(times)?)
            }
            ("diff", _) => Err(argument_count_error(
                name,
                span,
                arguments.len(),
                "diff(w, x, 2)",
            )),
            ("at", [value, place]) => self.resolve_at(value, place),
            ("at", _) => Err(argument_count_error(
                name,
                span,
                arguments.len(),
                "at(w, l)",
            )),
            ("integral", [integrand, field]) => self.resolve_integral(integrand, field),
            ("integral", _) => Err(argument_count_error(
                name,
                span,
                arguments.len(),
                "integral(w^2, w)",
            )),
            ("sum", [index, field, summand]) => self.resolve_sum(index, field, summand),
            _ => Err(argument_count_error(
                name,
                span,
                arguments.len(),
                "sum(i, w, q[i]^2)",
            )),
        }
    }

    fn resolve_dot(&mut self, operand: &Syntax) -> ResolvedKind {
        let resolved = self.resolve(operand)?;
        let span = operand.span;
        match resolved.kind {
            ExprKind::Coordinate(_)
            | ExprKind::State(_)
            | ExprKind::Definition(_)
            | ExprKind::Field(_)
            | ExprKind::ModeCoordinate(_)
            | ExprKind::SingleMode { .. } => Ok(ExprKind::Dot(Box::new(resolved))),
            ExprKind::Diff(inner, times) if matches!(inner.kind, ExprKind::Field(_)) => {
                let kind = ExprKind::Dot(inner);
                Ok(ExprKind::Diff(Box::new(Expr { kind, span }), times))
            }
            ExprKind::Dot(_) => Err(Diagnostic::error("dot(dot(...)) is an acceleration")
                .with_span(span, "already a rate")
                .with_help(NO_ACCELERATION)),
            ExprKind::Input(input) => match self.names.input_rate(input) {
                Some(rate) => Ok(ExprKind::Input(rate)),
                None => Err(Diagnostic::error("the input has no given rate")
                    .with_span(span, "this is an input")
                    .with_help("add `rates = 2` to the input to supply its rates")),
            },
            ExprKind::At {
                field,
                value,
                position,
            } => Ok(rate_at(field, *value, position, span)),
            ExprKind::Parameter(_)
            | ExprKind::Number(_)
            | ExprKind::Pi
            | ExprKind::ModeShape(_) => {
                Err(no_rate_error(span, "this is a constant, which has no rate"))
            }
            ExprKind::Time | ExprKind::Position(_) => {
                Err(no_rate_error(span, "this is not a coordinate"))
            }
            _ => Err(no_rate_error(span, "this is an expression")
                .with_help("move the expression to [definitions] and write dot(NAME)")),
        }
    }

    fn resolve_diff(&mut self, value: &Syntax, along: &Syntax, times: u8) -> ResolvedKind {
        if matches!(&along.kind, SyntaxKind::Name(name) if name == "t") {
            let help = match &value.kind {
                SyntaxKind::Name(name) => format!("write dot({name}) for the rate"),
                _ => "write dot(x) for the rate".to_owned(),
            };
            return Err(Diagnostic::error(
                "diff() is the derivative with respect to the position along a field, not to time",
            )
            .with_span(along.span, "this is the time")
            .with_help(help));
        }
        let resolved = self.resolve(value)?;
        let Some(field) = field_of(&resolved) else {
            return Err(Diagnostic::error(
                "the first argument of diff() must be a field, its rate or a mode shape",
            )
            .with_span(value.span, "not a field")
            .with_help("write diff(w, x, 2), diff(dot(w), x, 1) or diff(phi[i], x, 2)"));
        };
        let names = &self.names.fields[field];
        if !matches!(&along.kind, SyntaxKind::Name(name) if *name == names.along) {
            let (field, along_name) = (&names.field, &names.along);
            return Err(Diagnostic::error(
                "the second argument of diff() must be the position along the field",
            )
            .with_span(along.span, "not the position")
            .with_help(format!("the position along `{field}` is `{along_name}`")));
        }
        let (inner, before) = match resolved.kind {
            ExprKind::Diff(inner, before) => (inner, before),
            _ => (Box::new(resolved), 0),
        };
        let total = before.saturating_add(times);
        if f64::from(total) > MAX_DERIVATIVE {
            return Err(derivative_order_error(value.span));
        }
        Ok(ExprKind::Diff(inner, total))
    }

    fn resolve_at(&mut self, value: &Syntax, place: &Syntax) -> ResolvedKind {
        let field = self.find_field(value)?;
        let value = self.resolve_in_field(field, value)?;
        let mut outside = Resolver::new(self.names, Scope::Parameters);
        let position = Box::new(outside.resolve(place)?);
        Ok(ExprKind::At {
            field,
            value,
            position,
        })
    }

    fn resolve_integral(&mut self, integrand: &Syntax, field: &Syntax) -> ResolvedKind {
        let field = self.resolve_field(field)?;
        let integrand = self.resolve_in_field(field, integrand)?;
        Ok(ExprKind::Integral { field, integrand })
    }

    /// Resolves an expression of the position along `field`.
    fn resolve_in_field(
        &mut self,
        field: FieldId,
        syntax: &Syntax,
    ) -> Result<Box<Expr>, Diagnostic> {
        self.domains.push(field);
        let resolved = self.resolve(syntax);
        self.domains.pop();
        resolved.map(Box::new)
    }

    fn resolve_sum(&mut self, index: &Syntax, field: &Syntax, summand: &Syntax) -> ResolvedKind {
        let SyntaxKind::Name(name) = &index.kind else {
            return Err(Diagnostic::error(
                "the first argument of sum() must be the name of an index",
            )
            .with_span(index.span, "not a name")
            .with_help("write sum(i, w, q[i]^2)"));
        };
        if let Some(symbol) = self.names.get(name) {
            return Err(Diagnostic::error(format!(
                "the index `{name}` has the same name as {}",
                symbol.kind()
            ))
            .with_span(index.span, "choose another name"));
        }
        let field_index = self.resolve_field(field)?;
        if self.sums.iter().any(|(_, known)| *known == field_index) {
            return Err(
                Diagnostic::error("a sum over a field inside a sum over the same field")
                    .with_span(field.span, "an enclosing sum is over this field"),
            );
        }
        self.sums.push((name.clone(), field_index));
        let summand = self.resolve(summand);
        self.sums.pop();
        Ok(ExprKind::Sum {
            field: field_index,
            summand: Box::new(summand?),
        })
    }

    fn resolve_field(&self, syntax: &Syntax) -> Result<FieldId, Diagnostic> {
        if let SyntaxKind::Name(name) = &syntax.kind
            && let Some(Symbol::Field(field)) = self.names.get(name)
        {
            return Ok(field);
        }
        let known = self.names.fields.iter().map(|names| names.field.as_str());
        let known: Vec<&str> = known.collect();
        let help = match known.as_slice() {
            [] => "this model has no field".to_owned(),
            fields => format!("the fields are: {}", fields.join(", ")),
        };
        Err(Diagnostic::error("expected the name of a field")
            .with_span(syntax.span, "not a field")
            .with_help(help))
    }

    /// Returns the field of an expression of the position.
    fn find_field(&self, syntax: &Syntax) -> Result<FieldId, Diagnostic> {
        let mut named = Vec::new();
        let mut positions = Vec::new();
        self.collect_fields(syntax, &mut named, &mut positions);
        let mut candidates = if named.is_empty() { positions } else { named };
        candidates.sort_unstable();
        candidates.dedup();
        match candidates.as_slice() {
            [only] => Ok(*only),
            [] => Err(Diagnostic::error(
                "the first argument of at() must be an expression of a field",
            )
            .with_span(syntax.span, "this contains no field")
            .with_help("write at(w, l) or at(diff(w, x, 1), l)")),
            _ => Err(Diagnostic::error("at() of several fields")
                .with_span(syntax.span, "the position is ambiguous")
                .with_help("write a separate at(...) for each field")),
        }
    }

    /// Collects the fields that an expression names, and the fields whose position it contains.
    fn collect_fields(
        &self,
        syntax: &Syntax,
        named: &mut Vec<FieldId>,
        positions: &mut Vec<FieldId>,
    ) {
        match &syntax.kind {
            // Vectors were already expanded to scalars or rejected.
            SyntaxKind::Number(_) | SyntaxKind::Vector(_) | SyntaxKind::Member { .. } => {}
            SyntaxKind::Name(name) => match self.names.get(name) {
                Some(Symbol::Field(field)) => named.push(field),
                Some(Symbol::Position) => {
                    let fields = self.names.fields.iter().enumerate();
                    let along = fields.filter(|(_, names)| names.along == *name);
                    positions.extend(along.map(|(field, _)| FieldId::new(field)));
                }
                _ => {}
            },
            SyntaxKind::Element { name, index, .. } if name == "phi" => {
                let sums = self.sums.iter().filter(|(known, _)| known == index);
                named.extend(sums.map(|(_, field)| *field));
            }
            SyntaxKind::Element { .. } => {}
            SyntaxKind::Call {
                function,
                arguments,
                ..
            } => {
                // The forms `integral` and `at` have their own position.
                if function != "integral" && function != "at" {
                    for argument in arguments {
                        self.collect_fields(argument, named, positions);
                    }
                }
            }
            SyntaxKind::Negate(operand) => self.collect_fields(operand, named, positions),
            SyntaxKind::Binary(_, left, right) => {
                self.collect_fields(left, named, positions);
                self.collect_fields(right, named, positions);
            }
        }
    }
}

/// Returns the field of `w`, `dot(w)`, `phi[i]` and their derivatives.
fn field_of(expr: &Expr) -> Option<FieldId> {
    match &expr.kind {
        ExprKind::Field(field) | ExprKind::ModeShape(field) => Some(*field),
        ExprKind::Dot(inner) | ExprKind::Diff(inner, _) => field_of(inner),
        _ => None,
    }
}

/// Returns the rate at a fixed position: dot(at(w, l)) = at(dot(w), l). If `value` is not a field or its derivative,
/// returns the rate of the whole expression.
fn rate_at(field: FieldId, value: Expr, position: Box<Expr>, span: Span) -> ExprKind {
    let expr = |kind| Box::new(Expr { kind, span });
    let at = |value| ExprKind::At {
        field,
        value,
        position,
    };
    match value.kind {
        ExprKind::Field(_) => at(expr(ExprKind::Dot(Box::new(value)))),
        ExprKind::Diff(inner, times) if matches!(inner.kind, ExprKind::Field(_)) => {
            at(expr(ExprKind::Diff(expr(ExprKind::Dot(inner)), times)))
        }
        _ => ExprKind::Dot(expr(at(Box::new(value)))),
    }
}

fn read_derivative_order(syntax: &Syntax) -> Result<u8, Diagnostic> {
    match syntax.kind {
        SyntaxKind::Number(value)
            if value.fract() == 0.0 && (1.0..=MAX_DERIVATIVE).contains(&value) =>
        {
            Ok(value as u8)
        }
        _ => Err(derivative_order_error(syntax.span)),
    }
}

fn derivative_order_error(span: Span) -> Diagnostic {
    Diagnostic::error("the order of a derivative along a field must be 1, 2, 3 or 4")
        .with_span(span, "invalid order")
}

fn no_rate_error(span: Span, label: &str) -> Diagnostic {
    Diagnostic::error(
        "the argument of dot() must be a coordinate, a definition, a field or at(...) of a field",
    )
    .with_span(span, label)
}
