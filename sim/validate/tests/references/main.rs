//! Tests of the hand-written equations: comparison with each other, with closed forms and energies, and simulation.

mod arm_references;
mod closed_forms;
mod mode_shapes;
mod reference_equations;
mod solve_arm;
