//! From the syntax tree of an expression to an expression with every name looked up. What
//! a name may stand for depends on where the expression stands ([`Scope`]) and, along a
//! field, on the enclosing `integral`, `at` and `sum`. Units are not looked at here.

mod forms;

use crate::ast::{Syntax, SyntaxKind};
use crate::diagnostic::{Diagnostic, quoted};
use crate::foreign::written_here;
use crate::functions::{FORMS, VECTOR_FUNCTIONS, callable};
use crate::ids::{CoefficientId, FieldId};
use crate::model::{Expr, ExprKind, Function};
use crate::names::{Names, Symbol};
use crate::span::Span;
use crate::suggest::did_you_mean;

/// Where an expression stands, hence what it may hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// Parameters only: parameters' own expressions, initial values, places along a field.
    Parameters,
    /// Anything but coefficients: definitions, energies, forces, observables.
    Motion,
    /// Parameters, integrals of them, and coefficients before this one.
    Coefficient(CoefficientId),
    /// What a coefficient multiplies: as `Motion`, and mode coordinates without an index.
    Factor,
}

/// Looks up the names of one expression.
pub struct Resolver<'n> {
    names: &'n Names,
    scope: Scope,
    /// Fields whose position may be used, innermost last.
    domains: Vec<FieldId>,
    /// Indices of the enclosing sums and their fields, innermost last.
    sums: Vec<(String, FieldId)>,
    /// Of each earlier coefficient, the fields for whose modes it is given.
    per_mode: &'n [Vec<FieldId>],
}

type ResolvedKind = Result<ExprKind, Diagnostic>;

impl<'n> Resolver<'n> {
    /// A resolver for expressions that stand in `scope`.
    pub fn new(names: &'n Names, scope: Scope) -> Self {
        Self {
            names,
            scope,
            domains: Vec::new(),
            sums: Vec::new(),
            per_mode: &[],
        }
    }

    /// The same with what is known of earlier coefficients.
    pub fn knowing(mut self, per_mode: &'n [Vec<FieldId>]) -> Self {
        self.per_mode = per_mode;
        self
    }

    /// The same for an expression that is given for each mode of a field, by its index.
    pub fn for_each(mut self, each: Option<(String, FieldId)>) -> Self {
        self.sums.extend(each);
        self
    }

    /// Looks up the names of an expression.
    ///
    /// # Errors
    /// The first name or call that has no meaning where it stands.
    pub fn resolve(&mut self, syntax: &Syntax) -> Result<Expr, Diagnostic> {
        let span = syntax.span;
        let kind = match &syntax.kind {
            SyntaxKind::Number(value) => ExprKind::Number(*value),
            SyntaxKind::Name(name) => self.name(name, span)?,
            SyntaxKind::Element {
                name,
                index,
                index_span,
            } => self.element(name, span, index, *index_span)?,
            SyntaxKind::Call {
                function,
                function_span,
                arguments,
            } => self.call(function, *function_span, span, arguments)?,
            SyntaxKind::Vector(_) | SyntaxKind::Member { .. } => {
                return Err(vectors_elsewhere(span));
            }
            SyntaxKind::Negate(operand) => ExprKind::Negate(Box::new(self.resolve(operand)?)),
            SyntaxKind::Binary(operator, left, right) => {
                let left = Box::new(self.resolve(left)?);
                ExprKind::Binary(*operator, left, Box::new(self.resolve(right)?))
            }
        };
        Ok(Expr { kind, span })
    }

    fn name(&self, name: &str, span: Span) -> ResolvedKind {
        match name {
            "pi" => return Ok(ExprKind::Pi),
            "t" if self.scope == Scope::Motion || self.scope == Scope::Factor => {
                return Ok(ExprKind::Time);
            }
            "t" => return Err(self.out_of_scope("`t`", "the time", span)),
            _ => {}
        }
        let Some(symbol) = self.names.get(name) else {
            return Err(self.unknown(name, span));
        };
        let motion = matches!(self.scope, Scope::Motion | Scope::Factor);
        match symbol {
            Symbol::Parameter(index) => Ok(ExprKind::Parameter(index)),
            Symbol::Coordinate(index) if motion => Ok(ExprKind::Coordinate(index)),
            Symbol::Input(index) if motion => Ok(ExprKind::Input(index)),
            Symbol::State(index) if self.scope == Scope::Motion => Ok(ExprKind::State(index)),
            Symbol::Definition(index) if motion => Ok(ExprKind::Definition(index)),
            Symbol::Field(field) if motion => self.field(field, name, span),
            Symbol::Position if self.scope != Scope::Parameters => self.position(name, span),
            Symbol::Modes(field) if self.scope == Scope::Factor => {
                Ok(ExprKind::ModeCoordinate(field))
            }
            Symbol::Modes(_) if motion => Err(Diagnostic::error(format!(
                "`{name}` stands for all modes at once"
            ))
            .at(span, "which mode?")
            .help(format!(
                "write a sum over the modes: sum(i, {}, {name}[i])",
                self.field_of(symbol)
            ))),
            Symbol::Multiplier(index) if self.scope == Scope::Motion => {
                Ok(ExprKind::Multiplier(index))
            }
            Symbol::Residual(index) if self.scope == Scope::Motion => Ok(ExprKind::Residual(index)),
            Symbol::Coefficient(index) => self.coefficient(index, name, span),
            other => Err(self.out_of_scope(&quoted(name), other.kind(), span)),
        }
    }

    fn field_of(&self, symbol: Symbol) -> &str {
        match symbol {
            Symbol::Field(field) | Symbol::Modes(field) => &self.names.fields[field].field,
            _ => "",
        }
    }

    fn coefficient(&self, index: CoefficientId, name: &str, span: Span) -> ResolvedKind {
        match self.scope {
            Scope::Coefficient(own) if index < own => {
                let fields = self
                    .per_mode
                    .get(index.index())
                    .map_or(&[][..], Vec::as_slice);
                let summed = |field: &FieldId| self.sums.iter().any(|(_, known)| known == field);
                match fields.iter().find(|field| !summed(field)) {
                    None => Ok(ExprKind::Coefficient(index)),
                    Some(field) => Err(self.one_per_mode(*field, name, span)),
                }
            }
            Scope::Coefficient(_) => Err(Diagnostic::error(format!(
                "the coefficient `{name}` is not known yet"
            ))
            .at(span, "refers to itself or to a later entry")
            .help("a coefficient refers to those listed before it")),
            _ => Err(self.out_of_scope(&quoted(name), "a coefficient", span)),
        }
    }

    fn one_per_mode(&self, field: FieldId, name: &str, span: Span) -> Diagnostic {
        let field = &self.names.fields[field].field;
        Diagnostic::error(format!(
            "the coefficient `{name}` is one for each mode of `{field}`"
        ))
        .at(span, "of which mode?")
        .help(format!(
            "use it inside sum(i, {field}, ...) or with each = \"{field}[i]\""
        ))
    }

    fn out_of_scope(&self, what: &str, kind: &str, span: Span) -> Diagnostic {
        let rule = match self.scope {
            Scope::Factor if kind == "a state" => {
                "coefficients are factors of accelerations, by coordinates, rates and inputs"
            }
            Scope::Parameters => "this expression may hold parameters only",
            Scope::Coefficient(_) => "a coefficient holds parameters and earlier coefficients",
            Scope::Motion | Scope::Factor => "coefficients are names for results, not for input",
        };
        let label = if what == "`t`" {
            "this is the time".to_owned()
        } else {
            format!("this is {kind}")
        };
        Diagnostic::error(format!("{what} cannot be used here"))
            .at(span, label)
            .help(rule)
    }

    fn field(&self, field: FieldId, name: &str, span: Span) -> ResolvedKind {
        if self.domains.last() == Some(&field) {
            return Ok(ExprKind::Field(field));
        }
        Err(
            Diagnostic::error(format!("the field `{name}` is a function of the position"))
                .at(span, "stands outside integral(...) and at(...)")
                .help(format!(
                    "write at({name}, PLACE) for its value at a place, or integral(..., {name})"
                )),
        )
    }

    fn position(&self, name: &str, span: Span) -> ResolvedKind {
        match self.domains.last() {
            Some(&field) if self.names.fields[field].along == name => Ok(ExprKind::Position(field)),
            _ => Err(
                Diagnostic::error(format!("the position `{name}` has no value here"))
                    .at(span, "stands outside its field's functions")
                    .help(format!(
                        "`{name}` is known inside integral(..., FIELD) and at(...) only"
                    )),
            ),
        }
    }

    fn unknown(&self, name: &str, span: Span) -> Diagnostic {
        let diagnostic = Diagnostic::error(format!("unknown name {}", quoted(name)));
        if callable().any(|known| known == name) {
            return Diagnostic::error(format!("the function `{name}` has no arguments"))
                .at(span, "here")
                .help(format!("write {name}(...)"));
        }
        let modes = name.rsplit_once('_').map(|(stem, _)| stem);
        if let Some(Symbol::Modes(field)) = modes.and_then(|stem| self.names.get(stem)) {
            let names = &self.names.fields[field];
            let (field, modes) = (&names.field, &names.modes);
            return diagnostic
                .at(span, "a single mode cannot be used")
                .help(format!(
                    "the order is open: write sum(i, {field}, ... {modes}[i] ...)"
                ));
        }
        if self.names.is_observable(name) {
            return diagnostic.at(span, "this is an observable").help(
                "observables are reported only: give the expression a name in [definitions]",
            );
        }
        let rate = name
            .strip_suffix("_dot")
            .filter(|stem| self.names.get(stem).is_some());
        let help = match rate {
            Some(stem) => Some(format!("a rate is written dot({stem})")),
            None => did_you_mean(name, self.names.known().chain(["t", "pi"])),
        };
        diagnostic.at(span, "not declared").help_if(help)
    }

    /// `q[i]` or `phi[i]`.
    fn element(&self, name: &str, span: Span, index: &str, index_span: Span) -> ResolvedKind {
        let Some((_, field)) = self.sums.iter().rev().find(|(known, _)| known == index) else {
            return Err(
                Diagnostic::error(format!("the index {} is not known", quoted(index)))
                    .at(index_span, "no sum over it here")
                    .help(format!(
                        "modes appear inside a sum: sum({index}, w, {name}[{index}])"
                    )),
            );
        };
        let names = &self.names.fields[*field];
        if name == "phi" {
            if self.domains.last() == Some(field) {
                return Ok(ExprKind::ModeShape(*field));
            }
            return Err(
                Diagnostic::error("the mode shape `phi` is a function of the position")
                    .at(span, "stands outside integral(...) and at(...)"),
            );
        }
        if name != names.modes {
            let (modes, field) = (&names.modes, &names.field);
            return Err(Diagnostic::error(format!("{} has no modes", quoted(name)))
                .at(span, format!("`{index}` counts the modes of `{field}`"))
                .help(format!("write {modes}[{index}] or phi[{index}]")));
        }
        if matches!(self.scope, Scope::Motion | Scope::Factor) {
            Ok(ExprKind::ModeCoordinate(*field))
        } else {
            Err(self.out_of_scope(&quoted(name), "a mode coordinate", span))
        }
    }

    fn call(
        &mut self,
        name: &str,
        name_span: Span,
        span: Span,
        arguments: &[Syntax],
    ) -> ResolvedKind {
        if FORMS.contains(&name) {
            return self.form(name, name_span, span, arguments);
        }
        let Some(function) = Function::named(name) else {
            return Err(self.unknown_function(name, name_span));
        };
        let expected = function.arguments();
        if arguments.len() != expected.len() {
            let usage = format!("{name}({})", expected.join(", "));
            return Err(wrong_count(name, span, arguments.len(), &usage));
        }
        let arguments = arguments.iter().map(|argument| self.resolve(argument));
        Ok(ExprKind::Call(
            function,
            arguments.collect::<Result<_, _>>()?,
        ))
    }

    fn unknown_function(&self, name: &str, span: Span) -> Diagnostic {
        if let Some(symbol) = self.names.get(name) {
            return Diagnostic::error(format!("`{name}` is {}, not a function", symbol.kind()))
                .at(span, "called like a function")
                .help(format!("products are written out: {name}*(...)"));
        }
        if VECTOR_FUNCTIONS.contains(&name) {
            return vectors_elsewhere(span);
        }
        let help = match written_here(name) {
            Some(help) => Some(help.to_owned()),
            None => did_you_mean(name, callable().chain(VECTOR_FUNCTIONS)),
        };
        Diagnostic::error(format!("unknown function {}", quoted(name)))
            .at(span, "not known")
            .help_if(help)
    }
}

/// The finding that there are no vectors here.
fn vectors_elsewhere(span: Span) -> Diagnostic {
    Diagnostic::error("a vector cannot be used here")
        .at(span, "expected a scalar")
        .help(
            "vectors stand in [definitions], energies, [forces], [constraints], [observables], \
             [frames] and [bodies]",
        )
}

/// The finding that a call has the wrong number of arguments.
pub(super) fn wrong_count(name: &str, span: Span, count: usize, usage: &str) -> Diagnostic {
    let plural = if count == 1 { "" } else { "s" };
    Diagnostic::error(format!("`{name}` does not take {count} argument{plural}"))
        .at(span, "here")
        .help(format!("write {usage}"))
}
