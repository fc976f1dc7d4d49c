//! Parses tokens to a syntax tree, with the usual mathematical precedence. `^` has the highest precedence and is
//! right-associative, above unary minus: -x^2 is -(x^2), and 2^-1 is valid. The depth of the tree is bounded because
//! the later steps recurse over it.

use crate::ast::{BinaryOperator, Syntax, SyntaxKind};
use crate::diagnostic::Diagnostic;
use crate::foreign::find_word_equivalent;
use crate::lexer::{Token, TokenKind};
use crate::span::Span;
use crate::unit::Unit;

/// Largest accepted depth of a tree. A sum of 200 terms has this depth.
pub const MAX_DEPTH: usize = 200;

/// Precedence of the operators.
const ADDITIVE: u8 = 1;
const MULTIPLICATIVE: u8 = 2;
const UNARY: u8 = 3;
const POWER: u8 = 4;

/// Parses a whole expression; `end` is the position after its last token.
///
/// # Errors
/// A token is unexpected or missing.
pub fn parse(tokens: &[Token], end: Span) -> Result<Syntax, Diagnostic> {
    let mut parser = Parser {
        tokens,
        next: 0,
        end,
        nesting: 0,
    };
    let tree = parser.parse_expression(ADDITIVE)?;
    match parser.peek() {
        None => Ok(tree.syntax),
        Some(token) => {
            let before = parser.next.checked_sub(1).and_then(|last| tokens.get(last));
            Err(leftover_token_error(before, token, &tree.syntax))
        }
    }
}

struct Parser<'t> {
    tokens: &'t [Token],
    next: usize,
    end: Span,
    nesting: usize,
}

struct Tree {
    syntax: Syntax,
    depth: usize,
}

type Parsed = Result<Tree, Diagnostic>;

impl<'t> Parser<'t> {
    fn peek(&self) -> Option<&'t Token> {
        self.tokens.get(self.next)
    }

    fn take(&mut self) -> Option<&'t Token> {
        let token = self.tokens.get(self.next)?;
        self.next += 1;
        Some(token)
    }

    /// Parses operators of at least this precedence.
    fn parse_expression(&mut self, tightest: u8) -> Parsed {
        self.nesting += 1;
        if self.nesting > MAX_DEPTH {
            let place = self.peek().map_or(self.end, |token| token.span);
            return Err(depth_error(place));
        }
        let mut left = self.parse_operand()?;
        while let Some((operator, binding)) = self
            .peek()
            .and_then(|token| find_infix_operator(&token.kind))
        {
            if binding < tightest {
                break;
            }
            self.next += 1;
            let right = match binding {
                POWER => self.parse_expression(UNARY)?,
                _ => self.parse_expression(binding + 1)?,
            };
            left = combine(operator, left, right)?;
        }
        self.nesting -= 1;
        Ok(left)
    }

    /// Parses an operand with its members: `r`, `r.x`, `arm.origin.x`.
    fn parse_operand(&mut self) -> Parsed {
        let minus = self.peek().is_some_and(|t| t.kind == TokenKind::Minus);
        let mut tree = self.parse_atom()?;
        // If there is a minus, its operand has already parsed the members.
        while !minus && self.peek().is_some_and(|t| t.kind == TokenKind::Point) {
            self.next += 1;
            tree = self.parse_member(tree)?;
        }
        Ok(tree)
    }

    fn parse_member(&mut self, of: Tree) -> Parsed {
        let (member, member_span) = match self.take() {
            Some(Token {
                kind: TokenKind::Name(member),
                span,
            }) => (member.clone(), *span),
            other => {
                let place = other.map_or(self.end, |token| token.span);
                return Err(Diagnostic::error("a name is missing after the `.`")
                    .with_span(place, "expected a component, for example r.x"));
            }
        };
        let span = of.syntax.span.join(member_span);
        let kind = SyntaxKind::Member {
            of: Box::new(of.syntax),
            member,
            member_span,
        };
        nest(Syntax { kind, span }, of.depth)
    }

    fn parse_atom(&mut self) -> Parsed {
        let Some(token) = self.take() else {
            let what = if self.tokens.is_empty() {
                "is empty"
            } else {
                "is not finished"
            };
            return Err(Diagnostic::error(format!("the expression {what}"))
                .with_span(self.end, "expected a number, a name or `(`"));
        };
        match &token.kind {
            TokenKind::Number(value) => Ok(leaf(SyntaxKind::Number(*value), token.span)),
            TokenKind::Name(name) => self.parse_name(name, token.span),
            TokenKind::Minus => self.parse_negation(token.span),
            TokenKind::OpenIndex => {
                let (components, depth) = self.parse_list(&TokenKind::CloseIndex)?;
                let close = self.expect_closing(&TokenKind::CloseIndex, token.span)?;
                let kind = SyntaxKind::Vector(components);
                let span = token.span.join(close);
                nest(Syntax { kind, span }, depth)
            }
            TokenKind::Open => {
                let inner = self.parse_expression(ADDITIVE)?;
                let close = self.expect_closing(&TokenKind::Close, token.span)?;
                let span = token.span.join(close);
                let syntax = Syntax {
                    span,
                    ..inner.syntax
                };
                Ok(Tree { syntax, ..inner })
            }
            other => Err(
                Diagnostic::error(format!("unexpected {}", other.to_quoted()))
                    .with_span(token.span, "expected a number, a name or `(`"),
            ),
        }
    }

    /// Parses `-operand`; the operand includes powers.
    fn parse_negation(&mut self, minus: Span) -> Parsed {
        let operand = self.parse_expression(UNARY)?;
        let span = minus.join(operand.syntax.span);
        let kind = SyntaxKind::Negate(Box::new(operand.syntax));
        nest(Syntax { kind, span }, operand.depth)
    }

    fn parse_name(&mut self, name: &str, span: Span) -> Parsed {
        match self.peek().map(|token| &token.kind) {
            Some(TokenKind::Open) => self.parse_call(name, span),
            Some(TokenKind::OpenIndex) => self.parse_element(name, span),
            _ => Ok(leaf(SyntaxKind::Name(name.to_owned()), span)),
        }
    }

    fn parse_call(&mut self, function: &str, function_span: Span) -> Parsed {
        let open = self.take().map_or(self.end, |token| token.span);
        let (arguments, depth) = self.parse_list(&TokenKind::Close)?;
        let close = self.expect_closing(&TokenKind::Close, open)?;
        let kind = SyntaxKind::Call {
            function: function.to_owned(),
            function_span,
            arguments,
        };
        let span = function_span.join(close);
        nest(Syntax { kind, span }, depth)
    }

    /// Parses expressions between commas up to a closing bracket. Returns them and the largest
    /// depth.
    fn parse_list(&mut self, close: &TokenKind) -> Result<(Vec<Syntax>, usize), Diagnostic> {
        let (mut list, mut depth) = (Vec::new(), 0);
        if self.peek().is_some_and(|token| token.kind == *close) {
            return Ok((list, depth));
        }
        loop {
            let tree = self.parse_expression(ADDITIVE)?;
            depth = depth.max(tree.depth);
            list.push(tree.syntax);
            match self.peek() {
                Some(token) if token.kind == TokenKind::Comma => self.next += 1,
                _ => return Ok((list, depth)),
            }
        }
    }

    fn parse_element(&mut self, name: &str, span: Span) -> Parsed {
        let open = self.take().map_or(self.end, |token| token.span);
        let (index, index_span) = match self.take() {
            Some(Token {
                kind: TokenKind::Name(index),
                span,
            }) => (index.clone(), *span),
            other => {
                let place = other.map_or(self.end, |token| token.span);
                return Err(Diagnostic::error("the index of a mode must be a name")
                    .with_span(place, "expected a name")
                    .with_help(
                        "modes appear inside a sum: sum(i, w, q[i]^2); components are written r.x",
                    ));
            }
        };
        let close = self.expect_closing(&TokenKind::CloseIndex, open)?;
        let kind = SyntaxKind::Element {
            name: name.to_owned(),
            index,
            index_span,
        };
        Ok(leaf(kind, span.join(close)))
    }

    fn expect_closing(&mut self, expected: &TokenKind, open: Span) -> Result<Span, Diagnostic> {
        let before = self
            .next
            .checked_sub(1)
            .and_then(|last| self.tokens.get(last));
        match self.take() {
            Some(token) if token.kind == *expected => Ok(token.span),
            Some(token) => {
                let shown = expected.to_quoted();
                let unexpected = format!("expected {shown}, found {}", token.kind.to_quoted());
                let diagnostic = Diagnostic::error(unexpected).with_span(token.span, "here");
                let diagnostic = diagnostic.with_related_span(open, "to close this bracket");
                Err(diagnostic.with_optional_help(missing_operator_help(before, &token.kind)))
            }
            None => Err(
                Diagnostic::error(format!("a {} is missing", expected.to_quoted()))
                    .with_span(self.end, "the expression ends here")
                    .with_related_span(open, "this bracket is not closed"),
            ),
        }
    }
}

fn find_infix_operator(kind: &TokenKind) -> Option<(BinaryOperator, u8)> {
    Some(match kind {
        TokenKind::Plus => (BinaryOperator::Add, ADDITIVE),
        TokenKind::Minus => (BinaryOperator::Subtract, ADDITIVE),
        TokenKind::Star => (BinaryOperator::Multiply, MULTIPLICATIVE),
        TokenKind::Slash => (BinaryOperator::Divide, MULTIPLICATIVE),
        TokenKind::Caret => (BinaryOperator::Power, POWER),
        _ => return None,
    })
}

fn leaf(kind: SyntaxKind, span: Span) -> Tree {
    Tree {
        syntax: Syntax { kind, span },
        depth: 1,
    }
}

fn combine(operator: BinaryOperator, left: Tree, right: Tree) -> Parsed {
    let span = left.syntax.span.join(right.syntax.span);
    let depth = left.depth.max(right.depth);
    let kind = SyntaxKind::Binary(operator, Box::new(left.syntax), Box::new(right.syntax));
    nest(Syntax { kind, span }, depth)
}

fn nest(syntax: Syntax, below: usize) -> Parsed {
    let depth = below + 1;
    if depth > MAX_DEPTH {
        return Err(depth_error(syntax.span));
    }
    Ok(Tree { syntax, depth })
}

fn depth_error(place: Span) -> Diagnostic {
    Diagnostic::error(format!(
        "the expression has more than {MAX_DEPTH} nested levels; each term of a sum and each factor of a product counts \
         as one level"
    ))
    .with_span(place, "the limit is exceeded here")
    .with_help("move parts of it to [definitions]")
}

fn leftover_token_error(last: Option<&Token>, token: &Token, before: &Syntax) -> Diagnostic {
    let diagnostic = match token.kind {
        TokenKind::Close | TokenKind::CloseIndex => {
            Diagnostic::error(format!("{} closes nothing", token.kind.to_quoted()))
                .with_span(token.span, "there is no open bracket here")
        }
        TokenKind::Comma => Diagnostic::error("a comma outside the parentheses of a function")
            .with_span(token.span, "unexpected here")
            .with_help("decimal fractions are written with a point"),
        _ => Diagnostic::error(format!(
            "an operator is missing before {}",
            token.kind.to_quoted()
        ))
        .with_span(token.span, "expected + - * / or ^")
        .with_related_span(before.span, "the expression so far"),
    };
    let word = match &before.kind {
        SyntaxKind::Name(name) => find_word_equivalent(name).map(str::to_owned),
        _ => None,
    };
    diagnostic.with_optional_help(word.or_else(|| missing_operator_help(last, &token.kind)))
}

/// Returns help for an operand that follows another operand, whose last token is `before`.
fn missing_operator_help(before: Option<&Token>, found: &TokenKind) -> Option<String> {
    if let TokenKind::Name(word) = found
        && let Some(help) = find_word_equivalent(word)
    {
        return Some(help.to_owned());
    }
    let starts = matches!(
        found,
        TokenKind::Number(_) | TokenKind::Name(_) | TokenKind::Open
    );
    starts.then(|| {
        let unit = before.and_then(|before| unit_help(&before.kind, found));
        unit.unwrap_or_else(|| "write a product with `*`: 2*x, not 2 x".to_owned())
    })
}

/// Returns help for a number with a unit after it, such as `20 deg`.
fn unit_help(number: &TokenKind, unit: &TokenKind) -> Option<String> {
    let (TokenKind::Number(number), TokenKind::Name(word)) = (number, unit) else {
        return None;
    };
    let unit = Unit::parse(word).or_else(|error| match error.spelling {
        Some(spelling) => Unit::parse(&spelling),
        None => Err(error),
    });
    let unit = unit.ok()?;
    let in_si = match unit.text.as_str() {
        "deg" => format!("{number}*pi/180"),
        _ => unit.to_si(*number).to_string(),
    };
    Some(format!(
        "numbers in an expression are in SI units: write {in_si} for {number} {word}; write a product with `*`"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lexer::tokenize;

    fn parsed(text: &str) -> Result<Syntax, Diagnostic> {
        let end = Span::new(text.len(), text.len());
        parse(&tokenize(text, Span::new)?, end)
    }

    fn bracketed(syntax: &Syntax) -> String {
        match &syntax.kind {
            SyntaxKind::Number(value) => value.to_string(),
            SyntaxKind::Name(name) => name.clone(),
            SyntaxKind::Element { name, index, .. } => format!("{name}[{index}]"),
            SyntaxKind::Call {
                function,
                arguments,
                ..
            } => {
                let arguments: Vec<_> = arguments.iter().map(bracketed).collect();
                format!("{function}({})", arguments.join(","))
            }
            SyntaxKind::Vector(components) => {
                let components: Vec<_> = components.iter().map(bracketed).collect();
                format!("[{}]", components.join(","))
            }
            SyntaxKind::Member { of, member, .. } => format!("{}.{member}", bracketed(of)),
            SyntaxKind::Negate(operand) => format!("(-{})", bracketed(operand)),
            SyntaxKind::Binary(operator, left, right) => {
                let sign = match operator {
                    BinaryOperator::Add => '+',
                    BinaryOperator::Subtract => '-',
                    BinaryOperator::Multiply => '*',
                    BinaryOperator::Divide => '/',
                    BinaryOperator::Power => '^',
                };
                format!("({}{sign}{})", bracketed(left), bracketed(right))
            }
        }
    }

    #[test]
    fn precedence_follows_mathematics() {
        for (text, expected) in [
            ("-x^2", "(-(x^2))"),
            ("2^-1", "(2^(-1))"),
            ("2^-x^2", "(2^(-(x^2)))"),
            ("a^b^c", "(a^(b^c))"),
            ("a-b-c", "((a-b)-c)"),
            ("a/b/c", "((a/b)/c)"),
            ("a/b*c", "((a/b)*c)"),
            ("1/2*m*v^2", "(((1/2)*m)*(v^2))"),
            ("a+b*c^d", "(a+(b*(c^d)))"),
            ("-a*b", "((-a)*b)"),
            ("a*-b", "(a*(-b))"),
            ("a*-b^2*c", "((a*(-(b^2)))*c)"),
            ("a--b", "(a-(-b))"),
            ("2^-1*c", "((2^(-1))*c)"),
            ("(a+b)*c", "((a+b)*c)"),
            ("sum(i, w, q[i]^2)", "sum(i,w,(q[i]^2))"),
            ("f()", "f()"),
            ("-a.x^2", "(-(a.x^2))"),
            ("2*a.b.c", "(2*a.b.c)"),
            ("[x, y+1].x", "[x,(y+1)].x"),
            ("m*[x, -y, 0]", "(m*[x,(-y),0])"),
        ] {
            assert_eq!(bracketed(&parsed(text).unwrap()), expected, "{text}");
        }
    }

    #[test]
    fn foreign_words_are_rejected_with_help() {
        for (text, help) in [
            ("above(x) and above(y)", "product"),
            ("(a or b)", "max("),
            ("not a", "1 - above"),
            ("if a then b else c", "above(x - a)*A"),
            ("a if b else c", "above(x - a)*A"),
            ("2 step", "2*x, not 2 x"),
        ] {
            let given = parsed(text).expect_err(text).help.unwrap_or_default();
            assert!(given.contains(help), "{text}: {given}");
        }
    }

    #[test]
    fn syntax_errors_have_positions() {
        for (text, message, place) in [
            ("", "is empty", 0),
            ("a+", "is not finished", 2),
            ("(a+b", "`)` is missing", 4),
            ("a+b)", "closes nothing", 3),
            ("2 x", "operator is missing", 2),
            ("f(a b)", "expected `)`", 4),
            ("*a", "unexpected `*`", 0),
            ("q[1]", "index", 2),
            ("1,5", "comma", 1),
            ("f(a,)", "unexpected `)`", 4),
            ("+a", "unexpected `+`", 0),
            ("a.", "a name is missing", 2),
            ("a.1", "operator is missing", 1),
            ("[a, b", "`]` is missing", 5),
            (".", "unexpected `.`", 0),
        ] {
            let diagnostic = parsed(text).expect_err(text);
            assert!(
                diagnostic.message.contains(message),
                "{text}: {diagnostic:?}"
            );
            assert_eq!(
                diagnostic.primary.map(|label| label.span.start),
                Some(place),
                "{text}"
            );
        }
    }

    #[test]
    fn depth_is_bounded_in_every_direction() {
        let many = 10_000;
        for text in [
            "(".repeat(many),
            "-".repeat(many),
            "2^".repeat(many),
            "f(".repeat(many),
            "1+".repeat(many) + "1",
            format!("{}1{}", "(".repeat(many), ")".repeat(many)),
        ] {
            let message = parsed(&text).expect_err("too deep").message;
            assert!(message.contains("more than 200 nested levels"), "{message}");
        }
        let allowed = "1+".repeat(MAX_DEPTH - 1) + "1";
        assert!(parsed(&allowed).is_ok());
    }

    #[test]
    fn span_includes_the_brackets() {
        let tree = parsed("2*(a + b)").unwrap();
        assert_eq!(tree.span, Span::new(0, 9));
    }
}
