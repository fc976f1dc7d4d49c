//! Quadrature rule of a field: Gauss-Legendre nodes between its knots.

use eomgen_model_spec::ids::FieldId;
use eomgen_model_spec::model::Model;

use super::breaks::find_fixed_breaks;
use super::degree::find_highest_degree;
use super::modes::{compute_nodes_per_piece, knots};
use super::quadrature::{QuadratureRule, build_composite_rule};

/// Quadrature rule of a field: knots, and the number of nodes between adjacent knots.
#[derive(Clone, Debug)]
pub struct FieldRule {
    knots: Vec<f64>,
    nodes_per_piece: usize,
}

impl FieldRule {
    /// Returns the rule of a field at an order. The knots are both ends, the rows of a shape table, and the positions
    /// at which coefficients switch if they are fixed fractions of the length.
    pub fn new(model: &Model, field: FieldId, order: usize) -> Self {
        let basis = &model.fields[field].basis;
        let nodes_per_piece =
            compute_nodes_per_piece(basis, order, find_highest_degree(model, field));
        let mut knots = knots(basis);
        knots.extend(find_fixed_breaks(model, field));
        knots.sort_by(f64::total_cmp);
        knots.dedup();
        Self {
            knots,
            nodes_per_piece,
        }
    }

    /// Returns the number of nodes.
    pub fn node_count(&self) -> usize {
        (self.knots.len() - 1) * self.nodes_per_piece
    }

    /// Returns the knots, ascending from 0 to 1.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// Computes nodes and weights.
    pub fn quadrature(&self) -> QuadratureRule {
        build_composite_rule(&self.knots, self.nodes_per_piece)
    }
}
