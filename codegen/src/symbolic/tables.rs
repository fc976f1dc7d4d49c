//! Tables of constants that belong to a field's basis: mode shapes at points, their
//! dimensionless integrals, quadrature nodes and weights. A table is filled for one
//! order; what the numbers are is computed in `modes` and `quadrature`.

use crate::symbolic::graph::{Shape, Space};
use eomgen_model_spec::ids::FieldId;

/// What a table holds; s = (x - from)/(to - from) runs from 0 to 1, phi_r^(a) is the
/// a-th derivative by s.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TableKind {
    /// beta_r l, a vector over the modes.
    Wavenumber,
    /// xi_r of Eq. (17), the factor of cos z beside sin z, a vector over the modes.
    Mixing,
    /// (1 + xi_r) exp(beta_r l), which stays of order 1, a vector over the modes.
    GrowingAmplitude,
    /// The factor of exp(-z), z = beta_r l s, in a mode, a vector over the modes.
    FallingAmplitude,
    /// The factor of exp(z - beta_r l) in a mode, a vector over the modes.
    RisingAmplitude,
    /// phi_r^(a)(0), a vector over the modes.
    ShapeAtStart(u8),
    /// phi_r^(a)(1), a vector over the modes.
    ShapeAtEnd(u8),
    /// phi_r^(a)(s) at a fixed place of a table of shapes, a vector over the modes.
    ShapeAtPlace {
        /// s, by its bits.
        bits: u64,
        /// a
        derivative: u8,
    },
    /// The integral of s^k phi_r^(a), a vector over the modes.
    Moment {
        /// k
        power: u32,
        /// a
        derivative: u8,
    },
    /// The integral of s^k phi_r^(a) phi_r^(b), a vector over the modes.
    OwnMoment {
        /// k
        power: u32,
        /// a
        left: u8,
        /// b
        right: u8,
    },
    /// The integral of s^k phi_r^(a) phi_p^(b), a matrix modes x modes.
    PairMoment {
        /// k
        power: u32,
        /// a
        left: u8,
        /// b
        right: u8,
    },
    /// The quadrature nodes, a vector over the nodes.
    NodePosition,
    /// The quadrature weights, a vector over the nodes.
    NodeWeight,
    /// phi_r^(a) at the quadrature nodes, a matrix nodes x modes.
    ShapeAtNodes(u8),
}

/// A table of constants.
#[derive(Clone, Debug)]
pub struct Table {
    /// The field it belongs to.
    pub field: FieldId,
    /// What it holds.
    pub kind: TableKind,
    /// Its numbers; a matrix row by row.
    pub values: Vec<f64>,
}

impl Table {
    /// The table's shape.
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

/// How many Gauss-Legendre nodes integrate products of two modes up to `order`.
///
/// A product of two shapes of wavenumber beta l < pi (order + 1/2) has phases up to
/// pi order on [-1, 1]; n nodes are exact to degree 2 n - 1, and the expansion of such a
/// wave in Legendre polynomials dies out a few dozen degrees past pi order.
pub fn quadrature_size(order: usize) -> usize {
    2 * order + 32
}
