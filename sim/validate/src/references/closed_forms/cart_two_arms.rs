//! Cart of mass M on a straight track with two arms hinged to it next to each other: point masses on massless rods,
//! both angles are from the downward vertical.

use super::linear_system::LinearSystem;
use super::{NotApplicable, StateAndParameters};
use crate::references::evaluation::Evaluation;

pub fn accelerations(at: &StateAndParameters<'_>) -> Result<Evaluation, NotApplicable> {
    let cart = at.required("M")?;
    let masses = [at.required("m_1")?, at.required("m_2")?];
    let lengths = [at.required("l_1")?, at.required("l_2")?];
    let hinges = [at.optional("c_1"), at.optional("c_2")];
    let g = at.required("g")?;
    let ([_, theta_1, theta_2], [x_dot, theta_1_dot, theta_2_dot]) = at.motion()?;
    let arms = [(theta_1, theta_1_dot), (theta_2, theta_2_dot)];

    let mut system = LinearSystem::new(3);
    system.mass(0, 0, cart);
    system.force(0, at.input("u"));
    system.force(0, -at.optional("c") * x_dot);
    for (arm, (theta, theta_dot)) in arms.into_iter().enumerate() {
        let (m, l, row) = (masses[arm], lengths[arm], arm + 1);
        let (sin, cos) = theta.sin_cos();
        system.mass(0, 0, m);
        system.mass(0, row, m * l * cos);
        system.mass(row, row, m * l * l);
        system.force(0, m * l * sin * theta_dot * theta_dot);
        system.force(row, -m * g * l * sin);
        system.force(row, -hinges[arm] * theta_dot);
    }
    system.solve()
}
