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

/// Number of roundings of its terms above which the stiffness along a rigid motion is not rounding.
const MAX_STIFFNESS_ROUNDINGS: f64 = 8.0;

/// Part of a change of a parameter that the stiffness along a motion has if terms with this parameter make it. Terms that
/// cancel leave rounding.
const MIN_STIFFNESS_FRACTION: f64 = 0.1;

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
            return Err(hidden_parameter_error(&name));
        }
        for mode in modes.iter().filter(|mode| mode.frequency() == 0.0) {
            if let Some(name) = self.find_acting_parameter((&found.a, degrees), mode, point) {
                return Err(hidden_parameter_error(&name));
            }
        }
        Ok(modes)
    }

    /// Returns the name of a parameter that gives a rigid motion a stiffness above rounding, but below that of eigenvalues.
    fn find_acting_parameter(
        &self,
        (a, degrees): (&[f64], usize),
        mode: &NaturalMode,
        point: Point<'_>,
    ) -> Option<String> {
        let states = point.state.len();
        let stiffness = |a: &[f64]| {
            let mut sums = (0.0, 0.0);
            for row in 0..degrees {
                for column in 0..degrees {
                    let entry = a[(degrees + row) * states + column];
                    let term = mode.shape[row].re * entry * mode.shape[column].re;
                    sums = (sums.0 + term, sums.1 + term.abs());
                }
            }
            sums
        };
        let (own, terms) = stiffness(a);
        let rounding = MAX_STIFFNESS_ROUNDINGS * f64::EPSILON * terms;
        if own.abs() <= rounding {
            return None;
        }
        self.model().parameter_names().into_iter().find(|name| {
            let doubled = self.scaled_state_matrix(name, 2.0, point);
            doubled.is_some_and(|doubled| {
                let change = (stiffness(&doubled).0 - own).abs();
                change > rounding && own.abs() >= MIN_STIFFNESS_FRACTION * change
            })
        })
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

fn hidden_parameter_error(name: &str) -> Error {
    Error::Request(format!(
        "a motion has the frequency 0 because the term with `{name}` is below the rounding of a stiffness \
         beside it: make the stiff part rigid, or reduce its stiffness"
    ))
}
