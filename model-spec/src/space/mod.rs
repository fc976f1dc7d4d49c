//! Bodies in space as a short form: `[frames]`, `[bodies]` and `gravity` become definitions,
//! kinetic and potential energies before any name is looked up, so that all that follows sees
//! scalars. Every part of what is written here bears the place of the text it stands for.
//!
//! Velocities go from frame to frame, each along the frame's own axes, as in the outward
//! recursion of Luh, Walker and Paul (1980): J. Dyn. Sys. Meas. Control 102, 69-76, eqs. (6)
//! to (10). The text they make grows with the number of frames and not with its square.
//!
//! `scalar` and `vector` write sums and products, `rotation` reads rotations, `moving` says what
//! has a rate, `frames` and `bodies` do what they are called; `inertia` asks whether a body can
//! be.

mod bodies;
mod frames;
mod inertia;
mod moving;
mod rotation;
mod scalar;
mod vector;

use crate::ast::Syntax;
use crate::diagnostic::Diagnostics;
use crate::dimension::Dimension;
use crate::raw::Document;
use crate::source::Source;
use crate::span::Span;
use crate::table::{Name, Quantity};

pub use inertia::check as check_inertias;

/// What the short forms ask of the quantities in them.
#[derive(Default)]
pub struct Demands {
    /// Quantities with the unit they must have.
    pub units: Vec<UnitDemand>,
    /// Masses and inertias of bodies.
    pub inertias: Vec<Inertia<Quantity>>,
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

/// Replaces frames, bodies and gravity by definitions and energies.
///
/// # Errors
/// Frames in a circle, unknown frames, rotations that are none, bodies that change.
pub fn expand(document: &mut Document, source: &Source) -> Result<Demands, Diagnostics> {
    let mut found = Diagnostics::new(source.clone());
    let mut demands = Demands::default();
    let moving = moving::Moving::of(document);
    let frames = frames::expand(document, &moving, &mut demands, &mut found);
    if found.is_empty() {
        bodies::expand(document, &frames, &moving, &mut demands, &mut found);
    }
    if found.is_empty() {
        Ok(demands)
    } else {
        Err(found)
    }
}

fn expansion(syntax: Syntax) -> Quantity {
    Quantity::Expansion(Box::new(syntax))
}
