//! What all expressions of one variant share: the layout of the state, the fields with
//! their places, the definitions. Built by `lower`, read by `scene` and `evaluate`.

use super::places::{Domain, PlaceSet};
use super::tree::{Dependence, Leaf, Tree};

/// The shared part of a variant.
#[derive(Clone, Debug, Default)]
pub(super) struct System {
    /// Number of generalised coordinates, modes included.
    pub size: usize,
    /// Fields in the order of the model.
    pub domains: Vec<Domain>,
    /// Place sets, referred to by the trees.
    pub places: Vec<PlaceSet>,
    /// Definitions in the order of the model.
    pub definitions: Vec<Tree>,
    /// Rates of states of first order in the order of the model, each addend by itself.
    pub state_rates: Vec<Vec<Tree>>,
    /// What the expressions of constraints are, in the order of the model.
    pub residuals: Vec<Tree>,
    /// What each definition depends on.
    pub dependences: Vec<Dependence>,
    /// The integrals whose derivatives are worth keeping for one state.
    pub integrals: Vec<Integral>,
}

/// An integral over a field's domain whose integrand holds no further sum.
#[derive(Clone, Debug)]
pub(super) struct Integral {
    /// The place set.
    pub set: usize,
    /// The integrand.
    pub body: Tree,
    /// Coordinates the integrand depends on.
    pub coordinates: Vec<usize>,
    /// Field values the integrand depends on.
    pub leaves: Vec<Leaf>,
}

impl System {
    /// The range of the state that holds a field's modes.
    pub fn modes(&self, field: usize) -> std::ops::Range<usize> {
        self.domains
            .get(field)
            .map_or(0..0, |domain| domain.offset..domain.offset + domain.order)
    }

    /// What `tree` depends on.
    pub fn dependence(&self, tree: &Tree) -> Dependence {
        tree.dependence(&self.dependences)
    }

    /// Whether something with this dependence can change with generalised coordinate
    /// `row` or its rate.
    pub fn concerns(&self, dependence: &Dependence, row: usize) -> bool {
        dependence.coordinates.contains(&row)
            || dependence
                .fields
                .iter()
                .any(|field| self.modes(*field).contains(&row))
    }
}
