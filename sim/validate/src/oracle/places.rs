//! Sets of positions of a field (quadrature nodes or a single position) with the mode shapes at these positions.
//!
//! Number of nodes: the phase of phi_S increases by pi S over the domain. A product of two modes oscillates as cos(2 pi
//! S s), a product of four (a quartic energy) as cos(4 pi S s). On [0, 1] a Gauss-Legendre rule with N nodes integrates
//! cos(w s) to rounding if 2 N exceeds w/2 by a margin that increases as the cube root of w. A margin of 32 is
//! sufficient up to S = 128. With 4 S + 40 nodes, 2 N = 8 S + 80 exceeds 2 pi S + 32 for every S. The additional nodes
//! allow for coefficients that vary along the field. A product of p > 4 modes gets p S + 40 nodes.

use super::legendre::unit_rule;
use super::shapes::Shape;
use super::splines::{self, SplineShape};
use crate::double_double::DoubleDouble;
use eomgen_model_spec::model::Basis;
use nalgebra::DMatrix;

/// Minimum number of modes in a product for which the number of nodes is chosen.
const MIN_POWER: usize = 4;

/// Number of derivative orders of a mode shape, from 0.
const DERIVATIVE_ORDERS: usize = 5;

#[derive(Clone, Debug)]
pub(super) struct FieldDomain {
    pub from: f64,
    pub length: f64,
    /// Index of the field's first mode among the generalised coordinates.
    pub offset: usize,
    pub order: usize,
    /// Number of nodes of the whole domain.
    nodes: usize,
    /// Relative positions of switches, between 0 and 1.
    knots: Vec<f64>,
    shapes: Shapes,
}

/// Mode shapes from a formula, or from a table with its quadrature rule.
#[derive(Clone, Debug)]
enum Shapes {
    Modes(Vec<Shape>),
    Splines(Vec<SplineShape>, Vec<(DoubleDouble, f64)>),
}

impl FieldDomain {
    /// Creates the domain for integrals of products of up to `power` modes.
    pub fn new(
        [from, to]: [f64; 2],
        basis: &Basis,
        offset: usize,
        order: usize,
        power: usize,
        knots: &[f64],
    ) -> Self {
        let numbers = 1..=order;
        let power = power.max(MIN_POWER);
        let nodes = power * order + 40;
        let shapes = match basis {
            Basis::Table { table, .. } => Shapes::Splines(
                numbers.map(|r| SplineShape::new(table, r)).collect(),
                splines::quadrature_rule(table, nodes, power, knots),
            ),
            Basis::Beam { .. } | Basis::ClampedFreePrinted => {
                Shapes::Modes(numbers.map(|r| Shape::new(basis, r)).collect())
            }
        };
        Self {
            from,
            length: to - from,
            offset,
            order,
            nodes,
            knots: knots.to_vec(),
            shapes,
        }
    }

    fn quadrature_rule(&self) -> Vec<(DoubleDouble, f64)> {
        match &self.shapes {
            Shapes::Splines(_, rule) => rule.clone(),
            Shapes::Modes(_) if self.knots.is_empty() => unit_rule(self.nodes)
                .iter()
                .map(|node| (node.position, node.weight))
                .collect(),
            Shapes::Modes(_) => {
                splines::rule_between(&[&[0.0], &self.knots[..], &[1.0]].concat(), self.nodes)
            }
        }
    }

    /// Returns the derivative of order `derivative` with respect to s of shape `mode` (counted from 0).
    fn shape(&self, mode: usize, derivative: u8, position: DoubleDouble) -> f64 {
        let value = match &self.shapes {
            Shapes::Modes(shapes) => shapes.get(mode).map(|s| s.derivative(derivative, position)),
            Shapes::Splines(shapes, _) => shapes
                .get(mode)
                .map(|s| s.derivative(derivative, position.high)),
        };
        value.unwrap_or(f64::NAN)
    }
}

#[derive(Clone, Debug)]
pub(super) struct PlaceSet {
    pub field: usize,
    pub positions: Vec<f64>,
    /// Weights: dx of the rule, or 1 for a single position.
    pub weights: Vec<f64>,
    relative_positions: Vec<DoubleDouble>,
    /// For each derivative order, the matrix of shapes (modes by positions); `None` before the first use.
    shapes: [Option<DMatrix<f64>>; DERIVATIVE_ORDERS],
}

impl PlaceSet {
    pub fn from_quadrature(field: usize, domain: &FieldDomain) -> Self {
        let rule = domain.quadrature_rule();
        Self {
            field,
            positions: rule
                .iter()
                .map(|(position, _)| domain.from + domain.length * position.high)
                .collect(),
            weights: rule
                .iter()
                .map(|(_, weight)| domain.length * weight)
                .collect(),
            relative_positions: rule.iter().map(|(position, _)| *position).collect(),
            shapes: Default::default(),
        }
    }

    pub fn from_position(field: usize, domain: &FieldDomain, x: f64) -> Self {
        Self {
            field,
            positions: vec![x],
            weights: vec![1.0],
            relative_positions: vec![DoubleDouble::new((x - domain.from) / domain.length)],
            shapes: Default::default(),
        }
    }

    pub fn compute_shapes(&mut self, derivative: u8, domain: &FieldDomain) {
        let scale = domain.length.powi(-i32::from(derivative));
        let relative = &self.relative_positions;
        if let Some(entry) = self.shapes.get_mut(usize::from(derivative))
            && entry.is_none()
        {
            *entry = Some(DMatrix::from_fn(
                domain.order,
                relative.len(),
                |mode, place| {
                    relative.get(place).map_or(f64::NAN, |position| {
                        scale * domain.shape(mode, derivative, *position)
                    })
                },
            ));
        }
    }

    /// Returns the derivatives of one order of all shapes, modes by positions.
    pub fn shapes(&self, derivative: u8) -> Option<&DMatrix<f64>> {
        self.shapes.get(usize::from(derivative))?.as_ref()
    }

    pub fn derivatives(&self) -> impl Iterator<Item = u8> {
        (0..DERIVATIVE_ORDERS as u8).filter(|derivative| self.shapes(*derivative).is_some())
    }
}
