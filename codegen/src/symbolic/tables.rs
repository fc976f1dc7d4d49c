//! Tables of constants of a field's basis for one truncation order: mode shapes at points, their
//! dimensionless integrals, quadrature nodes and weights. `modes` and `quadrature` compute the numbers.

use crate::symbolic::graph::{Shape, Space};
use eomgen_model_spec::ids::FieldId;

/// Content of a table; s = (x - from)/(to - from) is between 0 and 1, phi_r^(a) is the a-th derivative with respect to
/// s.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TableKind {
    /// beta_r l, a vector over the modes.
    Wavenumber,
    /// xi_r of Eq. (17) of the paper, the factor of cos z relative to sin z, a vector over the modes.
    Mixing,
    /// (1 + xi_r) exp(beta_r l), which is of order 1, a vector over the modes.
    GrowingAmplitude,
    /// Factor of exp(-z), z = beta_r l s, in a mode, a vector over the modes.
    FallingAmplitude,
    /// Factor of exp(z - beta_r l) in a mode, a vector over the modes.
    RisingAmplitude,
    /// phi_r^(a)(0), a vector over the modes.
    ShapeAtStart(u8),
    /// phi_r^(a)(1), a vector over the modes.
    ShapeAtEnd(u8),
    /// phi_r^(a)(s) of tabulated shapes at a fixed position, a vector over the modes.
    ShapeAtPlace {
        /// Bits of s.
        bits: u64,
        /// a
        derivative: u8,
    },
    /// 1 for the mode with this number (from 1), 0 for all other modes; a vector over the modes.
    Indicator(usize),
    /// Integral of s^k phi_r^(a), a vector over the modes.
    Moment {
        /// k
        power: u32,
        /// a
        derivative: u8,
    },
    /// Integral of s^k phi_r^(a) phi_r^(b), a vector over the modes.
    OwnMoment {
        /// k
        power: u32,
        /// a
        left: u8,
        /// b
        right: u8,
    },
    /// Integral of s^k phi_r^(a) phi_p^(b), a matrix modes x modes.
    PairMoment {
        /// k
        power: u32,
        /// a
        left: u8,
        /// b
        right: u8,
    },
    /// Quadrature nodes, a vector over the nodes.
    NodePosition,
    /// Quadrature weights, a vector over the nodes.
    NodeWeight,
    /// phi_r^(a) at the quadrature nodes, a matrix nodes x modes.
    ShapeAtNodes(u8),
}

/// Table of constants.
#[derive(Clone, Debug)]
pub struct Table {
    /// Field.
    pub field: FieldId,
    /// Content.
    pub kind: TableKind,
    /// Numbers; a matrix row by row.
    pub values: Vec<f64>,
}

impl Table {
    /// Returns the shape of the table.
    pub fn shape(&self) -> Shape {
        let modes = Space::Modes(self.field);
        let nodes = Space::Nodes(self.field);
        match self.kind {
            TableKind::PairMoment { .. } => Shape::Matrix(modes, modes),
            TableKind::ShapeAtNodes(_) => Shape::Matrix(nodes, modes),
            TableKind::NodePosition | TableKind::NodeWeight => Shape::Vector(nodes),
            _ => Shape::Vector(modes),
        }
    }
}

/// Returns the number of Gauss-Legendre nodes for products of `degree` mode shapes up to `order`; a degree below 2
/// counts as 2.
///
/// A product of p shapes with wave numbers beta l < pi (order + 1/2) has phases up to p pi order/2 on [-1, 1]. A rule
/// of n nodes is exact up to the degree 2 n - 1. The Legendre coefficients of such a wave are negligible from a few
/// dozen degrees above p pi order/2. This is less than 2 n = 2 p order + 64.
pub fn count_quadrature_nodes(order: usize, degree: u32) -> usize {
    degree.max(2) as usize * order + 32
}
