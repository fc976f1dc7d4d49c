//! Syntax tree of one expression, before names are resolved. `resolve` converts it to [`crate::model::Expr`].

use crate::span::Span;

/// Expression as written, with the position of every part.
#[derive(Clone, Debug, PartialEq)]
pub struct Syntax {
    /// Form of the expression.
    pub kind: SyntaxKind,
    /// Position of the expression.
    pub span: Span,
}

/// Forms of an expression.
#[derive(Clone, Debug, PartialEq)]
pub enum SyntaxKind {
    /// Numeric literal.
    Number(f64),
    /// Name.
    Name(String),
    /// `name[index]`, an element of a field's modes in a sum.
    Element {
        /// The indexed name: modal coordinates of a field, or `phi`.
        name: String,
        /// The index of the sum.
        index: String,
        /// Position of the index.
        index_span: Span,
    },
    /// `function(arguments)`.
    Call {
        /// Name of the function.
        function: String,
        /// Position of the name.
        function_span: Span,
        /// Arguments in order.
        arguments: Vec<Syntax>,
    },
    /// `[a, b, c]`, a vector from its components.
    Vector(Vec<Syntax>),
    /// `of.member`, a component of a vector or a member of a frame.
    Member {
        /// The vector or the frame.
        of: Box<Syntax>,
        /// Name of the member.
        member: String,
        /// Position of the name.
        member_span: Span,
    },
    /// `-operand`.
    Negate(Box<Syntax>),
    /// `left operator right`.
    Binary(BinaryOperator, Box<Syntax>, Box<Syntax>),
}

impl Syntax {
    /// Calls `see` with this expression and all its subexpressions.
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

/// Binary operators. `^` has the highest precedence and is right-associative, above unary
/// minus.
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
