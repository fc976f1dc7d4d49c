//! Mode shapes of uniform beams and their dimensionless integrals, for the bases a
//! specification can name. Everything is a function of s = x/l and of the mode's number;
//! lengths and stiffnesses enter elsewhere as parameters.
//!
//! The shapes are Eq. (17) of the paper,
//! phi_r(s) = sin z - sinh z + xi_r (cos z - cosh z), z = beta_r l s, evaluated with
//! exponentials of -z and of -(beta_r l - z): the hyperbolic functions themselves lose all
//! digits from r of about 12 on. The elementary functions are the project's own, so that
//! the tables have the same bits on every machine.

use eomgen_elementary::Function;
use eomgen_model_spec::model::Basis;

use crate::mechanics::fields::quadrature::{QuadratureRule, gauss_legendre};
use crate::symbolic::tables::{TableKind, quadrature_size};

/// One mode of a basis.
#[derive(Clone, Copy, Debug)]
struct Mode {
    /// r, from 1.
    number: usize,
    /// beta_r l
    wavenumber: f64,
    /// xi_r
    mixing: f64,
    /// (1 + xi_r) exp(beta_r l)
    growing: f64,
}

impl Mode {
    fn new(basis: Basis, number: usize) -> Self {
        match basis {
            Basis::ClampedFree => Self::clamped_free(number),
            Basis::ClampedFreePrinted => Self::printed(number),
        }
    }

    /// Root of cos z cosh z = -1 next to (r - 1/2) pi. With z = (r - 1/2) pi + d the
    /// equation is sin d = (-1)^(r+1) sech z, a contraction.
    fn clamped_free(number: usize) -> Self {
        let sign = alternating(number);
        let centre = std::f64::consts::PI * (number as f64 - 0.5);
        let mut offset = 0.0;
        for _ in 0..64 {
            let decay = exponential(-(centre + offset));
            let sech = 2.0 * decay / (1.0 + decay * decay);
            let next = -sign * Function::Asin.apply(&[sech]);
            if next == offset {
                break;
            }
            offset = next;
        }
        let wavenumber = centre + offset;
        let decay = exponential(-wavenumber);
        let sech = 2.0 * decay / (1.0 + decay * decay);
        let cosine = -sech;
        let sine = -sign * Function::Cos.apply(&[offset]);
        // xi = -(sin + sinh)/(cos + cosh), numerator and denominator times 2 exp(-z)
        let numerator = 2.0 * sine * decay + 1.0 - decay * decay;
        let denominator = 2.0 * cosine * decay + 1.0 + decay * decay;
        Self {
            number,
            wavenumber,
            mixing: -numerator / denominator,
            growing: 2.0 * (cosine - sine + decay) / denominator,
        }
    }

    /// beta_r l and xi_r as Eq. (18) and (19) print them.
    fn printed(number: usize) -> Self {
        let wavenumber = std::f64::consts::PI * (number as f64 - 0.5);
        let sine = -alternating(number);
        let decay = exponential(-wavenumber);
        let mixing = (1.0 + decay * decay) / (2.0 * sine * decay + 1.0 - decay * decay);
        Self {
            number,
            wavenumber,
            mixing,
            growing: (1.0 + mixing) / decay,
        }
    }

    /// phi_r^(a)(s), the derivative by s.
    fn shape(&self, derivative: u8, s: f64) -> f64 {
        let z = self.wavenumber * s;
        let (sine, cosine) = (Function::Sin.apply(&[z]), Function::Cos.apply(&[z]));
        let wave = match derivative % 4 {
            0 => sine + self.mixing * cosine,
            1 => cosine - self.mixing * sine,
            2 => -sine - self.mixing * cosine,
            _ => -cosine + self.mixing * sine,
        };
        let growing = self.growing * exponential(-self.wavenumber * (1.0 - s));
        let falling = (1.0 - self.mixing) * exponential(-z);
        let falling = if derivative.is_multiple_of(2) {
            -falling
        } else {
            falling
        };
        power(self.wavenumber, derivative) * (wave - 0.5 * (growing + falling))
    }

    fn at_start(&self, derivative: u8) -> f64 {
        match derivative {
            0 | 1 => 0.0,
            _ => self.shape(derivative, 0.0),
        }
    }

    /// At the free end moment and shear vanish and phi_r(1) = (-1)^r 2 xi_r.
    fn at_end(&self, basis: Basis, derivative: u8) -> f64 {
        match (basis, derivative) {
            (Basis::ClampedFree, 0) => 2.0 * alternating(self.number) * self.mixing,
            (Basis::ClampedFree, 2 | 3) => 0.0,
            _ => self.shape(derivative, 1.0),
        }
    }
}

/// (-1)^r
fn alternating(number: usize) -> f64 {
    if number.is_multiple_of(2) { 1.0 } else { -1.0 }
}

fn exponential(x: f64) -> f64 {
    Function::Exp.apply(&[x])
}

fn power(base: f64, exponent: u8) -> f64 {
    (0..exponent).fold(1.0, |product, _| product * base)
}

/// Whether the integral of s^k phi_r^(a) phi_p^(b) vanishes for r != p in this basis:
/// the shapes and their curvatures are orthogonal for a uniform beam.
pub fn is_orthogonal(basis: Basis, power: u32, left: u8, right: u8) -> bool {
    basis == Basis::ClampedFree && power == 0 && left == right && (left == 0 || left == 2)
}

/// The numbers of a table for modes 1 to `order`; matrices row by row.
pub fn table(basis: Basis, order: usize, kind: TableKind) -> Vec<f64> {
    let modes: Vec<Mode> = (1..=order).map(|number| Mode::new(basis, number)).collect();
    let each = |value: &dyn Fn(&Mode) -> f64| modes.iter().map(value).collect::<Vec<f64>>();
    match kind {
        TableKind::Wavenumber => each(&|mode| mode.wavenumber),
        TableKind::Mixing => each(&|mode| mode.mixing),
        TableKind::GrowingAmplitude => each(&|mode| mode.growing),
        TableKind::ShapeAtStart(derivative) => each(&|mode| mode.at_start(derivative)),
        TableKind::ShapeAtEnd(derivative) => each(&|mode| mode.at_end(basis, derivative)),
        TableKind::Moment { power, derivative } => moments(basis, &modes, power, derivative),
        TableKind::OwnMoment { power, left, right } => {
            own_moments(basis, &modes, power, left, right)
        }
        TableKind::PairMoment { power, left, right } => pair_moments(&modes, power, left, right),
        TableKind::NodePosition => gauss_legendre(quadrature_size(order)).nodes,
        TableKind::NodeWeight => gauss_legendre(quadrature_size(order)).weights,
        TableKind::ShapeAtNodes(derivative) => {
            let nodes = gauss_legendre(quadrature_size(order)).nodes;
            shapes_at(&modes, derivative, &nodes).concat()
        }
    }
}

/// RowNodes: nodes; columns: modes.
fn shapes_at(modes: &[Mode], derivative: u8, nodes: &[f64]) -> Vec<Vec<f64>> {
    nodes
        .iter()
        .map(|&s| modes.iter().map(|mode| mode.shape(derivative, s)).collect())
        .collect()
}

/// Integrals of s^k phi_r^(a).
///
/// For the exact shapes phi'''' = (beta l)^4 phi, so integrating by parts with
/// phi(0) = phi'(0) = phi''(1) = phi'''(1) = 0 gives 2/(beta l) for k = 0 and
/// -2 xi/(beta l)^2 for k = 1.
fn moments(basis: Basis, modes: &[Mode], moment: u32, derivative: u8) -> Vec<f64> {
    match (basis, moment, derivative) {
        (Basis::ClampedFree, 0, 0) => modes.iter().map(|m| 2.0 / m.wavenumber).collect(),
        (Basis::ClampedFree, 1, 0) => modes
            .iter()
            .map(|m| -2.0 * m.mixing / (m.wavenumber * m.wavenumber))
            .collect(),
        _ => {
            let (nodes, weights) = rule(modes.len(), moment);
            let shapes = shapes_at(modes, derivative, &nodes);
            (0..modes.len())
                .map(|r| sum_over(&weights, |g| shapes[g][r]))
                .collect()
        }
    }
}

/// Integrals of s^k phi_r^(a) phi_r^(b); xi^2 and (beta l)^4 xi^2 for the exact shapes
/// and curvatures.
fn own_moments(basis: Basis, modes: &[Mode], moment: u32, left: u8, right: u8) -> Vec<f64> {
    if is_orthogonal(basis, moment, left, right) {
        return modes
            .iter()
            .map(|m| power(m.wavenumber, 2 * left) * m.mixing * m.mixing)
            .collect();
    }
    let pairs = pair_moments(modes, moment, left, right);
    (0..modes.len())
        .map(|r| pairs[r * modes.len() + r])
        .collect()
}

fn pair_moments(modes: &[Mode], moment: u32, left: u8, right: u8) -> Vec<f64> {
    let (nodes, weights) = rule(modes.len(), moment);
    let a = shapes_at(modes, left, &nodes);
    let b = if left == right {
        a.clone()
    } else {
        shapes_at(modes, right, &nodes)
    };
    let order = modes.len();
    (0..order * order)
        .map(|place| sum_over(&weights, |g| a[g][place / order] * b[g][place % order]))
        .collect()
}

/// Nodes and weights times s^k.
fn rule(order: usize, moment: u32) -> (Vec<f64>, Vec<f64>) {
    let QuadratureRule { nodes, mut weights } =
        gauss_legendre(quadrature_size(order) + moment as usize);
    for (weight, s) in weights.iter_mut().zip(&nodes) {
        *weight *= (0..moment).fold(1.0, |product, _| product * s);
    }
    (nodes, weights)
}

/// Sum of weights times values with a running compensation of the rounding errors: the
/// off-diagonal integrals are small differences of large terms.
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
