//! Formulas as MathML Core, which browsers render without a library. Each term of a formula's
//! outermost sum is a separate element, because browsers break lines only between elements.

mod basis;

use eomgen_codegen::symbolic::formula::{
    Choice, Formula, Level, MatrixPart, Symbol, Term, letter, powers_of_ten, small_fraction,
};
use eomgen_model_spec::model::Function;
use maud::{Markup, html};

/// Invisible multiplication sign of Unicode.
const INVISIBLE_TIMES: &str = "\u{2062}";

/// Returns a formula as MathML elements; lines can break between them.
pub fn formula(formula: &Formula) -> Markup {
    match formula {
        Formula::Sum(terms) => html! {
            @for (place, of) in terms.iter().enumerate() {
                @if place > 0 { " " }
                math { (term(of, place == 0)) }
            }
        },
        other => html! { math { (formula_at_level(other, Level::Sum)) } },
    }
}

/// Returns a number as MathML: a mantissa, times a power of ten if there is an exponent.
pub(crate) fn power_of_ten(mantissa: &str, exponent: Option<&str>) -> Markup {
    let signed = |number: &str| number.replace('-', "\u{2212}");
    let mantissa = signed(mantissa);
    html! {
        @if exponent.is_none() || mantissa != "1" { mn { (mantissa) } }
        @if let Some(exponent) = exponent {
            @if mantissa != "1" { mo { "·" } }
            msup { mn { "10" } mn { (signed(exponent)) } }
        }
    }
}

fn identifier(name: &str) -> Markup {
    html! { mi { (name) } }
}

fn parenthesise(open: &str, content: &Markup, close: &str) -> Markup {
    html! { mrow { mo { (open) } (content) mo { (close) } } }
}

fn times() -> Markup {
    html! { mo { (INVISIBLE_TIMES) } }
}

/// Returns a formula at a level of precedence, with parentheses if necessary.
fn formula_at_level(formula: &Formula, level: Level) -> Markup {
    if formula.set_level() < level {
        return parenthesise("(", &formula_at_level(formula, Level::Sum), ")");
    }
    match formula {
        Formula::Number(value) => number(*value),
        Formula::Symbol(of) => symbol(of),
        Formula::Table(kind) => basis::table(*kind),
        Formula::Sum(terms) => {
            html! { @for (place, of) in terms.iter().enumerate() { (term(of, place == 0)) } }
        }
        Formula::Quotient { above, below } => quotient(above, below),
        Formula::Power(base, exponent) => html! {
            msup { mrow { (formula_at_level(base, Level::Base)) } mrow { (formula_at_level(exponent, Level::Sum)) } }
        },
        Formula::Call(function, arguments) => call(*function, arguments),
        Formula::Operation(name, operands) => {
            html! { (identifier(name)) (argument_list(operands)) }
        }
        Formula::Choice(choice) => cases(choice),
        Formula::Total(index, of) => html! {
            munder { mo { "∑" } (identifier(index.name())) }
            mrow { (formula_at_level(of, Level::Product)) }
        },
        Formula::Applied(matrix, vector) => {
            let product = html! {
                (formula_at_level(matrix, Level::Product)) (times()) (formula_at_level(vector, Level::Product))
            };
            element(&parenthesise("(", &product, ")"), "i")
        }
        Formula::Transposed(matrix) => html! {
            msup { mrow { (formula_at_level(matrix, Level::Base)) } mi mathvariant="normal" { "T" } }
        },
        Formula::Matrix(parts) => html! {
            @for (place, part) in parts.iter().enumerate() {
                @if place > 0 { mo { "+" } }
                (matrix_part(part))
            }
        },
        Formula::Omitted => html! { mo { "…" } },
    }
}

fn term(term: &Term, is_first: bool) -> Markup {
    let magnitude = term.factor.abs();
    html! {
        @if term.factor < 0.0 { mo { "\u{2212}" } } @else if !is_first { mo { "+" } }
        @match &term.of {
            None => (number(magnitude)),
            Some(of) if term.factor == 1.0 => (formula_at_level(of, Level::Sum)),
            Some(of) if magnitude == 1.0 => (formula_at_level(of, Level::Product)),
            Some(of) => { (factor(magnitude)) (times()) (formula_at_level(of, Level::Product)) },
        }
    }
}

/// Returns factors in a row; a sum over modes before other factors has parentheses.
fn product(factors: &[Formula]) -> Markup {
    if let [only] = factors {
        return formula_at_level(only, Level::Sum);
    }
    let last = factors.len().saturating_sub(1);
    html! {
        @for (place, factor) in factors.iter().enumerate() {
            @if place > 0 { (times()) }
            @match factor {
                Formula::Total(..) if place < last => (parenthesise("(", &formula_at_level(factor, Level::Sum), ")")),
                _ => (formula_at_level(factor, Level::Product)),
            }
        }
    }
}

fn quotient(above: &[Formula], below: &[Formula]) -> Markup {
    match (above, below) {
        ([only], []) => formula_at_level(only, Level::Product),
        (above, []) => product(above),
        (above, below) => html! {
            mfrac {
                @if above.is_empty() { mn { "1" } } @else { mrow { (product(above)) } }
                mrow { (product(below)) }
            }
        },
    }
}

fn call(function: Function, arguments: &[Formula]) -> Markup {
    let inner = |a: &Formula| formula_at_level(a, Level::Sum);
    match (function, arguments) {
        (Function::Sqrt, [a]) => html! { msqrt { (inner(a)) } },
        (Function::Abs, [a]) => parenthesise("|", &inner(a), "|"),
        (Function::Exp, [a]) => html! { msup { mi { "e" } mrow { (inner(a)) } } },
        _ => html! { (identifier(function.name())) (argument_list(arguments)) },
    }
}

fn argument_list(arguments: &[Formula]) -> Markup {
    let arguments = html! {
        @for (place, argument) in arguments.iter().enumerate() {
            @if place > 0 { mo { "," } }
            (formula_at_level(argument, Level::Sum))
        }
    };
    parenthesise("(", &arguments, ")")
}

fn cases(choice: &Choice) -> Markup {
    let inner = |part: &Formula| formula_at_level(part, Level::Sum);
    html! {
        mrow {
            mo { "{" }
            mtable {
                mtr {
                    mtd { (inner(&choice.then)) }
                    mtd { (inner(&choice.a)) mo { ">" } (inner(&choice.b)) }
                }
                mtr { mtd { (inner(&choice.otherwise)) } mtd { mtext { "else" } } }
            }
        }
    }
}

fn matrix_part(part: &MatrixPart) -> Markup {
    let bracketed = |of: &Formula, index: &str| {
        element(
            &parenthesise("[", &formula_at_level(of, Level::Sum), "]"),
            index,
        )
    };
    html! {
        @match part {
            MatrixPart::Diagonal(diagonal) => {
                (element(&identifier("δ"), "ij")) (times()) (formula_at_level(diagonal, Level::Product))
            },
            MatrixPart::Outer(u, v) => {
                (bracketed(u, "i")) (times()) (bracketed(v, "j"))
            },
            MatrixPart::Scaled(row, matrix, column) => {
                (bracketed(row, "i")) (times())
                (formula_at_level(matrix, Level::Product)) (times())
                (bracketed(column, "j"))
            },
        }
    }
}

fn element(of: &Markup, index: &str) -> Markup {
    html! { msub { (of) (identifier(index)) } }
}

fn symbol(symbol: &Symbol) -> Markup {
    let (head, mut parts) = symbol.parts();
    let head = identifier(letter(head).unwrap_or(head));
    let head = match symbol.dots {
        0 => head,
        dots => html! {
            mover accent="true" { (head) mo { (if dots == 1 { "˙" } else { "¨" }) } }
        },
    };
    let indices: String = symbol.indices.iter().map(|index| index.name()).collect();
    if !indices.is_empty() {
        parts.push(&indices);
    }
    if parts.is_empty() {
        return head;
    }
    let parts = parts.into_iter().map(|part| letter(part).unwrap_or(part));
    element(&head, &parts.collect::<Vec<_>>().join(","))
}

/// Returns the factor before a product, as a fraction if it is a small fraction exactly.
fn factor(magnitude: f64) -> Markup {
    match small_fraction(magnitude) {
        Some((numerator, denominator)) => {
            html! { mfrac { mn { (numerator.to_string()) } mn { (denominator) } } }
        }
        None => number(magnitude),
    }
}

fn number(value: f64) -> Markup {
    match powers_of_ten(value) {
        Some((mantissa, exponent)) => power_of_ten(&mantissa, Some(&exponent)),
        None => power_of_ten(&value.to_string(), None),
    }
}
