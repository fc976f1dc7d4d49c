//! The double pendulum: two point masses on massless rods, both angles from the
//! vertical, hanging at 0 (Landau and Lifshitz, "Mechanics", section 5, problem 1).

use super::balance::Balance;
use super::{Situation, Unfit};
use crate::reference::evaluation::Evaluation;

pub fn accelerations(situation: &Situation<'_>) -> Result<Evaluation, Unfit> {
    let (m_1, m_2) = (situation.required("m_1")?, situation.required("m_2")?);
    let (l_1, l_2) = (situation.required("l_1")?, situation.required("l_2")?);
    let g = situation.required("g")?;
    let (c_1, c_2) = (situation.optional("c_1"), situation.optional("c_2"));
    let ([theta_1, theta_2], [theta_1_dot, theta_2_dot]) = situation.motion()?;
    let coupling = m_2 * l_1 * l_2;
    let (sin, cos) = (theta_1 - theta_2).sin_cos();
    let elbow = c_2 * (theta_2_dot - theta_1_dot);

    let mut balance = Balance::new(2);
    balance.mass(0, 0, (m_1 + m_2) * l_1 * l_1);
    balance.mass(0, 1, coupling * cos);
    balance.mass(1, 1, m_2 * l_2 * l_2);

    balance.force(0, -coupling * sin * theta_2_dot * theta_2_dot);
    balance.force(0, -(m_1 + m_2) * g * l_1 * theta_1.sin());
    balance.force(0, -c_1 * theta_1_dot);
    balance.force(0, elbow);

    balance.force(1, coupling * sin * theta_1_dot * theta_1_dot);
    balance.force(1, -m_2 * g * l_2 * theta_2.sin());
    balance.force(1, -elbow);
    balance.solve()
}
