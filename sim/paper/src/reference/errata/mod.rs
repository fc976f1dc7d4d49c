//! Errata: comparison of the printed equations with the mechanics of the paper, row by row, and
//! with a derived model.
//!
//! `measure` reads every coefficient of a derived right-hand side by differences between states,
//! which are exact up to rounding because the model is linear in a regime. `rigid` (Eq. 10, 12,
//! 16), `flexible` (Eq. 22) and `consequences` (scales, mode shapes, Table I) give the printed and
//! the corrected values; `table` compares. Only ratios such as a_35/a_30 follow from accelerations.

mod consequences;
mod flexible;
mod measure;
mod rigid;
mod table;

pub use measure::DerivedModel;
pub use table::{ErrataTable, ErratumOutcome, Statement};

use super::equation_12::EquivalentMasses;
use super::equation_22::Coefficients;
use super::parameters::PlanetaryArmParameters;
use measure::Responses;

const PRINTED_ORDER: usize = 4;

/// Parameters, corrected coefficients and responses of the derived model.
struct Sources {
    parameters: PlanetaryArmParameters,
    masses: EquivalentMasses,
    coefficients: Coefficients,
    rigid: Responses,
    flexible: Responses,
}

/// Compares a derived model of the arm with the printed and the corrected equations.
///
/// `derived(parameters, order, t, state)` returns the accelerations of x_sp, x_pr, x_c, q_1 .. q_S
/// (m/s^2) at time t (s) and the state (coordinates in m, then their rates in m/s). It is called
/// with orders 0 and 4.
pub fn errata_table(derived: &DerivedModel<'_>) -> ErrataTable {
    let parameters = distinct_parameters();
    let sources = Sources {
        parameters,
        masses: EquivalentMasses::new(&parameters),
        coefficients: Coefficients::new(&parameters, PRINTED_ORDER),
        rigid: Responses::measure(derived, &parameters, 0),
        flexible: Responses::measure(derived, &parameters, PRINTED_ORDER),
    };
    let mut table = ErrataTable::default();
    rigid::add_rows(&sources, &mut table);
    flexible::add_rows(&sources, &mut table);
    consequences::state(&sources, derived, &mut table);
    table
}

/// Returns the values of the paper with different meshes: with equal stiffness, damping and
/// backlash, exchanged meshes would remain undetected.
fn distinct_parameters() -> PlanetaryArmParameters {
    PlanetaryArmParameters {
        k_pr: 1.3e8,
        c_pr: 820.0,
        b_pr: 35e-6,
        ..PlanetaryArmParameters::default()
    }
}
