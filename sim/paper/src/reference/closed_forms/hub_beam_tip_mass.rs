//! A uniform beam on a hub of inertia J_h that turns by theta, with a tip of mass M_t and
//! rotary inertia J_t, in the clamped-free modes of the bare beam.
//!
//! A point x of the beam moves by x theta + w(x, t), the tip by l theta + w(l, t), and
//! the tip turns by theta + w_x(l, t): the tip couples the modes through phi_i(l) and
//! phi_i'(l) (Meirovitch, "Fundamentals of Vibrations", chapter 8, with a moving base).

use super::balance::Balance;
use super::{Situation, Unfit};
use crate::reference::evaluation::Evaluation;
use crate::reference::mode_shapes::ModeShape;

pub fn accelerations(situation: &Situation<'_>) -> Result<Evaluation, Unfit> {
    let hub = situation.required("J_h")?;
    let line_mass = situation.required("rho")? * situation.required("A")?;
    let bending = situation.required("E")? * situation.required("I")?;
    let l = situation.required("l")?;
    let (tip, tip_inertia) = (situation.required("M_t")?, situation.required("J_t")?);
    let order = situation.order;
    if situation.state.len() != 2 * (1 + order) {
        return Err(Unfit::State(2 * (1 + order)));
    }
    let (position, rate) = situation.state.split_at(1 + order);
    let shapes: Vec<ModeShape> = (1..=order).map(ModeShape::clamped_free).collect();
    let at_tip = |shape: &ModeShape| (shape.value(1.0), shape.derivative(1, 1.0) / l);

    let mut balance = Balance::new(1 + order);
    balance.mass(0, 0, hub);
    balance.mass(0, 0, line_mass * l.powi(3) / 3.0);
    balance.mass(0, 0, tip * l * l + tip_inertia);
    balance.force(0, situation.input("u"));
    balance.force(0, -situation.optional("c") * rate[0]);
    for (i, shape) in shapes.iter().enumerate() {
        let row = 1 + i;
        let integrals = shape.integrals();
        let (value, slope) = at_tip(shape);
        balance.mass(0, row, line_mass * l * l * integrals.s_phi);
        balance.mass(0, row, tip * l * value + tip_inertia * slope);
        balance.mass(row, row, line_mass * l * integrals.phi_squared);
        for (j, other) in shapes.iter().enumerate().skip(i) {
            let (other_value, other_slope) = at_tip(other);
            let coupling = tip * value * other_value + tip_inertia * slope * other_slope;
            balance.mass(row, 1 + j, coupling);
        }
        let stiffness = bending / l.powi(3) * integrals.curvature_squared;
        balance.force(row, -stiffness * position[row]);
    }
    balance.solve()
}
