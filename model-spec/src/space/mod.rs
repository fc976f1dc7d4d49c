//! Bodies in space as a short form: vectors, `[frames]`, `[bodies]` and `gravity` become definitions,
//! energies, forces, constraints and observables of scalars before any name is looked up, so that all that follows sees
//! scalars. Every part of what is written here bears the place of the text it stands for.
//!
//! Velocities go from frame to frame, each along the frame's own axes, as in the outward
//! recursion of Luh, Walker and Paul (1980): J. Dyn. Sys. Meas. Control 102, 69-76, eqs. (6)
//! to (10). The text they make grows with the number of frames and not with its square.
//!
//! `scalar` and `vector` write sums and products, `rotation` reads rotations, `moving` says what
//! has a rate, `definitions` gives names; `frames` says how frames move and `placement` where they
//! are; `expression`, with `operations` and `functions`, works out what is written, of a kind that
//! `value` lists. `references` says in which order, `sections` does so entry by entry, and `bodies`
//! writes energies, beside which `tree` keeps what they are of; `known` has what is known on the way, `demands` what is checked later, and
//! `inertia` asks whether a body can be.

mod bodies;
mod definitions;
mod demands;
mod expression;
mod frames;
mod functions;
mod inertia;
mod known;
mod moving;
mod operations;
mod placement;
mod references;
mod rotation;
mod scalar;
mod sections;
mod terms;
mod tree;
mod value;
mod vector;

use crate::diagnostic::Diagnostics;
use crate::raw::Document;
use crate::source::Source;

pub use demands::{Demands, Inertia};
pub use inertia::check as check_inertias;

/// Replaces vectors, frames, bodies and gravity by scalars.
///
/// # Errors
/// Frames in a circle, unknown frames, rotations that are none, bodies that change, scalars where
/// vectors have to be and the other way round.
pub fn expand(document: &mut Document, source: &Source) -> Result<Demands, Diagnostics> {
    if !sections::are_spatial(document) {
        return Ok(Demands::default());
    }
    let mut found = Diagnostics::new(source.clone());
    let demands = sections::expand(document, &mut found);
    match demands {
        Some(demands) if found.is_empty() => Ok(demands),
        _ => Err(found),
    }
}
