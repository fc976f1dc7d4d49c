//! The paper's arm integrated by Taylor series, in double and in extended precision: a reference
//! that shares no code with the solvers, the derivation or the reader of specifications.
//!
//! Between two switches the arm is a linear system with constant and sinusoidal forcing. The
//! coefficients of its Taylor series follow from a recurrence ([`expansion`]), and the series is
//! summed until its remainder is below the rounding. A switch is the first root of a mesh's
//! polynomial at the edge of its backlash, isolated by the signs of its Bernstein coefficients, so
//! that no root is missed ([`crossing`]). All code is generic over the arithmetic ([`scalar`]): the
//! difference between a run in doubles and one in double-doubles ([`double_double`],
//! [`elementary`]) is the effect of rounding on this motion.
//!
//! Data flow: [`modes`] and Table I to an [`arm`]; [`expansion`] and [`crossing`] to a [`run`].

pub mod arm;
pub mod crossing;
pub mod double_double;
pub mod elementary;
pub mod expansion;
pub mod modes;
pub mod run;
pub mod scalar;
