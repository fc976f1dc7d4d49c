//! Terms that are lost in the rounding of stiffer ones.

use eomgen_codegen::program::evaluator::Point;

use crate::instance::Instance;
use crate::linearisation::Linearisation;

/// Rate, 1/s, below which a motion counts as rigid.
const MAX_HIDDEN_RATE: f64 = 1e-2;

/// Factors by which a parameter is multiplied until its terms exceed the rounding of others.
const LARGE_FACTORS: [f64; 5] = [1e24, 1e60, 1e150, 1e220, 1e290];

/// Change of an entry, relative to the entry, that its rounding may falsify.
const MAX_SMALL_FRACTION: f64 = 1e-12;

/// Relative error of such a change from which on it is lost.
const MAX_LOST_FRACTION: f64 = 1e-2;

impl Instance<'_> {
    /// Returns the name of a parameter whose terms are lost in the rounding of others: a change of it changes
    /// a rate or an entry of the state matrix by less than its own terms would.
    pub(crate) fn find_lost_parameter(
        &self,
        here: &Linearisation,
        point: Point<'_>,
    ) -> Option<String> {
        let largest = here
            .a
            .iter()
            .fold(0.0_f64, |most, entry| most.max(entry.abs()));
        // Rounding of the largest entry hides slower motions.
        if (f64::EPSILON * largest).sqrt() <= MAX_HIDDEN_RATE {
            return None;
        }
        let here = entries(here);
        for name in self.model().parameter_names() {
            let scaled = |factor: f64| self.scaled_entries(&name, factor, point);
            let Some(doubled) = scaled(2.0) else { continue };
            let large = LARGE_FACTORS.into_iter().find_map(|factor| {
                let there = scaled(factor)?;
                (there != here).then_some((factor, there))
            });
            let Some((factor, there)) = large else {
                continue;
            };
            let is_lost = here
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
                return Some(name);
            }
        }
        None
    }

    /// Returns the entries with a parameter times a factor; `None` if the parameter is 0 or one is not finite there.
    fn scaled_entries(&self, name: &str, factor: f64, point: Point<'_>) -> Option<Vec<f64>> {
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
        let found = entries(&changed.linearise(point).ok()?);
        (value != 0.0 && found.iter().all(|entry| entry.is_finite())).then_some(found)
    }
}

/// Returns the entries of the state matrix, then the rates.
fn entries(linear: &Linearisation) -> Vec<f64> {
    [&linear.a[..], &linear.rates].concat()
}
