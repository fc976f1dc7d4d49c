//! `[initial]` and `[windows]`: where motions begin, and how records are cut.

use eomgen_model_spec::diagnostic::{Diagnostic, Diagnostics};
use eomgen_model_spec::table::{Entry, Name, Number};

use super::keys;
use super::required::required;

/// `[initial]`
#[derive(Debug)]
pub enum InitialState {
    /// As the model says, at rest.
    Rest,
    /// Not known.
    Estimate,
    /// These states, by name.
    Given(Vec<(Name, Number)>),
}

/// `[windows]`
#[derive(Debug, Default)]
pub struct Windows {
    /// The length of a window, s; none if every record is one.
    pub length: Option<Number>,
    /// Whether initial states are read from the smoothed record.
    pub smoothed: bool,
}

/// The words of `initial.state`.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Word {
    Rest,
    Estimate,
    Given,
}

pub(super) fn initial(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<InitialState> {
    let record = entry.record(&keys::INITIAL, "{ state = \"rest\" }", found)?;
    let state = required(&record, "state", "\"rest\"", found)?.clone();
    if state.is_table() {
        return given(&state, found);
    }
    let words = [
        ("rest", Word::Rest),
        ("estimate", Word::Estimate),
        ("given", Word::Given),
    ];
    let word = found.keep(state.word(&words))?;
    let values = record.get("values");
    match (word, values) {
        (Word::Given, Some(values)) => given(values, found),
        (Word::Given, None) => {
            found.push(
                Diagnostic::error("no state is given")
                    .at(state.span(), "`values` are missing")
                    .help("write [initial.values] with the states by name, in SI"),
            );
            None
        }
        (_, Some(values)) => {
            found.push(
                Diagnostic::error("`values` are not used")
                    .at(values.name.span, "these say nothing")
                    .also(state.span(), "beside this")
                    .help("write state = \"given\", or leave the values out"),
            );
            None
        }
        (Word::Rest, None) => Some(InitialState::Rest),
        (Word::Estimate, None) => Some(InitialState::Estimate),
    }
}

fn given(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<InitialState> {
    let values = found.keep(entry.table("{ x = 0.1 }"))?;
    if values.is_empty() {
        found.push(
            Diagnostic::error("no state is given")
                .at(entry.span(), "this is empty")
                .help("give states by name, in SI, as x = 0.1"),
        );
    }
    let mut given = Vec::with_capacity(values.len());
    for value in values {
        given.push((value.name.clone(), found.keep(value.number())?));
    }
    Some(InitialState::Given(given))
}

pub(super) fn windows(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<Windows> {
    let record = entry.record(&keys::WINDOWS, "{ length = 0.5 }", found)?;
    let smoothed = match record.get("start") {
        Some(start) => found.keep(start.word(&[("fitted", false), ("smoothed", true)])),
        None => Some(false),
    };
    let length = required(&record, "length", "0.5, in s, or \"record\"", found)?;
    let length = match length.written() {
        Ok(_) => found.keep(length.word(&[("record", None)])),
        Err(_) => found.keep(length.number()).map(Some),
    };
    let length = length?;
    if let Some(length) = length.filter(|length| length.value <= 0.0) {
        found.push(
            Diagnostic::error(format!("a window cannot last {} s", length.value))
                .at(length.span, "expected seconds, more than 0, or \"record\""),
        );
    }
    Some(Windows {
        length,
        smoothed: smoothed?,
    })
}
