//! Appends an entry to a section, and the section to the file if it is missing.

use toml_edit::{DocumentMut, InlineTable, Item, Table, Value};

use super::{
    EditError, NewCoordinate, NewForce, NewParameter, NewState, NewTerm, NewValue, Section,
};

/// Adds a term. If it has no description and no origin, the entry is only the expression.
pub fn insert_term(document: &mut DocumentMut, new: &NewTerm) -> Result<(), EditError> {
    let value = if new.doc.is_empty() && new.source.is_empty() {
        Value::from(new.value.as_str())
    } else {
        let texts = [
            ("value", &new.value),
            ("doc", &new.doc),
            ("source", &new.source),
        ];
        add_texts(InlineTable::new(), &texts)
    };
    insert(document, new.section.name(), &new.name, value)
}

pub fn insert_parameter(document: &mut DocumentMut, new: &NewParameter) -> Result<(), EditError> {
    let mut table = InlineTable::new();
    table.insert("value", format_value(&new.name, &new.value)?);
    table.insert("unit", Value::from(new.unit.as_str()));
    let value = add_texts(table, &[("doc", &new.doc), ("source", &new.source)]);
    insert(document, "parameters", &new.name, value)
}

pub fn insert_coordinate(document: &mut DocumentMut, new: &NewCoordinate) -> Result<(), EditError> {
    let mut table = InlineTable::new();
    table.insert("unit", Value::from(new.unit.as_str()));
    if let Some(initial) = &new.initial {
        table.insert("initial", format_value(&new.name, initial)?);
    }
    let value = add_texts(table, &[("doc", &new.doc)]);
    insert(document, "coordinates", &new.name, value)
}

pub fn insert_state(document: &mut DocumentMut, new: &NewState) -> Result<(), EditError> {
    let texts = [("unit", &new.unit), ("rate", &new.rate), ("doc", &new.doc)];
    let value = add_texts(InlineTable::new(), &texts);
    insert(document, Section::States.name(), &new.name, value)
}

pub fn insert_force(document: &mut DocumentMut, new: &NewForce) -> Result<(), EditError> {
    let head = [("on", &new.on), ("value", &new.value)];
    let tail = [("doc", &new.doc), ("source", &new.source)];
    let value = add_texts(InlineTable::new(), &[head, tail].concat());
    insert(document, "forces", &new.name, value)
}

fn insert(
    document: &mut DocumentMut,
    section: &str,
    name: &str,
    value: Value,
) -> Result<(), EditError> {
    let taken = || EditError::NameTaken {
        section: section.to_owned(),
        name: name.to_owned(),
    };
    if document.get(section).is_none() {
        add_section(document, section);
    }
    let item = document.get_mut(section);
    let Some(table) = item.and_then(Item::as_table_like_mut) else {
        return Err(taken());
    };
    if table.contains_key(name) {
        return Err(taken());
    }
    table.insert(name, Item::Value(value));
    Ok(())
}

/// Appends an empty section after an empty line.
fn add_section(document: &mut DocumentMut, section: &str) {
    let mut table = Table::new();
    // Text after the last entry, such as a comment at the end, stays before the new section.
    let trailing = document.trailing().as_str().unwrap_or_default().to_owned();
    document.set_trailing("");
    let separator = if trailing.is_empty() || trailing.ends_with('\n') {
        ""
    } else {
        "\n"
    };
    table
        .decor_mut()
        .set_prefix(format!("{trailing}{separator}\n"));
    document.insert(section, Item::Table(table));
}

fn add_texts(mut table: InlineTable, texts: &[(&str, &String)]) -> Value {
    for (key, text) in texts {
        if !text.is_empty() {
            table.insert(*key, Value::from(text.as_str()));
        }
    }
    table.into()
}

/// Formats a number in the shortest form that parses to the same value.
fn format_value(name: &str, value: &NewValue) -> Result<Value, EditError> {
    match value {
        NewValue::Expression(text) => Ok(Value::from(text.as_str())),
        NewValue::Number(number) => {
            let written = format!("{number:?}").parse().ok();
            let finite = written.filter(|_| number.is_finite());
            finite.ok_or_else(|| EditError::NotFinite {
                name: name.to_owned(),
            })
        }
    }
}
