//! What short forms ask of the quantities in them, checked where units and values are known.

use crate::ast::Syntax;
use crate::dimension::Dimension;
use crate::rigid_tree::RigidTree;
use crate::span::Span;
use crate::table::{Name, Quantity};

/// What the short forms ask of the quantities in them.
#[derive(Default)]
pub struct Demands {
    /// Quantities with the unit they must have.
    pub units: Vec<UnitDemand>,
    /// Components of vectors, which must have one unit.
    pub alike: Vec<Vec<Quantity>>,
    /// Masses and inertias of bodies.
    pub inertias: Vec<Inertia<Quantity>>,
    /// Vectors that nothing refers to.
    pub unused: Vec<Name>,
    /// The frames and the bodies, if there are bodies.
    pub rigid_tree: Option<RigidTree<Syntax>>,
}

/// A quantity that must have a unit.
pub struct UnitDemand {
    /// The quantity.
    pub value: Quantity,
    /// Its unit.
    pub dimension: Dimension,
    /// What it is, for a message.
    pub subject: String,
}

/// The mass and the inertia of a body.
pub struct Inertia<T> {
    /// The body.
    pub body: Name,
    /// The mass in kg, if it has one.
    pub mass: Option<T>,
    /// None, three or all of I_xx, I_yy, I_zz, I_xy, I_yz, I_xz, in kg m^2.
    pub elements: Vec<T>,
    /// Where they stand.
    pub span: Span,
}
