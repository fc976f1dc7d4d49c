//! Names of the bases of a field.

use crate::model::{Basis, End};

/// Name of the basis with shapes from a file.
pub const TABLE: &str = "table";

/// All other bases. Rods and strings have the sines and cosines of pinned and guided beams as shapes.
pub static BASES: [(&str, Basis); 21] = [
    ("clamped_free", beam(End::Clamped, End::Free)),
    ("clamped_free_printed", Basis::ClampedFreePrinted),
    ("clamped_clamped", beam(End::Clamped, End::Clamped)),
    ("clamped_pinned", beam(End::Clamped, End::Pinned)),
    ("clamped_guided", beam(End::Clamped, End::Guided)),
    ("pinned_clamped", beam(End::Pinned, End::Clamped)),
    ("pinned_pinned", beam(End::Pinned, End::Pinned)),
    ("pinned_free", beam(End::Pinned, End::Free)),
    ("pinned_guided", beam(End::Pinned, End::Guided)),
    ("free_clamped", beam(End::Free, End::Clamped)),
    ("free_pinned", beam(End::Free, End::Pinned)),
    ("free_free", beam(End::Free, End::Free)),
    ("free_guided", beam(End::Free, End::Guided)),
    ("guided_clamped", beam(End::Guided, End::Clamped)),
    ("guided_pinned", beam(End::Guided, End::Pinned)),
    ("guided_free", beam(End::Guided, End::Free)),
    ("guided_guided", beam(End::Guided, End::Guided)),
    ("rod_fixed_free", beam(End::Pinned, End::Guided)),
    ("rod_fixed_fixed", beam(End::Pinned, End::Pinned)),
    ("rod_free_free", beam(End::Guided, End::Guided)),
    ("string", beam(End::Pinned, End::Pinned)),
];

const fn beam(from: End, to: End) -> Basis {
    Basis::Beam { from, to }
}
