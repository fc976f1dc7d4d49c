//! Expands vectors, `[frames]`, `[bodies]` and `gravity` to definitions, energies, forces,
//! constraints and observables of scalars, before names are resolved. Later steps see only
//! scalars. Every generated expression has the position of the text that it replaces.
//!
//! Velocities are computed from frame to frame, along each frame's own axes, as in the outward
//! recursion of Luh, Walker and Paul (1980), J. Dyn. Sys. Meas. Control 102, 69-76, Eq. (6) to
//! (10). The size of the generated text is linear in the number of frames, not quadratic.
//!
//! Modules: `scalar` and `vector` (sums and products), `rotation`, `moving` (names with a
//! rate), `definitions` (generated definitions), `frames` (motion of frames), `placement`
//! (positions of frames), `expression`, `operations` and `functions` (evaluation to the kinds
//! in `value`), `references` (order of evaluation), `sections` and `terms` (expansion entry by
//! entry), `bodies` (energies), `tree` (declared bodies), `known` (state of the expansion),
//! `requirements` (checks for later steps), `inertia` (admissible masses and inertias).

mod bodies;
mod definitions;
mod expression;
mod frames;
mod functions;
mod inertia;
mod moving_names;
mod operations;
mod placement;
mod references;
mod requirements;
mod rotation;
mod scalar;
mod sections;
mod state;
mod terms;
mod tree;
mod value;
mod vector;

use crate::diagnostic::Diagnostics;
use crate::raw::Document;
use crate::source::Source;

pub use inertia::check as check_inertias;
pub use requirements::{Inertia, Requirements};

/// Replaces vectors, frames, bodies and gravity by scalars.
///
/// # Errors
/// Frames are cyclic or unknown, a rotation is invalid, the mass or inertia of a body is not constant, or a scalar is
/// given instead of a vector or a vector instead of a scalar.
pub fn expand(document: &mut Document, source: &Source) -> Result<Requirements, Diagnostics> {
    if !sections::has_vectors(document) {
        return Ok(Requirements::default());
    }
    let mut found = Diagnostics::new(source.clone());
    let requirements = sections::expand(document, &mut found);
    match requirements {
        Some(requirements) if found.is_empty() => Ok(requirements),
        _ => Err(found),
    }
}
