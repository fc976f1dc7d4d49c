//! The paper's arm integrated by Taylor series, in double and in extended precision: a
//! reference for solvers that shares no code with them, with the derivation or with the
//! specification's reader.
//!
//! Between two switches the arm is a linear system with constant and sinusoidal forcing, so
//! the coefficients of its Taylor series follow from one another ([`expansion`]) and the
//! series is summed until its remainder lies below the rounding. A switch is the first
//! root of a mesh's polynomial at the edge of its play, isolated by the signs of its
//! Bernstein coefficients, which cannot overlook one ([`crossing`]). Everything is generic over
//! the arithmetic ([`scalar`]): the difference between a run in doubles and one in
//! double-doubles ([`double_double`], [`elementary`]) is what rounding does to this motion.
//!
//! Pipeline: [`modes`] and Table I to an [`arm`]; [`expansion`] and [`crossing`] to a
//! [`run`].

pub mod arm;
pub mod crossing;
pub mod double_double;
pub mod elementary;
pub mod expansion;
pub mod modes;
pub mod run;
pub mod scalar;
