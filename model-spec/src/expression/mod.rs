//! Resolves the names of an expression. The valid names depend on the [`Scope`] of the expression and, along a field,
//! on the enclosing `integral`, `at` and `sum`. Units are checked later.

mod forms;

use crate::ast::{Syntax, SyntaxKind};
use crate::diagnostic::{Diagnostic, quote};
use crate::foreign::{NO_ACCELERATION, find_equivalent, find_name_equivalent, read_rate};
use crate::functions::{FORMS, VECTOR_FUNCTIONS, callable_names};
use crate::ids::{CoefficientId, FieldId};
use crate::model::{Expr, ExprKind, Function, MAX_ORDER};
use crate::names::{Names, Symbol};
use crate::span::Span;
use crate::suggest::did_you_mean;

/// Use of an expression, which determines the valid names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// Only parameters: expressions of parameters, initial values, positions along a field.
    Parameters,
    /// Everything but coefficients: definitions, energies, forces, observables.
    Motion,
    /// Parameters, integrals of them, and earlier coefficients.
    Coefficient(CoefficientId),
    /// Quantity that a coefficient multiplies: the names of `Motion`, and modal coordinates without an index.
    Factor,
}

pub struct Resolver<'n> {
    names: &'n Names,
    scope: Scope,
    /// Fields whose position is a valid name, innermost last.
    domains: Vec<FieldId>,
    /// Indices and fields of the enclosing sums, innermost last.
    sums: Vec<(String, FieldId)>,
    /// For each earlier coefficient, the fields with one coefficient per mode.
    per_mode: &'n [Vec<FieldId>],
}

type ResolvedKind = Result<ExprKind, Diagnostic>;

impl<'n> Resolver<'n> {
    pub fn new(names: &'n Names, scope: Scope) -> Self {
        Self {
            names,
            scope,
            domains: Vec::new(),
            sums: Vec::new(),
            per_mode: &[],
        }
    }

    /// Sets the fields of earlier coefficients.
    pub fn with_coefficient_fields(mut self, per_mode: &'n [Vec<FieldId>]) -> Self {
        self.per_mode = per_mode;
        self
    }

    /// Sets the index and the field of an expression for each mode.
    pub fn with_mode_index(mut self, each: Option<(String, FieldId)>) -> Self {
        self.sums.extend(each);
        self
    }

    pub fn resolve(&mut self, syntax: &Syntax) -> Result<Expr, Diagnostic> {
        let span = syntax.span;
        let kind = match &syntax.kind {
            SyntaxKind::Number(value) => ExprKind::Number(*value),
            SyntaxKind::Name(name) => self.resolve_name(name, span)?,
            SyntaxKind::Element {
                name,
                index,
                index_span,
            } => self.resolve_element(name, span, index, *index_span)?,
            SyntaxKind::Call {
                function,
                function_span,
                arguments,
            } => self.resolve_call(function, *function_span, span, arguments)?,
            SyntaxKind::Vector(_) | SyntaxKind::Member { .. } => {
                return Err(vector_error(span));
            }
            SyntaxKind::Negate(operand) => ExprKind::Negate(Box::new(self.resolve(operand)?)),
            SyntaxKind::Binary(operator, left, right) => {
                let left = Box::new(self.resolve(left)?);
                ExprKind::Binary(*operator, left, Box::new(self.resolve(right)?))
            }
        };
        Ok(Expr { kind, span })
    }

    fn resolve_name(&self, name: &str, span: Span) -> ResolvedKind {
        match name {
            "pi" => return Ok(ExprKind::Pi),
            "t" if self.scope == Scope::Motion || self.scope == Scope::Factor => {
                return Ok(ExprKind::Time);
            }
            "t" => return Err(self.out_of_scope_error("`t`", "the time", span)),
            _ => {}
        }
        let Some(symbol) = self.names.get(name) else {
            return self.resolve_single_mode(name, span);
        };
        let motion = matches!(self.scope, Scope::Motion | Scope::Factor);
        match symbol {
            Symbol::Parameter(index) => Ok(ExprKind::Parameter(index)),
            Symbol::Coordinate(index) if motion => Ok(ExprKind::Coordinate(index)),
            Symbol::Input(index) if motion => Ok(ExprKind::Input(index)),
            Symbol::State(index) if self.scope == Scope::Motion => Ok(ExprKind::State(index)),
            Symbol::Definition(index) if motion => Ok(ExprKind::Definition(index)),
            Symbol::Field(field) if motion => self.resolve_field_value(field, name, span),
            Symbol::Position if self.scope != Scope::Parameters => {
                self.resolve_position(name, span)
            }
            Symbol::Modes(field) if self.scope == Scope::Factor => {
                Ok(ExprKind::ModeCoordinate(field))
            }
            Symbol::Modes(_) if motion => {
                Err(Diagnostic::error(format!("`{name}` denotes all modes"))
                    .with_span(span, "no mode index")
                    .with_help(format!(
                        "write a sum over the modes: sum(i, {}, {name}[i])",
                        self.field_of(symbol)
                    )))
            }
            Symbol::Multiplier(index) if self.scope == Scope::Motion => {
                Ok(ExprKind::Multiplier(index))
            }
            Symbol::Residual(index) if self.scope == Scope::Motion => Ok(ExprKind::Residual(index)),
            Symbol::Coefficient(index) => self.resolve_coefficient(index, name, span),
            other => Err(self.out_of_scope_error(&quote(name), other.kind(), span)),
        }
    }

    fn field_of(&self, symbol: Symbol) -> &str {
        match symbol {
            Symbol::Field(field) | Symbol::Modes(field) => &self.names.fields[field].field,
            _ => "",
        }
    }

    fn resolve_coefficient(&self, index: CoefficientId, name: &str, span: Span) -> ResolvedKind {
        match self.scope {
            Scope::Coefficient(own) if index < own => {
                let fields = self
                    .per_mode
                    .get(index.index())
                    .map_or(&[][..], Vec::as_slice);
                let summed = |field: &FieldId| self.sums.iter().any(|(_, known)| known == field);
                match fields.iter().find(|field| !summed(field)) {
                    None => Ok(ExprKind::Coefficient(index)),
                    Some(field) => Err(self.missing_mode_error(*field, name, span)),
                }
            }
            Scope::Coefficient(_) => Err(Diagnostic::error(format!(
                "the coefficient `{name}` is not defined yet"
            ))
            .with_span(span, "refers to itself or to a later entry")
            .with_help("refer only to coefficients listed before this one")),
            _ => Err(self.out_of_scope_error(&quote(name), "a coefficient", span)),
        }
    }

    fn missing_mode_error(&self, field: FieldId, name: &str, span: Span) -> Diagnostic {
        let field = &self.names.fields[field].field;
        Diagnostic::error(format!(
            "the coefficient `{name}` exists for each mode of `{field}`"
        ))
        .with_span(span, "no mode index")
        .with_help(format!(
            "use it inside sum(i, {field}, ...) or with each = \"{field}[i]\""
        ))
    }

    fn out_of_scope_error(&self, what: &str, kind: &str, span: Span) -> Diagnostic {
        let rule = match self.scope {
            Scope::Factor if kind == "a state" => {
                "coefficients are factors of coordinates, rates and inputs in an acceleration"
            }
            Scope::Parameters => "use only parameters in this expression",
            Scope::Coefficient(_) => "use only parameters and earlier coefficients",
            Scope::Motion | Scope::Factor => {
                "coefficients are results, and no expression may depend on them"
            }
        };
        let label = if what == "`t`" {
            "this is the time".to_owned()
        } else {
            format!("this is {kind}")
        };
        Diagnostic::error(format!("{what} cannot be used here"))
            .with_span(span, label)
            .with_help(rule)
    }

    fn resolve_field_value(&self, field: FieldId, name: &str, span: Span) -> ResolvedKind {
        if self.domains.last() == Some(&field) {
            return Ok(ExprKind::Field(field));
        }
        Err(
            Diagnostic::error(format!("the field `{name}` is a function of the position"))
                .with_span(span, "outside integral(...) and at(...)")
                .with_help(format!(
                    "write at({name}, POSITION) for its value at a position, or integral(..., {name})"
                )),
        )
    }

    fn resolve_position(&self, name: &str, span: Span) -> ResolvedKind {
        match self.domains.last() {
            Some(&field) if self.names.fields[field].along == name => Ok(ExprKind::Position(field)),
            _ => Err(
                Diagnostic::error(format!("the position `{name}` has no value here"))
                    .with_span(span, "outside the functions of its field")
                    .with_help(format!(
                        "use `{name}` only inside integral(..., FIELD) and at(...)"
                    )),
            ),
        }
    }

    /// Resolves `q_3`, the coordinate of one mode.
    fn resolve_single_mode(&self, name: &str, span: Span) -> ResolvedKind {
        let parts = name.rsplit_once('_').and_then(|(stem, number)| {
            let digits = number.bytes().all(|byte| byte.is_ascii_digit());
            let mode = number.parse::<usize>().ok().filter(|_| digits)?;
            Some((self.names.get(stem)?, mode, number))
        });
        let Some((Symbol::Modes(field), mode, number)) = parts else {
            return Err(self.unknown_name_error(name, span));
        };
        if self.scope != Scope::Motion {
            return Err(self.out_of_scope_error(&quote(name), "a modal coordinate", span));
        }
        if mode == 0 || mode > MAX_ORDER || number.starts_with('0') {
            let modes = &self.names.fields[field].modes;
            return Err(Diagnostic::error(format!("there is no mode {number}"))
                .with_span(span, format!("modes are {modes}_1 to {modes}_{MAX_ORDER}")));
        }
        Ok(ExprKind::SingleMode { field, mode })
    }

    fn unknown_name_error(&self, name: &str, span: Span) -> Diagnostic {
        let diagnostic = Diagnostic::error(format!("unknown name {}", quote(name)));
        if callable_names().any(|known| known == name) {
            return Diagnostic::error(format!("the function `{name}` has no arguments"))
                .with_span(span, "here")
                .with_help(format!("write {name}(...)"));
        }
        if self.names.is_observable(name) {
            return diagnostic
                .with_span(span, "this is an observable")
                .with_help(
                    "an observable is only an output: move the expression to [definitions]",
                );
        }
        let rate = read_rate(name, |of| self.names.get(of).is_some_and(Symbol::moves));
        let help = match rate {
            Some(rate) if rate.is_second => Some(NO_ACCELERATION.to_owned()),
            Some(rate) => Some(format!("write dot({}) for the rate", rate.of)),
            None => find_name_equivalent(name)
                .map(str::to_owned)
                .or_else(|| did_you_mean(name, self.names.known_names().chain(["t", "pi"]))),
        };
        diagnostic
            .with_span(span, "not declared")
            .with_optional_help(help)
    }

    /// Resolves `q[i]` or `phi[i]`.
    fn resolve_element(
        &self,
        name: &str,
        span: Span,
        index: &str,
        index_span: Span,
    ) -> ResolvedKind {
        let Some((_, field)) = self.sums.iter().rev().find(|(known, _)| known == index) else {
            return Err(Diagnostic::error(format!("unknown index {}", quote(index)))
                .with_span(index_span, "no enclosing sum has this index")
                .with_help(format!(
                    "write a sum over the modes: sum({index}, w, {name}[{index}])"
                )));
        };
        let names = &self.names.fields[*field];
        if name == "phi" {
            if self.domains.last() == Some(field) {
                return Ok(ExprKind::ModeShape(*field));
            }
            return Err(
                Diagnostic::error("the mode shape `phi` is a function of the position")
                    .with_span(span, "outside integral(...) and at(...)"),
            );
        }
        if name != names.modes {
            let (modes, field) = (&names.modes, &names.field);
            return Err(Diagnostic::error(format!("{} has no modes", quote(name)))
                .with_span(span, format!("`{index}` counts the modes of `{field}`"))
                .with_help(format!("write {modes}[{index}] or phi[{index}]")));
        }
        if matches!(self.scope, Scope::Motion | Scope::Factor) {
            Ok(ExprKind::ModeCoordinate(*field))
        } else {
            Err(self.out_of_scope_error(&quote(name), "a modal coordinate", span))
        }
    }

    fn resolve_call(
        &mut self,
        name: &str,
        name_span: Span,
        span: Span,
        arguments: &[Syntax],
    ) -> ResolvedKind {
        if FORMS.contains(&name) {
            return self.resolve_form(name, name_span, span, arguments);
        }
        let Some(function) = Function::from_name(name) else {
            return Err(self.unknown_function_error(name, name_span));
        };
        let expected = function.arguments();
        if arguments.len() != expected.len() {
            let usage = format!("{name}({})", expected.join(", "));
            return Err(argument_count_error(name, span, arguments.len(), &usage));
        }
        let arguments = arguments.iter().map(|argument| self.resolve(argument));
        Ok(ExprKind::Call(
            function,
            arguments.collect::<Result<_, _>>()?,
        ))
    }

    fn unknown_function_error(&self, name: &str, span: Span) -> Diagnostic {
        if let Some(symbol) = self.names.get(name) {
            return Diagnostic::error(format!("`{name}` is {}, not a function", symbol.kind()))
                .with_span(span, "called like a function")
                .with_help(format!("write a product with `*`: {name}*(...)"));
        }
        if VECTOR_FUNCTIONS.contains(&name) {
            return vector_error(span);
        }
        let help = match find_equivalent(name) {
            Some(help) => Some(help.to_owned()),
            None => did_you_mean(name, callable_names().chain(VECTOR_FUNCTIONS)),
        };
        Diagnostic::error(format!("unknown function {}", quote(name)))
            .with_span(span, "not known")
            .with_optional_help(help)
    }
}

/// Returns the error for a vector where a scalar is required.
fn vector_error(span: Span) -> Diagnostic {
    Diagnostic::error("a vector cannot be used here")
        .with_span(span, "expected a scalar")
        .with_help(
            "use vectors in [definitions], energies, [forces], [constraints], [observables], \
             [frames] and [bodies]",
        )
}

pub(super) fn argument_count_error(
    name: &str,
    span: Span,
    count: usize,
    usage: &str,
) -> Diagnostic {
    let plural = if count == 1 { "" } else { "s" };
    Diagnostic::error(format!("`{name}` does not accept {count} argument{plural}"))
        .with_span(span, "here")
        .with_help(format!("write {usage}"))
}
