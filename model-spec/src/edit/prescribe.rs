//! Replaces an input by a definition of the same name, so that all references remain valid.

use toml_edit::{DocumentMut, Item};

use super::insert::{parameter, term};
use super::substitute::{replaced, syntax};
use super::{EditError, NewParameter, NewTerm, NewValue, PrescribeInput, Section};
use crate::assignment::find_unit_start;
use crate::ast::{Syntax, SyntaxKind};
use crate::diagnostic::Diagnostic;
use crate::lexer::{Token, TokenKind, tokenize};
use crate::span::Span;
use crate::unit::Unit;

pub fn prescribe(document: &mut DocumentMut, edit: &PrescribeInput) -> Result<(), EditError> {
    let (unit, has_rates) = remove(document, &edit.name).ok_or_else(|| EditError::MissingTerm {
        section: "inputs".to_owned(),
        name: edit.name.clone(),
    })?;
    let (given, own_unit) = split_unit(edit, &unit)?;
    let tree = syntax(given)?;
    reject_motion(document, edit, &tree)?;
    if own_unit.is_some() && !has_only_numbers(&tree) {
        let help = "remove the unit: parameters have units";
        let label = ("an expression with a unit", help);
        return Err(rejected(
            edit,
            tree.span,
            "this value already has a unit",
            label,
        ));
    }
    let value = if has_only_numbers(&tree) {
        // Numbers are dimensionless, and units are checked: parameters of value 1, a second and a
        // unit of the input, supply the units.
        let (second, one) = (
            unused_name(document, "one_second"),
            unused_name(document, "one_unit"),
        );
        let timed = replaced(given, "t", &format!("t/{second}"))?;
        if timed.is_some() {
            parameter(document, &unit_parameter(&second, "s"))?;
        }
        parameter(document, &unit_parameter(&one, own_unit.unwrap_or(&unit)))?;
        format!("({})*{one}", timed.as_deref().unwrap_or(given))
    } else {
        given.to_owned()
    };
    if !has_rates {
        return define(document, &edit.name, value);
    }
    // The factor depends on the time, so that the definition has a rate.
    let value = if mentions_time(&tree) {
        value
    } else {
        let second = unused_name(document, "one_second");
        parameter(document, &unit_parameter(&second, "s"))?;
        format!("({value})*(1 + 0*t/{second})")
    };
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
    // The parser explains conditions.
    let Some(first) = first.filter(|first| !is_word(first)) else {
        return Ok((&edit.value, None));
    };
    let (expression, own) = edit.value.split_at(first.span.start);
    let own = own.trim_end();
    let place = Span::new(first.span.start, first.span.start + own.len());
    let found = Unit::parse(own).map_err(|error| {
        let help = "write a product with `*`: 2*x, not 2 x; or end with a unit: 5 N";
        rejected(edit, place, &error.message, ("not a unit", help))
    })?;
    if Unit::parse(unit).is_ok_and(|unit| unit.dimension != found.dimension) {
        let message = format!("`{}` is in {unit}, not in {found}", edit.name);
        let help = format!("give a unit of the same dimension as {unit}");
        let label = ("another kind of quantity", help.as_str());
        return Err(rejected(edit, place, &message, label));
    }
    Ok((expression, Some(own)))
}

/// Returns the error of an expression at a place in it.
fn rejected(
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
    let input = &edit.name;
    let message =
        format!("`{name}` is a {kind}: the input `{input}` is an expression of t and parameters");
    let help = "write a force that depends on the motion under [forces], and a feedback under [controllers]";
    let label = "not known before the motion";
    Err(rejected(edit, span, &message, (label, help)))
}

fn define(document: &mut DocumentMut, name: &str, value: String) -> Result<(), EditError> {
    let definition = NewTerm {
        section: Section::Definitions,
        name: name.to_owned(),
        value,
        doc: String::new(),
        source: String::new(),
    };
    term(document, &definition)
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

fn unit_parameter(name: &str, unit: &str) -> NewParameter {
    NewParameter {
        name: name.to_owned(),
        value: NewValue::Number(1.0),
        unit: unit.to_owned(),
        doc: String::new(),
        source: String::new(),
    }
}
