//! Text of a proposed dataset file.

use std::fmt::Write;

use eomgen_model_spec::hidden_characters::{escape_hidden_in_strings, is_hidden};
use eomgen_model_spec::model::ParameterValue;

use super::DetectedRecord;
use super::matching::{FileColumn, Match};
use crate::description::format::{DECIMALS, Format, SEPARATORS};
use crate::noise::estimate_noise;
use crate::samples::span;
use crate::unwrapping::unwrap_values;
use crate::wrap_detection::WrapPattern;

/// Noise of a channel without visible noise, relative to its range. Smaller estimates are the rounding of computed
/// values.
const INVISIBLE_NOISE_FRACTION: f64 = 1e-6;

pub(super) fn dataset_text(found: &DetectedRecord<'_>, name: &str) -> String {
    let mut text =
        "# Proposed by `eomgen dataset`. Check the entries that are marked as guessed.\n"
            .to_owned();
    text += &format!(
        "title = {}\n",
        quote_text(&format!("{name}, {}", found.model.name))
    );
    text += &records_table(found, name);
    text += &format_table(&found.format);
    text += &time_table(found);
    for matched in &found.matches {
        text += &match found.quantities[matched.quantity].is_input {
            true => input_table(found, matched),
            false => channel_table(found, matched),
        };
    }
    text += &unmatched_comments(found);
    text += "\n[initial]\nstate = \"estimate\"\u{1}or \"rest\" if the machine is at rest at the start\n";
    text += &uncertain_tables(found);
    text += &windows_table(found);
    align_comments(&text)
}

/// Column at which comments of short lines start.
const COMMENT_COLUMN: usize = 30;

fn align_comments(text: &str) -> String {
    let line = |line: &str| match line.split_once('\u{1}') {
        Some((code, comment)) => format!("{code:<COMMENT_COLUMN$} # {comment}\n"),
        None => format!("{line}\n"),
    };
    text.lines().map(line).collect()
}

fn quote_text(text: &str) -> String {
    if !text.contains(is_hidden) {
        return toml_edit::Value::from(text).to_string();
    }
    let escapes = [("\\", "\\\\"), ("\"", "\\\""), ("\n", "\\n"), ("\t", "\\t")];
    let escaped = escapes
        .iter()
        .fold(text.to_owned(), |text, (letter, escape)| {
            text.replace(letter, escape)
        });
    format!("\"{}\"", escape_hidden_in_strings(&escaped))
}

fn records_table(found: &DetectedRecord<'_>, name: &str) -> String {
    let (file, at) = (quote_text(name), found.test_start());
    format!(
        "\n[records]\u{1}the first 60 % for training, the rest for testing;\n\
         train = [{{ file = {file}, to = {at:?} }}]\u{1}better: another measurement, test = [\"other.csv\"]\n\
         test = [{{ file = {file}, from = {at:?} }}]\n"
    )
}

fn format_table(format: &Format) -> String {
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
        quote_text(known.map_or("", |(word, _)| word))
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
        .map(|sign| quote_text(&char::from(sign).to_string()));
    key(
        comment.is_some(),
        format!("comment = {}", comment.unwrap_or_default()),
    );
    key(
        !format.has_names,
        "names = false\u{1}columns are identified by number".to_owned(),
    );
    key(
        format.has_units,
        "units = true\u{1}after the line of names".to_owned(),
    );
    match keys.is_empty() {
        true => String::new(),
        false => format!("\n[format]\n{keys}"),
    }
}

fn column_key(found: &DetectedRecord<'_>, column: &FileColumn) -> String {
    let mut all = found
        .columns
        .iter()
        .filter(|other| other.name == column.name);
    let is_unique = all.next().is_some() && all.next().is_none();
    match found.format.has_names && is_unique && !column.name.is_empty() {
        true => quote_text(&column.name),
        false => column.number.to_string(),
    }
}

fn time_table(found: &DetectedRecord<'_>) -> String {
    let column = &found.columns[found.time];
    let why = match (&column.unit, &column.unknown_unit) {
        (Some(_), _) => "from the file".to_owned(),
        (None, Some(unknown)) => format!("guessed: {} is not a known unit", quote_text(unknown)),
        (None, None) if found.time_is_a_counter() => {
            "guessed: the file has none; a counter of samples must be replaced by a column of time"
                .to_owned()
        }
        (None, None) => "guessed: the file has none".to_owned(),
    };
    let mut text = format!(
        "\n[time]\ncolumn = {}\nunit = {}\u{1}{why}; samples are {:.6} s apart\n",
        column_key(found, column),
        quote_text(&found.time_unit.to_string()),
        found.step()
    );
    let every = found.decimation_factor();
    if every > 1 {
        let _ = writeln!(
            text,
            "every = {every}\u{1}of {} samples, after a low-pass filter",
            found.times().len()
        );
        if found.is_uneven() {
            text += "filter = \"none\"\u{1}time steps are uneven: no low-pass filter\n";
        }
    }
    text
}

fn unit_entry(found: &DetectedRecord<'_>, matched: &Match) -> String {
    let (unit, why) = found.unit(matched);
    format!("unit = {}\u{1}{why}", quote_text(&unit.to_string()))
}

fn input_table(found: &DetectedRecord<'_>, matched: &Match) -> String {
    let column = &found.columns[matched.column];
    let pattern = found.wrap_pattern(matched);
    format!(
        "\n[inputs.{}]\u{1}{}\ncolumn = {}\n{}\n{}",
        found.quantities[matched.quantity].name,
        matched.reason,
        column_key(found, column),
        unit_entry(found, matched),
        wrap_entry(pattern.filter(|pattern| pattern.is_wrapped(true)))
    )
}

fn wrap_entry(pattern: Option<WrapPattern>) -> String {
    pattern.map_or_else(String::new, |pattern| {
        let doubt = pattern.uncertainty_note(pattern.period);
        format!(
            "wrap = {}\u{1}it jumps by about this{}; \"none\" if the jumps are real\n",
            pattern.format_period(pattern.period),
            doubt.map_or_else(String::new, |doubt| format!(", {doubt}"))
        )
    })
}

fn channel_table(found: &DetectedRecord<'_>, matched: &Match) -> String {
    let column = &found.columns[matched.column];
    let pattern = found.wrap_pattern(matched);
    let pattern = pattern.filter(|pattern| pattern.is_wrapped(false));
    let read = &found.values[matched.column];
    let values = match pattern {
        Some(pattern) => unwrap_values(found.times(), read, pattern.period).values,
        None => read.clone(),
    };
    let name = &found.quantities[matched.quantity].name;
    let span = span(&values);
    if span.is_nan() || span <= 0.0 {
        return format!(
            "\n# `{name}` is constant in column {}: it is omitted.\n",
            column.number
        );
    }
    let (noise, why) = match estimate_noise(&values) {
        Some(noise) if noise < INVISIBLE_NOISE_FRACTION * span => (
            noise,
            "suspicious: rounding only, so the column looks computed, not measured",
        ),
        Some(noise) => (noise, "guessed from the differences between samples"),
        None => (
            INVISIBLE_NOISE_FRACTION * span,
            "guessed: no noise is visible",
        ),
    };
    format!(
        "\n[channels.{name}]\u{1}{}\ncolumn = {}\n{}\n{}noise = {noise:.2e}\u{1}{why}\n",
        matched.reason,
        column_key(found, column),
        unit_entry(found, matched),
        wrap_entry(pattern),
    )
}

fn unmatched_comments(found: &DetectedRecord<'_>) -> String {
    let is_used = |place: usize| {
        place == found.time || found.matches.iter().any(|matched| matched.column == place)
    };
    let columns = found.columns.iter().enumerate();
    let columns = columns.filter(|(place, _)| !is_used(*place));
    let named = columns.map(|(_, column)| {
        let name = match column.name.as_str() {
            "" => format!("column {}", column.number),
            name => quote_text(name),
        };
        let unknown = column.unknown_unit.as_ref();
        unknown.map_or_else(
            || name.clone(),
            |unit| format!("{name} ({} is not a known unit)", quote_text(unit)),
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

fn uncertain_tables(found: &DetectedRecord<'_>) -> String {
    let parameters = found.model.parameters.iter();
    let numbers = parameters.filter(|p| matches!(p.value, ParameterValue::Number(v) if v != 0.0));
    let names: Vec<&str> = numbers.map(|p| p.name.as_str()).collect();
    let Some(first) = names.first() else {
        return String::new();
    };
    format!(
        "\n[uncertain]\u{1}parameters that are not known well, with a relative standard deviation:\n\
# {first} = {{ relative = 0.05 }}\u{1}parameters: {}\n",
        names.join(", ")
    )
}

fn windows_table(found: &DetectedRecord<'_>) -> String {
    match found.window_length() {
        Some(length) => format!(
            "\n[windows]\nlength = {length:?}\u{1}s; each window has a separate initial state\n"
        ),
        None => "\n[windows]\nlength = \"record\"\u{1}too short to split\n".to_owned(),
    }
}
