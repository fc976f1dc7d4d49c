//! A cart of mass M on a straight track with two arms hinged to it side by side: point
//! masses on massless rods, both angles from the vertical, hanging at 0.

use super::balance::Balance;
use super::{Situation, Unfit};
use crate::reference::evaluation::Evaluation;

pub fn accelerations(situation: &Situation<'_>) -> Result<Evaluation, Unfit> {
    let cart = situation.required("M")?;
    let masses = [situation.required("m_1")?, situation.required("m_2")?];
    let lengths = [situation.required("l_1")?, situation.required("l_2")?];
    let hinges = [situation.optional("c_1"), situation.optional("c_2")];
    let g = situation.required("g")?;
    let ([_, theta_1, theta_2], [x_dot, theta_1_dot, theta_2_dot]) = situation.motion()?;
    let arms = [(theta_1, theta_1_dot), (theta_2, theta_2_dot)];

    let mut balance = Balance::new(3);
    balance.mass(0, 0, cart);
    balance.force(0, situation.input("u"));
    balance.force(0, -situation.optional("c") * x_dot);
    for (arm, (theta, theta_dot)) in arms.into_iter().enumerate() {
        let (m, l, row) = (masses[arm], lengths[arm], arm + 1);
        let (sin, cos) = theta.sin_cos();
        balance.mass(0, 0, m);
        balance.mass(0, row, m * l * cos);
        balance.mass(row, row, m * l * l);
        balance.force(0, m * l * sin * theta_dot * theta_dot);
        balance.force(row, -m * g * l * sin);
        balance.force(row, -hinges[arm] * theta_dot);
    }
    balance.solve()
}
