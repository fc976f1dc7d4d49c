//! Tables `[initial]` and `[windows]`: initial states and windows of the records.

use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics, quote};
use eomgen_model_spec::dimension::Dimension;
use eomgen_model_spec::quantity::{Name, Number, StringValue};
use eomgen_model_spec::record::Record;
use eomgen_model_spec::suggest::did_you_mean;
use eomgen_model_spec::table::Entry;
use eomgen_model_spec::unit::Unit;

use super::keys;

/// Table `[initial]`.
#[derive(Debug, Default)]
pub enum InitialState {
    /// Initial values of the model, at rest.
    Rest,
    /// Unknown initial state.
    #[default]
    Estimate,
    /// Values of states by name.
    Values(Vec<(Name, Number)>),
}

/// Table `[windows]`.
#[derive(Debug, Default)]
pub struct Windows {
    /// Length of a window in s; `None` for one window per record.
    pub length: Option<Number>,
    /// True if initial states are read from the smoothed record.
    pub is_smoothed: bool,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum InitialWord {
    Rest,
    Estimate,
    Given,
}

pub(super) fn read_initial(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<InitialState> {
    let record = Record::read(entry, &keys::INITIAL, found)?;
    let state = record.require("state", found)?.clone();
    if state.is_table() {
        return read_values(&state, found);
    }
    let words = [
        ("rest", InitialWord::Rest),
        ("estimate", InitialWord::Estimate),
        ("given", InitialWord::Given),
    ];
    let word = found.push_error(state.keyword(&words))?;
    let values = record.get("values");
    match (word, values) {
        (InitialWord::Given, Some(values)) => read_values(values, found),
        (InitialWord::Given, None) => {
            found.push(
                Diagnostic::error("no state is given")
                    .with_span(state.span(), "`values` are missing")
                    .with_help("write [initial.values] with the states by name, in SI"),
            );
            None
        }
        (_, Some(values)) => {
            found.push(
                Diagnostic::error("`values` are not used")
                    .with_span(values.name.span, "only used with state = \"given\"")
                    .with_related_span(state.span(), "beside this")
                    .with_help("write state = \"given\", or remove the values"),
            );
            None
        }
        (InitialWord::Rest, None) => Some(InitialState::Rest),
        (InitialWord::Estimate, None) => Some(InitialState::Estimate),
    }
}

fn read_values(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<InitialState> {
    let values = found.push_error(entry.table("{ x = 0.1 }"))?;
    if values.is_empty() {
        found.push(
            Diagnostic::error("no state is given")
                .with_span(entry.span(), "empty table")
                .with_help("give states by name in SI, such as x = 0.1"),
        );
    }
    let mut given = Vec::with_capacity(values.len());
    for value in values {
        given.push((value.name.clone(), found.push_error(value.number())?));
    }
    Some(InitialState::Values(given))
}

/// Reads the length of a window that is given as text.
fn read_length_text(written: &StringValue) -> Result<Option<Number>, Diagnostic> {
    const RECORD: &str = "record";
    if written.text == RECORD {
        return Ok(None);
    }
    let duration = Unit::parse_quantity(&written.text);
    let duration = duration.filter(|(_, unit)| unit.dimension == Dimension::TIME);
    let help = match duration {
        Some((number, unit)) => format!("write length = {}", unit.to_si(number)),
        None => did_you_mean(&written.text, [RECORD])
            .unwrap_or_else(|| "write a number in s, such as length = 0.25".to_owned()),
    };
    Err(
        Diagnostic::error(format!("`length` cannot be {}", quote(&written.text)))
            .with_span(written.span, "expected \"record\" or a number in s")
            .with_help(help),
    )
}

pub(super) fn read_windows(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<Windows> {
    let record = Record::read(entry, &keys::WINDOWS, found)?;
    let start = |entry: &Entry<'_>| entry.keyword(&[("fitted", false), ("smoothed", true)]);
    let smoothed = record.optional("start", start, found);
    let length = record.require("length", found)?;
    let length = match length.written() {
        Ok(written) => found.push_error(read_length_text(&written)),
        Err(_) => found.push_error(length.number()).map(Some),
    };
    let length = length?;
    if let Some(length) = length.filter(|length| length.value <= 0.0) {
        found.push(
            Diagnostic::error(format!("a window cannot last {} s", length.value))
                .with_span(length.span, "expected seconds, more than 0, or \"record\""),
        );
    }
    Some(Windows {
        length,
        is_smoothed: smoothed.unwrap_or_default(),
    })
}
