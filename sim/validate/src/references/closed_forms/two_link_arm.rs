//! Planar arm of two rigid links with a mass at its end. The first angle is from the horizontal, the second from the
//! first link (Spong, Hutchinson and Vidyasagar, "Robot Modeling and Control", section 6.4, with the rotor of the elbow
//! on the second link). Flexible links have no closed form here.

use super::linear_system::LinearSystem;
use super::{NotApplicable, StateAndParameters};
use crate::references::evaluation::Evaluation;

pub fn accelerations(at: &StateAndParameters<'_>) -> Result<Evaluation, NotApplicable> {
    let required = |name| at.required(name);
    let (l_1, l_2, g) = (required("l_1")?, required("l_2")?, required("g")?);
    let (link_1, link_2) = (required("mu_1")? * l_1, required("mu_2")? * l_2);
    let (elbow, tip) = (required("M_e")?, required("M_t")?);
    let (rotor_1, stator, rotor_2) = (required("J_1")?, required("J_e")?, required("J_2")?);
    let (c_1, c_2) = (at.optional("c_1"), at.optional("c_2"));
    let ([theta_1, theta_2], [rate_1, rate_2]) = at.motion()?;

    // Mass outward of the elbow, and its first and second moments about the elbow.
    let carried = link_2 + tip;
    let moment = link_2 * l_2 / 2.0 + tip * l_2;
    let inertia = rotor_2 + link_2 * l_2 * l_2 / 3.0 + tip * l_2 * l_2;
    let bent = l_1 * moment * theta_2.cos();
    let swept = l_1 * moment * theta_2.sin();

    let mut system = LinearSystem::new(2);
    system.mass(0, 0, rotor_1 + stator + link_1 * l_1 * l_1 / 3.0);
    system.mass(0, 0, (elbow + carried) * l_1 * l_1);
    system.mass(0, 0, inertia + 2.0 * bent);
    system.mass(0, 1, inertia + bent);
    system.mass(1, 1, inertia);

    let outer_weight = g * moment * (theta_1 + theta_2).cos();
    system.force(0, at.input("u_1") - c_1 * rate_1);
    system.force(0, swept * (2.0 * rate_1 + rate_2) * rate_2);
    system.force(
        0,
        -g * (link_1 / 2.0 + elbow + carried) * l_1 * theta_1.cos(),
    );
    system.force(0, -outer_weight);

    system.force(1, at.input("u_2") - c_2 * rate_2);
    system.force(1, -swept * rate_1 * rate_1);
    system.force(1, -outer_weight);
    system.solve()
}
