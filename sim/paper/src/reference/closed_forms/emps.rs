//! The electro-mechanical positioning system: one axis with friction.
//!
//! M q'' + F_v q' + F_c sign(q') + offset = force (Janot, Gautier and Brunot, "Data set
//! and reference models of EMPS", 2019, Eq. 1); the dry friction is optional.

use super::balance::Balance;
use super::{Situation, Unfit};
use crate::reference::evaluation::Evaluation;

pub fn accelerations(situation: &Situation<'_>) -> Result<Evaluation, Unfit> {
    let mass = situation.required("M")?;
    let viscous = situation.required("F_v")?;
    let coulomb = situation.optional("F_c");
    let offset = situation.optional("offset");
    let ([_], [rate]) = situation.motion()?;
    let direction = if rate == 0.0 { 0.0 } else { rate.signum() };

    let mut balance = Balance::new(1);
    balance.mass(0, 0, mass);
    balance.force(0, situation.input("force"));
    balance.force(0, -viscous * rate);
    balance.force(0, -coulomb * direction);
    balance.force(0, -offset);
    balance.solve()
}
