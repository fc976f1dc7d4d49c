//! Hand-written equations: against each other, against closed forms and energies, and as a system
//! for the solvers.

mod arm_references;
mod closed_forms;
mod mode_shapes;
mod reference_equations;
mod solve_arm;
