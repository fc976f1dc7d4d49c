//! Hand-written equations for comparison with derived models.
//!
//! They come from the paper (with its errors corrected) or from textbooks, and share no code with
//! the derivation. For the arm, [`parameters`] and [`mode_shapes`] give the numbers, [`mesh`] the
//! piecewise laws, and [`equation_10`], [`equation_12`] and [`equation_22`] the equations, each
//! with the scale of its rounding ([`evaluation`]). [`errata`] compares the printed equations and a
//! derived model. [`closed_forms`] has the other machines.

pub mod closed_forms;
pub mod equation_10;
pub mod equation_12;
pub mod equation_22;
pub mod errata;
pub mod evaluation;
pub mod mesh;
pub mod mode_shapes;
pub mod parameters;

pub use evaluation::Evaluation;
pub use parameters::PlanetaryArmParameters;
