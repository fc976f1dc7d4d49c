//! The derivation against independent computations: mode tables, random expressions and
//! their derivatives, guards and solved systems, and the emitted source. Specifications
//! that exercise whole features are certified in the workspace's own tests.

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
mod size;
mod solved;
mod support;
mod trees;
mod weights;
