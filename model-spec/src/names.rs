//! Declares the names of a specification. Checks that they are valid identifiers and unique,
//! including generated names (`q_1`, `theta_dot`).

use std::collections::{HashMap, HashSet};

use crate::diagnostic::{Diagnostic, Diagnostics, quote};
use crate::functions::reservation_reason;
use crate::ids::{
    CoefficientId, ConstraintId, CoordinateId, DefinitionId, FieldId, InputId, ParameterId, StateId,
};
use crate::model::{MULTIPLIER, RESIDUAL};
use crate::quantity::Name;
use crate::raw::Document;
use crate::span::Span;

/// Largest length of a name, in characters.
pub const MAX_NAME: usize = 64;

/// Meaning of a name in an expression.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Symbol {
    Parameter(ParameterId),
    Coordinate(CoordinateId),
    Input(InputId),
    State(StateId),
    Field(FieldId),
    Modes(FieldId),
    /// Position along one or more fields.
    Position,
    Definition(DefinitionId),
    /// Vector, with components that are definitions.
    Vector,
    Coefficient(CoefficientId),
    Multiplier(ConstraintId),
    Residual(ConstraintId),
    /// State of a controller.
    ControllerState,
}

impl Symbol {
    /// Returns true for a quantity that may have a rate.
    pub fn moves(self) -> bool {
        matches!(
            self,
            Self::Coordinate(_)
                | Self::Input(_)
                | Self::State(_)
                | Self::Field(_)
                | Self::Definition(_)
        )
    }

    pub fn kind(self) -> &'static str {
        match self {
            Self::Parameter(_) => "a parameter",
            Self::Coordinate(_) => "a coordinate",
            Self::Input(_) => "an input",
            Self::State(_) => "a state",
            Self::Field(_) => "a field",
            Self::Modes(_) => "a field's modal coordinates",
            Self::Position => "a field's position",
            Self::Definition(_) => "a definition",
            Self::Vector => "a vector",
            Self::Coefficient(_) => "a coefficient",
            Self::Multiplier(_) => "the multiplier of a constraint",
            Self::Residual(_) => "the residual of a constraint",
            Self::ControllerState => "a state of a controller",
        }
    }
}

pub struct Names {
    symbols: HashMap<String, (Symbol, Span)>,
    observables: HashSet<String>,
    /// For each input: the input that is its rate, if given.
    input_rates: Vec<Option<InputId>>,
    pub fields: Vec<FieldNames>,
}

pub struct FieldNames {
    pub field: String,
    /// Position along the field.
    pub along: String,
    pub modes: String,
}

impl Names {
    pub fn declare(document: &Document, found: &mut Diagnostics) -> Self {
        found.push_error(check_identifier(&document.name));
        let mut names = Self {
            symbols: HashMap::new(),
            observables: HashSet::new(),
            input_rates: Vec::new(),
            fields: Vec::new(),
        };
        names.declare_quantities(document, found);
        names.declare_fields(document, found);
        for (index, definition) in document.definitions.iter().enumerate() {
            names.add(
                &definition.name,
                Symbol::Definition(DefinitionId::new(index)),
                found,
            );
        }
        for vector in &document.vectors {
            names.add(vector, Symbol::Vector, found);
        }
        for (index, coefficient) in document.coefficients.iter().enumerate() {
            names.add(
                &coefficient.name,
                Symbol::Coefficient(CoefficientId::new(index)),
                found,
            );
        }
        for (index, constraint) in document.constraints.iter().enumerate() {
            let id = ConstraintId::new(index);
            let reported = [
                (MULTIPLIER, Symbol::Multiplier(id)),
                (RESIDUAL, Symbol::Residual(id)),
            ];
            for (prefix, symbol) in reported {
                let name = Name {
                    text: format!("{prefix}{}", constraint.name.text),
                    span: constraint.name.span,
                };
                names.observables.insert(name.text.clone());
                names.add(&name, symbol, found);
            }
        }
        let controllers = document.controllers.iter();
        for state in controllers.flat_map(|controller| &controller.states) {
            names.add(&state.name, Symbol::ControllerState, found);
        }
        names.check_terms(document, found);
        names.check_observables(document, found);
        names.check_generated(document, found);
        names
    }

    pub fn get(&self, name: &str) -> Option<Symbol> {
        self.symbols.get(name).map(|(symbol, _)| *symbol)
    }

    /// Returns the input that is the rate of an input, if given.
    pub fn input_rate(&self, input: InputId) -> Option<InputId> {
        self.input_rates.get(input.index()).copied().flatten()
    }

    pub fn is_observable(&self, name: &str) -> bool {
        self.observables.contains(name)
    }

    /// Returns the names of the observables.
    pub fn observable_names(&self) -> impl Iterator<Item = &str> {
        self.observables.iter().map(String::as_str)
    }

    /// Returns true for a prescribed motion and its rates.
    pub fn is_prescribed(&self, input: InputId) -> bool {
        self.input_rate(input).is_some() || self.input_rates.contains(&Some(input))
    }

    pub fn known_names(&self) -> impl Iterator<Item = &str> {
        self.symbols.keys().map(String::as_str)
    }

    fn declare_quantities(&mut self, document: &Document, found: &mut Diagnostics) {
        for (index, parameter) in document.parameters.iter().enumerate() {
            self.add(
                &parameter.name,
                Symbol::Parameter(ParameterId::new(index)),
                found,
            );
        }
        for (index, coordinate) in document.coordinates.iter().enumerate() {
            self.add(
                &coordinate.name,
                Symbol::Coordinate(CoordinateId::new(index)),
                found,
            );
        }
        for (index, input) in document.inputs.iter().enumerate() {
            let id = InputId::new(index);
            self.add(&input.name, Symbol::Input(id), found);
            self.input_rates
                .push((input.rates > 0).then(|| InputId::new(index + 1)));
        }
        for (index, state) in document.states.iter().enumerate() {
            self.add(&state.name, Symbol::State(StateId::new(index)), found);
        }
    }

    fn declare_fields(&mut self, document: &Document, found: &mut Diagnostics) {
        for (index, field) in document.fields.iter().enumerate() {
            self.add(&field.name, Symbol::Field(FieldId::new(index)), found);
            self.add(
                &field.coordinates,
                Symbol::Modes(FieldId::new(index)),
                found,
            );
            // Fields may have positions of the same name.
            if self.get(&field.along.text) != Some(Symbol::Position) {
                self.add(&field.along, Symbol::Position, found);
            }
            self.fields.push(FieldNames {
                field: field.name.text.clone(),
                along: field.along.text.clone(),
                modes: field.coordinates.text.clone(),
            });
        }
        if !document.fields.is_empty()
            && let Some((symbol, span)) = self.symbols.get("phi")
        {
            found.push(
                Diagnostic::error("`phi` is reserved for mode shapes in a model with a field")
                    .with_span(*span, format!("declared as {}", symbol.kind()))
                    .with_help("choose another name"),
            );
        }
    }

    fn add(&mut self, name: &Name, symbol: Symbol, found: &mut Diagnostics) {
        // An invalid name is declared as well, so that one mistake gives one error.
        found.push_error(check_identifier(name));
        if let Some((other, place)) = self.symbols.get(&name.text) {
            found.push(
                name_taken_error(name, &format!("used by {}", other.kind()))
                    .with_related_span(*place, "here"),
            );
            return;
        }
        self.symbols.insert(name.text.clone(), (symbol, name.span));
    }

    /// Checks the names of terms, forces and drawings. No expression uses them, so reserved words
    /// are valid.
    fn check_terms(&self, document: &Document, found: &mut Diagnostics) {
        let terms = document.kinetic.iter();
        let terms = terms
            .chain(&document.potential)
            .chain(&document.dissipation);
        let terms = terms.chain(&document.constraints);
        let terms = terms.chain(document.impacts.iter().map(|impact| &impact.distance));
        for controller in &document.controllers {
            found.push_error(check_word(&controller.name));
        }
        for term in terms.chain(document.forces.iter().map(|(term, _)| term)) {
            found.push_error(check_word(&term.name));
        }
        if let Some(drawing) = &document.drawing {
            let points = drawing.points.iter().map(|point| &point.name);
            for name in points.chain(drawing.lines.iter().map(|line| &line.name)) {
                found.push_error(check_word(name));
            }
        }
    }

    /// Checks the observables. An observable may have the name of the definition or coefficient that is its value.
    fn check_observables(&mut self, document: &Document, found: &mut Diagnostics) {
        for (observable, _) in &document.observables {
            let name = &observable.name;
            found.push_error(check_identifier(name));
            self.observables.insert(name.text.clone());
            match self.symbols.get(&name.text) {
                None
                | Some((Symbol::Definition(_) | Symbol::Vector | Symbol::Coefficient(_), _)) => {}
                Some((other, place)) => {
                    let owner = format!("used by {}", other.kind());
                    found.push(name_taken_error(name, &owner).with_related_span(*place, "here"));
                }
            }
        }
    }

    /// Rejects declared names that are equal to generated names: `q_3`, `theta_dot`, `q_3_dot`.
    fn check_generated(&self, document: &Document, found: &mut Diagnostics) {
        let mut declared: Vec<(&str, Span)> = self
            .symbols
            .iter()
            .map(|(name, (_, span))| (name.as_str(), *span))
            .collect();
        let observables = document.observables.iter().map(|(term, _)| &term.name);
        declared.extend(observables.map(|name| (name.text.as_str(), name.span)));
        declared.sort_by_key(|(_, span)| span.start);
        for (name, span) in declared {
            if let Some(meaning) = self.generated_meaning(name) {
                found.push(
                    Diagnostic::error(format!("the name `{name}` is taken"))
                        .with_span(span, format!("it is generated for {meaning}"))
                        .with_help("choose another name"),
                );
            }
        }
    }

    fn generated_meaning(&self, name: &str) -> Option<String> {
        let (stem, what) = match name.strip_suffix("_dot") {
            Some(stem) => (stem, "the rate of"),
            None => (name, "a mode of"),
        };
        let has_rate = matches!(
            self.get(stem),
            Some(Symbol::Coordinate(_) | Symbol::State(_))
        );
        if what == "the rate of" && has_rate {
            return Some(format!("{what} `{stem}`"));
        }
        let (modes, number) = stem.rsplit_once('_')?;
        let numbered = !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit());
        let Some(Symbol::Modes(field)) = self.get(modes).filter(|_| numbered) else {
            return None;
        };
        Some(format!("{what} the field `{}`", self.fields[field].field))
    }
}

fn name_taken_error(name: &Name, owner: &str) -> Diagnostic {
    Diagnostic::error(format!("the name {} is taken", quote(&name.text)))
        .with_span(name.span, owner)
        .with_help("choose another name")
}

/// Checks that a name is an identifier in every target language.
fn check_identifier(name: &Name) -> Result<(), Diagnostic> {
    check_word(name)?;
    let text = name.text.as_str();
    match reservation_reason(text) {
        Some(why) => Err(invalid_name_error(
            name,
            format!("`{text}` cannot be a name, because it {why}"),
        )
        .with_help(format!("for example `{text}_1`"))),
        None => Ok(()),
    }
}

fn invalid_name_error(name: &Name, message: String) -> Diagnostic {
    Diagnostic::error(message).with_span(name.span, "this name")
}

/// Checks that a name consists of letters, digits and underscores.
fn check_word(name: &Name) -> Result<(), Diagnostic> {
    let text = name.text.as_str();
    let fit = text.starts_with(|first: char| first.is_ascii_alphabetic())
        && text.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_');
    if !fit {
        return Err(
            invalid_name_error(name, format!("{} cannot be a name", quote(text))).with_help(
                "a name starts with a letter a-z or A-Z, followed by letters, digits and `_`",
            ),
        );
    }
    if text.len() > MAX_NAME {
        let message = format!("the name {} is too long", quote(text));
        return Err(
            invalid_name_error(name, message).with_help(format!("at most {MAX_NAME} characters"))
        );
    }
    Ok(())
}
