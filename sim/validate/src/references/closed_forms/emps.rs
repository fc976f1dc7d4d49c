//! Electro-mechanical positioning system: one axis with friction.
//!
//! M q'' + F_v q' + F_c sign(q') + offset = force (Janot, Gautier and Brunot, "Data set and
//! reference models of EMPS", 2019, Eq. 1). The dry friction is optional.

use super::linear_system::LinearSystem;
use super::{NotApplicable, StateAndParameters};
use crate::references::evaluation::Evaluation;

pub fn accelerations(at: &StateAndParameters<'_>) -> Result<Evaluation, NotApplicable> {
    let mass = at.required("M")?;
    let viscous = at.required("F_v")?;
    let coulomb = at.optional("F_c");
    let offset = at.optional("offset");
    let ([_], [rate]) = at.motion()?;
    let direction = if rate == 0.0 { 0.0 } else { rate.signum() };

    let mut system = LinearSystem::new(1);
    system.mass(0, 0, mass);
    system.force(0, at.input("force"));
    system.force(0, -viscous * rate);
    system.force(0, -coulomb * direction);
    system.force(0, -offset);
    system.solve()
}
