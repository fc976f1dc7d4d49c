//! Edits a specification: adds terms, parameters, coordinates and states, replaces expressions in terms, and sets
//! numbers. Comments, order and layout of the other text are kept. The result is checked.

mod insert;
mod prescribe;
mod set;
mod substitute;

use toml_edit::DocumentMut;

use crate::diagnostic::{Diagnostic, Diagnostics, quote};
use crate::load::check;
use crate::source::Source;

/// Section of named expressions.
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
    /// `[states]`, with their rates as expressions
    States,
}

impl Section {
    /// Returns the key in the file.
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

    /// Returns the key of the expression in an entry that is a table.
    fn expression_key(self) -> &'static str {
        match self {
            Self::States => "rate",
            _ => "value",
        }
    }
}

/// Number or expression.
#[derive(Clone, Debug, PartialEq)]
pub enum NewValue {
    /// Finite number in the declared unit.
    Number(f64),
    /// Expression in SI.
    Expression(String),
}

/// One edit. Empty texts (`doc`, `source`) are omitted.
#[derive(Clone, Debug, PartialEq)]
pub enum Edit {
    /// Adds a term to an energy, the dissipation, the definitions or the observables.
    AddTerm(NewTerm),
    /// Adds a parameter.
    AddParameter(NewParameter),
    /// Adds a coordinate.
    AddCoordinate(NewCoordinate),
    /// Adds a first-order state.
    AddState(NewState),
    /// Adds a force.
    AddForce(NewForce),
    /// Replaces an expression inside terms.
    Substitute(Substitution),
    /// Sets the value of an existing parameter to a number.
    SetParameter(SetParameter),
    /// Sets gain, bias and delay of a sensor.
    SetSensor(SetSensor),
    /// Replaces an input by an expression.
    PrescribeInput(PrescribeInput),
    /// Removes all controllers.
    RemoveControllers,
}

/// Input given by an expression. If the expression contains only numbers and `t`, it gives the
/// input in its unit, with `t` in s. Otherwise the units have to match.
#[derive(Clone, Debug, PartialEq)]
pub struct PrescribeInput {
    /// Name of the input, which becomes the name of the definition.
    pub name: String,
    /// Expression.
    pub value: String,
}

/// New number of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct SetParameter {
    /// Name of the parameter.
    pub name: String,
    /// Finite number in the declared unit; it also replaces an expression.
    pub value: f64,
    /// Origin of the number; if it is empty, the existing origin is kept.
    pub source: String,
}

/// Model of a sensor: measured(t) = gain * quantity(t - delay) + bias.
#[derive(Clone, Debug, PartialEq)]
pub struct SetSensor {
    /// Name of the channel.
    pub channel: String,
    /// Observable that the sensor measures.
    pub observable: String,
    /// Gain, dimensionless.
    pub gain: f64,
    /// Bias in the channel's SI unit.
    pub bias: f64,
    /// Delay in s; negative for an early signal.
    pub delay: f64,
}

/// New term.
#[derive(Clone, Debug, PartialEq)]
pub struct NewTerm {
    /// Section, except `Forces` and `States`, whose entries need more than a value.
    pub section: Section,
    /// Name, not yet used in the section.
    pub name: String,
    /// Expression.
    pub value: String,
    /// Description.
    pub doc: String,
    /// Origin.
    pub source: String,
}

/// New parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct NewParameter {
    /// Name.
    pub name: String,
    /// Value.
    pub value: NewValue,
    /// Unit.
    pub unit: String,
    /// Description.
    pub doc: String,
    /// Origin of the value.
    pub source: String,
}

/// New coordinate.
#[derive(Clone, Debug, PartialEq)]
pub struct NewCoordinate {
    /// Name.
    pub name: String,
    /// Unit, coherent SI.
    pub unit: String,
    /// Description.
    pub doc: String,
    /// Initial value; 0 if absent.
    pub initial: Option<NewValue>,
}

/// New first-order state, with the initial value 0.
#[derive(Clone, Debug, PartialEq)]
pub struct NewState {
    /// Name.
    pub name: String,
    /// Unit, coherent SI.
    pub unit: String,
    /// Rate, in the state's unit per s.
    pub rate: String,
    /// Description.
    pub doc: String,
}

/// New force.
#[derive(Clone, Debug, PartialEq)]
pub struct NewForce {
    /// Name.
    pub name: String,
    /// Coordinate or displacement that the force acts on.
    pub on: String,
    /// Expression.
    pub value: String,
    /// Description.
    pub doc: String,
    /// Origin.
    pub source: String,
}

/// Replacement of an expression in the values of named terms. Each of the terms must contain the expression.
/// Expressions are compared as syntax trees, so spaces and redundant brackets have no effect, but the order of
/// operands has.
#[derive(Clone, Debug, PartialEq)]
pub struct Substitution {
    /// Section of the terms.
    pub section: Section,
    /// Names of the terms.
    pub terms: Vec<String>,
    /// Expression to be replaced.
    pub find: String,
    /// Replacement.
    pub replace: String,
}

/// Error of an edit.
#[derive(Clone, Debug)]
pub enum EditError {
    /// The text is not TOML, or the edited text is not a valid specification.
    Invalid(Diagnostics),
    /// The section has an entry of this name.
    NameTaken {
        /// Section.
        section: String,
        /// Name.
        name: String,
    },
    /// The section has no entry of this name.
    MissingTerm {
        /// Section.
        section: String,
        /// Name.
        name: String,
    },
    /// The term does not contain the expression to be replaced.
    MissingExpression {
        /// Section of the term.
        section: String,
        /// Name of the term.
        name: String,
        /// Expression that was not found.
        find: String,
    },
    /// An expression of the edit or of the term has a syntax error.
    Expression {
        /// Expression.
        text: String,
        /// Error; its positions are byte offsets in the expression.
        diagnostic: Box<Diagnostic>,
    },
    /// A value of the edit is not a finite number.
    NotFinite {
        /// Name of the entry.
        name: String,
    },
}

impl std::fmt::Display for EditError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Invalid(diagnostics) => write!(f, "{diagnostics}"),
            Self::NameTaken { section, name } => {
                write!(f, "[{section}] already contains {}", quote(name))
            }
            Self::MissingTerm { section, name } => {
                write!(f, "[{section}] does not contain {}", quote(name))
            }
            Self::MissingExpression {
                section,
                name,
                find,
            } => write!(
                f,
                "{} in [{section}] does not contain {}",
                quote(name),
                quote(find)
            ),
            Self::Expression { text, diagnostic } => {
                write!(f, "{}: {}", quote(text), diagnostic.message)?;
                match &diagnostic.help {
                    Some(help) => write!(f, " ({help})"),
                    None => Ok(()),
                }
            }
            Self::NotFinite { name } => write!(f, "the value of {} is not finite", quote(name)),
        }
    }
}

impl std::error::Error for EditError {}

/// Returns the text of a specification after all edits, in order. The result passes
/// [`crate::check`].
///
/// # Errors
/// The target of an edit is missing or already exists, or the result is invalid (all errors are returned).
pub fn apply(source: &Source, edits: &[Edit]) -> Result<String, EditError> {
    let parsed: Result<DocumentMut, _> = source.text.parse();
    let Ok(mut document) = parsed else {
        return match check(source.clone()) {
            Err(diagnostics) => Err(EditError::Invalid(diagnostics)),
            Ok(_) => Ok(source.text.to_string()),
        };
    };
    for edit in edits {
        apply_one(&mut document, edit)?;
    }
    let text = restore_line_ends(&source.text, document.to_string());
    let edited = source.with_text(text.as_str());
    check(edited).map_err(EditError::Invalid)?;
    Ok(text)
}

/// Restores the line ends and the byte order mark of the original, which the TOML writer drops.
/// A file with mixed line ends gets `\
/// `.
fn restore_line_ends(original: &str, edited: String) -> String {
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

fn apply_one(document: &mut DocumentMut, edit: &Edit) -> Result<(), EditError> {
    match edit {
        Edit::AddTerm(term) => insert::insert_term(document, term),
        Edit::AddParameter(parameter) => insert::insert_parameter(document, parameter),
        Edit::AddCoordinate(coordinate) => insert::insert_coordinate(document, coordinate),
        Edit::AddState(state) => insert::insert_state(document, state),
        Edit::AddForce(force) => insert::insert_force(document, force),
        Edit::Substitute(substitution) => substitute::substitute(document, substitution),
        Edit::SetParameter(parameter) => set::set_parameter(document, parameter),
        Edit::SetSensor(sensor) => set::set_sensor(document, sensor),
        Edit::PrescribeInput(input) => prescribe::prescribe(document, input),
        Edit::RemoveControllers => {
            document.remove("controllers");
            Ok(())
        }
    }
}
