//! Adding one entry at the end of a section, the section itself at the end of the file
//! where it is missing.

use toml_edit::{DocumentMut, InlineTable, Item, Table, Value};

use super::{Edit, EditError, NewValue};

/// Adds the entry of an edit.
pub fn insert(document: &mut DocumentMut, edit: &Edit) -> Result<(), EditError> {
    let (section, name, value) = entry(edit)?;
    let taken = || EditError::Taken {
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

/// Adds an empty section behind all others, parted from them by an empty line.
fn add_section(document: &mut DocumentMut, section: &str) {
    let mut table = Table::new();
    // What stands behind the last entry, such as a closing comment, stays in front.
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

type Entry<'e> = (&'static str, &'e str, Value);

fn entry(edit: &Edit) -> Result<Entry<'_>, EditError> {
    let mut table = InlineTable::new();
    Ok(match edit {
        Edit::AddTerm {
            section,
            name,
            value,
            doc,
            source,
        } => {
            if doc.is_empty() && source.is_empty() {
                return Ok((section.name(), name, Value::from(value.as_str())));
            }
            add_texts(
                &mut table,
                &[("value", value), ("doc", doc), ("source", source)],
            );
            (section.name(), name, table.into())
        }
        Edit::AddParameter {
            name,
            value,
            unit,
            doc,
            source,
        } => {
            table.insert("value", new_value(name, value)?);
            table.insert("unit", Value::from(unit.as_str()));
            add_texts(&mut table, &[("doc", doc), ("source", source)]);
            ("parameters", name, table.into())
        }
        Edit::AddCoordinate {
            name,
            unit,
            doc,
            initial,
        } => {
            table.insert("unit", Value::from(unit.as_str()));
            add_texts(&mut table, &[("doc", doc)]);
            if let Some(initial) = initial {
                table.insert("initial", new_value(name, initial)?);
            }
            ("coordinates", name, table.into())
        }
        Edit::AddForce {
            name,
            on,
            value,
            doc,
            source,
        } => {
            let texts = [
                ("on", on),
                ("value", value),
                ("doc", doc),
                ("source", source),
            ];
            add_texts(&mut table, &texts);
            ("forces", name, table.into())
        }
        // Substitutions add nothing; they name no section of their own here.
        Edit::Substitute { section, find, .. } => (section.name(), find, table.into()),
    })
}

fn add_texts(table: &mut InlineTable, texts: &[(&str, &String)]) {
    for (key, text) in texts {
        if !text.is_empty() {
            table.insert(*key, Value::from(text.as_str()));
        }
    }
}

/// A number in the shortest form that reads back as itself.
fn new_value(name: &str, value: &NewValue) -> Result<Value, EditError> {
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
