//! How fast neighbouring motions part, for any model: the variational equation along a motion of
//! the general solver.
//!
//! The pipeline: a [`Beside`] is a [`System`](crate::ode::System) with one tangent vector beside
//! its state, v' = J v, which the `saltation` matrix takes over a located switch; [`growths`]
//! follows it from stretch to stretch and measures how its length grows (Benettin, Galgani, Giorgilli
//! and Strelcyn, Meccanica 15 (1980) 9-30). What is linear between its switches has the same exactly in
//! [`piecewise_linear`](crate::piecewise_linear).

mod beside;
mod growth;
mod saltation;

pub use beside::Beside;
pub use growth::{GrowthError, Growths, Stretches, growths};
