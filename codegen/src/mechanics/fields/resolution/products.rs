//! Expansion of an integrand into products of shapes, coefficients along the field and factors that are
//! constant along it.

use eomgen_model_spec::ast::BinaryOperator;
use eomgen_model_spec::model::{Expr, ExprKind, Model};

use super::super::contents::{Contents, contents};
use super::super::degree::read_integer_exponent;

/// Highest power of the position with exact integrals.
const MAX_POWER: u32 = 32;

/// Largest number of products of an expanded integrand.
const MAX_PRODUCTS: usize = 4096;

/// Integrand as a sum.
pub(super) enum Expansion<'m> {
    /// Products; empty if all integrals are exact.
    Products(Vec<Product<'m>>),
    /// The integrand is not a polynomial of the motion.
    Nonlinear,
}

/// Product of coefficients and shapes; factors that are constant along the field are left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Product<'m> {
    pub coefficients: Vec<Coefficient<'m>>,
    /// Order of the derivative of each shape, ascending.
    pub shapes: Vec<u8>,
}

/// Function of the position, parameters and time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Coefficient<'m> {
    pub value: &'m Expr,
    pub is_divisor: bool,
}

/// Expands an integrand.
pub(super) fn expand<'m>(model: &Model, integrand: &'m Expr) -> Expansion<'m> {
    let Some(mut products) = products(model, integrand) else {
        return Expansion::Nonlinear;
    };
    products.retain(|product| {
        let powers = product.coefficients.iter().map(Coefficient::power);
        let power: Option<u32> = powers.sum();
        power.is_none_or(|power| power > MAX_POWER)
    });
    Expansion::Products(products)
}

/// Returns the first subexpression that jumps at a position which moves along the field with time, motion or inputs.
pub(super) fn find_moving_jump<'m>(model: &Model, integrand: &'m Expr) -> Option<&'m Expr> {
    let mut found = None;
    integrand.visit(&mut |part| {
        let arguments = match &part.kind {
            ExprKind::Call(function, arguments) if function.is_step() => arguments,
            _ => return,
        };
        let mut all = Contents::default();
        for argument in arguments {
            all.include(contents(model, argument));
        }
        if all.position && !all.shapes && (all.motion || all.time) {
            found = found.or(Some(part));
        }
    });
    found
}

impl Coefficient<'_> {
    /// Returns the degree of a polynomial of the position; `None` for other functions.
    pub fn power(&self) -> Option<u32> {
        let power = read_position_power(self.value)?;
        (!self.is_divisor).then_some(power)
    }
}

/// Expands an expression into a sum of products; `None` if this is impossible or takes too many products.
fn products<'m>(model: &Model, expr: &'m Expr) -> Option<Vec<Product<'m>>> {
    let all = contents(model, expr);
    if !all.varies_along_field() {
        return Some(vec![Product::default()]);
    }
    if !all.shapes && !all.motion {
        return Some(vec![Product::coefficient(expr, false)]);
    }
    match &expr.kind {
        ExprKind::Field(_) | ExprKind::ModeShape(_) => Some(vec![Product::shape(0)]),
        ExprKind::Dot(operand) => products(model, operand),
        ExprKind::Diff(operand, times) => {
            let mut found = products(model, operand)?;
            let shapes = found.iter_mut().flat_map(|product| &mut product.shapes);
            shapes.for_each(|derivative| *derivative += times);
            Some(found)
        }
        ExprKind::Negate(operand) => products(model, operand),
        ExprKind::Binary(operator, left, right) => match operator {
            BinaryOperator::Add | BinaryOperator::Subtract => {
                let mut sum = products(model, left)?;
                sum.extend(products(model, right)?);
                Some(remove_repetitions(sum))
            }
            BinaryOperator::Multiply => multiply(&products(model, left)?, &products(model, right)?),
            BinaryOperator::Divide => {
                let divisor = contents(model, right);
                let numerators = products(model, left)?;
                match (
                    divisor.varies_along_field(),
                    divisor.shapes || divisor.motion,
                ) {
                    (false, _) => Some(numerators),
                    (true, false) => multiply(&numerators, &[Product::coefficient(right, true)]),
                    (true, true) => None,
                }
            }
            BinaryOperator::Power => {
                let base = products(model, left)?;
                let mut power = vec![Product::default()];
                for _ in 0..read_integer_exponent(right)? {
                    power = multiply(&power, &base)?;
                }
                Some(power)
            }
        },
        _ => None,
    }
}

fn multiply<'m>(one: &[Product<'m>], other: &[Product<'m>]) -> Option<Vec<Product<'m>>> {
    if one.len() * other.len() > MAX_PRODUCTS {
        return None;
    }
    let products = one.iter().flat_map(|a| {
        other.iter().map(move |b| {
            let mut shapes = [&a.shapes[..], &b.shapes].concat();
            shapes.sort_unstable();
            Product {
                coefficients: [&a.coefficients[..], &b.coefficients].concat(),
                shapes,
            }
        })
    });
    Some(remove_repetitions(products.collect()))
}

/// Removes repeated products; factors that are constant along the field are ignored.
fn remove_repetitions(products: Vec<Product<'_>>) -> Vec<Product<'_>> {
    let mut distinct: Vec<Product<'_>> = Vec::new();
    for product in products {
        if !distinct.contains(&product) {
            distinct.push(product);
        }
    }
    distinct
}

impl<'m> Product<'m> {
    fn shape(derivative: u8) -> Self {
        Self {
            coefficients: Vec::new(),
            shapes: vec![derivative],
        }
    }

    fn coefficient(value: &'m Expr, is_divisor: bool) -> Self {
        Self {
            coefficients: vec![Coefficient { value, is_divisor }],
            shapes: Vec::new(),
        }
    }
}

/// Returns the degree of a polynomial of the position; `None` for other functions.
fn read_position_power(expr: &Expr) -> Option<u32> {
    match &expr.kind {
        ExprKind::Position(_) => Some(1),
        ExprKind::Negate(operand) => read_position_power(operand),
        ExprKind::Binary(operator, left, right) => {
            let one = read_position_power(left)?;
            match operator {
                BinaryOperator::Power if one > 0 => Some(one * read_integer_exponent(right)?),
                BinaryOperator::Power => (read_position_power(right)? == 0).then_some(0),
                BinaryOperator::Divide => (read_position_power(right)? == 0).then_some(one),
                BinaryOperator::Multiply => Some(one + read_position_power(right)?),
                BinaryOperator::Add | BinaryOperator::Subtract => {
                    Some(one.max(read_position_power(right)?))
                }
            }
        }
        ExprKind::Call(_, arguments) => arguments
            .iter()
            .all(|part| read_position_power(part) == Some(0))
            .then_some(0),
        _ => Some(0),
    }
}
