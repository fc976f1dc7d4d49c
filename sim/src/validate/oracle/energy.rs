//! Energies, their change along a motion, and powers, each with the size of the largest
//! addend, so that a balance can be judged.

use super::equations::RowTermKind;
use super::evaluate::Pass;
use super::scene::Direction;
use super::{Oracle, OracleError, expect_length};

/// A sum with the size of its largest addend.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Total {
    /// The sum.
    pub value: f64,
    /// The largest magnitude among the addends.
    pub scale: f64,
}

impl Total {
    fn add(&mut self, addend: f64) {
        self.value += addend;
        self.scale = self.scale.max(addend.abs());
    }
}

impl Oracle {
    /// T + V at a state, in J.
    ///
    /// # Errors
    /// [`OracleError::Length`] if the state or the inputs do not fit.
    pub fn energy(&self, time: f64, state: &[f64], inputs: &[f64]) -> Result<Total, OracleError> {
        let scene = self.scene(time, state, None, inputs)?;
        let pass = Pass::new(&scene, Direction::Still, Direction::Still);
        let mut total = Total::default();
        for term in self.kinetic.iter().chain(&self.potential) {
            total.add(pass.value(&term.tree).re);
        }
        Ok(total)
    }

    /// d(T + V)/dt along the motion with given accelerations, in W. The addends whose
    /// largest is the scale are q_j' dT/dq_j, q_j' dV/dq_j and q_j' M_jk q_k''.
    ///
    /// # Errors
    /// [`OracleError::Length`] if the state, the accelerations or the inputs do not fit.
    pub fn energy_rate(
        &self,
        time: f64,
        state: &[f64],
        accelerations: &[f64],
        inputs: &[f64],
    ) -> Result<Total, OracleError> {
        expect_length("accelerations", self.size(), accelerations.len())?;
        let scene = self.scene(time, state, Some(accelerations), inputs)?;
        let along = Pass::new(&scene, Direction::Time, Direction::Still);
        let rates = state.get(self.size()..).unwrap_or_default();
        let mut total = Total::default();
        for term in self.kinetic.iter().chain(&self.potential) {
            total.value += along.value(&term.tree).eps1;
            for (row, rate) in rates.iter().enumerate() {
                let addend = rate * term.derivative(&scene, row, Direction::Position(row));
                total.scale = total.scale.max(addend.abs());
            }
        }
        let mass = self.mass(&scene);
        for (row, rate) in rates.iter().enumerate() {
            for (column, acceleration) in accelerations.iter().enumerate() {
                let addend = rate * mass[(row, column)] * acceleration;
                total.scale = total.scale.max(addend.abs());
            }
        }
        Ok(total)
    }

    /// The power of all non-conservative forces at a state, in W.
    ///
    /// # Errors
    /// [`OracleError::Length`] if the state or the inputs do not fit.
    pub fn power(&self, time: f64, state: &[f64], inputs: &[f64]) -> Result<Total, OracleError> {
        let scene = self.scene(time, state, None, inputs)?;
        let mut total = Total::default();
        let dissipated = self
            .dissipation
            .iter()
            .map(|term| term.rows(&scene, RowTermKind::Dissipation));
        let forces = self.forces.iter().map(|force| force.rows(&scene));
        for term in dissipated.chain(forces) {
            for (row, value) in term.rows.iter().enumerate() {
                total.add(-value * state.get(self.size() + row).copied().unwrap_or(f64::NAN));
            }
        }
        Ok(total)
    }

    /// Whether T + V is what the power of the forces changes: the kinetic energy a
    /// quadratic form of the rates (2 T = sum of q_j' dT/dq_j' at the given state, to
    /// 1e-10) and no energy explicitly dependent on time or inputs.
    ///
    /// # Errors
    /// [`OracleError::Length`] if the state or the inputs do not fit.
    pub fn is_scleronomic(
        &self,
        time: f64,
        state: &[f64],
        inputs: &[f64],
    ) -> Result<bool, OracleError> {
        let scene = self.scene(time, state, None, inputs)?;
        let mut defect = Total::default();
        for term in self.kinetic.iter().chain(&self.potential) {
            if term.dependence.time || term.dependence.input {
                return Ok(false);
            }
        }
        for term in &self.kinetic {
            let pass = Pass::new(&scene, Direction::Still, Direction::Still);
            defect.add(-2.0 * pass.value(&term.tree).re);
            for row in 0..self.size() {
                let rate = state.get(self.size() + row).copied().unwrap_or(f64::NAN);
                defect.add(rate * term.derivative(&scene, row, Direction::Rate(row)));
            }
        }
        Ok(defect.value.abs() <= 1e-10 * defect.scale)
    }
}
