//! Load on a rope of changing length below a moving trolley. The balance of forces perpendicular to the rope is m (l
//! theta'' + 2 l' theta' + s'' cos theta + g sin theta) = drag perpendicular to the rope.

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
    // Velocity of the load perpendicular to the rope.
    row.add(-c * rate / m);
    row.add(-c * at.input("s_dot") * theta.cos() / (m * l));
    Ok(Evaluation::from_rows([row]))
}
