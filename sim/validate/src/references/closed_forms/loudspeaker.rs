//! Moving-coil loudspeaker for small signals: m x'' + c x' + k x = Bl i, and the voltage equations of two loops,
//! L_e i' + R_e i + R_2 (i - i_2) + Bl x' = u and L_2 i_2' = R_2 (i - i_2) (Klippel, "Tutorial: Loudspeaker
//! nonlinearities", J. Audio Eng. Soc. 54, 2006, Fig. 2 with constant parameters). In the result, the rates of the
//! currents follow the acceleration.

use super::{NotApplicable, StateAndParameters};
use crate::references::evaluation::{Evaluation, Row};

pub fn accelerations(at: &StateAndParameters<'_>) -> Result<Evaluation, NotApplicable> {
    let [x, v, i, i_2] = at.state else {
        return Err(NotApplicable::State(4));
    };
    let (m, l_e, l_2) = (at.required("m")?, at.required("L_e")?, at.required("L_2")?);
    let (r_e, r_2) = (at.required("R_e")?, at.required("R_2")?);
    let force_factor = at.required("Bl")?;
    let between = r_2 * (i - i_2);
    let row = |terms: &[f64], of: f64| {
        let mut row = Row::new();
        terms.iter().for_each(|term| row.add(term / of));
        row
    };
    Ok(Evaluation::from_rows([
        row(
            &[
                force_factor * i,
                -at.required("k")? * x,
                -at.required("c")? * v,
            ],
            m,
        ),
        row(&[at.input("u"), -r_e * i, -between, -force_factor * v], l_e),
        row(&[between], l_2),
    ]))
}
