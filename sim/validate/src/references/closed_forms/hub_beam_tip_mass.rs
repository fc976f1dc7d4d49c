//! Uniform beam on a hub of inertia J_h that turns by theta, with a tip of mass M_t and rotary
//! inertia J_t, in the clamped-free modes of the bare beam.
//!
//! A point at x of the beam is displaced by x theta + w(x, t) and the tip by l theta + w(l, t). The tip turns by
//! theta + w_x(l, t). Therefore the tip couples the modes through phi_i(l) and phi_i'(l) (Meirovitch, "Fundamentals of
//! Vibrations", chapter 8, with a moving base).

use super::linear_system::LinearSystem;
use super::{NotApplicable, StateAndParameters};
use crate::references::evaluation::Evaluation;
use crate::references::planetary_arm::mode_shapes::ModeShape;

pub fn accelerations(at: &StateAndParameters<'_>) -> Result<Evaluation, NotApplicable> {
    let hub = at.required("J_h")?;
    let line_mass = at.required("rho")? * at.required("A")?;
    let bending = at.required("E")? * at.required("I")?;
    let l = at.required("l")?;
    let (tip, tip_inertia) = (at.required("M_t")?, at.required("J_t")?);
    let order = at.order;
    if at.state.len() != 2 * (1 + order) {
        return Err(NotApplicable::State(2 * (1 + order)));
    }
    let (position, rate) = at.state.split_at(1 + order);
    let shapes: Vec<ModeShape> = (1..=order).map(ModeShape::clamped_free).collect();
    let at_tip = |shape: &ModeShape| (shape.value(1.0), shape.derivative(1, 1.0) / l);

    let mut system = LinearSystem::new(1 + order);
    system.mass(0, 0, hub);
    system.mass(0, 0, line_mass * l.powi(3) / 3.0);
    system.mass(0, 0, tip * l * l + tip_inertia);
    system.force(0, at.input("u"));
    system.force(0, -at.optional("c") * rate[0]);
    for (i, shape) in shapes.iter().enumerate() {
        let row = 1 + i;
        let integrals = shape.integrals();
        let (value, slope) = at_tip(shape);
        system.mass(0, row, line_mass * l * l * integrals.s_phi);
        system.mass(0, row, tip * l * value + tip_inertia * slope);
        system.mass(row, row, line_mass * l * integrals.phi_squared);
        for (j, other) in shapes.iter().enumerate().skip(i) {
            let (other_value, other_slope) = at_tip(other);
            let coupling = tip * value * other_value + tip_inertia * slope * other_slope;
            system.mass(row, 1 + j, coupling);
        }
        let stiffness = bending / l.powi(3) * integrals.curvature_squared;
        system.force(row, -stiffness * position[row]);
    }
    system.solve()
}
