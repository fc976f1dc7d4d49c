//! Polynomials in coordinates, rates and parameters, in a canonical form. Expressions can be
//! compared independently of their notation.

use std::collections::BTreeMap;

use eomgen_model_spec::ast::BinaryOperator;
use eomgen_model_spec::ids::{CoordinateId, ParameterId};
use eomgen_model_spec::model::{Expr, ExprKind, Model};

use crate::thresholds;

/// Variable of a polynomial.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Variable {
    /// Coordinate.
    Coordinate(CoordinateId),
    /// Rate of a coordinate.
    Rate(CoordinateId),
    /// Parameter.
    Parameter(ParameterId),
    /// Reciprocal of a sum of parameters, identified by the printed sum.
    Inverse(String),
}

/// Product of variables with nonzero powers.
type Monomial = BTreeMap<Variable, i32>;

/// Sum of monomials with their factors.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Polynomial(BTreeMap<Monomial, f64>);

impl Polynomial {
    /// Expands an expression. `None` if it is not a polynomial or has too many terms.
    pub(super) fn from_expression(model: &Model, expr: &Expr) -> Option<Self> {
        Reader::new(model).convert(expr)
    }

    /// Returns the time derivative; `None` if the polynomial contains a rate.
    pub(super) fn differentiate(&self) -> Option<Self> {
        let mut sum = Self::default();
        for (monomial, factor) in &self.0 {
            for (letter, power) in monomial {
                let rate = match letter {
                    Variable::Coordinate(id) => Variable::Rate(*id),
                    Variable::Rate(_) => return None,
                    Variable::Parameter(_) | Variable::Inverse(_) => continue,
                };
                let mut term = monomial.clone();
                multiply_by_power(&mut term, letter.clone(), -1);
                multiply_by_power(&mut term, rate, 1);
                sum.add_term(term, factor * f64::from(*power));
            }
        }
        Some(sum)
    }

    /// Returns true if two rates are proportional: both are linear in the rates of coordinates, and
    /// all coefficients have the same ratio. Zero is not proportional to any rate.
    pub(super) fn is_proportional_to(&self, other: &Self) -> bool {
        let (Some(own), Some(others)) = (self.collect_coefficients(), other.collect_coefficients())
        else {
            return false;
        };
        let ids = || own.keys().chain(others.keys());
        let zero = Self::default();
        let of = |list: &BTreeMap<CoordinateId, Self>, id: &CoordinateId| {
            list.get(id).unwrap_or(&zero).clone()
        };
        let agree = |a: &CoordinateId, b: &CoordinateId| {
            let one = of(&own, a).multiply(&of(&others, b));
            let two = of(&own, b).multiply(&of(&others, a));
            matches!((one, two), (Some(one), Some(two)) if one.is_near(&two))
        };
        !own.is_empty() && !others.is_empty() && ids().all(|a| ids().all(|b| agree(a, b)))
    }

    /// Returns the coefficient of each rate; `None` if a term has no rate or several rates.
    fn collect_coefficients(&self) -> Option<BTreeMap<CoordinateId, Self>> {
        let mut found: BTreeMap<CoordinateId, Self> = BTreeMap::new();
        for (monomial, factor) in &self.0 {
            let mut rates = monomial.iter().filter_map(|(letter, power)| match letter {
                Variable::Rate(id) => Some((*id, *power)),
                _ => None,
            });
            let (Some((id, 1)), None) = (rates.next(), rates.next()) else {
                return None;
            };
            let mut rest = monomial.clone();
            rest.remove(&Variable::Rate(id));
            found.entry(id).or_default().add_term(rest, *factor);
        }
        found.retain(|_, coefficient| !coefficient.0.is_empty());
        Some(found)
    }

    /// Returns true if two polynomials are equal within rounding.
    fn is_near(&self, other: &Self) -> bool {
        let of = |polynomial: &Self, monomial: &Monomial| {
            polynomial.0.get(monomial).copied().unwrap_or(0.0)
        };
        let mut monomials = self.0.keys().chain(other.0.keys());
        monomials.all(|monomial| {
            let (a, b) = (of(self, monomial), of(other, monomial));
            (a - b).abs() <= 1e-12 * a.abs().max(b.abs())
        })
    }

    fn from_number(value: f64) -> Self {
        let mut sum = Self::default();
        sum.add_term(Monomial::new(), value);
        sum
    }

    fn from_variable(letter: Variable) -> Self {
        Self([([(letter, 1)].into(), 1.0)].into())
    }

    fn add_term(&mut self, monomial: Monomial, factor: f64) {
        let sum = self.0.get(&monomial).copied().unwrap_or(0.0) + factor;
        match sum == 0.0 {
            true => self.0.remove(&monomial),
            false => self.0.insert(monomial, sum),
        };
    }

    fn add_scaled(mut self, other: &Self, sign: f64) -> Option<Self> {
        for (monomial, factor) in &other.0 {
            self.add_term(monomial.clone(), sign * factor);
        }
        self.limit_length()
    }

    fn multiply(&self, other: &Self) -> Option<Self> {
        let mut product = Self::default();
        for (one, factor) in &self.0 {
            for (two, by) in &other.0 {
                let mut monomial = one.clone();
                for (letter, power) in two {
                    multiply_by_power(&mut monomial, letter.clone(), *power);
                }
                product.add_term(monomial, factor * by);
            }
        }
        product.limit_length()
    }

    /// Returns the reciprocal. `None` if the polynomial is 0, or contains variables other than
    /// parameters.
    fn invert(&self) -> Option<Self> {
        let is_fixed = |letter: &Variable| matches!(letter, Variable::Parameter(_));
        if self.0.is_empty() || !self.0.keys().flat_map(BTreeMap::keys).all(is_fixed) {
            return None;
        }
        let mut terms = self.0.iter();
        if let (Some((monomial, factor)), None) = (terms.next(), terms.next()) {
            let inverse = monomial
                .iter()
                .map(|(letter, power)| (letter.clone(), -power));
            return Some(Self([(inverse.collect(), 1.0 / factor)].into()));
        }
        Some(Self::from_variable(Variable::Inverse(format!("{self:?}"))))
    }

    fn limit_length(self) -> Option<Self> {
        (self.0.len() <= thresholds::MAX_RATE_TERMS).then_some(self)
    }
}

fn multiply_by_power(monomial: &mut Monomial, letter: Variable, by: i32) {
    let power = monomial.get(&letter).copied().unwrap_or(0) + by;
    match power {
        0 => monomial.remove(&letter),
        _ => monomial.insert(letter, power),
    };
}

/// Converter of the model's expressions; each definition is converted once.
struct Reader<'m> {
    model: &'m Model,
    definitions: Vec<Option<Option<Polynomial>>>,
}

impl<'m> Reader<'m> {
    fn new(model: &'m Model) -> Self {
        Self {
            model,
            definitions: vec![None; model.definitions.len()],
        }
    }

    fn convert(&mut self, expr: &Expr) -> Option<Polynomial> {
        match &expr.kind {
            ExprKind::Number(value) => Some(Polynomial::from_number(*value)),
            ExprKind::Pi => Some(Polynomial::from_number(std::f64::consts::PI)),
            ExprKind::Parameter(id) => Some(Polynomial::from_variable(Variable::Parameter(*id))),
            ExprKind::Coordinate(id) => Some(Polynomial::from_variable(Variable::Coordinate(*id))),
            ExprKind::Definition(id) => {
                if self.definitions[*id].is_none() {
                    let model = self.model;
                    self.definitions[*id] = Some(self.convert(&model.definitions[*id].value));
                }
                self.definitions[*id].clone().flatten()
            }
            ExprKind::Dot(inner) => self.convert(inner)?.differentiate(),
            ExprKind::Negate(inner) => {
                Polynomial::default().add_scaled(&self.convert(inner)?, -1.0)
            }
            ExprKind::Binary(operator, left, right) => {
                let (left, right) = (self.convert(left)?, self.convert(right)?);
                match operator {
                    BinaryOperator::Add => left.add_scaled(&right, 1.0),
                    BinaryOperator::Subtract => left.add_scaled(&right, -1.0),
                    BinaryOperator::Multiply => left.multiply(&right),
                    BinaryOperator::Divide => left.multiply(&right.invert()?),
                    BinaryOperator::Power => raise_to_power(&left, &right),
                }
            }
            _ => None,
        }
    }
}

/// Returns a power with a small integer exponent.
fn raise_to_power(base: &Polynomial, exponent: &Polynomial) -> Option<Polynomial> {
    let mut powers = 1..=thresholds::MAX_RATE_POWER;
    let exponent = powers.find(|n| *exponent == Polynomial::from_number(f64::from(*n)))?;
    (1..exponent).try_fold(base.clone(), |product, _| product.multiply(base))
}
