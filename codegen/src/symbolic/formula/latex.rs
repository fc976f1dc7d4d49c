//! Formulas in LaTeX math mode with amsmath.
//!
//! TeX breaks lines at the signs of a sum, except inside fractions and stretched parentheses. Therefore long sums
//! have parentheses of fixed size, and long quotients are written with a slash.

use eomgen_model_spec::model::Function;

use super::letters;
use super::symbol::Symbol;
use super::tree::{
    Choice, Formula, Level, MatrixPart, Term, find_small_fraction, split_powers_of_ten,
};
use crate::symbolic::table_text;

/// Largest length, in characters of plain text, of a part that TeX must not break.
const MAX_UNBROKEN_LENGTH: usize = 80;

/// Largest number of terms of a sum with fraction bars; in longer sums, quotients are written with a slash.
const MAX_FRACTIONS: usize = 8;

const TIMES: &str = "\\,";

impl Formula {
    /// Returns the formula in LaTeX math mode with amsmath.
    pub fn latex(&self) -> String {
        write_latex_at_level(self, Level::Sum)
    }
}

/// Writes a formula, with parentheses if its context requires them.
fn write_latex_at_level(formula: &Formula, level: Level) -> String {
    if formula.set_level() < level {
        return in_parentheses(formula);
    }
    match formula {
        Formula::Number(value) => number(*value),
        Formula::Symbol(symbol) => self::symbol(symbol),
        Formula::Table(kind) => table_text::latex(*kind),
        Formula::Sum(terms) => sum(terms),
        Formula::Quotient { above, below } => quotient(above, below),
        Formula::Power(base, exponent) => power(base, exponent),
        Formula::Call(function, arguments) => call(*function, arguments),
        Formula::Operation(name, operands) => operation(name, operands),
        Formula::Choice(choice) => cases(choice),
        Formula::Total(index, of) => {
            format!(
                "\\sum_{{{}}} {}",
                index.name(),
                write_latex_at_level(of, Level::Product)
            )
        }
        Formula::Applied(matrix, vector) => {
            format!(
                "\\left({}{TIMES}{}\\right)_{{i}}",
                write_latex_at_level(matrix, Level::Product),
                write_latex_at_level(vector, Level::Product)
            )
        }
        Formula::Transposed(matrix) => format!(
            "{{{}}}^{{\\mathsf{{T}}}}",
            write_latex_at_level(matrix, Level::Base)
        ),
        Formula::Matrix(parts) => {
            let parts: Vec<String> = parts.iter().map(matrix_part).collect();
            parts.join(" + ")
        }
        Formula::Omitted => "\\dots".to_owned(),
    }
}

fn in_parentheses(formula: &Formula) -> String {
    let inner = formula.latex();
    if is_long(formula) {
        format!("\\bigl({inner}\\bigr)")
    } else {
        format!("\\left({inner}\\right)")
    }
}

fn is_long(formula: &Formula) -> bool {
    formula.to_string().len() > MAX_UNBROKEN_LENGTH
}

fn sum(terms: &[Term]) -> String {
    let with_strokes = terms.len() > MAX_FRACTIONS;
    let at = |of: &Formula, level: Level| match of {
        Formula::Quotient { above, below } if with_strokes && !above.is_empty() => {
            write_slash_quotient(above, below)
        }
        _ => write_latex_at_level(of, level),
    };
    let mut text = String::new();
    for (place, term) in terms.iter().enumerate() {
        text.push_str(match (term.factor < 0.0, place) {
            (true, 0) => "-",
            (false, 0) => "",
            (true, _) => " - ",
            (false, _) => " + ",
        });
        let magnitude = term.factor.abs();
        match &term.of {
            None => text.push_str(&number(magnitude)),
            Some(of) if term.factor == 1.0 => text.push_str(&at(of, Level::Sum)),
            Some(of) if magnitude == 1.0 => text.push_str(&at(of, Level::Product)),
            Some(of) => {
                let (factor, of) = (factor(magnitude), at(of, Level::Product));
                text.push_str(&format!("{factor}{TIMES}{of}"));
            }
        }
    }
    text
}

/// Writes factors next to each other; a sum over modes that precedes other factors gets parentheses.
fn product(factors: &[Formula]) -> String {
    if let [only] = factors {
        return only.latex();
    }
    let last = factors.len().saturating_sub(1);
    let factors: Vec<String> = factors
        .iter()
        .enumerate()
        .map(|(place, factor)| match factor {
            Formula::Total(..) if place < last => in_parentheses(factor),
            _ => write_latex_at_level(factor, Level::Product),
        })
        .collect();
    factors.join(TIMES)
}

fn quotient(above: &[Formula], below: &[Formula]) -> String {
    let numerator = match above {
        [] => "1".to_owned(),
        factors => product(factors),
    };
    if below.is_empty() {
        // A single factor gets parentheses only if it would need them outside a product.
        return match above {
            [only] => write_latex_at_level(only, Level::Product),
            _ => numerator,
        };
    }
    if !above.is_empty() && above.iter().chain(below).any(is_long) {
        return write_slash_quotient(above, below);
    }
    format!("\\frac{{{numerator}}}{{{}}}", product(below))
}

/// Writes a product, or a quotient with a slash, on one line that TeX can break.
fn write_slash_quotient(above: &[Formula], below: &[Formula]) -> String {
    let numerator = match above {
        [only] => write_latex_at_level(only, Level::Product),
        several => product(several),
    };
    match below {
        [] => numerator,
        [Formula::Symbol(divisor)] => format!("{numerator}/{}", symbol(divisor)),
        several => format!("{numerator}/\\bigl({}\\bigr)", product(several)),
    }
}

/// Writes a power. If the base is no symbol, braces separate its superscripts from the exponent.
fn power(base: &Formula, exponent: &Formula) -> String {
    let (base_text, exponent) = (write_latex_at_level(base, Level::Base), exponent.latex());
    match base {
        Formula::Symbol(_) => format!("{base_text}^{{{exponent}}}"),
        _ => format!("{{{base_text}}}^{{{exponent}}}"),
    }
}

fn call(function: Function, arguments: &[Formula]) -> String {
    match (function, arguments) {
        (Function::Sqrt, [a]) => format!("\\sqrt{{{}}}", a.latex()),
        (Function::Abs, [a]) => format!("\\left|{}\\right|", a.latex()),
        (Function::Exp, [a]) => format!("e^{{{}}}", a.latex()),
        _ => format!("{}{}", function_name(function), list(arguments)),
    }
}

pub(super) fn function_name(function: Function) -> String {
    match function {
        Function::Asin => "\\arcsin".to_owned(),
        Function::Acos => "\\arccos".to_owned(),
        Function::Atan => "\\arctan".to_owned(),
        Function::Sin
        | Function::Cos
        | Function::Tan
        | Function::Sinh
        | Function::Cosh
        | Function::Tanh
        | Function::Ln
        | Function::Min
        | Function::Max => format!("\\{}", function.name()),
        _ => format!("\\operatorname{{{}}}", function.name()),
    }
}

/// Writes arguments. Symbols need no stretched parentheses.
fn list(arguments: &[Formula]) -> String {
    let long = arguments.iter().any(is_long);
    let low = arguments.iter().all(|a| matches!(a, Formula::Symbol(_)));
    let arguments: Vec<String> = arguments.iter().map(Formula::latex).collect();
    let arguments = arguments.join(", ");
    if low {
        format!("({arguments})")
    } else if long {
        format!("\\bigl({arguments}\\bigr)")
    } else {
        format!("\\left({arguments}\\right)")
    }
}

/// Writes an operation; the indices of a name such as `gram_ii` become subscripts.
fn operation(name: &str, operands: &[Formula]) -> String {
    let (name, indices) = name.split_once('_').unwrap_or((name, ""));
    format!(
        "\\operatorname{{{name}}}{}{}",
        subscript(&[indices]),
        list(operands)
    )
}

fn cases(choice: &Choice) -> String {
    format!(
        "\\begin{{cases}}{} & {} > {}\\\\ {} & \\text{{else}}\\end{{cases}}",
        choice.then.latex(),
        choice.a.latex(),
        choice.b.latex(),
        choice.otherwise.latex()
    )
}

fn matrix_part(part: &MatrixPart) -> String {
    match part {
        MatrixPart::Diagonal(diagonal) => {
            format!(
                "\\delta_{{ij}}{TIMES}{}",
                write_latex_at_level(diagonal, Level::Product)
            )
        }
        MatrixPart::Outer(u, v) => format!(
            "\\left[{}\\right]_{{i}}{TIMES}\\left[{}\\right]_{{j}}",
            u.latex(),
            v.latex()
        ),
        MatrixPart::Scaled(row, matrix, column) => format!(
            "\\left[{}\\right]_{{i}}{TIMES}{}{TIMES}\\left[{}\\right]_{{j}}",
            row.latex(),
            write_latex_at_level(matrix, Level::Product),
            column.latex()
        ),
    }
}

/// Writes a symbol: its first part with dots, its other parts as subscripts.
fn symbol(symbol: &Symbol) -> String {
    let (head, mut parts) = symbol.parts();
    let head = word(head);
    let head = match symbol.dots {
        0 => head,
        1 => format!("\\dot{{{head}}}"),
        _ => format!("\\ddot{{{head}}}"),
    };
    let indices: String = symbol.indices.iter().map(|index| index.name()).collect();
    parts.push(&indices);
    let owners: Vec<String> = symbol.owners.iter().map(self::symbol).collect();
    parts.extend(owners.iter().map(String::as_str));
    format!("{head}{}", subscript(&parts))
}

/// Writes a subscript with commas between the parts.
fn subscript(parts: &[&str]) -> String {
    let parts: Vec<&str> = parts
        .iter()
        .filter(|part| !part.is_empty())
        .map(|part| letters::command(part).unwrap_or(part))
        .collect();
    match parts.as_slice() {
        [] => String::new(),
        parts => format!("_{{{}}}", parts.join(",")),
    }
}

fn word(head: &str) -> String {
    match letters::command(head) {
        Some(command) => command.to_owned(),
        None if head.len() == 1 => head.to_owned(),
        None => format!("\\mathrm{{{}}}", head.replace('_', "\\_")),
    }
}

/// Writes the numeric factor of a product, as a small fraction if the fraction is exact.
fn factor(magnitude: f64) -> String {
    match find_small_fraction(magnitude) {
        Some((numerator, denominator)) => format!("\\tfrac{{{numerator}}}{{{denominator}}}"),
        None => number(magnitude),
    }
}

fn number(value: f64) -> String {
    match split_powers_of_ten(value) {
        Some((mantissa, exponent)) if mantissa == "1" => format!("10^{{{exponent}}}"),
        Some((mantissa, exponent)) => format!("{mantissa}\\cdot 10^{{{exponent}}}"),
        None => format!("{value}"),
    }
}

/// Escapes LaTeX characters in prose. Letters that the font lacks are written in math mode or as code points.
pub(crate) fn prose(text: &str) -> String {
    text.chars().map(prose_letter).collect()
}

fn prose_letter(c: char) -> String {
    match c {
        '\\' => "\\textbackslash{}".to_owned(),
        '#' | '$' | '%' | '&' | '_' | '{' | '}' => format!("\\{c}"),
        '~' | '^' => format!("\\{c}{{}}"),
        '<' | '>' | '|' => format!("${c}$"),
        c if c.is_ascii_graphic() || c == ' ' => c.to_string(),
        c if c.is_whitespace() || c.is_control() => " ".to_owned(),
        'Ð' | 'Þ' | 'ð' | 'þ' | '×' | '÷' => by_number(c),
        'À'..='ÿ' | '–' | '—' | '‘' | '’' | '“' | '”' => c.to_string(),
        _ => match letters::find_command(c) {
            Some(command) => format!("${command}$"),
            None => by_number(c),
        },
    }
}

fn by_number(c: char) -> String {
    format!("U+{:04X}", u32::from(c))
}
