//! Natural modes of a model linearised about a point.

use eomgen_analysis::constrained_modes::constrained_modes;
use eomgen_analysis::natural_modes::NaturalMode;
use eomgen_codegen::program::evaluator::Point;

use crate::error::Error;
use crate::instance::Instance;
use crate::model::CompiledModel;

impl CompiledModel {
    /// Returns names and SI units of the amplitudes of a mode shape: coordinates, then first-order states.
    pub fn amplitudes(&self) -> Vec<(String, String)> {
        let degrees = self.program().degrees_of_freedom();
        let states = self.state_names().into_iter().zip(self.state_units());
        let mut amplitudes: Vec<_> = states.collect();
        amplitudes.drain(degrees..2 * degrees);
        amplitudes
    }
}

impl Instance<'_> {
    /// Returns the natural modes about a point, lowest frequency first. With constraints, they are those of the
    /// motions that the constraints allow. The entries of a shape are those of
    /// [`CompiledModel::amplitudes`].
    ///
    /// # Errors
    /// Same as [`Instance::linearise`], or eigenvalues that are not found.
    pub fn natural_modes(&self, point: Point<'_>) -> Result<Vec<NaturalMode>, Error> {
        let found = self.linearise(point)?;
        let degrees = self.model().program().degrees_of_freedom();
        constrained_modes(&found.a, &found.constraint_matrix(self.model()), degrees)
            .map_err(|error| Error::Request(error.to_string()))
    }
}
