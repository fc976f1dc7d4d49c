//! The text of a proposed dataset file.

use std::fmt::Write;

use eomgen_model_spec::model::ParameterValue;
use eomgen_model_spec::visible::{is_hidden, visible_in_strings};

use super::Found;
use super::matching::{FileColumn, Match};
use crate::description::format::{DECIMALS, Format, SEPARATORS};
use crate::noise::estimated;
use crate::samples::span;
use crate::unwrapping::unwrapped;
use crate::wrap_detection::WrapPattern;

/// A channel whose noise cannot be seen gets this part of its span.
const UNSEEN: f64 = 1e-6;

/// A dataset file; what was guessed stands beside it as a comment.
pub(super) fn text(found: &Found<'_>, name: &str) -> String {
    let mut text =
        "# Proposed by `eomgen dataset`. What was guessed says so: look at it once.\n".to_owned();
    text += &format!(
        "title = {}\n",
        quoted(&format!("{name}, {}", found.model.name))
    );
    text += &records(found, name);
    text += &format(&found.format);
    text += &time(found);
    for matched in &found.matches {
        text += &match found.quantities[matched.quantity].is_input {
            true => input(found, matched),
            false => channel(found, matched),
        };
    }
    text += &unmatched(found);
    text +=
        "\n[initial]\nstate = \"estimate\"\u{1}\"rest\" where the machine stands still at first\n";
    text += &uncertain(found);
    text += &windows(found);
    aligned(&text)
}

/// Where comments begin beside short lines.
const COMMENTS: usize = 30;

/// The text with what stands behind marks as comments below each other.
fn aligned(text: &str) -> String {
    let line = |line: &str| match line.split_once('\u{1}') {
        Some((code, comment)) => format!("{code:<COMMENTS$} # {comment}\n"),
        None => format!("{line}\n"),
    };
    text.lines().map(line).collect()
}

/// A TOML string without hidden characters.
fn quoted(text: &str) -> String {
    if !text.contains(is_hidden) {
        return toml_edit::Value::from(text).to_string();
    }
    let escapes = [("\\", "\\\\"), ("\"", "\\\""), ("\n", "\\n"), ("\t", "\\t")];
    let escaped = escapes
        .iter()
        .fold(text.to_owned(), |text, (letter, escape)| {
            text.replace(letter, escape)
        });
    format!("\"{}\"", visible_in_strings(&escaped))
}

fn records(found: &Found<'_>, name: &str) -> String {
    let (file, at) = (quoted(name), found.split());
    format!(
        "\n[records]\u{1}the first 60 % to learn from, the rest to be judged by;\n\
         train = [{{ file = {file}, to = {at:?} }}]\u{1}better is another measurement: test = [\"other.csv\"]\n\
         test = [{{ file = {file}, from = {at:?} }}]\n"
    )
}

/// What differs from the usual format.
fn format(format: &Format) -> String {
    let usual = Format::default();
    let mut keys = String::new();
    let mut key = |differs: bool, line: String| {
        if differs {
            keys += &line;
            keys.push('\n');
        }
    };
    let word = |words: &[(&'static str, bool)]| {
        let known = words.iter().find(|(_, is_own)| *is_own);
        quoted(known.map_or("", |(word, _)| word))
    };
    let separator = SEPARATORS.map(|(word, sign)| (word, sign == format.separator));
    let decimal = DECIMALS.map(|(word, sign)| (word, sign == format.decimal));
    key(
        format.separator != usual.separator,
        format!("separator = {}", word(&separator)),
    );
    key(
        format.decimal != usual.decimal,
        format!("decimal = {}", word(&decimal)),
    );
    key(format.skip > 0, format!("skip = {}", format.skip));
    let comment = format
        .comment
        .map(|sign| quoted(&char::from(sign).to_string()));
    key(
        comment.is_some(),
        format!("comment = {}", comment.unwrap_or_default()),
    );
    key(
        !format.names,
        "names = false\u{1}columns are called by their numbers".to_owned(),
    );
    key(
        format.units,
        "units = true\u{1}behind the line of names".to_owned(),
    );
    match keys.is_empty() {
        true => String::new(),
        false => format!("\n[format]\n{keys}"),
    }
}

/// How a column is called.
fn key(found: &Found<'_>, column: &FileColumn) -> String {
    let mut all = found
        .columns
        .iter()
        .filter(|other| other.name == column.name);
    let is_unique = all.next().is_some() && all.next().is_none();
    match found.format.names && is_unique && !column.name.is_empty() {
        true => quoted(&column.name),
        false => column.number.to_string(),
    }
}

fn time(found: &Found<'_>) -> String {
    let column = &found.columns[found.time];
    let why = match (&column.unit, &column.unknown_unit) {
        (Some(_), _) => "as the file says".to_owned(),
        (None, Some(unknown)) => format!("guessed: {} is no known unit", quoted(unknown)),
        (None, None) => "guessed: the file says none".to_owned(),
    };
    let mut text = format!(
        "\n[time]\ncolumn = {}\nunit = {}\u{1}{why}; samples are {:.6} s apart\n",
        key(found, column),
        quoted(&found.time_unit.to_string()),
        found.step()
    );
    let every = found.every();
    if every > 1 {
        let _ = writeln!(
            text,
            "every = {every}\u{1}of {} samples, behind a low-pass",
            found.times().len()
        );
        if found.is_uneven() {
            text += "filter = \"none\"\u{1}steps are uneven: no low-pass\n";
        }
    }
    text
}

/// A column's unit, and where it comes from.
fn unit(found: &Found<'_>, matched: &Match) -> String {
    let (unit, why) = found.unit(matched);
    format!("unit = {}\u{1}{why}", quoted(&unit.to_string()))
}

fn input(found: &Found<'_>, matched: &Match) -> String {
    let column = &found.columns[matched.column];
    let pattern = found.wrap_pattern(matched);
    format!(
        "\n[inputs.{}]\u{1}{}\ncolumn = {}\n{}\n{}",
        found.quantities[matched.quantity].name,
        matched.why,
        key(found, column),
        unit(found, matched),
        wrap(pattern.filter(|pattern| pattern.is_wrapped(true)))
    )
}

/// The key of a column that wraps around.
fn wrap(pattern: Option<WrapPattern>) -> String {
    pattern.map_or_else(String::new, |pattern| {
        let doubt = pattern.doubt(pattern.period);
        format!(
            "wrap = {}\u{1}it jumps by about this{}; \"none\" if the jumps are real\n",
            pattern.written(pattern.period),
            doubt.map_or_else(String::new, |doubt| format!(", {doubt}"))
        )
    })
}

fn channel(found: &Found<'_>, matched: &Match) -> String {
    let column = &found.columns[matched.column];
    let pattern = found.wrap_pattern(matched);
    let pattern = pattern.filter(|pattern| pattern.is_wrapped(false));
    let read = &found.values[matched.column];
    let values = match pattern {
        Some(pattern) => unwrapped(found.times(), read, pattern.period).values,
        None => read.clone(),
    };
    let name = &found.quantities[matched.quantity].name;
    let span = span(&values);
    if span.is_nan() || span <= 0.0 {
        return format!(
            "\n# `{name}` does not move in column {}: it is left out.\n",
            column.number
        );
    }
    let (noise, why) = match estimated(&values) {
        Some(noise) => (noise, "guessed from what differs from sample to sample"),
        None => (UNSEEN * span, "guessed: none can be seen"),
    };
    format!(
        "\n[channels.{name}]\u{1}{}\ncolumn = {}\n{}\n{}noise = {noise:.1e}\u{1}{why}\n",
        matched.why,
        key(found, column),
        unit(found, matched),
        wrap(pattern),
    )
}

/// Columns and inputs that nothing was found for.
fn unmatched(found: &Found<'_>) -> String {
    let is_used = |place: usize| {
        place == found.time || found.matches.iter().any(|matched| matched.column == place)
    };
    let columns = found.columns.iter().enumerate();
    let columns = columns.filter(|(place, _)| !is_used(*place));
    let named = columns.map(|(_, column)| {
        let name = match column.name.as_str() {
            "" => format!("column {}", column.number),
            name => quoted(name),
        };
        let unknown = column.unknown_unit.as_ref();
        unknown.map_or_else(
            || name.clone(),
            |unit| format!("{name} ({} is no known unit)", quoted(unit)),
        )
    });
    let named: Vec<String> = named.collect();
    let quantities = found.quantities.iter().enumerate();
    let inputs = quantities.filter(|(place, quantity)| {
        quantity.is_input
            && found
                .matches
                .iter()
                .all(|matched| matched.quantity != *place)
    });
    let inputs: Vec<&str> = inputs.map(|(_, quantity)| quantity.name.as_str()).collect();
    let mut text = String::new();
    if !named.is_empty() {
        let _ = writeln!(text, "\n# Not used: {}.", named.join(", "));
    }
    if !inputs.is_empty() {
        let _ = writeln!(
            text,
            "\n# No column was found for these inputs, which are taken as 0: {}.",
            inputs.join(", ")
        );
    }
    text
}

/// Which parameters could be declared uncertain.
fn uncertain(found: &Found<'_>) -> String {
    let parameters = found.model.parameters.iter();
    let numbers = parameters.filter(|p| matches!(p.value, ParameterValue::Number(v) if v != 0.0));
    let names: Vec<&str> = numbers.map(|p| p.name.as_str()).collect();
    let Some(first) = names.first() else {
        return String::new();
    };
    format!(
        "\n[uncertain]\u{1}what is not known well, by one standard deviation of it, as\n\
# {first} = {{ relative = 0.05 }}\u{1}of {}\n",
        names.join(", ")
    )
}

fn windows(found: &Found<'_>) -> String {
    match found.window() {
        Some(length) => format!(
            "\n[windows]\nlength = {length:?}\u{1}s; each is simulated from a state of its own\n"
        ),
        None => "\n[windows]\nlength = \"record\"\u{1}too short to be cut\n".to_owned(),
    }
}
