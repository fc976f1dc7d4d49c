//! The paper's arm: closed forms, printed equations, mode shapes, studies.

mod arm_references;
mod closed_forms;
mod errata;
mod mode_shapes;
mod reference_equations;
mod solve_arm;
mod studies;
