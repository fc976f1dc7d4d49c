//! Replaces an input by a definition of the same name, so that all references remain valid.

use toml_edit::{DocumentMut, Item};

use super::insert::{insert_parameter, insert_term};
use super::substitute::{replace_all, syntax};
use super::{EditError, NewParameter, NewTerm, NewValue, PrescribeInput, Section};
use crate::assignment::find_unit_start;
use crate::ast::{Syntax, SyntaxKind};
use crate::diagnostic::Diagnostic;
use crate::dimension::Dimension;
use crate::lexer::{Token, TokenKind, tokenize};
use crate::model::UNIT_FACTOR_ORIGIN;
use crate::source::Source;
use crate::span::Span;
use crate::unit::Unit;

pub fn prescribe(document: &mut DocumentMut, edit: &PrescribeInput) -> Result<(), EditError> {
    let with_input = document.clone();
    let (unit, has_rates) = remove(document, &edit.name).ok_or_else(|| EditError::MissingTerm {
        section: "inputs".to_owned(),
        name: edit.name.clone(),
    })?;
    let (given, own_unit) = split_unit(edit, &unit)?;
    let tree = syntax(given)?;
    reject_motion(document, edit, &tree)?;
    let (of_numbers, is_timed) = (has_only_numbers(&tree), mentions_time(&tree));
    if !of_numbers {
        check_value(with_input, edit, (given, own_unit), (&tree, &unit))?;
    }
    // Numbers are dimensionless, and units are checked. Parameters of value 1, one in s and one in the unit of the
    // input, supply the units.
    let needs_second = if is_timed { of_numbers } else { has_rates };
    let second = match needs_second {
        true => Some(add_unit_factor(document, "one_second", "s")?),
        false => None,
    };
    let timed = match &second {
        Some(second) if is_timed => replace_all(given, "t", &format!("t/{second}"))?,
        _ => None,
    };
    let mut value = timed.unwrap_or_else(|| given.to_owned());
    if let Some(own) = own_unit.or(of_numbers.then_some(&unit)) {
        let one = add_unit_factor(document, "one_unit", own)?;
        value = format!("({value})*{one}");
    }
    if !has_rates {
        return define(document, &edit.name, value);
    }
    // The factor depends on time, because the definition must have a rate.
    if let Some(second) = second.filter(|_| !is_timed) {
        value = format!("({value})*(1 + 0*t/{second})");
    }
    define(document, &edit.name, value)?;
    let [rate, second] = ["dot", "ddot"].map(|suffix| format!("{}_{suffix}", edit.name));
    let has_second = contains_name(document, &second);
    if has_second || contains_name(document, &rate) {
        define(document, &rate, format!("dot({})", edit.name))?;
    }
    if has_second {
        define(document, &second, format!("dot({rate})"))?;
    }
    Ok(())
}

/// Checks that an expression of parameters and definitions does not depend on the motion, and that it has the unit of
/// the input, or no unit if a unit follows the expression. The check of the edited specification reports other
/// errors.
fn check_value(
    mut document: DocumentMut,
    edit: &PrescribeInput,
    (given, own_unit): (&str, Option<&str>),
    (tree, unit): (&Syntax, &str),
) -> Result<(), EditError> {
    let name = unused_name(&document, "value_of_input");
    define(&mut document, &name, given.to_owned())?;
    let Ok(checked) = crate::check(Source::new("", document.to_string())) else {
        return Ok(());
    };
    let model = &checked.model;
    let find = |name: &str| model.definitions.iter().find(|own| own.name == name);
    let (Some(value), Ok(unit)) = (find(&name), Unit::parse(unit)) else {
        return Ok(());
    };
    let mut moving = None;
    tree.visit(&mut |part| {
        if let SyntaxKind::Name(name) = &part.kind
            && find(name).is_some_and(|own| model.contains_motion(&own.value))
        {
            moving.get_or_insert((part.span, format!("definition `{name}`")));
        }
    });
    if let Some((span, what)) = moving {
        return Err(motion_error(
            edit,
            span,
            &format!("the {what} depends on the motion"),
        ));
    }
    let is_number = value.unit.dimension == Dimension::DIMENSIONLESS;
    let (message, help) = match own_unit {
        Some(own) if !is_number => (
            format!("this value already has a unit, {}", value.unit),
            format!("remove `{own}`"),
        ),
        None if value.unit.dimension != unit.dimension && is_number => (
            format!(
                "`{}` is in {unit}, but this value is a pure number",
                edit.name
            ),
            format!("end with a unit: {given} {unit}"),
        ),
        None if value.unit.dimension != unit.dimension => (
            format!(
                "`{}` is in {unit}, but this value is in {}",
                edit.name, value.unit
            ),
            format!("write an expression in {unit}"),
        ),
        _ => return Ok(()),
    };
    let label = ("the value of the input", help.as_str());
    Err(expression_error(edit, tree.span, &message, label))
}

/// Splits a value into an expression and the unit after it, for example `5` and `kN`.
fn split_unit<'e>(
    edit: &'e PrescribeInput,
    unit: &str,
) -> Result<(&'e str, Option<&'e str>), EditError> {
    let Ok(tokens) = tokenize(&edit.value, Span::new) else {
        return Ok((&edit.value, None));
    };
    let is_word = |token: &Token| token.kind == TokenKind::Name("if".to_owned());
    let first = tokens.get(find_unit_start(&tokens));
    // The parser reports words of conditions such as `if`.
    let Some(first) = first.filter(|first| !is_word(first)) else {
        return Ok((&edit.value, None));
    };
    let (expression, own) = edit.value.split_at(first.span.start);
    let own = own.trim_end();
    let place = Span::new(first.span.start, first.span.start + own.len());
    let found = Unit::parse(own).map_err(|error| {
        let help = "write a product with `*`: 2*x, not 2 x; or end with a unit: 5 N";
        expression_error(edit, place, &error.message, ("not a unit", help))
    })?;
    if Unit::parse(unit).is_ok_and(|unit| unit.dimension != found.dimension) {
        let message = format!("`{}` is in {unit}, not in {found}", edit.name);
        let help = format!("give a unit of the same dimension as {unit}");
        let label = ("another kind of quantity", help.as_str());
        return Err(expression_error(edit, place, &message, label));
    }
    Ok((expression, Some(own)))
}

/// Returns the error of an expression at a position in it.
fn expression_error(
    edit: &PrescribeInput,
    span: Span,
    message: &str,
    (label, help): (&str, &str),
) -> EditError {
    let diagnostic = Diagnostic::error(message)
        .with_span(span, label)
        .with_help(help);
    EditError::Expression {
        text: edit.value.clone(),
        diagnostic: Box::new(diagnostic),
    }
}

/// Rejects an expression that contains a coordinate or a state of the machine.
fn reject_motion(
    document: &DocumentMut,
    edit: &PrescribeInput,
    tree: &Syntax,
) -> Result<(), EditError> {
    let kinds = [
        ("coordinates", "coordinate"),
        ("states", "first-order state"),
    ];
    let mut wrong = None;
    tree.visit(&mut |part| {
        let SyntaxKind::Name(name) = &part.kind else {
            return;
        };
        for (section, kind) in kinds {
            let entries = document.get(section).and_then(Item::as_table_like);
            if wrong.is_none() && entries.is_some_and(|entries| entries.contains_key(name)) {
                wrong = Some((part.span, name.clone(), kind));
            }
        }
    });
    let Some((span, name, kind)) = wrong else {
        return Ok(());
    };
    Err(motion_error(edit, span, &format!("`{name}` is a {kind}")))
}

/// Returns the error of an input that depends on the motion, with a reason.
fn motion_error(edit: &PrescribeInput, span: Span, reason: &str) -> EditError {
    let input = &edit.name;
    let message = format!("{reason}: the input `{input}` is an expression of t and parameters");
    let help = "write a force that depends on the motion under [forces], and a feedback under [controllers]";
    let label = "not known before the motion";
    expression_error(edit, span, &message, (label, help))
}

fn define(document: &mut DocumentMut, name: &str, value: String) -> Result<(), EditError> {
    let definition = NewTerm {
        section: Section::Definitions,
        name: name.to_owned(),
        value,
        doc: String::new(),
        source: String::new(),
    };
    insert_term(document, &definition)
}

fn contains_name(document: &DocumentMut, name: &str) -> bool {
    let is_of_names = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let text = document.to_string();
    text.split(|c: char| !is_of_names(c))
        .any(|word| word == name)
}

fn mentions_time(tree: &Syntax) -> bool {
    let mut mentions = false;
    tree.visit(&mut |part| mentions |= part.kind == SyntaxKind::Name("t".to_owned()));
    mentions
}

/// Removes an input from a document. Returns its unit, and true if its rates are given.
fn remove(document: &mut DocumentMut, name: &str) -> Option<(String, bool)> {
    let inputs = document
        .get_mut("inputs")
        .and_then(Item::as_table_like_mut)?;
    let input = inputs.remove(name)?;
    let has_rates = input.get("rates").is_some();
    let unit = match input.as_str() {
        Some(unit) => unit.to_owned(),
        None => input.get("unit")?.as_str()?.to_owned(),
    };
    if inputs.is_empty() {
        document.remove("inputs");
    }
    Some((unit, has_rates))
}

/// Returns true if an expression contains only numbers and the time.
fn has_only_numbers(tree: &Syntax) -> bool {
    let mut of_numbers = true;
    tree.visit(&mut |part| {
        of_numbers &= match &part.kind {
            SyntaxKind::Name(name) => name == "t" || name == "pi",
            SyntaxKind::Element { .. } | SyntaxKind::Vector(_) | SyntaxKind::Member { .. } => false,
            _ => true,
        }
    });
    of_numbers
}

/// Returns a name with this prefix that the document does not contain.
fn unused_name(document: &DocumentMut, name: &str) -> String {
    let text = document.to_string();
    let mut unused = name.to_owned();
    while text.contains(&unused) {
        unused.push('_');
    }
    unused
}

/// Adds a parameter of value 1 in a unit. Returns its name.
fn add_unit_factor(
    document: &mut DocumentMut,
    name: &str,
    unit: &str,
) -> Result<String, EditError> {
    let name = unused_name(document, name);
    let factor = NewParameter {
        name: name.clone(),
        value: NewValue::Number(1.0),
        unit: unit.to_owned(),
        doc: String::new(),
        source: UNIT_FACTOR_ORIGIN.to_owned(),
    };
    insert_parameter(document, &factor)?;
    Ok(name)
}
