//! Load on a rope of changing length below a moving trolley, from the balance of forces across the
//! rope: m (l theta'' + 2 l' theta' + s'' cos theta + g sin theta) = the drag across it.

use super::{NotApplicable, StateAndParameters};
use crate::references::evaluation::{Evaluation, Row};

pub fn accelerations(at: &StateAndParameters<'_>) -> Result<Evaluation, NotApplicable> {
    let (m, g) = (at.required("m")?, at.required("g")?);
    let c = at.optional("c");
    let ([theta], [rate]) = at.motion()?;
    let (l, l_dot) = (at.input("l"), at.input("l_dot"));
    let mut row = Row::new();
    row.add(-2.0 * l_dot * rate / l);
    row.add(-at.input("s_ddot") * theta.cos() / l);
    row.add(-g * theta.sin() / l);
    // Velocity of the load across the rope.
    row.add(-c * rate / m);
    row.add(-c * at.input("s_dot") * theta.cos() / (m * l));
    Ok(Evaluation::from_rows([row]))
}
