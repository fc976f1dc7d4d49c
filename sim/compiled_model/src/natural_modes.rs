//! Natural modes of a model linearised about a point.

use eomgen_analysis::constrained_modes::constrained_modes;
use eomgen_analysis::natural_modes::NaturalMode;
use eomgen_codegen::program::evaluator::Point;

use crate::error::Error;
use crate::instance::Instance;
use crate::linearisation::Linearisation;
use crate::model::CompiledModel;

impl CompiledModel {
    /// Returns names and SI units of the entries of a mode shape: coordinates, then first-order states.
    pub fn amplitudes(&self) -> Vec<(String, String)> {
        let degrees = self.program().degrees_of_freedom();
        let states = self.state_names().into_iter().zip(self.state_units());
        let mut amplitudes: Vec<_> = states.collect();
        amplitudes.drain(degrees..2 * degrees);
        amplitudes
    }
}

impl Instance<'_> {
    /// Returns the natural modes of a linearisation about a point, lowest frequency first. With constraints, the modes
    /// belong to motions that satisfy the constraints. The entries of a shape are in the order of
    /// [`CompiledModel::amplitudes`].
    ///
    /// # Errors
    /// Eigenvalues that are not found, and a frequency of 0 by rounding.
    pub fn natural_modes(
        &self,
        found: &Linearisation,
        point: Point<'_>,
    ) -> Result<Vec<NaturalMode>, Error> {
        let degrees = self.model().program().degrees_of_freedom();
        let modes = constrained_modes(
            &found.a,
            &found.constraint_matrix(self.model()),
            degrees,
            self.model().typical_sizes(),
        )
        .map_err(|error| Error::Request(error.to_string()))?;
        let is_rigid = modes.iter().any(|mode| mode.frequency() == 0.0);
        if is_rigid && let Some(name) = self.find_lost_parameter(found, point) {
            return Err(Error::Request(format!(
                "a motion has the frequency 0 because the term with `{name}` is below the rounding error of a larger \
                 stiffness: make the stiff part rigid, or reduce its stiffness"
            )));
        }
        Ok(modes)
    }
}
