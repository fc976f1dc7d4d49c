//! Requirements of shorthands on their quantities, checked after units and values are known.

use crate::ast::Syntax;
use crate::dimension::Dimension;
use crate::quantity::{Name, Quantity};
use crate::rigid_tree::RigidTree;
use crate::span::Span;

#[derive(Default)]
pub struct Demands {
    pub units: Vec<UnitDemand>,
    /// Components of vectors, which need one unit.
    pub same_unit_vectors: Vec<Vec<Quantity>>,
    pub inertias: Vec<Inertia<Quantity>>,
    /// Vectors that nothing refers to.
    pub unused: Vec<Name>,
    pub rigid_tree: Option<RigidTree<Syntax>>,
}

pub struct UnitDemand {
    pub value: Quantity,
    pub dimension: Dimension,
    /// Name of the quantity in messages.
    pub subject: String,
}

pub struct Inertia<T> {
    pub body: Name,
    pub mass: Option<T>,
    /// None, three or all of I_xx, I_yy, I_zz, I_xy, I_yz, I_xz, in kg m^2.
    pub elements: Vec<T>,
    pub span: Span,
}
