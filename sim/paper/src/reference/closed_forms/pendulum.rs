//! A physical pendulum, theta from upright: hanging at pi.
//!
//! (m a^2 + I) theta'' = m g a sin theta - k theta' (any textbook).

use super::balance::Balance;
use super::{Situation, Unfit};
use crate::reference::evaluation::Evaluation;

pub fn accelerations(situation: &Situation<'_>) -> Result<Evaluation, Unfit> {
    let (m, a, g) = (
        situation.required("m")?,
        situation.required("a")?,
        situation.required("g")?,
    );
    let (about_centre, k) = (situation.optional("I"), situation.optional("k"));
    let ([theta], [theta_dot]) = situation.motion()?;

    let mut balance = Balance::new(1);
    balance.mass(0, 0, m * a * a);
    balance.mass(0, 0, about_centre);
    balance.force(0, -k * theta_dot);
    balance.force(0, m * g * a * theta.sin());
    balance.solve()
}
