//! Comparison of the derivation with independent computations: mode tables, random expressions and their
//! derivatives, guards, solved systems, and the emitted source. The workspace's tests certify specifications
//! of whole features.

mod arrays;
mod definiteness;
mod documented_limits;
mod emission;
mod examination;
mod expressions;
mod flat_sides;
mod gradients;
mod guards;
mod independence;
mod inertia;
mod limits;
mod misplaced;
mod modes;
mod names;
mod oldest_compiler;
mod operations;
mod outputs;
mod reports;
mod resolution;
mod size;
mod solved;
mod support;
mod trace;
mod trees;
mod weights;
