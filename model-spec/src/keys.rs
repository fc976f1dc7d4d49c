//! Sections of a specification and the keys of their entries, for the reader and for the JSON
//! schema.

use crate::model::{Basis, End};

pub const MODEL: [&str; 3] = ["name", "title", "gravity"];
pub const PARAMETER: [&str; 7] = [
    "value",
    "unit",
    "doc",
    "source",
    "min",
    "max",
    "uncertainty",
];
/// Keys of the `uncertainty` of a parameter; an entry has one of them.
pub const UNCERTAINTY: [&str; 3] = ["relative", "sd", "between"];
pub const COORDINATE: [&str; 5] = ["unit", "doc", "initial", "initial_rate", "range"];
pub const INPUT: [&str; 4] = ["unit", "rates", "doc", "range"];
pub const STATE: [&str; 5] = ["unit", "rate", "initial", "range", "doc"];
pub const FIELD: [&str; 9] = [
    "along",
    "from",
    "to",
    "basis",
    "table",
    "coordinates",
    "order",
    "unit",
    "doc",
];
pub const FRAME: [&str; 4] = ["in", "origin", "rotation", "doc"];
pub const BODY: [&str; 6] = ["frame", "mass", "centre", "inertia", "doc", "source"];
/// Keys of a definition, an energy term or a dissipation term.
pub const TERM: [&str; 3] = ["value", "doc", "source"];
pub const FORCE: [&str; 4] = ["on", "value", "doc", "source"];
pub const CONSTRAINT: [&str; 3] = ["zero", "doc", "source"];
pub const IMPACT: [&str; 6] = ["when", "restitution", "friction", "slip", "doc", "source"];
pub const OBSERVABLE: [&str; 4] = ["value", "unit", "doc", "source"];
pub const COEFFICIENT: [&str; 6] = ["value", "of", "by", "times", "each", "doc"];
pub const SENSOR: [&str; 4] = ["observable", "gain", "bias", "delay"];

pub const DRAWING: [&str; 2] = ["points", "lines"];
pub const POINT: [&str; 2] = ["x", "y"];

/// Sections with the keys of their entries; for `[model]` and `[drawing]`, the keys of the
/// section.
pub const SECTIONS: [(&str, &[&str]); 19] = [
    ("model", &MODEL),
    ("parameters", &PARAMETER),
    ("coordinates", &COORDINATE),
    ("inputs", &INPUT),
    ("states", &STATE),
    ("fields", &FIELD),
    ("definitions", &TERM),
    ("frames", &FRAME),
    ("bodies", &BODY),
    ("kinetic", &TERM),
    ("potential", &TERM),
    ("dissipation", &TERM),
    ("forces", &FORCE),
    ("constraints", &CONSTRAINT),
    ("impacts", &IMPACT),
    ("observables", &OBSERVABLE),
    ("coefficients", &COEFFICIENT),
    ("sensors", &SENSOR),
    ("drawing", &DRAWING),
];

pub fn sections() -> impl Iterator<Item = &'static str> {
    SECTIONS.iter().map(|(name, _)| *name)
}

/// Name of the basis with shapes from a file.
pub const TABLE: &str = "table";

/// All other bases. Rods and strings share the sines and cosines of pinned and guided beams.
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
