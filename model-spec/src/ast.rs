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
    /// `[a, b, c]`, a vector by its components.
    Vector(Vec<Syntax>),
    /// `of.member`: a component of a vector, or what a frame has.
    Member {
        /// What has the member.
        of: Box<Syntax>,
        /// The member's name.
        member: String,
        /// Where the member's name stands.
        member_span: Span,
    },
    /// `-operand`.
    Negate(Box<Syntax>),
    /// `left operator right`.
    Binary(BinaryOperator, Box<Syntax>, Box<Syntax>),
}

impl Syntax {
    /// Sees this expression and all that it is made of.
    pub fn visit(&self, see: &mut impl FnMut(&Syntax)) {
        see(self);
        match &self.kind {
            SyntaxKind::Number(_) | SyntaxKind::Name(_) | SyntaxKind::Element { .. } => {}
            SyntaxKind::Call {
                arguments: parts, ..
            }
            | SyntaxKind::Vector(parts) => {
                for part in parts {
                    part.visit(see);
                }
            }
            SyntaxKind::Member { of: part, .. } | SyntaxKind::Negate(part) => part.visit(see),
            SyntaxKind::Binary(_, left, right) => {
                left.visit(see);
                right.visit(see);
            }
        }
    }
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
