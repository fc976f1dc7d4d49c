//! A formula as a tree, without a notation.

use eomgen_model_spec::model::Function;
use serde::{Serialize, Serializer};

use super::symbol::{Index, Symbol};
use crate::symbolic::tables::TableKind;

/// A formula.
#[derive(Clone, Debug, PartialEq)]
pub enum Formula {
    /// A number.
    Number(f64),
    /// A named quantity.
    Symbol(Symbol),
    /// A constant of a basis.
    Table(TableKind),
    /// Terms, each with a factor.
    Sum(Vec<Term>),
    /// A product over a product; nothing above is 1.
    Quotient {
        /// The factors above the line.
        above: Vec<Self>,
        /// The factors below the line; none where there is no line.
        below: Vec<Self>,
    },
    /// A base and its exponent.
    Power(Box<Self>, Box<Self>),
    /// A function of the specification's language.
    Call(Function, Vec<Self>),
    /// One formula where a > b and another elsewhere.
    Choice(Box<Choice>),
    /// The sum over an index.
    Total(Index, Box<Self>),
    /// The elements of a matrix times a vector.
    Applied(Box<Self>, Box<Self>),
    /// A transposed matrix.
    Transposed(Box<Self>),
    /// The elements of a matrix, by the parts that add up to it.
    Matrix(Vec<MatrixPart>),
    /// An operation that has no sign of its own, by its name.
    Operation(&'static str, Vec<Self>),
    /// What is left out of an abridged formula.
    Omitted,
}

/// A term of a sum.
#[derive(Clone, Debug, PartialEq)]
pub struct Term {
    /// What the formula is multiplied with.
    pub factor: f64,
    /// The formula; a constant term is its factor alone.
    pub of: Option<Formula>,
}

/// One formula where a > b and another elsewhere.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// Compared.
    pub a: Formula,
    /// Compared with.
    pub b: Formula,
    /// The formula where a > b.
    pub then: Formula,
    /// The formula elsewhere.
    pub otherwise: Formula,
}

/// A part of a matrix.
#[derive(Clone, Debug, PartialEq)]
pub enum MatrixPart {
    /// A diagonal.
    Diagonal(Formula),
    /// The outer product of two vectors.
    Outer(Formula, Formula),
    /// A matrix with scaled rows and columns.
    Scaled(Formula, Formula, Formula),
}

/// What stands around a formula and decides whether it needs parentheses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// A sum needs none.
    Sum,
    /// A factor of a product.
    Product,
    /// What something is divided by.
    Divisor,
    /// The base of a power.
    Base,
}

impl Formula {
    /// A quantity by its name, without any index or dot.
    pub fn named(name: &str) -> Self {
        Self::Symbol(Symbol::plain(name))
    }

    /// The product of two formulas; a factor 1 is not written.
    pub fn times(self, other: Self) -> Self {
        match (self, other) {
            (Self::Number(1.0), other) => other,
            (own, Self::Number(1.0)) => own,
            (own, other) => Self::Quotient {
                above: vec![own, other],
                below: Vec::new(),
            },
        }
    }

    /// The sum of formulas; without any it is 0.
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

    /// A vector's element as one that is summed over columns; other formulas stay.
    pub fn by_columns(self) -> Self {
        match self {
            Self::Symbol(symbol) if symbol.indices == [Index::I] => {
                Self::Symbol(symbol.with_indices(&[Index::J]))
            }
            other => other,
        }
    }
}

impl Formula {
    /// Below which surroundings it needs parentheses where fractions have lines.
    pub fn set_level(&self) -> Level {
        match self {
            Self::Sum(_) | Self::Choice(_) => Level::Sum,
            Self::Number(value) if *value < 0.0 => Level::Sum,
            Self::Matrix(parts) if parts.len() > 1 => Level::Sum,
            Self::Number(value) if powers_of_ten(*value).is_some() => Level::Product,
            Self::Quotient { .. } | Self::Matrix(_) | Self::Total(..) => Level::Product,
            Self::Table(TableKind::GrowingAmplitude) => Level::Product,
            Self::Power(..) | Self::Table(_) | Self::Transposed(_) => Level::Divisor,
            Self::Call(Function::Exp, _) => Level::Divisor,
            _ => Level::Base,
        }
    }

    /// Hands this formula and all that it is made of to `see`.
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

/// Programs read formulas as plain text.
impl Serialize for Formula {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// A magnitude as a small fraction, where it is one exactly and no whole number.
pub fn small_fraction(value: f64) -> Option<(f64, u32)> {
    if value.fract() == 0.0 {
        return None;
    }
    (2..=12_u32).find_map(|denominator| {
        let numerator = (value * f64::from(denominator)).round();
        let exact = numerator / f64::from(denominator) == value;
        (exact && (1.0..=1000.0).contains(&numerator)).then_some((numerator, denominator))
    })
}

/// The mantissa and the exponent of ten of a number that is written with one.
pub fn powers_of_ten(value: f64) -> Option<(String, String)> {
    let magnitude = value.abs();
    if magnitude == 0.0 || (1e-4..1e6).contains(&magnitude) {
        return None;
    }
    let text = format!("{value:e}");
    let (mantissa, exponent) = text.split_once('e')?;
    Some((mantissa.to_owned(), exponent.to_owned()))
}
