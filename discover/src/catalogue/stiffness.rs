//! Stiffness of a flexible body: the factor `B` of an energy `1/2*integral(B*curvature^2)`, in any
//! notation of the product.

use eomgen_model_spec::ast::BinaryOperator;
use eomgen_model_spec::model::{Expr, ExprKind, Model};

use crate::catalogue::site::format_expression;

/// Factors of a product: a number, expressions with their powers, and the power of those factors
/// that contain a curvature.
struct Product<'m> {
    model: &'m Model,
    is_curvature: &'m dyn Fn(&Expr) -> bool,
    number: f64,
    factors: Vec<(String, i32)>,
    curvature_power: i32,
}

/// Returns the stiffness of an energy in the notation of the specification; `None` if the energy
/// has no integral of a squared curvature.
pub(super) fn find_stiffness(
    model: &Model,
    energy: &Expr,
    is_curvature: &dyn Fn(&Expr) -> bool,
) -> Option<String> {
    let mut product = Product {
        model,
        is_curvature,
        number: 2.0,
        factors: Vec::new(),
        curvature_power: 0,
    };
    product.multiply(energy, 1);
    (product.curvature_power == 2).then(|| product.format())
}

impl Product<'_> {
    /// Multiplies by a power of an expression. A sum outside the square is replaced by its summand
    /// with the curvature.
    fn multiply(&mut self, expr: &Expr, power: i32) {
        match &expr.kind {
            ExprKind::Number(value) => self.number *= value.powi(power),
            ExprKind::Negate(inner) => {
                self.number *= f64::powi(-1.0, power);
                self.multiply(inner, power);
            }
            ExprKind::Binary(BinaryOperator::Multiply, left, right) => {
                self.multiply(left, power);
                self.multiply(right, power);
            }
            ExprKind::Binary(BinaryOperator::Divide, left, right) => {
                self.multiply(left, power);
                self.multiply(right, -power);
            }
            ExprKind::Binary(BinaryOperator::Power, base, exponent) => match exponent.kind {
                ExprKind::Number(n) if n.fract() == 0.0 && n.abs() <= 8.0 => {
                    self.multiply(base, power * n as i32);
                }
                _ => self.push(expr, power),
            },
            ExprKind::Binary(operator, left, right)
                if power == 1 && self.contains_curvature(expr) =>
            {
                match (self.contains_curvature(left), operator) {
                    (true, _) => self.multiply(left, power),
                    (false, BinaryOperator::Subtract) => {
                        self.number = -self.number;
                        self.multiply(right, power);
                    }
                    (false, _) => self.multiply(right, power),
                }
            }
            ExprKind::Integral { integrand, .. } if self.contains_curvature(integrand) => {
                self.multiply(integrand, power);
            }
            _ => self.push(expr, power),
        }
    }

    fn push(&mut self, expr: &Expr, power: i32) {
        if self.contains_curvature(expr) {
            self.curvature_power += power;
            return;
        }
        let factor = format_expression(self.model, expr);
        match self.factors.iter_mut().find(|(known, _)| *known == factor) {
            Some((_, known)) => *known += power,
            None => self.factors.push((factor, power)),
        }
    }

    fn contains_curvature(&self, expr: &Expr) -> bool {
        let mut found = false;
        expr.visit(&mut |part| found |= (self.is_curvature)(part));
        found
    }

    fn format(&self) -> String {
        let written = |(factor, power): &(String, i32)| match power.abs() {
            1 => factor.clone(),
            more => format!("{factor}^{more}"),
        };
        let of_sign = |sign: i32| {
            let factors = self.factors.iter();
            let factors = factors.filter(move |(_, power)| power.signum() == sign);
            factors.map(written).collect::<Vec<String>>()
        };
        let mut above = of_sign(1);
        if self.number != 1.0 || above.is_empty() {
            above.insert(0, self.number.to_string());
        }
        [vec![above.join("*")], of_sign(-1)].concat().join("/")
    }
}
