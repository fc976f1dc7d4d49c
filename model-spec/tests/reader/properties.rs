//! Properties for arbitrary input: no panics, printed expressions parse to the same tree, units
//! follow the laws of multiplication.

use eomgen_model_spec::ast::{BinaryOperator, Syntax, SyntaxKind};
use eomgen_model_spec::check;
use eomgen_model_spec::dimension::Dimension;
use eomgen_model_spec::lexer::tokenize;
use eomgen_model_spec::models;
use eomgen_model_spec::parser::parse;
use eomgen_model_spec::source::Source;
use eomgen_model_spec::span::Span;
use eomgen_model_spec::unit::Unit;
use proptest::prelude::*;

fn parsed(text: &str) -> Option<Syntax> {
    let end = Span::new(text.len(), text.len());
    parse(&tokenize(text, Span::new).ok()?, end).ok()
}

/// Prints an expression with only the brackets that precedence needs, and returns its
/// precedence.
fn write_expression(syntax: &Syntax) -> (String, u8) {
    let bracketed = |part: &Syntax, least: u8| {
        let (text, binding) = write_expression(part);
        if binding < least {
            format!("({text})")
        } else {
            text
        }
    };
    match &syntax.kind {
        SyntaxKind::Number(value) => (format!("{value}"), 5),
        SyntaxKind::Name(name) => (name.clone(), 5),
        SyntaxKind::Element { name, index, .. } => (format!("{name}[{index}]"), 5),
        SyntaxKind::Call {
            function,
            arguments,
            ..
        } => {
            let arguments: Vec<_> = arguments.iter().map(|a| write_expression(a).0).collect();
            (format!("{function}({})", arguments.join(", ")), 5)
        }
        SyntaxKind::Vector(components) => {
            let components: Vec<_> = components.iter().map(|c| write_expression(c).0).collect();
            (format!("[{}]", components.join(", ")), 5)
        }
        SyntaxKind::Member { of, member, .. } => (format!("{}.{member}", bracketed(of, 5)), 5),
        SyntaxKind::Negate(operand) => (format!("-{}", bracketed(operand, 3)), 3),
        SyntaxKind::Binary(operator, left, right) => {
            let (sign, own) = match operator {
                BinaryOperator::Add => (" + ", 1),
                BinaryOperator::Subtract => (" - ", 1),
                BinaryOperator::Multiply => ("*", 2),
                BinaryOperator::Divide => ("/", 2),
                BinaryOperator::Power => ("^", 4),
            };
            // Powers are right-associative, and the exponent may have a sign.
            let (least_left, least_right) = if own == 4 { (5, 3) } else { (own, own + 1) };
            let (left, right) = (bracketed(left, least_left), bracketed(right, least_right));
            (format!("{left}{sign}{right}"), own)
        }
    }
}

/// Returns the tree without positions.
fn remove_positions(syntax: &Syntax) -> Syntax {
    let span = Span::default();
    let kind = match &syntax.kind {
        SyntaxKind::Call {
            function,
            arguments,
            ..
        } => SyntaxKind::Call {
            function: function.clone(),
            function_span: span,
            arguments: arguments.iter().map(remove_positions).collect(),
        },
        SyntaxKind::Element { name, index, .. } => SyntaxKind::Element {
            name: name.clone(),
            index: index.clone(),
            index_span: span,
        },
        SyntaxKind::Vector(components) => {
            SyntaxKind::Vector(components.iter().map(remove_positions).collect())
        }
        SyntaxKind::Member { of, member, .. } => SyntaxKind::Member {
            of: Box::new(remove_positions(of)),
            member: member.clone(),
            member_span: span,
        },
        SyntaxKind::Negate(operand) => SyntaxKind::Negate(Box::new(remove_positions(operand))),
        SyntaxKind::Binary(operator, left, right) => SyntaxKind::Binary(
            *operator,
            Box::new(remove_positions(left)),
            Box::new(remove_positions(right)),
        ),
        other => other.clone(),
    };
    Syntax { kind, span }
}

fn node(kind: SyntaxKind) -> Syntax {
    Syntax {
        kind,
        span: Span::default(),
    }
}

fn syntax() -> impl Strategy<Value = Syntax> {
    let leaf = prop_oneof![
        (0u32..1000).prop_map(|n| node(SyntaxKind::Number(f64::from(n) / 8.0))),
        "[a-z][a-z0-9_]{0,5}".prop_map(|name| node(SyntaxKind::Name(name))),
    ];
    leaf.prop_recursive(6, 64, 3, |inner| {
        let operator = prop_oneof![
            Just(BinaryOperator::Add),
            Just(BinaryOperator::Subtract),
            Just(BinaryOperator::Multiply),
            Just(BinaryOperator::Divide),
            Just(BinaryOperator::Power),
        ];
        let call = ("[a-z]{1,4}", prop::collection::vec(inner.clone(), 0..3));
        let vector = prop::collection::vec(inner.clone(), 1..4);
        let vector = vector.prop_map(|components| node(SyntaxKind::Vector(components)));
        let member = (vector.clone(), "[a-z]{1,4}").prop_map(|(of, member)| {
            node(SyntaxKind::Member {
                of: Box::new(of),
                member,
                member_span: Span::default(),
            })
        });
        prop_oneof![
            vector,
            member,
            (operator, inner.clone(), inner.clone())
                .prop_map(|(o, l, r)| node(SyntaxKind::Binary(o, Box::new(l), Box::new(r)))),
            inner.prop_map(|operand| node(SyntaxKind::Negate(Box::new(operand)))),
            call.prop_map(|(function, arguments)| node(SyntaxKind::Call {
                function,
                function_span: Span::default(),
                arguments,
            })),
        ]
    })
}

fn dimension() -> impl Strategy<Value = Dimension> {
    [-4i32..5, -4i32..5, -4i32..5, -4i32..5].prop_map(Dimension::from_mechanical_exponents)
}

proptest! {
    #[test]
    fn printed_expression_parses_to_the_same_tree(tree in syntax()) {
        let (text, _) = write_expression(&tree);
        let read = parsed(&text);
        prop_assert_eq!(read.as_ref().map(remove_positions), Some(tree), "{}", text);
    }

    #[test]
    fn arbitrary_text_does_not_panic(text in ".{0,200}") {
        let _ = parsed(&text);
        let _ = Unit::parse(&text);
        let _ = check(Source::new("any.toml", text)).map_err(|found| found.render(false));
    }

    #[test]
    fn arbitrary_expressions_do_not_panic(text in "[-+*/^()\\[\\],. a-c0-9e]{0,60}") {
        let _ = parsed(&text);
        let specification = format!(
            "[model]\nname = \"any\"\n[coordinates]\na = {{ unit = \"m\" }}\n\
             [kinetic]\nk = '{text}'\n"
        );
        let found = check(Source::new("any.toml", specification));
        let _ = found.map_err(|found| (found.render(true), found.records()));
    }

    #[test]
    fn fragments_of_a_specification_do_not_panic(start in 0usize..9000, length in 0usize..9000) {
        let whole = models::PLANETARY_ARM.text;
        let start = whole.floor_char_boundary(start);
        let end = whole.floor_char_boundary(start + length);
        let without = format!("{}{}", &whole[..start], &whole[end..]);
        for text in [&whole[start..end], &without] {
            let _ = check(Source::new("any.toml", text)).map_err(|found| found.render(false));
        }
    }

    #[test]
    fn dimensions_multiply_like_numbers(a in dimension(), b in dimension(), c in dimension()) {
        prop_assert_eq!(a.multiply(b), b.multiply(a));
        let left = a.multiply(b).and_then(|ab| ab.multiply(c));
        prop_assert_eq!(left, b.multiply(c).and_then(|bc| a.multiply(bc)));
        prop_assert_eq!(a.multiply(b).and_then(|ab| ab.divide(b)), Some(a));
        prop_assert_eq!(a.divide(a), Some(Dimension::DIMENSIONLESS));
        prop_assert_eq!(a.raise(2.into()), a.multiply(a));
    }

    #[test]
    fn printed_dimension_parses_to_itself(a in dimension()) {
        let read = Unit::parse(&a.to_string());
        prop_assert_eq!(read.map(|unit| (unit.dimension, unit.is_coherent())), Ok((a, true)));
    }

    #[test]
    fn conversion_to_si_and_back_is_within_rounding(
        value in -1e6f64..1e6,
        unit in prop::sample::select(vec!["mm", "um", "deg", "GPa", "g/cm^3", "km/h", "N m/deg"]),
    ) {
        let unit = Unit::parse(unit).expect("a unit");
        let back = unit.from_si(unit.to_si(value));
        // There are two roundings, so the error is at most two units in the last place.
        prop_assert!((back - value).abs() <= 2.0 * f64::EPSILON * value.abs());
    }
}
