//! Eq. (22) as a system for the solvers.

use eomgen_sim::ode::System;
use eomgen_validate::references::planetary_arm::dimensionless_equation_22::Equation22;
use eomgen_validate::references::planetary_arm::parameters::PlanetaryArmParameters;

/// Arm with S modes in physical units.
pub struct Arm<const S: usize> {
    equation: Equation22<S>,
    parameters: PlanetaryArmParameters,
}

impl<const S: usize> Default for Arm<S> {
    fn default() -> Self {
        let parameters = PlanetaryArmParameters::default();
        Self {
            equation: Equation22::new(&parameters, 1.0, 1.0),
            parameters,
        }
    }
}

impl<const S: usize> System for Arm<S> {
    fn state_count(&self) -> usize {
        Equation22::<S>::STATES
    }

    fn rates(&self, t: f64, y: &[f64], out: &mut [f64]) {
        self.equation.rates(t, y, out);
    }

    fn guard_count(&self) -> usize {
        4
    }

    fn guards(&self, _t: f64, y: &[f64], out: &mut [f64]) {
        let PlanetaryArmParameters { b_sp, b_pr, .. } = self.parameters;
        out.copy_from_slice(&[y[0] - b_sp, y[0] + b_sp, y[1] - b_pr, y[1] + b_pr]);
    }
}
