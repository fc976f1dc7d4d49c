//! The sections of a specification and the keys of their entries: what the reader takes, and
//! what the schema has to list.

use crate::model::Basis;

/// Keys of `[model]`.
pub const MODEL: [&str; 2] = ["name", "title"];
/// Keys of an entry of `[parameters]`.
pub const PARAMETER: [&str; 6] = ["value", "unit", "doc", "source", "min", "max"];
/// Keys of an entry of `[coordinates]`.
pub const COORDINATE: [&str; 5] = ["unit", "doc", "initial", "initial_rate", "range"];
/// Keys of an entry of `[inputs]`.
pub const INPUT: [&str; 3] = ["unit", "doc", "range"];
/// Keys of an entry of `[states]`.
pub const STATE: [&str; 4] = ["unit", "rate", "initial", "doc"];
/// Keys of a `[fields.NAME]`.
pub const FIELD: [&str; 8] = [
    "along",
    "from",
    "to",
    "basis",
    "coordinates",
    "order",
    "unit",
    "doc",
];
/// Keys of a definition, of a term of an energy or of the dissipation.
pub const TERM: [&str; 3] = ["value", "doc", "source"];
/// Keys of an entry of `[forces]`.
pub const FORCE: [&str; 4] = ["on", "value", "doc", "source"];
/// Keys of an entry of `[observables]`.
pub const OBSERVABLE: [&str; 4] = ["value", "unit", "doc", "source"];
/// Keys of an entry of `[coefficients]`.
pub const COEFFICIENT: [&str; 6] = ["value", "of", "by", "times", "each", "doc"];
/// Keys of a `[sensors.CHANNEL]`.
pub const SENSOR: [&str; 3] = ["gain", "bias", "delay"];

/// Keys of `[drawing]`.
pub const DRAWING: [&str; 2] = ["points", "lines"];
/// Keys of an entry of `[drawing.points]`.
pub const POINT: [&str; 2] = ["x", "y"];

/// The sections, each with the keys of its entries; of `[model]` and `[drawing]` their own.
pub const SECTIONS: [(&str, &[&str]); 15] = [
    ("model", &MODEL),
    ("parameters", &PARAMETER),
    ("coordinates", &COORDINATE),
    ("inputs", &INPUT),
    ("states", &STATE),
    ("fields", &FIELD),
    ("definitions", &TERM),
    ("kinetic", &TERM),
    ("potential", &TERM),
    ("dissipation", &TERM),
    ("forces", &FORCE),
    ("observables", &OBSERVABLE),
    ("coefficients", &COEFFICIENT),
    ("sensors", &SENSOR),
    ("drawing", &DRAWING),
];

/// The names of the sections.
pub fn sections() -> impl Iterator<Item = &'static str> {
    SECTIONS.iter().map(|(name, _)| *name)
}

/// The bases of a field.
pub const BASES: [(&str, Basis); 2] = [
    ("clamped_free", Basis::ClampedFree),
    ("clamped_free_printed", Basis::ClampedFreePrinted),
];
