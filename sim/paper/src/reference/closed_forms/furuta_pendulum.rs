//! The rotary pendulum of Furuta: an arm of inertia J_a and length L turns by phi about
//! the vertical; at its end a pendulum of mass m, its centre l from the hinge and its
//! inertia J about the centre, swings by theta in the plane across the arm, hanging at
//! 0 (Cazzolato and Prime, "On the dynamics of the Furuta pendulum", 2011, with slender
//! links).

use super::balance::Balance;
use super::{Situation, Unfit};
use crate::reference::evaluation::Evaluation;

pub fn accelerations(situation: &Situation<'_>) -> Result<Evaluation, Unfit> {
    let arm = situation.required("J_a")?;
    let arm_length = situation.required("L")?;
    let (m, l) = (situation.required("m")?, situation.required("l")?);
    let g = situation.required("g")?;
    let inertia = situation.optional("J");
    let (c_a, c_p) = (situation.optional("c_a"), situation.optional("c_p"));
    let ([_, theta], [phi_dot, theta_dot]) = situation.motion()?;
    let (sin, cos) = theta.sin_cos();
    let swing = inertia + m * l * l;

    let mut balance = Balance::new(2);
    balance.mass(0, 0, arm + m * arm_length * arm_length);
    balance.mass(0, 0, swing * sin * sin);
    balance.mass(0, 1, m * arm_length * l * cos);
    balance.mass(1, 1, swing);

    balance.force(0, situation.input("u"));
    balance.force(0, m * arm_length * l * sin * theta_dot * theta_dot);
    balance.force(0, -2.0 * swing * sin * cos * phi_dot * theta_dot);
    balance.force(0, -c_a * phi_dot);

    balance.force(1, swing * sin * cos * phi_dot * phi_dot);
    balance.force(1, -m * g * l * sin);
    balance.force(1, -c_p * theta_dot);
    balance.solve()
}
