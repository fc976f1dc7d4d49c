//! Disc of inertia J_d at the end of a uniform circular shaft, turned by a rotor of inertia J_m. The modes sin((r -
//! 1/2) pi x/l) are those of a shaft clamped at the rotor.
//!
//! The section at x turns by theta + w(x, t) and the disc by theta + w(l, t), where w(l, t) is the sum of (-1)^(r+1)
//! q_r (Rao, "Mechanical Vibrations", 8.3, with a moving base).

use std::f64::consts::PI;

use super::linear_system::LinearSystem;
use super::{NotApplicable, StateAndParameters};
use crate::references::evaluation::Evaluation;

pub fn accelerations(at: &StateAndParameters<'_>) -> Result<Evaluation, NotApplicable> {
    let (rotor, disc) = (at.required("J_m")?, at.required("J_d")?);
    let section = at.required("J_p")?;
    let l = at.required("l")?;
    let shaft = at.required("rho")? * section * l;
    let spring = at.required("G")? * section / l;
    let (bearing, internal) = (at.optional("c_b"), at.optional("c_i"));
    let order = at.order;
    if at.state.len() != 2 * (1 + order) {
        return Err(NotApplicable::State(2 * (1 + order)));
    }
    let (position, rate) = at.state.split_at(1 + order);
    let end = |row: usize| if row.is_multiple_of(2) { -1.0 } else { 1.0 };
    let disc_rate = rate[0] + (1..=order).map(|row| end(row) * rate[row]).sum::<f64>();
    let friction = -bearing * disc_rate;

    let mut system = LinearSystem::new(1 + order);
    system.mass(0, 0, rotor + shaft + disc);
    system.force(0, at.input("u"));
    system.force(0, friction);
    for row in 1..=order {
        let wavenumber = (row as f64 - 0.5) * PI;
        system.mass(0, row, shaft / wavenumber + disc * end(row));
        system.mass(row, row, 0.5 * shaft);
        for column in row..=order {
            system.mass(row, column, disc * end(row) * end(column));
        }
        let stiffness = 0.5 * spring * wavenumber * wavenumber;
        system.force(row, -stiffness * position[row]);
        system.force(row, -internal * stiffness * rate[row]);
        system.force(row, end(row) * friction);
    }
    system.solve()
}
