//! From a checked model to equations of motion, and from these to programs and source.
//!
//! Four stages, one folder each; a stage reads those above it and no other:
//!
//! 1. [`symbolic`]: expressions as nodes of one hash-consed graph, their simplification,
//!    derivatives and formulas;
//! 2. [`mechanics`]: from a model to its equations of motion, [`mechanics::equations::derive`];
//! 3. [`program`]: from equations to a list of values in static single assignment,
//!    [`program::lowering::lower`], and its evaluation;
//! 4. [`rust`] (the emitted source) and [`report`] (equations for people).
//!
//! [`variant`] goes from a model to its program in one call.

pub mod mechanics;
pub mod program;
pub mod report;
pub mod rust;
pub mod symbolic;
pub mod variant;
