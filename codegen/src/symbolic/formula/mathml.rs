//! Formulas as MathML, for pages: the elements of MathML Core, which browsers set by
//! themselves. Each term of a formula's outermost sum is an element of its own, because
//! browsers break lines between these and nowhere inside.

mod basis;

use model_spec::model::Function;

use super::letters;
use super::symbol::Symbol;
use super::tree::{Choice, Formula, Level, MatrixPart, Term, powers_of_ten, small_fraction};

/// Nothing is seen between factors.
const TIMES: &str = "<mo>&#x2062;</mo>";

impl Formula {
    /// As MathML elements, between which a line may be broken.
    pub fn mathml(&self) -> String {
        let parts: Vec<String> = match self {
            Self::Sum(terms) => terms
                .iter()
                .enumerate()
                .map(|(place, term)| self::term(term, place == 0))
                .collect(),
            other => vec![at(other, Level::Sum)],
        };
        let parts: Vec<String> = parts
            .iter()
            .map(|part| format!("<math>{part}</math>"))
            .collect();
        parts.join(" ")
    }
}

/// A number as a MathML element; with a power of ten where that is shorter.
pub fn number_element(mantissa: &str, exponent: Option<&str>) -> String {
    let signed = |number: &str| number.replace('-', "\u{2212}");
    let mantissa = signed(mantissa);
    match exponent {
        None => format!("<mn>{mantissa}</mn>"),
        Some(exponent) => {
            let power = format!("<msup><mn>10</mn><mn>{}</mn></msup>", signed(exponent));
            match mantissa.as_str() {
                "1" => power,
                _ => format!("<mn>{mantissa}</mn><mo>·</mo>{power}"),
            }
        }
    }
}

fn row(content: &str) -> String {
    format!("<mrow>{content}</mrow>")
}

fn operator(sign: &str) -> String {
    format!("<mo>{sign}</mo>")
}

/// Whatever a name is made of, it stays text.
fn identifier(name: &str) -> String {
    let text = name
        .replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
        .replace('\'', "&#39;");
    format!("<mi>{text}</mi>")
}

fn fenced(open: &str, content: &str, close: &str) -> String {
    row(&format!("<mo>{open}</mo>{content}<mo>{close}</mo>"))
}

/// A formula in its surroundings, as one element or a few.
fn at(formula: &Formula, level: Level) -> String {
    if formula.set_level() < level {
        return fenced("(", &at(formula, Level::Sum), ")");
    }
    match formula {
        Formula::Number(value) => number(*value),
        Formula::Symbol(symbol) => self::symbol(symbol),
        Formula::Table(kind) => basis::table(*kind),
        Formula::Sum(terms) => {
            let terms = terms.iter().enumerate();
            terms.map(|(place, of)| term(of, place == 0)).collect()
        }
        Formula::Quotient { above, below } => quotient(above, below),
        Formula::Power(base, exponent) => format!(
            "<msup>{}{}</msup>",
            row(&at(base, Level::Base)),
            row(&at(exponent, Level::Sum))
        ),
        Formula::Call(function, arguments) => call(*function, arguments),
        Formula::Operation(name, operands) => format!("{}{}", identifier(name), list(operands)),
        Formula::Choice(choice) => cases(choice),
        Formula::Total(index, of) => format!(
            "<munder><mo>∑</mo>{}</munder>{}",
            identifier(index.name()),
            row(&at(of, Level::Product))
        ),
        Formula::Applied(matrix, vector) => {
            let product = format!(
                "{}{TIMES}{}",
                at(matrix, Level::Product),
                at(vector, Level::Product)
            );
            element(&fenced("(", &product, ")"), "i")
        }
        Formula::Transposed(matrix) => format!(
            "<msup>{}<mi mathvariant=\"normal\">T</mi></msup>",
            row(&at(matrix, Level::Base))
        ),
        Formula::Matrix(parts) => {
            let parts: Vec<String> = parts.iter().map(matrix_part).collect();
            parts.join(&operator("+"))
        }
        Formula::Omitted => operator("…"),
    }
}

fn term(term: &Term, first: bool) -> String {
    let sign = match (term.factor < 0.0, first) {
        (true, _) => operator("\u{2212}"),
        (false, true) => String::new(),
        (false, false) => operator("+"),
    };
    let magnitude = term.factor.abs();
    let rest = match &term.of {
        None => number(magnitude),
        Some(of) if term.factor == 1.0 => at(of, Level::Sum),
        Some(of) if magnitude == 1.0 => at(of, Level::Product),
        Some(of) => format!("{}{TIMES}{}", factor(magnitude), at(of, Level::Product)),
    };
    sign + &rest
}

/// Factors side by side; a sum over modes that others follow stands in parentheses.
fn product(factors: &[Formula]) -> String {
    if let [only] = factors {
        return at(only, Level::Sum);
    }
    let last = factors.len().saturating_sub(1);
    let factors: Vec<String> = factors
        .iter()
        .enumerate()
        .map(|(place, factor)| match factor {
            Formula::Total(..) if place < last => fenced("(", &at(factor, Level::Sum), ")"),
            _ => at(factor, Level::Product),
        })
        .collect();
    factors.join(TIMES)
}

fn quotient(above: &[Formula], below: &[Formula]) -> String {
    match (above, below) {
        ([only], []) => at(only, Level::Product),
        (above, []) => product(above),
        ([], below) => format!("<mfrac><mn>1</mn>{}</mfrac>", row(&product(below))),
        (above, below) => format!(
            "<mfrac>{}{}</mfrac>",
            row(&product(above)),
            row(&product(below))
        ),
    }
}

fn call(function: Function, arguments: &[Formula]) -> String {
    let inner = |a: &Formula| at(a, Level::Sum);
    match (function, arguments) {
        (Function::Sqrt, [a]) => format!("<msqrt>{}</msqrt>", inner(a)),
        (Function::Abs, [a]) => fenced("|", &inner(a), "|"),
        (Function::Exp, [a]) => format!("<msup><mi>e</mi>{}</msup>", row(&inner(a))),
        _ => format!("{}{}", identifier(function.name()), list(arguments)),
    }
}

fn list(arguments: &[Formula]) -> String {
    let arguments: Vec<String> = arguments.iter().map(|a| at(a, Level::Sum)).collect();
    fenced("(", &arguments.join(&operator(",")), ")")
}

fn cases(choice: &Choice) -> String {
    let inner = |part: &Formula| at(part, Level::Sum);
    let line =
        |value: &str, place: &str| format!("<mtr><mtd>{value}</mtd><mtd>{place}</mtd></mtr>");
    let taken = format!("{}<mo>&gt;</mo>{}", inner(&choice.a), inner(&choice.b));
    let lines = [
        line(&inner(&choice.then), &taken),
        line(&inner(&choice.otherwise), "<mtext>else</mtext>"),
    ];
    row(&format!("<mo>{{</mo><mtable>{}</mtable>", lines.concat()))
}

fn matrix_part(part: &MatrixPart) -> String {
    let bracketed =
        |of: &Formula, index: &str| element(&fenced("[", &at(of, Level::Sum), "]"), index);
    match part {
        MatrixPart::Diagonal(diagonal) => format!(
            "{}{TIMES}{}",
            element(&identifier("δ"), "ij"),
            at(diagonal, Level::Product)
        ),
        MatrixPart::Outer(u, v) => format!("{}{TIMES}{}", bracketed(u, "i"), bracketed(v, "j")),
        MatrixPart::Scaled(of_row, matrix, column) => format!(
            "{}{TIMES}{}{TIMES}{}",
            bracketed(of_row, "i"),
            at(matrix, Level::Product),
            bracketed(column, "j")
        ),
    }
}

/// An element of what is indexed.
fn element(of: &str, index: &str) -> String {
    format!("<msub>{of}{}</msub>", identifier(index))
}

/// A name with its dots above its head and everything else below the line.
fn symbol(symbol: &Symbol) -> String {
    let (head, mut parts) = symbol.parts();
    let head = identifier(letters::letter(head).unwrap_or(head));
    let accent = |dots: &str| format!("<mover accent=\"true\">{head}<mo>{dots}</mo></mover>");
    let head = match symbol.dots {
        0 => head.clone(),
        1 => accent("˙"),
        _ => accent("¨"),
    };
    let indices: String = symbol.indices.iter().map(|index| index.name()).collect();
    if !indices.is_empty() {
        parts.push(&indices);
    }
    let parts: Vec<&str> = parts
        .into_iter()
        .map(|part| letters::letter(part).unwrap_or(part))
        .collect();
    match parts.as_slice() {
        [] => head,
        parts => format!("<msub>{head}{}</msub>", identifier(&parts.join(","))),
    }
}

/// A magnitude in front of a product: a small fraction where it is one exactly.
fn factor(magnitude: f64) -> String {
    match small_fraction(magnitude) {
        Some((numerator, denominator)) => {
            format!("<mfrac><mn>{numerator}</mn><mn>{denominator}</mn></mfrac>")
        }
        None => number(magnitude),
    }
}

fn number(value: f64) -> String {
    match powers_of_ten(value) {
        Some((mantissa, exponent)) => number_element(&mantissa, Some(&exponent)),
        None => number_element(&value.to_string(), None),
    }
}
