//! What the whole-path tests share: the shipped specifications with their derived
//! variants ([`models`]), models made on the spot and their motions ([`motions`]) or their
//! certificates ([`certified`]), right ones at random ([`smooth_models`]), the built
//! program ([`program`]), what the pages print ([`pages`]), records as if measured ([`measured`], with [`logistic_noise`]) and the arm integrated in extended precision ([`taylor`]). The tests themselves are in `tests/`, one subject per file.

pub mod certified;
pub mod logistic_noise;
pub mod measured;
pub mod models;
pub mod motions;
pub mod pages;
pub mod piecewise;
pub mod program;
pub mod smooth_models;
pub mod taylor;
