//! The numbers of a basis: mode shapes at points and their dimensionless integrals. Everything is
//! a function of s = x/l and of the mode's number; lengths and stiffnesses enter elsewhere as
//! parameters.

use eomgen_model_spec::model::Basis;

use super::beam;
use super::mode::{Mode, power};
use crate::mechanics::fields::quadrature::{QuadratureRule, gauss_legendre};
use crate::symbolic::tables::{TableKind, quadrature_size};

/// Mode `number` of a basis, from 1.
fn mode(basis: Basis, number: usize) -> Mode {
    match basis {
        Basis::Beam { from, to } => beam::mode(from, to, number),
        Basis::ClampedFreePrinted => beam::printed(number),
    }
}

/// Whether the integral of s^k phi_r^(a) phi_p^(b) vanishes for r != p in this basis: the shapes
/// and their curvatures are orthogonal for a uniform beam. Sines and cosines are so in every
/// derivative that is one of the same kind.
pub fn is_orthogonal(basis: Basis, power: u32, left: u8, right: u8) -> bool {
    let alike = left == right && (left == 0 || left == 2);
    match basis {
        Basis::Beam { from, to } if beam::is_sinusoidal(from, to) => {
            power == 0 && (left + right).is_multiple_of(2)
        }
        Basis::Beam { .. } => power == 0 && alike,
        Basis::ClampedFreePrinted => false,
    }
}

/// The numbers of a table for modes 1 to `order`; matrices row by row.
pub fn table(basis: Basis, order: usize, kind: TableKind) -> Vec<f64> {
    let modes: Vec<Mode> = (1..=order).map(|number| mode(basis, number)).collect();
    let each = |value: &dyn Fn(&Mode) -> f64| modes.iter().map(value).collect::<Vec<f64>>();
    match kind {
        TableKind::Wavenumber => each(&|mode| mode.wavenumber),
        TableKind::Mixing => each(&|mode| mode.cosine),
        TableKind::GrowingAmplitude => each(&|mode| -2.0 * mode.rising),
        TableKind::FallingAmplitude => each(&|mode| mode.falling),
        TableKind::RisingAmplitude => each(&|mode| mode.rising),
        TableKind::ShapeAtStart(derivative) => each(&|mode| at_start(mode, derivative)),
        TableKind::ShapeAtEnd(derivative) => each(&|mode| at_end(basis, mode, derivative)),
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

fn at_start(mode: &Mode, derivative: u8) -> f64 {
    match mode.at_start.get(usize::from(derivative)) {
        Some(0.0) => 0.0,
        _ => mode.shape(derivative, 0.0),
    }
}

/// By the values the end's conditions give, which are free of the error of a phase of beta_r l.
/// The clamped beam's free end keeps the rounding it has always had where they say nothing.
fn at_end(basis: Basis, mode: &Mode, derivative: u8) -> f64 {
    match (basis, derivative) {
        (Basis::ClampedFreePrinted, _) | (Basis::CLAMPED_FREE, 1 | 4..) => {
            mode.shape(derivative, 1.0)
        }
        _ => power(mode.wavenumber, derivative) * mode.at_end[usize::from(derivative % 4)],
    }
}

/// Rows: nodes; columns: modes.
fn shapes_at(modes: &[Mode], derivative: u8, nodes: &[f64]) -> Vec<Vec<f64>> {
    nodes
        .iter()
        .map(|&s| modes.iter().map(|mode| mode.shape(derivative, s)).collect())
        .collect()
}

/// Integrals of s^k phi_r^(a).
fn moments(basis: Basis, modes: &[Mode], moment: u32, derivative: u8) -> Vec<f64> {
    if matches!(basis, Basis::Beam { .. }) && moment < 2 && derivative == 0 {
        return modes
            .iter()
            .map(|mode| closed_moment(mode, moment))
            .collect();
    }
    let (nodes, weights) = rule(modes.len(), moment);
    let shapes = shapes_at(modes, derivative, &nodes);
    (0..modes.len())
        .map(|r| sum_over(&weights, |g| shapes[g][r]))
        .collect()
}

/// The integral of phi, or of s phi, of a beam: phi'''' = k^4 phi, so that integrating by parts
/// leaves values at the ends.
pub(super) fn closed_moment(mode: &Mode, moment: u32) -> f64 {
    let k = mode.wavenumber;
    match moment {
        0 => (mode.at_end[3] - mode.at_start[3]) / k,
        _ => mode.at_end[3] / k + (mode.at_start[2] - mode.at_end[2]) / (k * k),
    }
}

/// Integrals of s^k phi_r^(a) phi_r^(b); where a and b differ by 2, twice by parts.
fn own_moments(basis: Basis, modes: &[Mode], moment: u32, left: u8, right: u8) -> Vec<f64> {
    if is_orthogonal(basis, moment, left, right) {
        let opposite = !(left.abs_diff(right) / 2).is_multiple_of(2);
        let sign = if opposite { -1.0 } else { 1.0 };
        return modes
            .iter()
            .map(|m| {
                let [one, other] = m.mean_square;
                sign * (power(m.wavenumber, left + right) * one * other)
            })
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
