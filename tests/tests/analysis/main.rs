//! Tests of equilibria, linearisation, natural modes and sweeps.

mod operating_points;
mod sweep;
