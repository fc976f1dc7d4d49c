//! Observables of the specification, with `energy` and `power` last.

use super::conditioned::Conditioned;
use super::evaluate::Pass;
use super::lower::Lowering;
use super::scene::Direction;
use super::tree::Tree;
use super::{Oracle, OracleError};
use eomgen_model_spec::model::Model;

/// Converts every observable; `None` stands for an unsupported one.
pub(super) fn lower_observables(lowering: &mut Lowering<'_>, model: &Model) -> Vec<Option<Tree>> {
    let observables = model.observables.iter();
    observables
        .map(|known| lowering.lower_term(&known.name, &known.value).ok())
        .collect()
}

impl Oracle {
    /// Returns the observables, T + V and its rate; 0 with infinite magnitude if unsupported.
    pub fn observables(
        &self,
        time: f64,
        state: &[f64],
        inputs: &[f64],
    ) -> Result<Vec<Conditioned>, OracleError> {
        let mut scene = self.scene(time, state, None, inputs)?;
        scene.multipliers = self.multipliers(&scene);
        let pass = Pass::new(&scene, Direction::Zero, Direction::Zero);
        let value = |tree: &Option<Tree>| match tree {
            Some(tree) => pass.value(tree).re,
            None => Conditioned::new(0.0, f64::INFINITY),
        };
        let mut found: Vec<Conditioned> = self.observables.iter().map(value).collect();
        found.push(self.energy(time, state, inputs)?);
        found.push(self.rate_of_energy(time, state, inputs)?);
        Ok(found)
    }

    /// Returns the rate of T + V along the motion: the power of the forces if no energy depends
    /// explicitly on time, otherwise the rate with the oracle's accelerations.
    pub fn rate_of_energy(
        &self,
        time: f64,
        state: &[f64],
        inputs: &[f64],
    ) -> Result<Conditioned, OracleError> {
        if self.is_scleronomic(time, state, inputs)? {
            return self.power(time, state, inputs);
        }
        let dense = self.equations(time, state, inputs)?.accelerations();
        let still = || vec![f64::NAN; self.size()];
        let accelerations = dense.map_or_else(still, |a| a.as_slice().to_vec());
        self.energy_rate(time, state, &accelerations, inputs)
    }
}
