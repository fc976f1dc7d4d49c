//! Sums and products of expressions; terms that are 0 and factors that are 1 are dropped.

use crate::ast::{BinaryOperator, Syntax, SyntaxKind};
use crate::quantity::Quantity;
use crate::span::Span;

/// Converts a generated expression to a quantity.
pub fn expansion(syntax: Syntax) -> Quantity {
    Quantity::Expansion(Box::new(syntax))
}

pub fn number(value: f64, span: Span) -> Syntax {
    Syntax {
        kind: SyntaxKind::Number(value),
        span,
    }
}

pub fn name(text: &str, span: Span) -> Syntax {
    Syntax {
        kind: SyntaxKind::Name(text.to_owned()),
        span,
    }
}

pub fn set_span(mut syntax: Syntax, span: Span) -> Syntax {
    syntax.span = span;
    match &mut syntax.kind {
        SyntaxKind::Negate(operand) => **operand = set_span((**operand).clone(), span),
        SyntaxKind::Call {
            function_span,
            arguments,
            ..
        } => {
            *function_span = span;
            for argument in arguments {
                *argument = set_span(argument.clone(), span);
            }
        }
        _ => {}
    }
    syntax
}

pub fn call(function: &str, argument: Syntax) -> Syntax {
    let span = argument.span;
    let kind = SyntaxKind::Call {
        function: function.to_owned(),
        function_span: span,
        arguments: vec![argument],
    };
    Syntax { kind, span }
}

/// Returns true if an expression is a number, a name, a rate or minus one of them.
pub fn is_plain(value: &Syntax) -> bool {
    let plain = |syntax: &Syntax| match &syntax.kind {
        SyntaxKind::Number(_) | SyntaxKind::Name(_) => true,
        SyntaxKind::Call { function, .. } => function == "dot",
        _ => false,
    };
    match &value.kind {
        SyntaxKind::Negate(operand) => plain(operand),
        _ => plain(value),
    }
}

pub fn is_literal(syntax: &Syntax, value: f64) -> bool {
    syntax.kind == SyntaxKind::Number(value)
}

pub fn negate(a: Syntax) -> Syntax {
    let span = a.span;
    match a.kind {
        SyntaxKind::Number(value) => number(0.0 - value, span),
        SyntaxKind::Negate(operand) => *operand,
        _ => Syntax {
            kind: SyntaxKind::Negate(Box::new(a)),
            span,
        },
    }
}

pub fn add(a: Syntax, b: Syntax) -> Syntax {
    if is_literal(&a, 0.0) {
        return b;
    }
    if is_literal(&b, 0.0) {
        return a;
    }
    let span = a.span;
    match b.kind {
        SyntaxKind::Negate(operand) => binary(BinaryOperator::Subtract, a, *operand, span),
        _ => binary(BinaryOperator::Add, a, b, span),
    }
}

pub fn multiply(a: Syntax, b: Syntax) -> Syntax {
    if is_literal(&a, 0.0) || is_literal(&b, 1.0) {
        return a;
    }
    if is_literal(&b, 0.0) || is_literal(&a, 1.0) {
        return b;
    }
    if is_literal(&a, -1.0) {
        return negate(b);
    }
    if is_literal(&b, -1.0) {
        return negate(a);
    }
    let span = b.span;
    match (a.kind, b.kind) {
        (SyntaxKind::Negate(a), SyntaxKind::Negate(b)) => multiply(*a, *b),
        (SyntaxKind::Negate(a), kind) => negate(multiply(*a, Syntax { kind, span })),
        (kind, SyntaxKind::Negate(b)) => negate(multiply(Syntax { kind, span }, *b)),
        (left, right) => {
            let left = Syntax {
                kind: left,
                span: a.span,
            };
            let right = Syntax { kind: right, span };
            binary(BinaryOperator::Multiply, left, right, span)
        }
    }
}

/// Returns `0*a`, which has the unit of `a`.
pub fn zero_times(a: &Syntax, span: Span) -> Syntax {
    binary(BinaryOperator::Multiply, number(0.0, span), a.clone(), span)
}

pub fn square(a: Syntax) -> Syntax {
    let span = a.span;
    match a.kind {
        SyntaxKind::Number(value) => number(value * value, span),
        SyntaxKind::Negate(operand) => square(*operand),
        _ => binary(BinaryOperator::Power, a, number(2.0, span), span),
    }
}

pub fn half(a: Syntax) -> Syntax {
    let span = a.span;
    multiply(number(0.5, span), a)
}

fn binary(operator: BinaryOperator, a: Syntax, b: Syntax, span: Span) -> Syntax {
    Syntax {
        kind: SyntaxKind::Binary(operator, Box::new(a), Box::new(b)),
        span,
    }
}
