//! Setting what is there: a parameter's number and where it comes from, and what a sensor
//! does to a channel.

use toml_edit::{DocumentMut, Item, Table, Value};

use super::{EditError, SetParameter, SetSensor};

/// Sets a parameter's number, whatever stood there.
pub fn parameter(document: &mut DocumentMut, edit: &SetParameter) -> Result<(), EditError> {
    let entry = document
        .get_mut("parameters")
        .and_then(|item| item.get_mut(&edit.name));
    let Some(table) = entry.and_then(Item::as_table_like_mut) else {
        return Err(EditError::MissingTerm {
            section: "parameters".to_owned(),
            name: edit.name.clone(),
        });
    };
    let number = number(&edit.name, edit.value)?;
    replace(table.get_mut("value"), number);
    if edit.source.is_empty() {
        return Ok(());
    }
    let source = Value::from(edit.source.as_str());
    if table.contains_key("source") {
        replace(table.get_mut("source"), source);
    } else {
        table.insert("source", Item::Value(source));
    }
    Ok(())
}

/// Sets what a sensor does, the whole of it.
pub fn sensor(document: &mut DocumentMut, edit: &SetSensor) -> Result<(), EditError> {
    if document.get("sensors").is_none() {
        let mut sensors = Table::new();
        sensors.set_implicit(true);
        document.insert("sensors", Item::Table(sensors));
    }
    let Some(sensors) = document
        .get_mut("sensors")
        .and_then(Item::as_table_like_mut)
    else {
        return Err(EditError::Taken {
            section: "sensors".to_owned(),
            name: edit.channel.clone(),
        });
    };
    let mut table = Table::new();
    if edit.observable != edit.channel {
        table.insert("observable", Item::Value(edit.observable.as_str().into()));
    }
    for (key, value) in [
        ("gain", edit.gain),
        ("bias", edit.bias),
        ("delay", edit.delay),
    ] {
        table.insert(key, Item::Value(number(&edit.channel, value)?));
    }
    sensors.insert(&edit.channel, Item::Table(table));
    Ok(())
}

/// A number in the shortest form that reads back as itself.
fn number(name: &str, value: f64) -> Result<Value, EditError> {
    let written = format!("{value:?}").parse().ok();
    let finite = written.filter(|_| value.is_finite());
    finite.ok_or_else(|| EditError::NotFinite {
        name: name.to_owned(),
    })
}

/// Puts a value in the place of another, with the spaces around it.
fn replace(place: Option<&mut Item>, mut value: Value) {
    if let Some(old) = place.and_then(Item::as_value_mut) {
        *value.decor_mut() = old.decor().clone();
        *old = value;
    }
}
