//! Natural modes of a model linearised about a point.

use eomgen_analysis::constrained_modes::constrained_modes;
use eomgen_analysis::natural_modes::NaturalMode;
use eomgen_codegen::program::evaluator::Point;

use crate::error::Error;
use crate::instance::Instance;
use crate::model::CompiledModel;

/// Rate, 1/s, below which a motion counts as rigid.
const MAX_HIDDEN_RATE: f64 = 1e-2;

/// Factors by which a parameter is multiplied until its terms exceed the rounding of others.
const LARGE_FACTORS: [f64; 5] = [1e24, 1e60, 1e150, 1e220, 1e290];

/// Change of an entry, relative to the entry, that its rounding may falsify.
const MAX_SMALL_FRACTION: f64 = 1e-12;

/// Relative error of such a change from which on it is lost.
const MAX_LOST_FRACTION: f64 = 1e-2;

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
        let modes = constrained_modes(&found.a, &found.constraint_matrix(self.model()), degrees)
            .map_err(|error| Error::Request(error.to_string()))?;
        let largest = found
            .a
            .iter()
            .fold(0.0_f64, |most, entry| most.max(entry.abs()));
        let is_rigid = modes.iter().any(|mode| mode.frequency() == 0.0);
        // Rounding of the largest entry hides slower motions.
        if is_rigid
            && (f64::EPSILON * largest).sqrt() > MAX_HIDDEN_RATE
            && let Some(name) = self.find_lost_parameter(&found.a, point)?
        {
            return Err(Error::Request(format!(
                "a motion has the frequency 0 because the term with `{name}` is below the rounding of a stiffness \
                 beside it: make the stiff part rigid, or reduce its stiffness"
            )));
        }
        Ok(modes)
    }

    /// Returns the name of a parameter whose terms are lost in the rounding of others: a change of it changes
    /// an entry of the state matrix `a` by less than its own terms would.
    fn find_lost_parameter(&self, a: &[f64], point: Point<'_>) -> Result<Option<String>, Error> {
        for name in self.model().parameter_names() {
            let scaled = |factor: f64| self.scaled_state_matrix(&name, factor, point);
            let Some(doubled) = scaled(2.0) else { continue };
            let large = LARGE_FACTORS.into_iter().find_map(|factor| {
                let there = scaled(factor)?;
                (there != a).then_some((factor, there))
            });
            let Some((factor, there)) = large else {
                continue;
            };
            let is_lost = a
                .iter()
                .zip(doubled)
                .zip(there)
                .any(|((a, doubled), there)| {
                    // Change of the entry if it is linear in the parameter.
                    let own = (there - a) / (factor - 1.0);
                    let change = doubled - a;
                    let is_small = own.abs().max(change.abs()) < MAX_SMALL_FRACTION * a.abs();
                    own != 0.0 && is_small && (change - own).abs() > MAX_LOST_FRACTION * own.abs()
                });
            if is_lost {
                return Ok(Some(name));
            }
        }
        Ok(None)
    }

    /// Returns the state matrix with a parameter times a factor; `None` if the parameter is 0 or the model
    /// has no finite matrix there.
    fn scaled_state_matrix(&self, name: &str, factor: f64, point: Point<'_>) -> Option<Vec<f64>> {
        let mut parameters = self.model().model().parameters.iter();
        let unit = &parameters.find(|known| known.name == name)?.unit;
        let value = unit.from_si(self.value(name)?);
        let settings = self
            .settings()
            .iter()
            .map(|(name, value)| (&**name, *value));
        let others = settings.filter(|(known, _)| *known != name);
        let settings: Vec<(&str, f64)> = others.chain([(name, factor * value)]).collect();
        let changed = self.model().with_parameters(&settings).ok()?;
        let a = changed.linearise(point).ok()?.a;
        (value != 0.0 && a.iter().all(|entry| entry.is_finite())).then_some(a)
    }
}
