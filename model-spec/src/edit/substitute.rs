//! Replaces an expression in a term. Expressions are compared as syntax trees and replaced in the text, so the other
//! text of the term is unchanged.

use toml_edit::{DocumentMut, Item, Value};

use super::{EditError, Section, Substitution};
use crate::ast::{Syntax, SyntaxKind};
use crate::lexer::tokenize;
use crate::parser::parse;
use crate::span::Span;

pub fn substitute(document: &mut DocumentMut, edit: &Substitution) -> Result<(), EditError> {
    let replacement = Replacement::new(&edit.find, &edit.replace)?;
    for term in &edit.terms {
        replacement.make(document, edit.section, term)?;
    }
    Ok(())
}

/// Returns the text with every occurrence of `find` replaced; `None` if there is no occurrence.
pub fn replace_all(text: &str, find: &str, replace: &str) -> Result<Option<String>, EditError> {
    Replacement::new(find, replace)?.replace_all(text)
}

struct Replacement<'e> {
    find: &'e str,
    pattern: Syntax,
    replace: &'e str,
    /// True if the replacement needs brackets next to an operator.
    needs_brackets: bool,
}

impl<'e> Replacement<'e> {
    fn new(find: &'e str, replace: &'e str) -> Result<Self, EditError> {
        let replacement = syntax(replace)?;
        Ok(Self {
            pattern: syntax(find)?,
            needs_brackets: matches!(
                replacement.kind,
                SyntaxKind::Binary(..) | SyntaxKind::Negate(_)
            ),
            find,
            replace: replace.trim(),
        })
    }

    fn make(
        &self,
        document: &mut DocumentMut,
        section: Section,
        term: &str,
    ) -> Result<(), EditError> {
        let entry = document
            .get_mut(section.name())
            .and_then(|item| item.get_mut(term));
        let place = entry.and_then(|item| expression_of(item, section.expression_key()));
        let Some((value, text)) = place else {
            return Err(EditError::MissingTerm {
                section: section.name().to_owned(),
                name: term.to_owned(),
            });
        };
        let Some(replaced) = self.replace_all(&text)? else {
            return Err(EditError::MissingExpression {
                section: section.name().to_owned(),
                name: term.to_owned(),
                find: self.find.to_owned(),
            });
        };
        let mut new_value = Value::from(replaced);
        *new_value.decor_mut() = value.decor().clone();
        *value = new_value;
        Ok(())
    }

    fn replace_all(&self, text: &str) -> Result<Option<String>, EditError> {
        let tree = syntax(text)?;
        let mut places = Vec::new();
        self.find_spans(&tree, false, &mut places);
        if places.is_empty() {
            return Ok(None);
        }
        places.sort_by_key(|(span, _)| span.start);
        let mut replaced = String::with_capacity(text.len());
        let mut done = 0;
        for (span, beside_operator) in places {
            replaced.push_str(&text[done..span.start]);
            if beside_operator && self.needs_brackets {
                replaced.push_str(&format!("({})", self.replace));
            } else {
                replaced.push_str(self.replace);
            }
            done = span.end;
        }
        replaced.push_str(&text[done..]);
        Ok(Some(replaced))
    }

    /// Collects the spans of the occurrences. The flag is true if the occurrence is next to an operator.
    fn find_spans(&self, tree: &Syntax, beside_operator: bool, found: &mut Vec<(Span, bool)>) {
        if is_same_tree(tree, &self.pattern) {
            found.push((tree.span, beside_operator));
            return;
        }
        match &tree.kind {
            SyntaxKind::Number(_) | SyntaxKind::Name(_) | SyntaxKind::Element { .. } => {}
            SyntaxKind::Call {
                arguments: parts, ..
            }
            | SyntaxKind::Vector(parts) => {
                for part in parts {
                    self.find_spans(part, false, found);
                }
            }
            SyntaxKind::Member { of, .. } => self.find_spans(of, true, found),
            SyntaxKind::Negate(operand) => self.find_spans(operand, true, found),
            SyntaxKind::Binary(_, left, right) => {
                self.find_spans(left, true, found);
                self.find_spans(right, true, found);
            }
        }
    }
}

/// Returns the TOML value that contains the expression of a term, and the text of the expression. If the term is a
/// table, `key` selects the value.
fn expression_of<'i>(item: &'i mut Item, key: &str) -> Option<(&'i mut Value, String)> {
    let value = if item.is_table_like() {
        item.get_mut(key)?.as_value_mut()?
    } else {
        item.as_value_mut()?
    };
    let text = value.as_str()?.to_owned();
    Some((value, text))
}

pub fn syntax(text: &str) -> Result<Syntax, EditError> {
    let end = Span::new(text.len(), text.len());
    let parsed = tokenize(text, Span::new).and_then(|tokens| parse(&tokens, end));
    parsed.map_err(|diagnostic| EditError::Expression {
        text: text.to_owned(),
        diagnostic: Box::new(diagnostic),
    })
}

/// Returns true if two trees are equal up to positions.
fn is_same_tree(one: &Syntax, other: &Syntax) -> bool {
    match (&one.kind, &other.kind) {
        (SyntaxKind::Number(one), SyntaxKind::Number(other)) => one == other,
        (SyntaxKind::Name(one), SyntaxKind::Name(other)) => one == other,
        (
            SyntaxKind::Element { name, index, .. },
            SyntaxKind::Element {
                name: other_name,
                index: other_index,
                ..
            },
        ) => name == other_name && index == other_index,
        (
            SyntaxKind::Call {
                function,
                arguments,
                ..
            },
            SyntaxKind::Call {
                function: other_function,
                arguments: other_arguments,
                ..
            },
        ) => {
            function == other_function
                && arguments.len() == other_arguments.len()
                && arguments
                    .iter()
                    .zip(other_arguments)
                    .all(|(a, b)| is_same_tree(a, b))
        }
        (SyntaxKind::Vector(one), SyntaxKind::Vector(other)) => {
            one.len() == other.len() && one.iter().zip(other).all(|(a, b)| is_same_tree(a, b))
        }
        (
            SyntaxKind::Member { of, member, .. },
            SyntaxKind::Member {
                of: other_of,
                member: other_member,
                ..
            },
        ) => member == other_member && is_same_tree(of, other_of),
        (SyntaxKind::Negate(one), SyntaxKind::Negate(other)) => is_same_tree(one, other),
        (SyntaxKind::Binary(one, a, b), SyntaxKind::Binary(other, c, d)) => {
            one == other && is_same_tree(a, c) && is_same_tree(b, d)
        }
        _ => false,
    }
}
