//! Formulas as MathML Core, which browsers render without a library. Each term of a formula's
//! outermost sum is a separate element, because browsers break lines only between elements.
//!
//! `products` orders and merges the factors of products and quotients, `basis` writes constants of a
//! basis.

mod basis;
mod products;

use eomgen_codegen::symbolic::formula::{
    Choice, Formula, Level, MatrixPart, Symbol, Term, find_multiple_of_pi, letter,
    split_powers_of_ten,
};
use eomgen_model_spec::model::Function;
use maud::{Markup, html};

/// Invisible multiplication sign and function application of Unicode.
const INVISIBLE_TIMES: &str = "\u{2062}";
const APPLY_FUNCTION: &str = "\u{2061}";

/// Returns a formula as MathML elements; lines can break between them.
pub fn formula(formula: &Formula) -> Markup {
    match formula {
        Formula::Sum(terms) => html! {
            @for (index, of) in terms.iter().enumerate() {
                @if index > 0 { " " }
                math { (term(of, index == 0)) }
            }
        },
        other => html! { math { (formula_at_level(other, Level::Sum)) } },
    }
}

/// Returns the symbol of a quantity by its name in the specification: θ with a dot for `theta_dot`.
pub fn quantity_symbol(name: &str) -> Markup {
    formula(&Formula::Symbol(Symbol::from_state(name)))
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
    html! {
        mrow {
            mo form="prefix" lspace="0" rspace="0" { (open) }
            (content)
            mo form="postfix" lspace="0" rspace="0" { (close) }
        }
    }
}

/// Returns an invisible multiplication sign with a thin space, which separates names of several letters.
fn times() -> Markup {
    html! { mo lspace="0.17em" rspace="0" { (INVISIBLE_TIMES) } }
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
            html! { @for (index, of) in terms.iter().enumerate() { (term(of, index == 0)) } }
        }
        Formula::Quotient { above, below } => products::quotient(1.0, above, below),
        Formula::Power(base, exponent) => power(base, exponent),
        Formula::Call(function, arguments) => call(*function, arguments),
        Formula::Operation(name, operands) => applied(&identifier(name), operands),
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
            @for (index, part) in parts.iter().enumerate() {
                @if index > 0 { mo { "+" } }
                (matrix_part(part))
            }
        },
        Formula::Omitted => html! { mo { "…" } },
    }
}

fn term(term: &Term, is_first: bool) -> Markup {
    let magnitude = term.factor.abs();
    html! {
        // Without `form`, the sign would have the spacing that follows from its position in the row.
        @if term.factor < 0.0 && is_first { mo form="prefix" { "\u{2212}" } }
        @else if term.factor < 0.0 { mo form="infix" { "\u{2212}" } }
        @else if !is_first { mo form="infix" { "+" } }
        @match &term.of {
            None => (number(magnitude)),
            Some(of) if term.factor == 1.0 => (formula_at_level(of, Level::Sum)),
            Some(Formula::Quotient { above, below }) => (products::quotient(magnitude, above, below)),
            Some(of) if magnitude == 1.0 => (formula_at_level(of, Level::Product)),
            Some(of) => { (products::factor(magnitude)) (times()) (formula_at_level(of, Level::Product)) },
        }
    }
}

/// Returns a power. The exponent of a trigonometric function follows its name: cos² α.
fn power(base: &Formula, exponent: &Formula) -> Markup {
    let raised = html! { mrow { (formula_at_level(exponent, Level::Sum)) } };
    match (base, exponent) {
        (Formula::Call(function, arguments), Formula::Number(number))
            if is_trigonometric(*function) && *number > 1.0 =>
        {
            let name = html! { msup { (identifier(function.name())) (raised) } };
            applied(&name, arguments)
        }
        _ => html! { msup { mrow { (formula_at_level(base, Level::Base)) } (raised) } },
    }
}

fn is_trigonometric(function: Function) -> bool {
    use Function::{Cos, Cosh, Sin, Sinh, Tan, Tanh};
    [Sin, Cos, Tan, Sinh, Cosh, Tanh].contains(&function)
}

fn call(function: Function, arguments: &[Formula]) -> Markup {
    let inner = |a: &Formula| formula_at_level(a, Level::Sum);
    match (function, arguments) {
        (Function::Sqrt, [a]) => html! { msqrt { (inner(a)) } },
        (Function::Abs, [a]) => parenthesise("|", &inner(a), "|"),
        (Function::Exp, [a]) => html! { msup { mi { "e" } mrow { (inner(a)) } } },
        _ => applied(&identifier(function.name()), arguments),
    }
}

fn applied(name: &Markup, arguments: &[Formula]) -> Markup {
    html! { (name) mo { (APPLY_FUNCTION) } (argument_list(arguments)) }
}

fn argument_list(arguments: &[Formula]) -> Markup {
    let arguments = html! {
        @for (index, argument) in arguments.iter().enumerate() {
            @if index > 0 { mo { "," } }
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
    // The rate of an input is an input whose name has the suffix of a rate.
    let named = Symbol::from_state(&symbol.name);
    let (head, mut parts) = if symbol.owners.is_empty() {
        named.parts()
    } else {
        symbol.parts()
    };
    let dots = symbol.dots + named.dots;
    if let Some(words) = words(head, &parts) {
        return dotted(&identifier(&words), dots);
    }
    let head = dotted(&identifier(letter(head).unwrap_or(head)), dots);
    if !symbol.owners.is_empty() {
        return with_subscripts(&head, symbol.owners.iter().map(self::symbol));
    }
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

/// Smallest numbers of letters of the words in a name that is not a letter with a subscript.
const MIN_WORD_LETTERS: [usize; 2] = [8, 4];

/// Returns the words of a name such as `stabilisation_rate`, which is not a letter with a subscript.
fn words(head: &str, parts: &[&str]) -> Option<String> {
    let [rest] = parts else { return None };
    let are_words = head.len() >= MIN_WORD_LETTERS[0] && rest.len() >= MIN_WORD_LETTERS[1];
    are_words.then(|| format!("{head}\u{a0}{rest}"))
}

fn dotted(head: &Markup, dots: u8) -> Markup {
    match dots {
        0 => head.clone(),
        dots => html! {
            mover accent="true" { (head) mo { (if dots == 1 { "˙" } else { "¨" }) } }
        },
    }
}

/// Returns a letter with formulas as subscripts, with commas between them.
fn with_subscripts(head: &Markup, subscripts: impl Iterator<Item = Markup>) -> Markup {
    html! {
        msub {
            (head)
            mrow {
                @for (index, subscript) in subscripts.enumerate() {
                    @if index > 0 { mo { "," } }
                    (subscript)
                }
            }
        }
    }
}

/// Returns the name of a matrix or vector entry: a letter with the names of its rows and columns as subscripts.
pub(crate) fn entry_name(letter: &str, rows: &[&Formula]) -> Markup {
    let rows = rows.iter().map(|row| formula_at_level(row, Level::Sum));
    html! { math { (with_subscripts(&identifier(letter), rows)) } }
}

/// Returns the letters of a name and those of its subscript as plain text with Greek letters and dots, for
/// drawings on a canvas.
pub fn name_letters(name: &str) -> (String, String) {
    let symbol = Symbol::from_state(name);
    let (head, mut parts) = symbol.parts();
    let words = words(head, &parts);
    if words.is_some() {
        parts.clear();
    }
    let mut head = words.unwrap_or_else(|| letter(head).unwrap_or(head).to_owned());
    match symbol.dots {
        0 => {}
        1 => head.push('\u{307}'),
        _ => head.push('\u{308}'),
    }
    let parts = parts.into_iter().map(|part| letter(part).unwrap_or(part));
    (head, parts.collect::<Vec<_>>().join(","))
}

fn number(value: f64) -> Markup {
    match (find_multiple_of_pi(value.abs()), split_powers_of_ten(value)) {
        (Some(of), _) if value > 0.0 => products::power_of_pi(of),
        (_, Some((mantissa, exponent))) => power_of_ten(&mantissa, Some(&exponent)),
        (_, None) => power_of_ten(&value.to_string(), None),
    }
}
