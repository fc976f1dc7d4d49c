//! Tables of a basis: mode shapes at points and their dimensionless integrals, as functions of s = x/l and of
//! the mode number. Lengths and stiffnesses are parameters.

use eomgen_model_spec::model::Basis;

use super::beam;
use super::mode::{Mode, power};
use super::quadrature::{QuadratureRule, build_composite_rule, gauss_legendre};
use super::spline::Spline;
use crate::symbolic::tables::{TableKind, count_quadrature_nodes};

/// Number of shapes in the products for which quadrature nodes are chosen by default.
const DEFAULT_PRODUCT_DEGREE: u32 = 2;

/// Polynomial degree of the pieces of a cubic spline.
const SPLINE_PIECE_DEGREE: usize = 3;

/// Returns true if the integral of s^k phi_r^(a) phi_p^(b) is zero for all r != p. The shapes of a uniform beam are
/// orthogonal, and so are their curvatures. For sines and cosines this also holds for other equal derivatives.
pub fn is_orthogonal(basis: &Basis, power: u32, left: u8, right: u8) -> bool {
    let alike = left == right && (left == 0 || left == 2);
    match *basis {
        Basis::Beam { from, to } if beam::is_sinusoidal(from, to) => {
            power == 0 && (left + right).is_multiple_of(2)
        }
        Basis::Beam { .. } => power == 0 && alike,
        Basis::ClampedFreePrinted | Basis::Table { .. } => false,
    }
}

/// Returns the number of quadrature nodes between neighbouring knots, for products of up to `degree` shapes. All
/// pieces of a table together have at least as many nodes as other bases, and each piece has enough nodes for the
/// products.
pub(super) fn compute_nodes_per_piece(basis: &Basis, order: usize, degree: u32) -> usize {
    let nodes = count_quadrature_nodes(order, degree);
    match basis {
        Basis::Table { table, .. } => {
            let exact = (SPLINE_PIECE_DEGREE * degree as usize + 1).div_ceil(2);
            nodes.div_ceil(table.positions.len() - 1).max(exact)
        }
        Basis::Beam { .. } | Basis::ClampedFreePrinted => nodes,
    }
}

/// Returns the relative positions between which the shapes are smooth, including both ends.
pub(super) fn knots(basis: &Basis) -> Vec<f64> {
    let Some(table) = basis.table() else {
        return vec![0.0, 1.0];
    };
    let first = table.positions[0];
    let length = table.positions[table.positions.len() - 1] - first;
    table
        .positions
        .iter()
        .map(|x| (x - first) / length)
        .collect()
}

/// Computes a table of values at these quadrature nodes; returns an empty table if `kind` is not a table at
/// quadrature nodes.
pub(crate) fn compute_table_at_nodes(
    basis: &Basis,
    order: usize,
    rule: &QuadratureRule,
    kind: TableKind,
) -> Vec<f64> {
    match kind {
        TableKind::NodePosition => rule.nodes.clone(),
        TableKind::NodeWeight => rule.weights.clone(),
        TableKind::ShapeAtNodes(derivative) => {
            let shapes = Shapes::new(basis, order);
            shapes
                .compute_values_at_nodes(derivative, &rule.nodes)
                .concat()
        }
        _ => Vec::new(),
    }
}

/// Computes a table for modes 1 to `order`; matrices row by row. Tables at quadrature nodes use the nodes for
/// products of two shapes.
pub fn table(basis: &Basis, order: usize, kind: TableKind) -> Vec<f64> {
    let shapes = Shapes::new(basis, order);
    match kind {
        TableKind::Wavenumber => shapes.values(|mode| mode.wavenumber),
        TableKind::Mixing => shapes.values(|mode| mode.cosine),
        TableKind::GrowingAmplitude => shapes.values(|mode| -2.0 * mode.rising),
        TableKind::FallingAmplitude => shapes.values(|mode| mode.falling),
        TableKind::RisingAmplitude => shapes.values(|mode| mode.rising),
        TableKind::ShapeAtStart(derivative) => shapes.at_start(derivative),
        TableKind::ShapeAtEnd(derivative) => shapes.at_end(basis, derivative),
        TableKind::ShapeAtPlace { bits, derivative } => {
            shapes.values_at(derivative, f64::from_bits(bits))
        }
        TableKind::Indicator(mode) => (1..=order)
            .map(|number| f64::from(u8::from(number == mode)))
            .collect(),
        TableKind::Moment { power, derivative } => shapes.compute_moments(basis, power, derivative),
        TableKind::OwnMoment { power, left, right } => {
            shapes.compute_diagonal_moments(basis, power, left, right)
        }
        TableKind::PairMoment { power, left, right } => {
            shapes.compute_pair_moments(basis, power, left, right)
        }
        TableKind::NodePosition | TableKind::NodeWeight | TableKind::ShapeAtNodes(_) => {
            let nodes = compute_nodes_per_piece(basis, order, DEFAULT_PRODUCT_DEGREE);
            let rule = build_composite_rule(&knots(basis), nodes);
            compute_table_at_nodes(basis, order, &rule, kind)
        }
    }
}

/// Shapes of a basis up to an order.
pub(super) enum Shapes {
    /// Analytic shapes.
    Modes(Vec<Mode>),
    /// Tabulated shapes, with their knots.
    Splines(Vec<f64>, Vec<Spline>),
}

impl Shapes {
    pub(super) fn new(basis: &Basis, order: usize) -> Self {
        let numbers = 1..=order;
        match basis {
            Basis::Beam { from, to } => {
                Self::Modes(numbers.map(|r| beam::compute_mode(*from, *to, r)).collect())
            }
            Basis::ClampedFreePrinted => {
                Self::Modes(numbers.map(beam::compute_printed_mode).collect())
            }
            Basis::Table { table, .. } => {
                let knots = knots(basis);
                let used = table.shapes.iter().take(order);
                let splines = used.map(|values| Spline::new(&knots, values)).collect();
                Self::Splines(knots, splines)
            }
        }
    }

    /// Returns `value` of each analytic mode; empty for tabulated shapes.
    fn values(&self, value: impl Fn(&Mode) -> f64) -> Vec<f64> {
        match self {
            Self::Modes(modes) => modes.iter().map(value).collect(),
            Self::Splines(..) => Vec::new(),
        }
    }

    /// Returns phi_r^(a)(s) for all modes r.
    pub(super) fn values_at(&self, derivative: u8, s: f64) -> Vec<f64> {
        match self {
            Self::Modes(modes) => modes.iter().map(|m| m.shape(derivative, s)).collect(),
            Self::Splines(_, splines) => splines
                .iter()
                .map(|spline| spline.derivative(derivative, s))
                .collect(),
        }
    }

    fn at_start(&self, derivative: u8) -> Vec<f64> {
        let zero = |mode: &Mode| mode.at_start.get(usize::from(derivative)) == Some(&0.0);
        match self {
            Self::Modes(_) => self.values(|mode| match zero(mode) {
                true => 0.0,
                false => mode.shape(derivative, 0.0),
            }),
            Self::Splines(..) => self.values_at(derivative, 0.0),
        }
    }

    /// Returns all shapes at the end of the domain from the boundary conditions, which avoids the rounding error of
    /// the phase beta_r l. The clamped-free beam keeps its original rounding in derivatives that the conditions do
    /// not determine.
    fn at_end(&self, basis: &Basis, derivative: u8) -> Vec<f64> {
        let keeps = *basis == Basis::CLAMPED_FREE && matches!(derivative, 1 | 4..);
        match (self, basis) {
            (Self::Modes(_), Basis::Beam { .. }) if !keeps => self.values(|mode| {
                power(mode.wavenumber, derivative) * mode.at_end[usize::from(derivative % 4)]
            }),
            _ => self.values_at(derivative, 1.0),
        }
    }

    /// Returns phi_r^(a) with one row for each position and one column for each mode.
    fn compute_values_at_nodes(&self, derivative: u8, places: &[f64]) -> Vec<Vec<f64>> {
        places
            .iter()
            .map(|s| self.values_at(derivative, *s))
            .collect()
    }

    /// Computes the integrals of s^k phi_r^(a) for all modes r.
    fn compute_moments(&self, basis: &Basis, moment: u32, derivative: u8) -> Vec<f64> {
        if matches!(basis, Basis::Beam { .. }) && moment < 2 && derivative == 0 {
            return self.values(|mode| mode.compute_moment(moment));
        }
        let QuadratureRule { nodes, weights } = self.rule(basis, moment);
        let shapes = self.compute_values_at_nodes(derivative, &nodes);
        (0..self.order())
            .map(|r| sum_over(&weights, |g| shapes[g][r]))
            .collect()
    }

    /// Computes the integrals of s^k phi_r^(a) phi_r^(b) for all modes r; if a and b differ by 2, by integration by
    /// parts.
    fn compute_diagonal_moments(
        &self,
        basis: &Basis,
        moment: u32,
        left: u8,
        right: u8,
    ) -> Vec<f64> {
        if is_orthogonal(basis, moment, left, right) {
            let opposite = !(left.abs_diff(right) / 2).is_multiple_of(2);
            let sign = if opposite { -1.0 } else { 1.0 };
            return self.values(|m| {
                let [one, other] = m.mean_square;
                sign * (power(m.wavenumber, left + right) * one * other)
            });
        }
        let pairs = self.compute_pair_moments(basis, moment, left, right);
        pairs.iter().step_by(self.order() + 1).copied().collect()
    }

    fn compute_pair_moments(&self, basis: &Basis, moment: u32, left: u8, right: u8) -> Vec<f64> {
        let QuadratureRule { nodes, weights } = self.rule(basis, moment);
        let a = self.compute_values_at_nodes(left, &nodes);
        let b = if left == right {
            a.clone()
        } else {
            self.compute_values_at_nodes(right, &nodes)
        };
        let order = self.order();
        (0..order * order)
            .map(|place| sum_over(&weights, |g| a[g][place / order] * b[g][place % order]))
            .collect()
    }

    fn order(&self) -> usize {
        match self {
            Self::Modes(modes) => modes.len(),
            Self::Splines(_, splines) => splines.len(),
        }
    }

    /// Returns a quadrature rule whose weights are multiplied by s^k.
    fn rule(&self, basis: &Basis, moment: u32) -> QuadratureRule {
        let nodes = compute_nodes_per_piece(basis, self.order(), DEFAULT_PRODUCT_DEGREE);
        let mut rule = match self {
            Self::Modes(_) => gauss_legendre(nodes + moment as usize),
            Self::Splines(knots, _) => build_composite_rule(knots, nodes + moment as usize / 2),
        };
        for (weight, s) in rule.weights.iter_mut().zip(&rule.nodes) {
            *weight *= (0..moment).fold(1.0, |product, _| product * s);
        }
        rule
    }
}

/// Sums weights times values with compensated summation, because the off-diagonal integrals are small differences of
/// large terms.
fn sum_over(weights: &[f64], value: impl Fn(usize) -> f64) -> f64 {
    let (mut total, mut lost) = (0.0, 0.0);
    for (g, weight) in weights.iter().enumerate() {
        let term = weight * value(g);
        let sum: f64 = total + term;
        let of_total = sum - term;
        lost += (total - of_total) + (term - (sum - of_total));
        total = sum;
    }
    total + lost
}
