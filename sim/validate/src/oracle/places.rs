//! Where fields are evaluated: the quadrature nodes of a field's domain and single
//! positions, each with the mode shapes there. Depends on parameters alone.
//!
//! The number of nodes: phi_S has the phase pi S over the domain, so a product of two
//! modes oscillates like cos(2 pi S s), a product of four (a quartic energy) like
//! cos(4 pi S s). On [0, 1] a Gauss-Legendre rule with N nodes integrates cos(w s) to
//! rounding once 2 N exceeds w/2 by a margin that grows like the cube root of w: 32 is
//! enough up to S = 128. 4 S + 40 nodes keep 2 N = 8 S + 80 above 2 pi S + 32 for every
//! S; the surplus serves coefficients that vary along the field.

use super::double_double::DoubleDouble;
use super::legendre::unit_rule;
use super::shapes::Shape;
use super::splines::{self, SplineShape};
use eomgen_model_spec::model::Basis;
use nalgebra::DMatrix;

/// The highest derivative of a mode shape the language knows.
const DERIVATIVES: usize = 5;

/// A field with its domain and mode shapes as numbers.
#[derive(Clone, Debug)]
pub(super) struct Domain {
    /// Where the domain starts.
    pub from: f64,
    /// Its length.
    pub length: f64,
    /// Place of the field's first mode among the generalised coordinates.
    pub offset: usize,
    /// Number of modes.
    pub order: usize,
    shapes: Shapes,
}

/// Mode shapes by a formula or through the values of a table, with the rule that integrates them.
#[derive(Clone, Debug)]
enum Shapes {
    Modes(Vec<Shape>),
    Splines(Vec<SplineShape>, Vec<(DoubleDouble, f64)>),
}

impl Domain {
    /// The domain `from..to` with the first `order` shapes of `basis`.
    pub fn new(from: f64, to: f64, basis: &Basis, offset: usize, order: usize) -> Self {
        let numbers = 1..=order;
        let shapes = match basis {
            Basis::Table { table, .. } => Shapes::Splines(
                numbers.map(|r| SplineShape::new(table, r)).collect(),
                splines::rule(table, order),
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
            shapes,
        }
    }

    /// The places and weights on [0, 1] that integrate the shapes.
    fn rule(&self) -> Vec<(DoubleDouble, f64)> {
        match &self.shapes {
            Shapes::Splines(_, rule) => rule.clone(),
            Shapes::Modes(_) => unit_rule(4 * self.order + 40)
                .iter()
                .map(|node| (node.position, node.weight))
                .collect(),
        }
    }

    /// A derivative of the shape number `mode`, from 0, by s.
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

/// Positions in a field's domain with weights.
#[derive(Clone, Debug)]
pub(super) struct PlaceSet {
    /// The field.
    pub field: usize,
    /// The positions x.
    pub positions: Vec<f64>,
    /// The weights: dx of the rule, or 1 at a single position.
    pub weights: Vec<f64>,
    relative: Vec<DoubleDouble>,
    /// For each order of the derivative, once asked for: modes by positions.
    shapes: [Option<DMatrix<f64>>; DERIVATIVES],
}

impl PlaceSet {
    /// The quadrature nodes of a field.
    pub fn quadrature(field: usize, domain: &Domain) -> Self {
        let rule = domain.rule();
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
            relative: rule.iter().map(|(position, _)| *position).collect(),
            shapes: Default::default(),
        }
    }

    /// The single position `x`.
    pub fn single(field: usize, domain: &Domain, x: f64) -> Self {
        Self {
            field,
            positions: vec![x],
            weights: vec![1.0],
            relative: vec![DoubleDouble::new((x - domain.from) / domain.length)],
            shapes: Default::default(),
        }
    }

    /// Makes the shapes' derivatives of one order available.
    pub fn require(&mut self, derivative: u8, domain: &Domain) {
        let scale = domain.length.powi(-i32::from(derivative));
        let relative = &self.relative;
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

    /// The derivatives of one order of all shapes, modes by positions.
    pub fn shapes(&self, derivative: u8) -> Option<&DMatrix<f64>> {
        self.shapes.get(usize::from(derivative))?.as_ref()
    }

    /// The orders of derivative available.
    pub fn derivatives(&self) -> impl Iterator<Item = u8> {
        (0..DERIVATIVES as u8).filter(|derivative| self.shapes(*derivative).is_some())
    }
}
