//! Equations written by hand: the oracle that derived models are compared with.
//!
//! What lives here is assembled from the paper (with its errors corrected) or from
//! textbooks, and shares no code with the derivation. The pipeline of the arm:
//! [`parameters`] and [`mode_shapes`] give the numbers, [`mesh`] the piecewise laws,
//! [`equation_10`], [`equation_12`] and [`equation_22`] the equations, each evaluated
//! with the scale of its rounding ([`evaluation`]); [`errata`] says where the printed
//! equations differ and checks a derived model against both.
//! [`closed_forms`] holds the other machines.

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
