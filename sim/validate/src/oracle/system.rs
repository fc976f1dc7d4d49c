//! Data that all expressions of one variant share: layout of the state, fields with their positions, definitions.
//! `lower` creates it; `scene` and `evaluate` read it.

use super::places::{FieldDomain, PlaceSet};
use super::tree::{Dependence, Leaf, Tree};

#[derive(Clone, Debug, Default)]
pub(super) struct System {
    /// Number of generalised coordinates, with modes.
    pub size: usize,
    pub domains: Vec<FieldDomain>,
    pub places: Vec<PlaceSet>,
    pub definitions: Vec<Tree>,
    /// Addends of first-order states' rates, in the order of the model.
    pub state_rates: Vec<Vec<Tree>>,
    pub residuals: Vec<Tree>,
    pub dependences: Vec<Dependence>,
    pub integrals: Vec<Integral>,
}

/// Integral over a field's domain. The integrand contains no further sum.
#[derive(Clone, Debug)]
pub(super) struct Integral {
    pub set: usize,
    pub body: Tree,
    pub coordinates: Vec<usize>,
    pub leaves: Vec<Leaf>,
}

impl System {
    pub fn modes(&self, field: usize) -> std::ops::Range<usize> {
        self.domains
            .get(field)
            .map_or(0..0, |domain| domain.offset..domain.offset + domain.order)
    }

    pub fn dependence(&self, tree: &Tree) -> Dependence {
        tree.dependence(&self.dependences)
    }

    /// Returns true if an expression with this dependence can depend on generalised coordinate `row` or its rate.
    pub fn depends_on_row(&self, dependence: &Dependence, row: usize) -> bool {
        dependence.coordinates.contains(&row)
            || dependence
                .fields
                .iter()
                .any(|field| self.modes(*field).contains(&row))
    }
}
