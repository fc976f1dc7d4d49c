//! Reads the entries of `[controllers]`.

use crate::diagnostic::{Diagnostic, Diagnostics, quote};
use crate::keys::Keys;
use crate::quantity::{Name, Number, Quantity};
use crate::raw::{RawController, RawControllerState, RawTime};
use crate::record::Record;
use crate::sections;
use crate::table::Entry;

pub(crate) fn read_controller(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<RawController> {
    let record = Record::read(entry, &sections::CONTROLLER, found)?;
    let period = record.require("period", found)?;
    let period = read_time(period, found);
    let mut time = |key: &str| match record.get(key) {
        Some(entry) => read_time(entry, found),
        None => Some(RawTime {
            value: Quantity::Number(Number {
                value: 0.0,
                span: entry.name.span,
            }),
            unit: None,
        }),
    };
    let (offset, delay) = (time("offset"), time("delay"));
    let states = read_entries(
        &record,
        "states",
        &sections::CONTROLLER_STATE,
        read_state,
        found,
    );
    let outputs = read_entries(
        &record,
        "outputs",
        &sections::CONTROLLER_OUTPUT,
        read_output,
        found,
    );
    if states.is_empty() && outputs.is_empty() && found.is_empty() {
        let name = quote(&entry.name.text);
        found.push(
            Diagnostic::error(format!(
                "the controller {name} has no `states` and no `outputs`"
            ))
            .with_span(entry.name.span, "it has no effect")
            .with_help("give its outputs: outputs = { u = \"-k_p*theta\" }"),
        );
    }
    Some(RawController {
        name: entry.name.clone(),
        period: period?,
        offset: offset?,
        delay: delay?,
        states,
        outputs,
        doc: record.text("doc", found),
    })
}

fn read_entries<T>(
    record: &Record<'_>,
    key: &str,
    keys: &Keys,
    read: impl Fn(&Entry<'_>, &mut Diagnostics) -> Option<T>,
    found: &mut Diagnostics,
) -> Vec<T> {
    let Some(table) = record.get(key) else {
        return Vec::new();
    };
    let example = format!("{{ NAME = {} }}", keys.example());
    let entries = found.push_error(table.table(&example)).unwrap_or_default();
    let mut list = Vec::with_capacity(entries.len());
    for entry in &entries {
        list.extend(read(entry, found));
    }
    list
}

/// Reads a number in s, an expression, or both with a unit.
fn read_time(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<RawTime> {
    if !entry.is_table() {
        let value = found.push_error(entry.quantity())?;
        return Some(RawTime { value, unit: None });
    }
    let record = Record::read(entry, &sections::SAMPLE_TIME, found)?;
    Some(RawTime {
        value: record.required("value", Entry::quantity, found)?,
        unit: record.written("unit", found),
    })
}

fn read_state(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<RawControllerState> {
    let record = Record::read(entry, &sections::CONTROLLER_STATE, found)?;
    let unit = record.required("unit", Entry::written, found);
    let next = record.required("next", Entry::quantity, found)?;
    Some(RawControllerState {
        name: entry.name.clone(),
        unit,
        next,
        initial: record.quantity("initial", found),
        doc: record.text("doc", found),
    })
}

fn read_output(entry: &Entry<'_>, found: &mut Diagnostics) -> Option<(Name, Quantity)> {
    if !entry.is_table() {
        let value = found.push_error(entry.quantity())?;
        return Some((entry.name.clone(), value));
    }
    let record = Record::read(entry, &sections::CONTROLLER_OUTPUT, found)?;
    let value = record.required("value", Entry::quantity, found)?;
    Some((entry.name.clone(), value))
}
