//! Values of a TOML file with their positions: keys, strings, numbers and expressions.

use crate::ast::{Syntax, SyntaxKind};
use crate::diagnostic::Diagnostic;
use crate::lexer::tokenize;
use crate::parser::parse;
use crate::span::Span;

/// Key of the file.
#[derive(Clone, Debug)]
pub struct Name {
    /// The key.
    pub text: String,
    /// Position of the key.
    pub span: Span,
}

/// String value of the file.
#[derive(Clone, Debug)]
pub struct StringValue {
    /// The string, with escapes resolved.
    pub text: String,
    /// Position, including the quotes.
    pub span: Span,
    /// Offset of the first character in the file, if the string has no escapes. The bytes of the string are then
    /// equal to the bytes of the file.
    pub(crate) first: Option<usize>,
}

/// Finite number of the file.
#[derive(Clone, Copy, Debug)]
pub struct Number {
    /// The value.
    pub value: f64,
    /// Position of the number.
    pub span: Span,
}

/// Number or expression.
#[derive(Clone, Debug)]
pub enum Quantity {
    /// TOML number.
    Number(Number),
    /// TOML string.
    Expression(StringValue),
    /// TOML array: a vector from its components.
    Vector(Vec<Quantity>, Span),
    /// Expression that replaces a shorthand.
    Expansion(Box<Syntax>),
}

impl StringValue {
    /// Creates a string that the file does not contain. `span` is the position in the file for which it is created.
    pub fn without_text(text: &str, span: Span) -> Self {
        Self {
            text: text.to_owned(),
            span,
            first: None,
        }
    }

    /// Returns the position of the bytes `start..end` of the string, or the position of the whole string if it has
    /// escapes.
    pub fn place(&self, start: usize, end: usize) -> Span {
        match self.first {
            Some(first) => Span::new(first + start, first + end),
            None => self.span,
        }
    }

    /// Parses the string as an expression.
    ///
    /// # Errors
    /// The expression has a syntax error.
    pub fn syntax(&self) -> Result<Syntax, Diagnostic> {
        let tokens = tokenize(&self.text, |start, end| self.place(start, end))?;
        let written = self.text.trim_end().len();
        // An empty span would be invisible: the end is underlined one character wide.
        let end = self.place(written, written + 1);
        parse(&tokens, end)
    }
}

impl Quantity {
    /// Parses the expression; a number is a literal.
    ///
    /// # Errors
    /// As for [`StringValue::syntax`].
    pub fn syntax(&self) -> Result<Syntax, Diagnostic> {
        match self {
            Self::Number(number) => Ok(Syntax {
                kind: SyntaxKind::Number(number.value),
                span: number.span,
            }),
            Self::Expression(written) => written.syntax(),
            Self::Vector(components, span) => {
                let components = components.iter().map(Self::syntax);
                Ok(Syntax {
                    kind: SyntaxKind::Vector(components.collect::<Result<_, _>>()?),
                    span: *span,
                })
            }
            Self::Expansion(syntax) => Ok(syntax.as_ref().clone()),
        }
    }

    /// Returns the position.
    pub fn span(&self) -> Span {
        match self {
            Self::Number(number) => number.span,
            Self::Expression(written) => written.span,
            Self::Vector(_, span) => *span,
            Self::Expansion(syntax) => syntax.span,
        }
    }
}
