//! Simulation, hand-written references and validation of derived models.
//!
//! [`mod@reference`] holds equations written by hand, [`by_hand`] says which belong to which
//! model, by [`same_motion`]; [`validate`] checks a derived model against them and against an oracle of its
//! own, [`certificates`] runs it on a model. [`derived`] lets the solver in [`solve`] and
//! the checks see a derived model, [`exact`] propagates those that are piecewise linear, [`record`] reads the inputs of a measured record,
//! [`analysis`] says what kind of motion a trajectory is, [`sweep`] measures over a grid of
//! parameters, and [`plot`] draws.

pub mod analysis;
pub mod by_hand;
pub mod certificates;
pub mod derived;
pub mod exact;
pub mod plot;
pub mod record;
pub mod reference;
pub mod requested;
pub mod same_motion;
pub mod solve;
pub mod studies;
pub mod sweep;
pub mod validate;
