//! The syntax tree of one expression, before any name is looked up. Names, units and
//! meaning are given by `resolve`, which turns this tree into [`crate::model::Expr`].

use crate::span::Span;

/// An expression as written, with the place of every part.
#[derive(Clone, Debug, PartialEq)]
pub struct Syntax {
    /// What stands here.
    pub kind: SyntaxKind,
    /// Where it stands.
    pub span: Span,
}

/// The forms of an expression as written.
#[derive(Clone, Debug, PartialEq)]
pub enum SyntaxKind {
    /// A numeric literal.
    Number(f64),
    /// A name on its own.
    Name(String),
    /// `name[index]`, an element of a field's modes inside a sum.
    Element {
        /// The indexed name (a field's mode coordinates, or `phi`).
        name: String,
        /// The sum's index.
        index: String,
        /// Where the index stands.
        index_span: Span,
    },
    /// `function(arguments)`.
    Call {
        /// The function's name.
        function: String,
        /// Where the function's name stands.
        function_span: Span,
        /// The arguments in order.
        arguments: Vec<Syntax>,
    },
    /// `-operand`.
    Negate(Box<Syntax>),
    /// `left operator right`.
    Binary(BinaryOperator, Box<Syntax>, Box<Syntax>),
}

/// The binary operators; `^` binds tightest and to the right, above unary minus.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BinaryOperator {
    /// `+`
    Add,
    /// `-`
    Subtract,
    /// `*`
    Multiply,
    /// `/`
    Divide,
    /// `^`
    Power,
}
