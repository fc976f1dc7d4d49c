//! Energies, their rates and powers, each with the magnitude of its terms.

use super::conditioned::Conditioned;
use super::equations::RowTermKind;
use super::evaluate::Pass;
use super::scene::Direction;
use super::{Oracle, OracleError, expect_length};

impl Oracle {
    /// Returns the energy T + V at a state, in J.
    pub fn energy(
        &self,
        time: f64,
        state: &[f64],
        inputs: &[f64],
    ) -> Result<Conditioned, OracleError> {
        let scene = self.scene(time, state, None, inputs)?;
        let pass = Pass::new(&scene, Direction::Zero, Direction::Zero);
        let terms = self.kinetic.iter().chain(&self.potential);
        Ok(terms.map(|term| pass.value(&term.tree).re).sum())
    }

    /// Returns d(T + V)/dt along the motion with given accelerations, in W.
    pub fn energy_rate(
        &self,
        time: f64,
        state: &[f64],
        accelerations: &[f64],
        inputs: &[f64],
    ) -> Result<Conditioned, OracleError> {
        expect_length("accelerations", self.size(), accelerations.len())?;
        let scene = self.scene(time, state, Some(accelerations), inputs)?;
        let along = Pass::new(&scene, Direction::Time, Direction::Zero);
        let terms = self.kinetic.iter().chain(&self.potential);
        Ok(terms.map(|term| along.value(&term.tree).eps1).sum())
    }

    /// Returns the power of all non-conservative forces at a state, in W.
    pub fn power(
        &self,
        time: f64,
        state: &[f64],
        inputs: &[f64],
    ) -> Result<Conditioned, OracleError> {
        let scene = self.scene(time, state, None, inputs)?;
        let dissipated = self
            .dissipation
            .iter()
            .map(|term| term.rows(&scene, RowTermKind::Dissipation));
        let forces = self.forces.iter().map(|force| force.rows(&scene));
        let rates = state.get(self.size()..).unwrap_or_default();
        let mut total = self.reaction_power(&scene, &rates[..rates.len().min(self.size())]);
        for term in dissipated.chain(forces) {
            let rows = term.rows.iter().zip(&term.magnitudes);
            for ((value, magnitude), rate) in rows.zip(rates) {
                total += Conditioned::new(-value * rate, magnitude * rate.abs());
            }
        }
        Ok(total)
    }

    /// Returns true if the power of the forces is the rate of T + V. In that case the kinetic
    /// energy is a quadratic form of the rates (2 T = sum of q_j' dT/dq_j' at the given state, to
    /// 1e-10) and no energy depends explicitly on time or inputs.
    pub fn is_scleronomic(
        &self,
        time: f64,
        state: &[f64],
        inputs: &[f64],
    ) -> Result<bool, OracleError> {
        let scene = self.scene(time, state, None, inputs)?;
        let mut defect = Conditioned::default();
        for term in self.kinetic.iter().chain(&self.potential) {
            let dependence = &term.dependence;
            if dependence.has_time || dependence.has_input || dependence.has_prescribed_input {
                return Ok(false);
            }
        }
        for term in &self.kinetic {
            let pass = Pass::new(&scene, Direction::Zero, Direction::Zero);
            defect += pass.value(&term.tree).re * -2.0;
            for row in 0..self.size() {
                let rate = state.get(self.size() + row).copied().unwrap_or(f64::NAN);
                defect += term.derivative(&scene, row, Direction::Rate(row)) * rate;
            }
        }
        Ok(defect.value.abs() <= 1e-10 * defect.magnitude)
    }
}
