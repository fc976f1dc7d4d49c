//! Furuta's rotary pendulum (Cazzolato and Prime, "On the dynamics of the Furuta pendulum", 2011,
//! with slender links).
//!
//! An arm of inertia J_a and length L turns by phi about the vertical. At its end, a pendulum of mass m, with its
//! centre l from the hinge and inertia J about the centre, swings by theta in the plane perpendicular to the arm. It
//! hangs down at theta = 0.

use super::linear_system::LinearSystem;
use super::{NotApplicable, StateAndParameters};
use crate::references::evaluation::Evaluation;

pub fn accelerations(at: &StateAndParameters<'_>) -> Result<Evaluation, NotApplicable> {
    let arm = at.required("J_a")?;
    let arm_length = at.required("L")?;
    let (m, l) = (at.required("m")?, at.required("l")?);
    let g = at.required("g")?;
    let inertia = at.optional("J");
    let (c_a, c_p) = (at.optional("c_a"), at.optional("c_p"));
    let ([_, theta], [phi_dot, theta_dot]) = at.motion()?;
    let (sin, cos) = theta.sin_cos();
    let swing = inertia + m * l * l;

    let mut system = LinearSystem::new(2);
    system.mass(0, 0, arm + m * arm_length * arm_length);
    system.mass(0, 0, swing * sin * sin);
    system.mass(0, 1, m * arm_length * l * cos);
    system.mass(1, 1, swing);

    system.force(0, at.input("u"));
    system.force(0, m * arm_length * l * sin * theta_dot * theta_dot);
    system.force(0, -2.0 * swing * sin * cos * phi_dot * theta_dot);
    system.force(0, -c_a * phi_dot);

    system.force(1, swing * sin * cos * phi_dot * phi_dot);
    system.force(1, -m * g * l * sin);
    system.force(1, -c_p * theta_dot);
    system.solve()
}
