//! What the paper prints against what its own mechanics gives, row by row, and the check
//! of a derived model against both.
//!
//! The pipeline: `measure` reads every coefficient off a derived right-hand side by
//! differences between states (the model is linear inside a regime, so that these are
//! exact up to rounding); `rigid` (Eq. 10, 12, 16), `flexible` (Eq. 22) and
//! `consequences` (rows that are no coefficient: scales, mode shapes, Table I) state
//! the printed and the corrected value of each; `table` compares. A ratio stands where
//! only a ratio can be observed: the accelerations give a_35/a_30, not a_35.

mod consequences;
mod flexible;
mod measure;
mod rigid;
mod table;

pub use measure::Derived;
pub use table::{ErrataTable, ErratumOutcome, Stated};

use super::equation_12::EquivalentMasses;
use super::equation_22::Coefficients;
use super::parameters::PlanetaryArmParameters;
use measure::Responses;

/// The truncation order at which Eq. (22) is printed.
const PRINTED_ORDER: usize = 4;

/// What the rows are computed from: the parameters, the corrected coefficients and the
/// responses of the derived model.
struct Sources {
    parameters: PlanetaryArmParameters,
    masses: EquivalentMasses,
    coefficients: Coefficients,
    rigid: Responses,
    flexible: Responses,
}

/// Compares a derived model of the arm with the printed and with the corrected equations.
///
/// `derived(parameters, order, t, state)` returns the accelerations of x_sp, x_pr, x_c,
/// q_1 .. q_S (m/s^2) at time t (s) and the state (the coordinates in m, then their
/// rates in m/s); it is called with order 0 and with order 4.
pub fn errata_table(derived: &Derived<'_>) -> ErrataTable {
    let parameters = distinct_parameters();
    let sources = Sources {
        parameters,
        masses: EquivalentMasses::new(&parameters),
        coefficients: Coefficients::new(&parameters, PRINTED_ORDER),
        rigid: Responses::of(derived, &parameters, 0),
        flexible: Responses::of(derived, &parameters, PRINTED_ORDER),
    };
    let mut table = ErrataTable::default();
    rigid::state(&sources, &mut table);
    flexible::state(&sources, &mut table);
    consequences::state(&sources, derived, &mut table);
    table
}

/// The paper's values, with the two meshes told apart: with equal stiffness, damping and
/// backlash an exchange of the meshes would go unnoticed.
fn distinct_parameters() -> PlanetaryArmParameters {
    PlanetaryArmParameters {
        k_pr: 1.3e8,
        c_pr: 820.0,
        b_pr: 35e-6,
        ..PlanetaryArmParameters::default()
    }
}
