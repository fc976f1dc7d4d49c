//! Entries of TOML tables with the position of every key and value, and errors for values of the wrong kind. `record`
//! reports unknown keys; `quantity` contains the types of the values.

use toml_edit::{Item, Table, TableLike, Value};

use crate::diagnostic::{Diagnostic, quote};
use crate::keys::Keys;
use crate::lexer::check_underflow;
use crate::quantity::{Name, Number, Quantity, StringValue};
use crate::span::Span;
use crate::suggest::did_you_mean;
use crate::unit::Unit;

/// One `key = value` of a table.
#[derive(Clone)]
pub struct Entry<'d> {
    /// Key; for an element of a list, the key of the list.
    pub name: Name,
    node: Node<'d>,
    /// Text of the whole file.
    text: &'d str,
}

/// Value of a key, or element of a list.
#[derive(Clone, Copy)]
enum Node<'d> {
    Item(&'d Item),
    Value(&'d Value),
    Table(&'d Table),
}

/// Returns the entries of a table in the order of the file.
pub fn entries<'d>(table: &'d dyn TableLike, text: &'d str) -> Vec<Entry<'d>> {
    let named = |(key, item): (&str, &'d Item)| {
        let span = table.key(key).and_then(|key| key.span());
        Entry {
            name: Name {
                text: key.to_owned(),
                span: span.map_or_else(Span::default, |range| Span::new(range.start, range.end)),
            },
            node: Node::Item(item),
            text,
        }
    };
    table.iter().map(named).collect()
}

impl<'d> Entry<'d> {
    /// Returns the position of the value, or of the key if the value has none.
    pub fn span(&self) -> Span {
        let range = match self.node {
            Node::Item(item) => item.span(),
            Node::Value(value) => value.span(),
            Node::Table(table) => table.span(),
        };
        range.map_or(self.name.span, |range| Span::new(range.start, range.end))
    }

    /// Returns the entries of a table; an error for any other kind of value.
    pub fn table(&self, example: &str) -> Result<Vec<Entry<'d>>, Diagnostic> {
        match self.table_like() {
            Some(table) => Ok(entries(table, self.text)),
            None => Err(self.kind_error("a table", example)),
        }
    }

    /// Returns the entries of a table with these keys. The error for any other kind of value contains the value, if
    /// the table has a key `value`.
    pub fn table_of(&self, keys: &Keys) -> Result<Vec<Entry<'d>>, Diagnostic> {
        match self.table_like() {
            Some(table) => Ok(entries(table, self.text)),
            None => Err(self.kind_error("a table", &keys.example_with(&self.given_values(keys)))),
        }
    }

    /// Returns the keys `value` and `unit` of the table that should be written instead of a number or a string, with their text.
    fn given_values(&self, keys: &Keys) -> Vec<(&'static str, String)> {
        let span = self.span();
        let written = self.text.get(span.start..span.end).unwrap_or_default();
        let is_key = |name: &str| keys.names().any(|key| key == name);
        match self.value() {
            _ if !is_key("value") => Vec::new(),
            Some(Value::Integer(_) | Value::Float(_)) if is_key("unit") => vec![
                ("value", written.to_owned()),
                ("unit", "\"UNIT\"".to_owned()),
            ],
            Some(Value::String(text)) => match Unit::parse_quantity(text.value()) {
                Some((number, unit)) if is_key("unit") => vec![
                    ("value", number.to_string()),
                    ("unit", format!("\"{unit}\"")),
                ],
                _ => vec![("value", written.to_owned())],
            },
            Some(Value::Integer(_) | Value::Float(_)) => vec![("value", written.to_owned())],
            _ => Vec::new(),
        }
    }

    /// Returns true if the value is a table with its own header.
    pub fn is_section(&self) -> bool {
        matches!(self.node, Node::Item(Item::Table(table)) if !table.is_dotted())
    }

    /// Returns the elements of a list, each with the key of the list and its own position; an
    /// error for any other kind of value.
    pub fn list(&self, example: &str) -> Result<Vec<Entry<'d>>, Diagnostic> {
        let element = |node: Node<'d>| {
            let mut entry = Entry {
                node,
                ..self.clone()
            };
            entry.name.span = entry.span();
            entry
        };
        if let Node::Item(Item::ArrayOfTables(tables)) = self.node {
            return Ok(tables.iter().map(|t| element(Node::Table(t))).collect());
        }
        match self.value() {
            Some(Value::Array(array)) => {
                Ok(array.iter().map(|v| element(Node::Value(v))).collect())
            }
            _ => Err(self.kind_error("a list", example)),
        }
    }

    /// Returns the value that `known` assigns to the word.
    ///
    /// # Errors
    /// The value is of another kind, or the word is unknown; the message contains the nearest known word.
    pub fn keyword<T: Copy>(&self, known: &[(&str, T)]) -> Result<T, Diagnostic> {
        let written = self.written()?;
        let meant = known.iter().find(|(word, _)| *word == written.text);
        meant.map(|(_, meaning)| *meaning).ok_or_else(|| {
            let words = || known.iter().map(|(word, _)| *word);
            let listed: Vec<String> = words().map(|word| format!("\"{word}\"")).collect();
            let listed = format!("expected {}", listed.join(" or "));
            Diagnostic::error(format!(
                "`{}` cannot be {}",
                self.name.text,
                quote(&written.text)
            ))
            .with_span(written.span, listed.clone())
            .with_help(did_you_mean(&written.text, words()).unwrap_or(listed))
        })
    }

    /// Returns a truth value; an error for any other kind of value.
    pub fn boolean(&self) -> Result<bool, Diagnostic> {
        match self.value() {
            Some(Value::Boolean(truth)) => Ok(*truth.value()),
            _ => Err(self.kind_error("a truth value", "true")),
        }
    }

    fn value(&self) -> Option<&'d Value> {
        match self.node {
            Node::Item(item) => item.as_value(),
            Node::Value(value) => Some(value),
            Node::Table(_) => None,
        }
    }

    fn table_like(&self) -> Option<&'d dyn TableLike> {
        match self.node {
            Node::Item(item) => item.as_table_like(),
            Node::Value(value) => value.as_inline_table().map(|t| t as &dyn TableLike),
            Node::Table(table) => Some(table),
        }
    }

    /// Returns true if the value is a table.
    pub fn is_table(&self) -> bool {
        self.table_like().is_some()
    }

    /// Returns a string; an error for any other kind of value.
    pub fn written(&self) -> Result<StringValue, Diagnostic> {
        let value = self.value();
        value
            .and_then(|value| self.written_in(value))
            .ok_or_else(|| self.kind_error("a string", "\"...\""))
    }

    /// Returns a finite number.
    ///
    /// # Errors
    /// The value is of another kind, or the number is not finite.
    pub fn number(&self) -> Result<Number, Diagnostic> {
        let value = self.value();
        value
            .and_then(|value| self.number_in(value))
            .unwrap_or_else(|| Err(self.kind_error("a number", "0.5")))
    }

    /// Returns a number or an expression; an error for any other kind of value.
    pub fn quantity(&self) -> Result<Quantity, Diagnostic> {
        let value = self.value();
        value
            .and_then(|value| self.quantity_in(value))
            .unwrap_or_else(|| {
                Err(self.kind_error("a number or an expression in quotes", "\"m*g*a\""))
            })
    }

    /// Returns a scalar or a vector: a number, an expression or an array of components; an
    /// error for any other kind of value.
    pub fn scalar_or_vector(&self) -> Result<Quantity, Diagnostic> {
        match self.value() {
            Some(Value::Array(_)) => {
                let components = self.list("[\"x\", \"y\", 0]")?;
                let components = components.iter().map(Entry::quantity);
                Ok(Quantity::Vector(
                    components.collect::<Result<_, _>>()?,
                    self.span(),
                ))
            }
            _ => self.quantity(),
        }
    }

    /// Returns a vector: an array of three components, or an expression; an error for any other
    /// kind of value.
    pub fn vector(&self, example: &str) -> Result<Quantity, Diagnostic> {
        match self.written() {
            Ok(written) => Ok(Quantity::Expression(written)),
            Err(_) => Ok(Quantity::Vector(
                self.quantities(&[3], example)?,
                self.span(),
            )),
        }
    }

    /// Returns the two numbers or expressions of an array, for example a range.
    ///
    /// # Errors
    /// The value is of another kind, or the number of elements differs.
    pub fn pair(&self) -> Result<[Quantity; 2], Diagnostic> {
        let example = "[-0.1, 0.1]";
        let Some(Value::Array(array)) = self.value() else {
            return Err(self.kind_error("a pair of ends", example));
        };
        let elements: Vec<&Value> = array.iter().collect();
        let [low, high] = elements[..] else {
            let name = &self.name.text;
            let message = format!("{} needs two ends, not {}", quote(name), array.len());
            return Err(Diagnostic::error(message)
                .with_span(self.span(), "expected the lower and the upper end")
                .with_help(format!("write {name} = {example}")));
        };
        let end = |value: &Value| {
            self.quantity_in(value).unwrap_or_else(|| {
                let message = "an end must be a number or an expression in quotes";
                Err(Diagnostic::error(message)
                    .with_span(self.place(value), "this is neither")
                    .with_help(format!("write {} = {example}", self.name.text)))
            })
        };
        Ok([end(low)?, end(high)?])
    }

    /// Returns the numbers or expressions of an array with one of the lengths in `counts`.
    ///
    /// # Errors
    /// The value is of another kind, or the number of elements differs.
    pub fn quantities(&self, counts: &[usize], example: &str) -> Result<Vec<Quantity>, Diagnostic> {
        let list = self.list(example)?;
        if !counts.contains(&list.len()) {
            let name = &self.name.text;
            let counts: Vec<String> = counts.iter().map(usize::to_string).collect();
            let (counts, given) = (counts.join(" or "), list.len());
            let message = format!("{} needs {counts} components, not {given}", quote(name));
            return Err(Diagnostic::error(message)
                .with_span(self.span(), format!("{given} given"))
                .with_help(format!("write {name} = {example}")));
        }
        list.iter().map(Entry::quantity).collect()
    }

    /// Returns the position of a value of this entry, or of the entry if the value has none.
    fn place(&self, value: &Value) -> Span {
        let range = value.span();
        range.map_or_else(|| self.span(), |range| Span::new(range.start, range.end))
    }

    /// Returns a string, or `None` for a value of another kind.
    fn written_in(&self, value: &Value) -> Option<StringValue> {
        let Value::String(string) = value else {
            return None;
        };
        let span = self.place(value);
        Some(StringValue {
            text: string.value().clone(),
            span,
            first: first_character(self.text, span, string.value()),
        })
    }

    /// Returns a finite number, or `None` for a value of another kind.
    fn number_in(&self, value: &Value) -> Option<Result<Number, Diagnostic>> {
        let span = self.place(value);
        let value = match value {
            Value::Integer(integer) => *integer.value() as f64,
            Value::Float(float) => *float.value(),
            _ => return None,
        };
        let shown = self.text.get(span.start..span.end).unwrap_or("this");
        if value.is_finite() {
            return Some(check_underflow(shown, value, span).map(|()| Number { value, span }));
        }
        let message = format!("{} is not a finite number", quote(shown));
        Some(Err(
            Diagnostic::error(message).with_span(span, "expected a finite number")
        ))
    }

    /// Returns a number or an expression, or `None` for a value of another kind.
    fn quantity_in(&self, value: &Value) -> Option<Result<Quantity, Diagnostic>> {
        match self.written_in(value) {
            Some(written) => Some(Ok(Quantity::Expression(written))),
            None => Some(self.number_in(value)?.map(Quantity::Number)),
        }
    }

    /// Returns a whole number; an error for any other kind of value.
    pub fn integer(&self) -> Result<(i64, Span), Diagnostic> {
        match self.value() {
            Some(Value::Integer(integer)) => Ok((*integer.value(), self.span())),
            _ => Err(self.kind_error("a whole number", "4")),
        }
    }

    fn kind_error(&self, expected: &str, example: &str) -> Diagnostic {
        let kind = match self.node {
            Node::Item(item) => item.type_name(),
            Node::Value(value) => value.type_name(),
            Node::Table(_) => "table",
        };
        let kind = match kind {
            "inline table" => "table",
            "integer" | "float" => "number",
            "boolean" => "truth value",
            other => other,
        };
        let article = if kind == "array" { "an" } else { "a" };
        Diagnostic::error(format!("{} is not {expected}", quote(&self.name.text)))
            .with_span(self.span(), format!("this is {article} {kind}"))
            .with_help(format!("write {} = {example}", self.name.text))
    }
}

/// Returns the offset of the first character of a string, if it has no escapes.
fn first_character(text: &str, span: Span, value: &str) -> Option<usize> {
    let raw = text.get(span.start..span.end)?;
    let opening = if raw.starts_with("\"\"\"") || raw.starts_with("'''") {
        let newline = raw[3..].starts_with("\r\n").then_some(2);
        3 + newline.unwrap_or(usize::from(raw[3..].starts_with('\n')))
    } else {
        1
    };
    let inside = raw.get(opening..)?;
    inside.starts_with(value).then_some(span.start + opening)
}
