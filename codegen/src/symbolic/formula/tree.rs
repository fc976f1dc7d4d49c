//! Formula as a tree, independent of its notation.

use eomgen_model_spec::model::Function;
use serde::{Serialize, Serializer};

use super::symbol::{Index, Symbol};
use crate::symbolic::tables::TableKind;

/// Formula.
#[derive(Clone, Debug, PartialEq)]
pub enum Formula {
    /// Number.
    Number(f64),
    /// Named quantity.
    Symbol(Symbol),
    /// Element of a table of constants of a basis.
    Table(TableKind),
    /// Sum of terms.
    Sum(Vec<Term>),
    /// Quotient of two products; an empty numerator is 1.
    Quotient {
        /// Factors of the numerator.
        above: Vec<Self>,
        /// Factors of the denominator; empty for a product.
        below: Vec<Self>,
    },
    /// Power with base and exponent.
    Power(Box<Self>, Box<Self>),
    /// Function of the specification language.
    Call(Function, Vec<Self>),
    /// Selection between two formulas.
    Choice(Box<Choice>),
    /// Sum over an index.
    Total(Index, Box<Self>),
    /// Element of the product of a matrix and a vector.
    Applied(Box<Self>, Box<Self>),
    /// Transposed matrix.
    Transposed(Box<Self>),
    /// Element of a matrix, as a sum of parts.
    Matrix(Vec<MatrixPart>),
    /// Operation without a mathematical notation, with its name.
    Operation(&'static str, Vec<Self>),
    /// Omitted part of an abridged formula.
    Omitted,
}

/// Term of a sum.
#[derive(Clone, Debug, PartialEq)]
pub struct Term {
    /// Numeric factor.
    pub factor: f64,
    /// Formula; `None` for a constant term.
    pub of: Option<Formula>,
}

/// Selection: one formula if a > b, else another.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// Left side of the comparison.
    pub a: Formula,
    /// Right side of the comparison.
    pub b: Formula,
    /// Formula if a > b.
    pub then: Formula,
    /// Formula otherwise.
    pub otherwise: Formula,
}

/// Part of a matrix.
#[derive(Clone, Debug, PartialEq)]
pub enum MatrixPart {
    /// Diagonal.
    Diagonal(Formula),
    /// Outer product of two vectors.
    Outer(Formula, Formula),
    /// Matrix with scaled rows and columns.
    Scaled(Formula, Formula, Formula),
}

/// Context of a formula, which determines whether it needs parentheses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// Term of a sum, or no context.
    Sum,
    /// Factor of a product.
    Product,
    /// Divisor.
    Divisor,
    /// Base of a power.
    Base,
}

impl Formula {
    /// Returns a named quantity without index or dot.
    pub fn from_name(name: &str) -> Self {
        Self::Symbol(Symbol::plain(name))
    }

    /// Returns the product of two formulas; a factor 1 is omitted.
    pub fn multiply(self, other: Self) -> Self {
        match (self, other) {
            (Self::Number(1.0), other) => other,
            (own, Self::Number(1.0)) => own,
            (own, other) => Self::Quotient {
                above: vec![own, other],
                below: Vec::new(),
            },
        }
    }

    /// Returns the sum of formulas, or 0 if there are none.
    pub fn sum(formulas: Vec<Self>) -> Self {
        let mut terms: Vec<Term> = formulas
            .into_iter()
            .map(|of| Term {
                factor: 1.0,
                of: Some(of),
            })
            .collect();
        match (terms.len(), terms.pop()) {
            (1, Some(Term { of: Some(only), .. })) => only,
            (_, Some(last)) => {
                terms.push(last);
                Self::Sum(terms)
            }
            (_, None) => Self::Number(0.0),
        }
    }

    /// Replaces the index of a vector element by the column index; other formulas are unchanged.
    pub fn split_by_columns(self) -> Self {
        match self {
            Self::Symbol(symbol) if symbol.indices == [Index::I] => {
                Self::Symbol(symbol.with_indices(&[Index::J]))
            }
            other => other,
        }
    }
}

impl Formula {
    /// Returns the lowest level at which the formula needs no parentheses, in a notation with fraction bars.
    pub fn set_level(&self) -> Level {
        match self {
            Self::Sum(_) | Self::Choice(_) => Level::Sum,
            Self::Number(value) if *value < 0.0 => Level::Sum,
            Self::Matrix(parts) if parts.len() > 1 => Level::Sum,
            Self::Number(value) if split_powers_of_ten(*value).is_some() => Level::Product,
            Self::Quotient { .. } | Self::Matrix(_) | Self::Total(..) => Level::Product,
            Self::Table(TableKind::GrowingAmplitude) => Level::Product,
            Self::Power(..) | Self::Table(_) | Self::Transposed(_) => Level::Divisor,
            Self::Call(Function::Exp, _) => Level::Divisor,
            _ => Level::Base,
        }
    }

    /// Calls `see` with the formula and all its parts.
    pub fn visit(&self, see: &mut impl FnMut(&Self)) {
        see(self);
        match self {
            Self::Number(_) | Self::Symbol(_) | Self::Table(_) | Self::Omitted => {}
            Self::Sum(terms) => {
                let formulas = terms.iter().filter_map(|term| term.of.as_ref());
                formulas.for_each(|of| of.visit(see));
            }
            Self::Quotient { above, below } => {
                above
                    .iter()
                    .chain(below)
                    .for_each(|factor| factor.visit(see));
            }
            Self::Power(one, other) | Self::Applied(one, other) => {
                one.visit(see);
                other.visit(see);
            }
            Self::Call(_, operands) | Self::Operation(_, operands) => {
                operands.iter().for_each(|operand| operand.visit(see));
            }
            Self::Choice(choice) => {
                let parts = [&choice.a, &choice.b, &choice.then, &choice.otherwise];
                parts.into_iter().for_each(|part| part.visit(see));
            }
            Self::Total(_, of) | Self::Transposed(of) => of.visit(see),
            Self::Matrix(parts) => parts.iter().for_each(|part| match part {
                MatrixPart::Diagonal(diagonal) => diagonal.visit(see),
                MatrixPart::Outer(u, v) => [u, v].into_iter().for_each(|of| of.visit(see)),
                MatrixPart::Scaled(row, matrix, column) => {
                    [row, matrix, column]
                        .into_iter()
                        .for_each(|of| of.visit(see));
                }
            }),
        }
    }
}

impl Serialize for Formula {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// Returns numerator and denominator if the magnitude is exactly a fraction with small integers; `None` for integers
/// and other numbers.
pub fn find_small_fraction(value: f64) -> Option<(f64, u32)> {
    if value.fract() == 0.0 {
        return None;
    }
    (2..=12_u32).find_map(|denominator| {
        let numerator = (value * f64::from(denominator)).round();
        let exact = numerator / f64::from(denominator) == value;
        (exact && (1.0..=1000.0).contains(&numerator)).then_some((numerator, denominator))
    })
}

/// Largest power of pi that [`find_multiple_of_pi`] finds.
const MAX_POWER_OF_PI: i32 = 4;

/// Returns factor and exponent if a magnitude equals, up to rounding, a small integer or fraction times a power of
/// pi: 39.478... is 4 pi^2.
pub fn find_multiple_of_pi(magnitude: f64) -> Option<(f64, i32)> {
    (1..=MAX_POWER_OF_PI).find_map(|power| {
        let rough = magnitude / std::f64::consts::PI.powi(power);
        let exact = (1..=12_u32).find_map(|denominator| {
            let denominator = f64::from(denominator);
            let numerator = (rough * denominator).round();
            let exact = numerator / denominator;
            let is_small = (1.0..=1000.0).contains(&numerator);
            (is_small && (rough / exact - 1.0).abs() < 4.0 * f64::EPSILON).then_some(exact)
        });
        exact.map(|factor| (factor, power))
    })
}

/// Returns mantissa and exponent of ten of a very small or large number; `None` for other numbers.
pub fn split_powers_of_ten(value: f64) -> Option<(String, String)> {
    let magnitude = value.abs();
    if magnitude == 0.0 || (1e-4..1e6).contains(&magnitude) {
        return None;
    }
    let text = format!("{value:e}");
    let (mantissa, exponent) = text.split_once('e')?;
    Some((mantissa.to_owned(), exponent.to_owned()))
}

#[cfg(test)]
mod tests {
    use super::find_multiple_of_pi;
    use std::f64::consts::{PI, TAU};

    #[test]
    fn multiples_of_pi_are_found() {
        assert_eq!(find_multiple_of_pi(39.47841760435743), Some((4.0, 2)));
        assert_eq!(find_multiple_of_pi(TAU), Some((2.0, 1)));
        assert_eq!(find_multiple_of_pi(PI / 6.0), Some((1.0 / 6.0, 1)));
        for other in [0.0, 1.0, 39.478, 9.81, 1e6 * PI, f64::NAN] {
            assert_eq!(find_multiple_of_pi(other), None, "{other}");
        }
    }
}
