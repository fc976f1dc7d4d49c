//! A pendulum: a point mass on a rod, theta from the vertical, hanging at 0.
//!
//! m l^2 theta'' + c theta' + m g l sin theta = 0 (any textbook).

use super::balance::Balance;
use super::{Situation, Unfit};
use crate::reference::evaluation::Evaluation;

pub fn accelerations(situation: &Situation<'_>) -> Result<Evaluation, Unfit> {
    let (m, l, g) = (
        situation.required("m")?,
        situation.required("l")?,
        situation.required("g")?,
    );
    let c = situation.optional("c");
    let ([theta], [theta_dot]) = situation.motion()?;

    let mut balance = Balance::new(1);
    balance.mass(0, 0, m * l * l);
    balance.force(0, -c * theta_dot);
    balance.force(0, -m * g * l * theta.sin());
    balance.solve()
}
