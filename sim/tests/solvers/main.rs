//! Solvers of ordinary differential equations: order, tolerances, events, sensitivities.

mod grazes;
mod sensitivities;
mod solve;
mod solve_adams;
mod solve_radau;
mod sticking;
mod systems;
