//! Changes of a specification made by program: terms, parameters, coordinates and states added,
//! expressions replaced inside terms, numbers set. Comments, order and layout of everything else stay as
//! they are. What to change is decided elsewhere; the result is checked here.

mod insert;
mod prescribe;
mod set;
mod substitute;

use toml_edit::DocumentMut;

use crate::diagnostic::{Diagnostic, Diagnostics, quoted};
use crate::load::check;
use crate::source::Source;

/// A section of named expressions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Section {
    /// `[definitions]`
    Definitions,
    /// `[kinetic]`
    Kinetic,
    /// `[potential]`
    Potential,
    /// `[dissipation]`
    Dissipation,
    /// `[forces]`
    Forces,
    /// `[observables]`
    Observables,
    /// `[states]`, by their rates
    States,
}

impl Section {
    /// Its key in the file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Definitions => "definitions",
            Self::Kinetic => "kinetic",
            Self::Potential => "potential",
            Self::Dissipation => "dissipation",
            Self::Forces => "forces",
            Self::Observables => "observables",
            Self::States => "states",
        }
    }

    /// The key of an entry's expression, where the entry is a table.
    fn expression_key(self) -> &'static str {
        match self {
            Self::States => "rate",
            _ => "value",
        }
    }
}

/// A number or an expression.
#[derive(Clone, Debug, PartialEq)]
pub enum NewValue {
    /// A finite number in the declared unit.
    Number(f64),
    /// An expression in SI.
    Expression(String),
}

/// One change. Empty texts (`doc`, `source`) are left out.
#[derive(Clone, Debug, PartialEq)]
pub enum Edit {
    /// Adds a term to an energy, the dissipation, the definitions or the observables.
    AddTerm(NewTerm),
    /// Adds a parameter.
    AddParameter(NewParameter),
    /// Adds a coordinate.
    AddCoordinate(NewCoordinate),
    /// Adds a state of first order.
    AddState(NewState),
    /// Adds a force.
    AddForce(NewForce),
    /// Replaces an expression inside terms.
    Substitute(Substitution),
    /// Sets the number of a parameter that is there.
    SetParameter(SetParameter),
    /// Says what a sensor does to its channel.
    SetSensor(SetSensor),
    /// Puts an expression in the place of an input.
    PrescribeInput(PrescribeInput),
}

/// An input that follows an expression. One of numbers and `t` alone gives the input in its unit, with
/// `t` in s; in any other the units have to agree, as everywhere in a specification.
#[derive(Clone, Debug, PartialEq)]
pub struct PrescribeInput {
    /// Its name; it is a definition afterwards.
    pub name: String,
    /// The expression.
    pub value: String,
}

/// A parameter's new number, in its declared unit.
#[derive(Clone, Debug, PartialEq)]
pub struct SetParameter {
    /// Its name.
    pub name: String,
    /// A finite number in the declared unit; it takes the place of an expression too.
    pub value: f64,
    /// Where the number comes from; if empty, what is said of that stays.
    pub source: String,
}

/// What a sensor does: measured(t) = gain * quantity(t - delay) + bias.
#[derive(Clone, Debug, PartialEq)]
pub struct SetSensor {
    /// Its channel.
    pub channel: String,
    /// What it measures.
    pub observable: String,
    /// Dimensionless.
    pub gain: f64,
    /// In the channel's SI unit.
    pub bias: f64,
    /// In s, negative where the channel is early.
    pub delay: f64,
}

/// A term to be added.
#[derive(Clone, Debug, PartialEq)]
pub struct NewTerm {
    /// Where; not `Forces` or `States`, which hold more than a value.
    pub section: Section,
    /// The term's name, not yet used in the section.
    pub name: String,
    /// Its expression.
    pub value: String,
    /// What it is.
    pub doc: String,
    /// Where it comes from.
    pub source: String,
}

/// A parameter to be added.
#[derive(Clone, Debug, PartialEq)]
pub struct NewParameter {
    /// Its name.
    pub name: String,
    /// Its value.
    pub value: NewValue,
    /// Its unit.
    pub unit: String,
    /// What it is.
    pub doc: String,
    /// Where its value comes from.
    pub source: String,
}

/// A coordinate to be added.
#[derive(Clone, Debug, PartialEq)]
pub struct NewCoordinate {
    /// Its name.
    pub name: String,
    /// Its unit, coherent SI.
    pub unit: String,
    /// What it is.
    pub doc: String,
    /// Its initial value, 0 if absent.
    pub initial: Option<NewValue>,
}

/// A state of first order to be added; it begins at 0.
#[derive(Clone, Debug, PartialEq)]
pub struct NewState {
    /// Its name.
    pub name: String,
    /// Its unit, coherent SI.
    pub unit: String,
    /// Its rate, in its unit per s.
    pub rate: String,
    /// What it is.
    pub doc: String,
}

/// A force to be added.
#[derive(Clone, Debug, PartialEq)]
pub struct NewForce {
    /// Its name.
    pub name: String,
    /// What it works on.
    pub on: String,
    /// Its value.
    pub value: String,
    /// What it is.
    pub doc: String,
    /// Where it comes from.
    pub source: String,
}

/// An expression to be replaced by another wherever it occurs inside the values of named
/// terms; each of the terms must hold it. Expressions are compared as syntax trees: spaces
/// and superfluous brackets do not matter, the order of operands does.
#[derive(Clone, Debug, PartialEq)]
pub struct Substitution {
    /// Where the terms are.
    pub section: Section,
    /// Their names.
    pub terms: Vec<String>,
    /// What is to be replaced.
    pub find: String,
    /// What takes its place.
    pub replace: String,
}

/// Why an edit could not be made.
#[derive(Clone, Debug)]
pub enum EditError {
    /// The text is not TOML, or the edited text is not a valid specification.
    Invalid(Diagnostics),
    /// The section has an entry of this name already.
    Taken {
        /// The section.
        section: String,
        /// The name.
        name: String,
    },
    /// The section has no entry of this name.
    MissingTerm {
        /// The section.
        section: String,
        /// The name.
        name: String,
    },
    /// The term does not hold the expression to be replaced.
    MissingExpression {
        /// The term's section.
        section: String,
        /// The term.
        name: String,
        /// What was looked for.
        find: String,
    },
    /// An expression of the edit or of the term cannot be read.
    Expression {
        /// The expression.
        text: String,
        /// What is wrong with it, its places being bytes of the expression.
        diagnostic: Box<Diagnostic>,
    },
    /// A value of the edit is not a finite number.
    NotFinite {
        /// The name it was for.
        name: String,
    },
}

impl std::fmt::Display for EditError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Invalid(diagnostics) => write!(f, "{diagnostics}"),
            Self::Taken { section, name } => write!(f, "[{section}] has {} already", quoted(name)),
            Self::MissingTerm { section, name } => write!(f, "[{section}] has no {}", quoted(name)),
            Self::MissingExpression {
                section,
                name,
                find,
            } => write!(
                f,
                "{} of [{section}] does not hold {}",
                quoted(name),
                quoted(find)
            ),
            Self::Expression { text, diagnostic } => {
                write!(f, "{}: {}", quoted(text), diagnostic.message)?;
                match &diagnostic.help {
                    Some(help) => write!(f, " ({help})"),
                    None => Ok(()),
                }
            }
            Self::NotFinite { name } => write!(f, "the value of {} is not finite", quoted(name)),
        }
    }
}

impl std::error::Error for EditError {}

/// The text of a specification after all edits, in order. The result passes
/// [`crate::check`].
///
/// # Errors
/// The first edit whose place is missing or taken; or all that is wrong with the result.
pub fn apply(source: &Source, edits: &[Edit]) -> Result<String, EditError> {
    let parsed: Result<DocumentMut, _> = source.text.parse();
    let Ok(mut document) = parsed else {
        return match check(source.clone()) {
            Err(diagnostics) => Err(EditError::Invalid(diagnostics)),
            Ok(_) => Ok(source.text.to_string()),
        };
    };
    for edit in edits {
        make(&mut document, edit)?;
    }
    let text = restored(&source.text, document.to_string());
    let edited = source.edited(text.as_str());
    check(edited).map_err(EditError::Invalid)?;
    Ok(text)
}

/// The edited text with the line ends and the byte order mark of the original, which
/// TOML's writer drops. A file of mixed line ends gets plain ones.
fn restored(original: &str, edited: String) -> String {
    let lines = original.matches('\n').count();
    let text = if lines > 0 && original.matches("\r\n").count() == lines {
        edited.replace('\n', "\r\n")
    } else {
        edited
    };
    let mark = '\u{feff}';
    if original.starts_with(mark) && !text.starts_with(mark) {
        format!("{mark}{text}")
    } else {
        text
    }
}

fn make(document: &mut DocumentMut, edit: &Edit) -> Result<(), EditError> {
    match edit {
        Edit::AddTerm(term) => insert::term(document, term),
        Edit::AddParameter(parameter) => insert::parameter(document, parameter),
        Edit::AddCoordinate(coordinate) => insert::coordinate(document, coordinate),
        Edit::AddState(state) => insert::state(document, state),
        Edit::AddForce(force) => insert::force(document, force),
        Edit::Substitute(substitution) => substitute::substitute(document, substitution),
        Edit::SetParameter(parameter) => set::parameter(document, parameter),
        Edit::SetSensor(sensor) => set::sensor(document, sensor),
        Edit::PrescribeInput(input) => prescribe::prescribe(document, input),
    }
}
