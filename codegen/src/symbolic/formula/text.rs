//! Formulas as plain text, with the names and operators of the specification.

use std::fmt::{self, Display, Formatter};

use super::tree::{
    Choice, Formula, Level, MatrixPart, Term, find_small_fraction, split_powers_of_ten,
};
use crate::symbolic::table_text;

/// Formula with the level of its context.
struct AtLevel<'a>(&'a Formula, Level);

/// Formulas with a separator.
struct Joined<'a>(&'a [Formula], &'static str, Level);

impl Display for Formula {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        AtLevel(self, Level::Sum).fmt(f)
    }
}

impl Display for Joined<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        for (place, formula) in self.0.iter().enumerate() {
            let between = if place == 0 { "" } else { self.1 };
            write!(f, "{between}{}", AtLevel(formula, self.2))?;
        }
        Ok(())
    }
}

impl Display for AtLevel<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        if own_level(self.0) < self.1 {
            return write!(f, "({})", self.0);
        }
        match self.0 {
            Formula::Number(value) => f.write_str(&number(*value)),
            Formula::Symbol(symbol) => symbol.fmt(f),
            Formula::Table(kind) => f.write_str(&table_text::plain(*kind)),
            Formula::Sum(terms) => sum(f, terms),
            Formula::Quotient { above, below } => quotient(f, above, below),
            Formula::Power(base, exponent) => power(f, base, exponent),
            Formula::Call(function, arguments) => call(f, function.name(), arguments),
            Formula::Operation(name, operands) => call(f, name, operands),
            Formula::Choice(choice) => write_choice(f, choice),
            Formula::Total(index, of) => write!(f, "sum_{}({of})", index.name()),
            Formula::Applied(matrix, vector) => write!(f, "({matrix} . {vector})_i"),
            Formula::Transposed(matrix) => write!(f, "{}^T", AtLevel(matrix, Level::Base)),
            Formula::Matrix(parts) => matrix(f, parts),
            Formula::Omitted => f.write_str("..."),
        }
    }
}

/// Returns the lowest level at which a formula needs no parentheses.
fn own_level(formula: &Formula) -> Level {
    match formula {
        Formula::Sum(_) => Level::Sum,
        Formula::Matrix(parts) if parts.len() > 1 => Level::Sum,
        Formula::Number(value) if *value < 0.0 => Level::Sum,
        Formula::Quotient { .. } | Formula::Matrix(_) => Level::Product,
        Formula::Power(..) => Level::Divisor,
        _ => Level::Base,
    }
}

fn sum(f: &mut Formatter<'_>, terms: &[Term]) -> fmt::Result {
    for (place, term) in terms.iter().enumerate() {
        f.write_str(match (term.factor < 0.0, place) {
            (true, 0) => "-",
            (false, 0) => "",
            (true, _) => " - ",
            (false, _) => " + ",
        })?;
        let magnitude = term.factor.abs();
        match &term.of {
            None => f.write_str(&number(magnitude))?,
            Some(of) if term.factor == 1.0 => AtLevel(of, Level::Sum).fmt(f)?,
            Some(of) if magnitude == 1.0 => AtLevel(of, Level::Product).fmt(f)?,
            Some(of) => write!(f, "{}*{}", factor(magnitude), AtLevel(of, Level::Product))?,
        }
    }
    Ok(())
}

fn quotient(f: &mut Formatter<'_>, above: &[Formula], below: &[Formula]) -> fmt::Result {
    if above.is_empty() {
        f.write_str("1")?;
    }
    Joined(above, "*", Level::Product).fmt(f)?;
    match below {
        [] => Ok(()),
        [only] => write!(f, "/{}", AtLevel(only, Level::Divisor)),
        several => write!(f, "/({})", Joined(several, "*", Level::Product)),
    }
}

fn power(f: &mut Formatter<'_>, base: &Formula, exponent: &Formula) -> fmt::Result {
    let base = AtLevel(base, Level::Base);
    match exponent {
        Formula::Number(n) if *n >= 0.0 && n.fract() == 0.0 => write!(f, "{base}^{n}"),
        _ => write!(f, "{base}^({exponent})"),
    }
}

fn call(f: &mut Formatter<'_>, name: &str, arguments: &[Formula]) -> fmt::Result {
    write!(f, "{name}({})", Joined(arguments, ", ", Level::Sum))
}

fn write_choice(f: &mut Formatter<'_>, choice: &Choice) -> fmt::Result {
    let Choice {
        a,
        b,
        then,
        otherwise,
    } = choice;
    write!(f, "if({a} > {b}, {then}, {otherwise})")
}

fn matrix(f: &mut Formatter<'_>, parts: &[MatrixPart]) -> fmt::Result {
    for (place, part) in parts.iter().enumerate() {
        f.write_str(if place == 0 { "" } else { " + " })?;
        match part {
            MatrixPart::Diagonal(diagonal) => write!(f, "diag({diagonal})")?,
            MatrixPart::Outer(u, v) => write!(f, "[{u}]_i [{v}]_j")?,
            MatrixPart::Scaled(row, matrix, column) => {
                write!(f, "[{row}]_i {matrix} [{column}]_j")?
            }
        }
    }
    Ok(())
}

/// Writes the numeric factor of a product, as a small fraction if the fraction is exact.
fn factor(magnitude: f64) -> String {
    match find_small_fraction(magnitude) {
        Some((numerator, denominator)) => format!("{numerator}/{denominator}"),
        None => number(magnitude),
    }
}

fn number(value: f64) -> String {
    match split_powers_of_ten(value) {
        Some((mantissa, exponent)) => format!("{mantissa}e{exponent}"),
        None => format!("{value}"),
    }
}
