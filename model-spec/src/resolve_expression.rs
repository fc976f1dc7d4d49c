//! From the syntax tree of an expression to an expression with every name looked up. What
//! a name may stand for depends on where the expression stands ([`Scope`]) and, along a
//! field, on the enclosing `integral`, `at` and `sum`. Units are not looked at here.

use crate::ast::{Syntax, SyntaxKind};
use crate::diagnostic::{Diagnostic, quoted};
use crate::functions::{FORMS, callable};
use crate::model::{Expr, ExprKind, Function};
use crate::names::{Names, Symbol};
use crate::span::Span;
use crate::suggest::did_you_mean;

/// The highest derivative by the position.
const MAX_DERIVATIVE: f64 = 4.0;

/// Where an expression stands, hence what it may hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// Parameters only: parameters' own expressions, initial values, places along a field.
    Parameters,
    /// Anything but coefficients: definitions, energies, forces, observables.
    Motion,
    /// Parameters, integrals of them, and coefficients before this one.
    Coefficient(usize),
    /// What a coefficient multiplies: as `Motion`, and mode coordinates without an index.
    Factor,
}

/// Looks up the names of one expression.
pub struct Resolver<'n> {
    names: &'n Names,
    scope: Scope,
    /// Fields whose position may be used, innermost last.
    domains: Vec<usize>,
    /// Indices of the enclosing sums and their fields, innermost last.
    sums: Vec<(String, usize)>,
}

type Resolved = Result<ExprKind, Diagnostic>;

impl<'n> Resolver<'n> {
    /// A resolver for expressions that stand in `scope`.
    pub fn new(names: &'n Names, scope: Scope) -> Self {
        Self {
            names,
            scope,
            domains: Vec::new(),
            sums: Vec::new(),
        }
    }

    /// The same for an expression that is given for each mode of a field, by its index.
    pub fn for_each(mut self, each: Option<(String, usize)>) -> Self {
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
            SyntaxKind::Negate(operand) => ExprKind::Negate(Box::new(self.resolve(operand)?)),
            SyntaxKind::Binary(operator, left, right) => {
                let left = Box::new(self.resolve(left)?);
                ExprKind::Binary(*operator, left, Box::new(self.resolve(right)?))
            }
        };
        Ok(Expr { kind, span })
    }

    fn name(&self, name: &str, span: Span) -> Resolved {
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
            .help(format!("write a sum over the modes: sum(i, {}, {name}[i])", self.field_of(symbol)))),
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

    fn coefficient(&self, index: usize, name: &str, span: Span) -> Resolved {
        match self.scope {
            Scope::Coefficient(own) if index < own => Ok(ExprKind::Coefficient(index)),
            Scope::Coefficient(_) => Err(Diagnostic::error(format!(
                "the coefficient `{name}` is not known yet"
            ))
            .at(span, "refers to itself or to a later entry")
            .help("a coefficient refers to those listed before it")),
            _ => Err(self.out_of_scope(&quoted(name), "a coefficient", span)),
        }
    }

    fn out_of_scope(&self, what: &str, kind: &str, span: Span) -> Diagnostic {
        let rule = match self.scope {
            Scope::Parameters => "this expression may hold parameters only",
            Scope::Coefficient(_) => "a coefficient holds parameters and earlier coefficients",
            Scope::Motion | Scope::Factor => "coefficients are names for results, not for input",
        };
        let label = if what == "`t`" { "this is the time".to_owned() } else { format!("this is {kind}") };
        Diagnostic::error(format!("{what} cannot be used here")).at(span, label).help(rule)
    }

    fn field(&self, field: usize, name: &str, span: Span) -> Resolved {
        if self.domains.last() == Some(&field) {
            return Ok(ExprKind::Field(field));
        }
        Err(Diagnostic::error(format!("the field `{name}` is a function of the position"))
            .at(span, "stands outside integral(...) and at(...)")
            .help(format!("write at({name}, PLACE) for its value at a place, or integral(..., {name})")))
    }

    fn position(&self, name: &str, span: Span) -> Resolved {
        match self.domains.last() {
            Some(&field) if self.names.fields[field].along == name => {
                Ok(ExprKind::Position(field))
            }
            _ => Err(Diagnostic::error(format!("the position `{name}` has no value here"))
                .at(span, "stands outside its field's functions")
                .help(format!("`{name}` is known inside integral(..., FIELD) and at(...) only"))),
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
                .help(format!("the order is open: write sum(i, {field}, ... {modes}[i] ...)"));
        }
        let rate = name.strip_suffix("_dot").filter(|stem| self.names.get(stem).is_some());
        let help = match rate {
            Some(stem) => Some(format!("a rate is written dot({stem})")),
            None => did_you_mean(name, self.names.known().chain(["t", "pi"])),
        };
        diagnostic.at(span, "not declared").help_if(help)
    }

    /// `q[i]` or `phi[i]`.
    fn element(&self, name: &str, span: Span, index: &str, index_span: Span) -> Resolved {
        let Some((_, field)) = self.sums.iter().rev().find(|(known, _)| known == index) else {
            return Err(Diagnostic::error(format!("the index {} is not known", quoted(index)))
                .at(index_span, "no sum over it here")
                .help(format!("modes appear inside a sum: sum({index}, w, {name}[{index}])")));
        };
        let names = &self.names.fields[*field];
        if name == "phi" {
            if self.domains.last() == Some(field) {
                return Ok(ExprKind::ModeShape(*field));
            }
            return Err(Diagnostic::error("the mode shape `phi` is a function of the position")
                .at(span, "stands outside integral(...) and at(...)"));
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

    fn call(&mut self, name: &str, name_span: Span, span: Span, arguments: &[Syntax]) -> Resolved {
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
        Ok(ExprKind::Call(function, arguments.collect::<Result<_, _>>()?))
    }

    fn unknown_function(&self, name: &str, span: Span) -> Diagnostic {
        if let Some(symbol) = self.names.get(name) {
            return Diagnostic::error(format!("`{name}` is {}, not a function", symbol.kind()))
                .at(span, "called like a function")
                .help(format!("products are written out: {name}*(...)"));
        }
        let help = match name {
            "log" => Some("the natural logarithm is ln".to_owned()),
            "pow" => Some("a power is written x^2".to_owned()),
            "ddt" | "der" | "derivative" => Some("a rate is written dot(x)".to_owned()),
            _ => did_you_mean(name, callable()),
        };
        Diagnostic::error(format!("unknown function {}", quoted(name)))
            .at(span, "not known")
            .help_if(help)
    }

    fn form(&mut self, name: &str, name_span: Span, span: Span, arguments: &[Syntax]) -> Resolved {
        let motion = matches!(self.scope, Scope::Motion | Scope::Factor);
        if self.scope == Scope::Parameters || (name == "dot" && !motion) {
            let what = format!("{name}(...)");
            return Err(self.out_of_scope(&quoted(&what), "no number known beforehand", name_span));
        }
        match (name, arguments) {
            ("dot", [operand]) => self.dot(operand),
            ("dot", _) => Err(wrong_count(name, span, arguments.len(), "dot(x)")),
            ("diff", [value, along]) => self.diff(value, along, 1),
            ("diff", [value, along, times]) => self.diff(value, along, derivative_order(times)?),
            ("diff", _) => Err(wrong_count(name, span, arguments.len(), "diff(w, x, 2)")),
            ("at", [value, place]) => self.at(value, place),
            ("at", _) => Err(wrong_count(name, span, arguments.len(), "at(w, l)")),
            ("integral", [integrand, field]) => self.integral(integrand, field),
            ("integral", _) => Err(wrong_count(name, span, arguments.len(), "integral(w^2, w)")),
            ("sum", [index, field, summand]) => self.sum(index, field, summand),
            _ => Err(wrong_count(name, span, arguments.len(), "sum(i, w, q[i]^2)")),
        }
    }

    fn dot(&mut self, operand: &Syntax) -> Resolved {
        let resolved = self.resolve(operand)?;
        let span = operand.span;
        match resolved.kind {
            ExprKind::Coordinate(_)
            | ExprKind::Definition(_)
            | ExprKind::Field(_)
            | ExprKind::ModeCoordinate(_) => Ok(ExprKind::Dot(Box::new(resolved))),
            ExprKind::Diff(inner, times) if matches!(inner.kind, ExprKind::Field(_)) => {
                let kind = ExprKind::Dot(inner);
                Ok(ExprKind::Diff(Box::new(Expr { kind, span }), times))
            }
            ExprKind::Dot(_) => Err(Diagnostic::error("dot(dot(...)) is an acceleration")
                .at(span, "already a rate")
                .help("accelerations follow from the energies and appear nowhere in them")),
            ExprKind::Input(_) => Err(Diagnostic::error("the rate of an input is not known")
                .at(span, "this is an input")),
            ExprKind::At { .. } => Err(not_moving(span, "an expression")
                .help("write the rate inside: at(dot(w), l)")),
            ExprKind::Parameter(_) | ExprKind::Number(_) | ExprKind::Pi | ExprKind::ModeShape(_) => {
                Err(not_moving(span, "a constant"))
            }
            ExprKind::Time | ExprKind::Position(_) => Err(not_moving(span, "no coordinate")),
            _ => Err(not_moving(span, "an expression")
                .help("name the expression in [definitions] and write dot(NAME)")),
        }
    }

    fn diff(&mut self, value: &Syntax, along: &Syntax, times: u8) -> Resolved {
        let resolved = self.resolve(value)?;
        let Some(field) = field_of(&resolved) else {
            return Err(Diagnostic::error("diff() takes a field, its rate or a mode shape")
                .at(value.span, "not one of them")
                .help("write diff(w, x, 2), diff(dot(w), x, 1) or diff(phi[i], x, 2)"));
        };
        let names = &self.names.fields[field];
        if !matches!(&along.kind, SyntaxKind::Name(name) if *name == names.along) {
            let (field, along_name) = (&names.field, &names.along);
            return Err(Diagnostic::error("diff() is by the position along the field")
                .at(along.span, "not the position")
                .help(format!("the position along `{field}` is `{along_name}`")));
        }
        let (inner, before) = match resolved.kind {
            ExprKind::Diff(inner, before) => (inner, before),
            _ => (Box::new(resolved), 0),
        };
        let total = before.saturating_add(times);
        if f64::from(total) > MAX_DERIVATIVE {
            return Err(derivative_range(value.span));
        }
        Ok(ExprKind::Diff(inner, total))
    }

    fn at(&mut self, value: &Syntax, place: &Syntax) -> Resolved {
        let field = self.field_in(value)?;
        let value = self.within(field, value)?;
        let mut outside = Resolver::new(self.names, Scope::Parameters);
        let position = Box::new(outside.resolve(place)?);
        Ok(ExprKind::At {
            field,
            value,
            position,
        })
    }

    fn integral(&mut self, integrand: &Syntax, field: &Syntax) -> Resolved {
        let field = self.field_named(field)?;
        let integrand = self.within(field, integrand)?;
        Ok(ExprKind::Integral { field, integrand })
    }

    /// An expression in which the position along `field` has a meaning.
    fn within(&mut self, field: usize, syntax: &Syntax) -> Result<Box<Expr>, Diagnostic> {
        self.domains.push(field);
        let resolved = self.resolve(syntax);
        self.domains.pop();
        resolved.map(Box::new)
    }

    fn sum(&mut self, index: &Syntax, field: &Syntax, summand: &Syntax) -> Resolved {
        let SyntaxKind::Name(name) = &index.kind else {
            return Err(Diagnostic::error("a sum begins with the name of its index")
                .at(index.span, "not a name")
                .help("write sum(i, w, q[i]^2)"));
        };
        if let Some(symbol) = self.names.get(name) {
            return Err(Diagnostic::error(format!("the index `{name}` is {} too", symbol.kind()))
                .at(index.span, "choose another name"));
        }
        let field_index = self.field_named(field)?;
        if self.sums.iter().any(|(_, known)| *known == field_index) {
            return Err(Diagnostic::error("a sum inside a sum over the same field")
                .at(field.span, "this field's modes are summed over already"));
        }
        self.sums.push((name.clone(), field_index));
        let summand = self.resolve(summand);
        self.sums.pop();
        Ok(ExprKind::Sum {
            field: field_index,
            summand: Box::new(summand?),
        })
    }

    fn field_named(&self, syntax: &Syntax) -> Result<usize, Diagnostic> {
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
        Err(Diagnostic::error("the name of a field is expected")
            .at(syntax.span, "not a field")
            .help(help))
    }

    /// The one field an expression of the position belongs to.
    fn field_in(&self, syntax: &Syntax) -> Result<usize, Diagnostic> {
        let mut named = Vec::new();
        let mut positions = Vec::new();
        self.fields_of(syntax, &mut named, &mut positions);
        let mut candidates = if named.is_empty() { positions } else { named };
        candidates.sort_unstable();
        candidates.dedup();
        match candidates.as_slice() {
            [only] => Ok(*only),
            [] => Err(Diagnostic::error("at() takes an expression in a field")
                .at(syntax.span, "no field in it")
                .help("write at(w, l) or at(diff(w, x, 1), l)")),
            _ => Err(Diagnostic::error("at() of more than one field")
                .at(syntax.span, "which field's position?")
                .help("write one at(...) for each field")),
        }
    }

    /// Fields named in an expression, and fields along whose position it uses.
    fn fields_of(&self, syntax: &Syntax, named: &mut Vec<usize>, positions: &mut Vec<usize>) {
        match &syntax.kind {
            SyntaxKind::Number(_) => {}
            SyntaxKind::Name(name) => match self.names.get(name) {
                Some(Symbol::Field(field)) => named.push(field),
                Some(Symbol::Position) => {
                    let fields = self.names.fields.iter().enumerate();
                    let along = fields.filter(|(_, names)| names.along == *name);
                    positions.extend(along.map(|(field, _)| field));
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
                // What stands inside these has a position of its own.
                if function != "integral" && function != "at" {
                    for argument in arguments {
                        self.fields_of(argument, named, positions);
                    }
                }
            }
            SyntaxKind::Negate(operand) => self.fields_of(operand, named, positions),
            SyntaxKind::Binary(_, left, right) => {
                self.fields_of(left, named, positions);
                self.fields_of(right, named, positions);
            }
        }
    }
}

/// The field of `w`, `dot(w)`, `phi[i]` and their derivatives.
fn field_of(expr: &Expr) -> Option<usize> {
    match &expr.kind {
        ExprKind::Field(field) | ExprKind::ModeShape(field) => Some(*field),
        ExprKind::Dot(inner) | ExprKind::Diff(inner, _) => field_of(inner),
        _ => None,
    }
}

fn derivative_order(syntax: &Syntax) -> Result<u8, Diagnostic> {
    match syntax.kind {
        SyntaxKind::Number(value)
            if value.fract() == 0.0 && (1.0..=MAX_DERIVATIVE).contains(&value) =>
        {
            Ok(value as u8)
        }
        _ => Err(derivative_range(syntax.span)),
    }
}

fn derivative_range(span: Span) -> Diagnostic {
    Diagnostic::error("a derivative by the position is of order 1, 2, 3 or 4")
        .at(span, "not one of them")
}

fn not_moving(span: Span, what: &str) -> Diagnostic {
    Diagnostic::error("dot() takes a coordinate, a definition or a field")
        .at(span, format!("this is {what}, it has no rate of its own"))
}

fn wrong_count(name: &str, span: Span, count: usize, usage: &str) -> Diagnostic {
    let plural = if count == 1 { "" } else { "s" };
    Diagnostic::error(format!("`{name}` does not take {count} argument{plural}"))
        .at(span, "here")
        .help(format!("write {usage}"))
}
