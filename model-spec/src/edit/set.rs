//! Sets the number and the origin of a parameter, or the model of a sensor.

use toml_edit::{DocumentMut, Item, RawString, Table, Value};

use super::{EditError, SetParameter, SetSensor};

/// Replaces the value of a parameter by a number. The value can be a number or an expression.
pub fn set_parameter(document: &mut DocumentMut, edit: &SetParameter) -> Result<(), EditError> {
    let mut entry = document
        .get_mut("parameters")
        .and_then(|item| item.get_mut(&edit.name));
    let Some(table) = entry.as_deref_mut().and_then(Item::as_table_like_mut) else {
        return Err(EditError::MissingTerm {
            section: "parameters".to_owned(),
            name: edit.name.clone(),
        });
    };
    let number = format_number(&edit.name, edit.value)?;
    replace(table.get_mut("value"), number);
    if edit.source.is_empty() {
        return Ok(());
    }
    let source = Value::from(edit.source.as_str());
    if table.contains_key("source") {
        replace(table.get_mut("source"), source);
    } else {
        table.insert("source", Item::Value(source));
        remove_inner_spaces(entry);
    }
    Ok(())
}

/// Removes spaces before the commas of an inline table. The space before the closing brace belongs to the last value;
/// after an insertion it is in front of a comma.
fn remove_inner_spaces(entry: Option<&mut Item>) {
    let Some(table) = entry.and_then(Item::as_inline_table_mut) else {
        return;
    };
    let inner = table.len().saturating_sub(1);
    for (_, value) in table.iter_mut().take(inner) {
        let suffix = value.decor().suffix().and_then(RawString::as_str);
        if suffix.is_some_and(|suffix| suffix.trim().is_empty()) {
            value.decor_mut().set_suffix("");
        }
    }
}

/// Sets gain, bias and delay of a sensor, and the observable.
pub fn set_sensor(document: &mut DocumentMut, edit: &SetSensor) -> Result<(), EditError> {
    if document.get("sensors").is_none() {
        let mut sensors = Table::new();
        sensors.set_implicit(true);
        document.insert("sensors", Item::Table(sensors));
    }
    let Some(sensors) = document
        .get_mut("sensors")
        .and_then(Item::as_table_like_mut)
    else {
        return Err(EditError::NameTaken {
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
        table.insert(key, Item::Value(format_number(&edit.channel, value)?));
    }
    sensors.insert(&edit.channel, Item::Table(table));
    Ok(())
}

fn format_number(name: &str, value: f64) -> Result<Value, EditError> {
    let written = format!("{value:?}").parse().ok();
    let finite = written.filter(|_| value.is_finite());
    finite.ok_or_else(|| EditError::NotFinite {
        name: name.to_owned(),
    })
}

/// Replaces a value, and keeps the spaces around it.
fn replace(place: Option<&mut Item>, mut value: Value) {
    if let Some(old) = place.and_then(Item::as_value_mut) {
        *value.decor_mut() = old.decor().clone();
        *old = value;
    }
}
