//! Planetary arm of the paper: its [`parameters`] and [`mode_shapes`], the piecewise laws of a gear
//! [`mesh`], and the equations of motion, corrected.
//!
//! [`equation_10`] and [`equation_12`] apply to the rigid arm, [`equation_22`] to the flexible arm
//! of any truncation order. [`dimensionless_equation_22`] is the latter in the scales of the paper.

pub mod dimensionless_equation_22;
pub mod equation_10;
pub mod equation_12;
pub mod equation_22;
pub mod mesh;
pub mod mode_shapes;
pub mod parameters;
