//! Integration of the paper's arm by Taylor series in double and in extended precision. This reference shares no code
//! with the solvers, the derivation or the parser of specifications.
//!
//! Between two switches the arm is a linear system with constant and sinusoidal forcing. The coefficients of its Taylor
//! series are computed by a recurrence ([`expansion`]), up to an order at which the remainder is below the rounding
//! error. A switch is the first root of the distance between a mesh deflection and the edge of the backlash. The root
//! is isolated by the signs of Bernstein coefficients, so that no root is missed ([`crossing`]). All code is generic
//! over the arithmetic ([`scalar`]). The difference between a run with doubles and a run with double-doubles
//! ([`double_double`], [`elementary`]) is the effect of rounding errors.
//!
//! Data flow: [`modes`] and Table I give the constants of the [`arm`]; a [`run`] uses [`expansion`] and [`crossing`].

pub mod arm;
pub mod crossing;
pub mod double_double;
pub mod elementary;
pub mod expansion;
pub mod modes;
pub mod run;
pub mod scalar;
