//! Double pendulum: two point masses on massless rods; both angles are from the downward vertical (Landau and Lifshitz,
//! "Mechanics", section 5, problem 1).

use super::linear_system::LinearSystem;
use super::{NotApplicable, StateAndParameters};
use crate::references::evaluation::Evaluation;

pub fn accelerations(at: &StateAndParameters<'_>) -> Result<Evaluation, NotApplicable> {
    let (m_1, m_2) = (at.required("m_1")?, at.required("m_2")?);
    let (l_1, l_2) = (at.required("l_1")?, at.required("l_2")?);
    let g = at.required("g")?;
    let (c_1, c_2) = (at.optional("c_1"), at.optional("c_2"));
    let ([theta_1, theta_2], [theta_1_dot, theta_2_dot]) = at.motion()?;
    let coupling = m_2 * l_1 * l_2;
    let (sin, cos) = (theta_1 - theta_2).sin_cos();
    let elbow = c_2 * (theta_2_dot - theta_1_dot);

    let mut system = LinearSystem::new(2);
    system.mass(0, 0, (m_1 + m_2) * l_1 * l_1);
    system.mass(0, 1, coupling * cos);
    system.mass(1, 1, m_2 * l_2 * l_2);

    system.force(0, -coupling * sin * theta_2_dot * theta_2_dot);
    system.force(0, -(m_1 + m_2) * g * l_1 * theta_1.sin());
    system.force(0, -c_1 * theta_1_dot);
    system.force(0, elbow);

    system.force(1, coupling * sin * theta_1_dot * theta_1_dot);
    system.force(1, -m_2 * g * l_2 * theta_2.sin());
    system.force(1, -elbow);
    system.solve()
}
