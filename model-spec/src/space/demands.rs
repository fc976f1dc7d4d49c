//! Requirements of short forms on their quantities, checked after units and values are known.

use crate::ast::Syntax;
use crate::dimension::Dimension;
use crate::rigid_tree::RigidTree;
use crate::span::Span;
use crate::table::{Name, Quantity};

/// Requirements of short forms on their quantities.
#[derive(Default)]
pub struct Demands {
    /// Quantities with a required unit.
    pub units: Vec<UnitDemand>,
    /// Components of vectors, which need one unit.
    pub alike: Vec<Vec<Quantity>>,
    /// Masses and inertias of bodies.
    pub inertias: Vec<Inertia<Quantity>>,
    /// Vectors that nothing refers to.
    pub unused: Vec<Name>,
    /// Frames and bodies, if there are bodies.
    pub rigid_tree: Option<RigidTree<Syntax>>,
}

/// Quantity with a required unit.
pub struct UnitDemand {
    pub value: Quantity,
    /// Required unit.
    pub dimension: Dimension,
    /// Name of the quantity in messages.
    pub subject: String,
}

/// Mass and inertia of a body.
pub struct Inertia<T> {
    pub body: Name,
    /// Mass in kg, if given.
    pub mass: Option<T>,
    /// None, three or all of I_xx, I_yy, I_zz, I_xy, I_yz, I_xz, in kg m^2.
    pub elements: Vec<T>,
    /// Position of the elements.
    pub span: Span,
}
