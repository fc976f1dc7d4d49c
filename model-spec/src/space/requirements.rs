//! Requirements of shorthands on their quantities. They are checked after units and values are known.

use crate::ast::Syntax;
use crate::dimension::Dimension;
use crate::quantity::{Name, Quantity};
use crate::rigid_tree::RigidTree;
use crate::span::Span;

#[derive(Default)]
pub struct Requirements {
    pub units: Vec<UnitRequirement>,
    /// Components of vectors; the components of one vector must have equal units.
    pub same_unit_vectors: Vec<Vec<Quantity>>,
    pub inertias: Vec<Inertia<Quantity>>,
    /// Unused vectors.
    pub unused: Vec<Name>,
    pub rigid_tree: Option<RigidTree<Syntax>>,
}

pub struct UnitRequirement {
    pub value: Quantity,
    pub dimension: Dimension,
    /// Name of the quantity in messages.
    pub subject: String,
}

pub struct Inertia<T> {
    pub body: Name,
    pub mass: Option<T>,
    /// Elements of the inertia matrix in kg m^2: none, the first three, or all of I_xx, I_yy, I_zz, I_xy, I_yz, I_xz.
    pub elements: Vec<T>,
    pub span: Span,
}
