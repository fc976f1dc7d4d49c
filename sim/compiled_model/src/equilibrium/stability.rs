//! Stability of an equilibrium, from the eigenvalues of the linearised model.

use std::fmt;

use eomgen_analysis::constrained_modes::constrained_modes;

use crate::error::Error;
use crate::instance::Instance;
use crate::operating_point::OperatingPoint;

/// Largest real part of an eigenvalue that counts as 0, relative to the largest magnitude.
const MAX_ZERO_REAL_PART_FRACTION: f64 = 1e-9;

/// Stability of an equilibrium of the linearised model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stability {
    /// Every small motion decays.
    Asymptotic,
    /// The slowest small motion neither decays nor grows, so the linearisation is inconclusive.
    Marginal,
    /// Some small motion grows.
    Unstable,
}

impl fmt::Display for Stability {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Asymptotic => "asymptotically stable",
            Self::Marginal => "marginal",
            Self::Unstable => "unstable",
        })
    }
}

impl Instance<'_> {
    /// Returns the stability of an equilibrium for small motions that satisfy the constraints.
    ///
    /// # Errors
    /// Eigenvalues that cannot be computed; see also [`Instance::linearise`].
    pub fn classify_stability(&self, at: &OperatingPoint) -> Result<Stability, Error> {
        let linear = self.linearise(at.point())?;
        let degrees = self.model().program().degrees_of_freedom();
        let modes = constrained_modes(
            &linear.a,
            &linear.constraint_matrix(self.model()),
            degrees,
            self.model().typical_sizes(),
        )
        .map_err(|error| Error::Request(error.to_string()))?;
        let eigenvalues = || modes.iter().map(|mode| mode.eigenvalue);
        let largest = eigenvalues().fold(0.0, |most: f64, value| most.max(value.norm()));
        let growth = eigenvalues().fold(f64::NEG_INFINITY, |most, value| most.max(value.re));
        Ok(match growth {
            growth if growth > MAX_ZERO_REAL_PART_FRACTION * largest => Stability::Unstable,
            growth if growth < -MAX_ZERO_REAL_PART_FRACTION * largest => Stability::Asymptotic,
            _ => Stability::Marginal,
        })
    }
}
