//! Physical pendulum; theta = 0 is upright and theta = pi hangs down.
//!
//! (m a^2 + I) theta'' = m g a sin theta - k theta' (any textbook).

use super::linear_system::LinearSystem;
use super::{NotApplicable, StateAndParameters};
use crate::references::evaluation::Evaluation;

pub fn accelerations(at: &StateAndParameters<'_>) -> Result<Evaluation, NotApplicable> {
    let (m, a, g) = (at.required("m")?, at.required("a")?, at.required("g")?);
    let (about_centre, k) = (at.optional("I"), at.optional("k"));
    let ([theta], [theta_dot]) = at.motion()?;

    let mut system = LinearSystem::new(1);
    system.mass(0, 0, m * a * a);
    system.mass(0, 0, about_centre);
    system.force(0, -k * theta_dot);
    system.force(0, m * g * a * theta.sin());
    system.solve()
}
