//! Equilibria, linearisation, natural modes and sweeps.

mod operating_points;
mod sweep;
