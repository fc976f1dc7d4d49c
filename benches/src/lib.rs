//! Criterion benches of the generated equations against hand-written ones; they are in
//! `benches/`, this library is empty.
