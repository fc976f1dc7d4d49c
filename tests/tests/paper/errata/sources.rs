//! Corrected coefficients, and responses of the derived model.

use eomgen_validate::references::planetary_arm::equation_12::EquivalentMasses;
use eomgen_validate::references::planetary_arm::equation_22::Coefficients;
use eomgen_validate::references::planetary_arm::parameters::PlanetaryArmParameters;

use super::measure::{DerivedModel, Responses};

/// Truncation order of the printed Eq. (22).
pub const PRINTED_ORDER: usize = 4;

/// Parameters, corrected coefficients and responses of the derived model.
pub struct Sources {
    pub parameters: PlanetaryArmParameters,
    pub masses: EquivalentMasses,
    pub coefficients: Coefficients,
    pub rigid: Responses,
    pub flexible: Responses,
}

impl Sources {
    /// Computes the responses of the derived model at orders 0 and 4.
    pub fn measure(derived: &DerivedModel<'_>) -> Self {
        let parameters = distinct_parameters();
        Self {
            parameters,
            masses: EquivalentMasses::new(&parameters),
            coefficients: Coefficients::new(&parameters, PRINTED_ORDER),
            rigid: Responses::measure(derived, &parameters, 0),
            flexible: Responses::measure(derived, &parameters, PRINTED_ORDER),
        }
    }
}

/// Returns the values of the paper, but with different values for the two meshes. With equal stiffness, damping and
/// backlash, exchanged meshes would not be detected.
fn distinct_parameters() -> PlanetaryArmParameters {
    PlanetaryArmParameters {
        k_pr: 1.3e8,
        c_pr: 820.0,
        b_pr: 35e-6,
        ..PlanetaryArmParameters::default()
    }
}
