//! Terms that are lost in the rounding of stiffer terms.

use eomgen_codegen::program::evaluator::Point;

use crate::instance::Instance;
use crate::linearisation::Linearisation;

/// Rate, 1/s, below which a motion counts as rigid.
const MAX_HIDDEN_RATE: f64 = 1e-2;

/// Factors on a parameter, tried until its terms exceed the rounding errors of other terms.
const LARGE_FACTORS: [f64; 5] = [1e24, 1e60, 1e150, 1e220, 1e290];

/// A change of an entry below this fraction of the entry may be wrong by rounding.
const MAX_SMALL_FRACTION: f64 = 1e-12;

/// Relative error of a change from which on the change counts as lost.
const MAX_LOST_FRACTION: f64 = 1e-2;

impl Instance<'_> {
    /// Returns the name of a parameter whose terms are lost in the rounding of others. A change of this parameter
    /// changes a rate or an entry of the state matrix by less than its own terms would.
    pub(crate) fn find_lost_parameter(
        &self,
        here: &Linearisation,
        point: Point<'_>,
    ) -> Option<String> {
        let largest = here
            .a
            .iter()
            .fold(0.0_f64, |most, entry| most.max(entry.abs()));
        // The rounding error of the largest entry hides slower motions.
        if (f64::EPSILON * largest).sqrt() <= MAX_HIDDEN_RATE {
            return None;
        }
        let here = collect_entries(here);
        for name in self.model().parameter_names() {
            let scaled = |factor: f64| self.evaluate_scaled_entries(&name, factor, point);
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
                    // Change of the entry by the parameter if the entry is linear in it.
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

    /// Returns the entries with a parameter multiplied by a factor; `None` if the parameter is 0 or an entry is not
    /// finite.
    fn evaluate_scaled_entries(
        &self,
        name: &str,
        factor: f64,
        point: Point<'_>,
    ) -> Option<Vec<f64>> {
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
        let found = collect_entries(&changed.linearise(point).ok()?);
        (value != 0.0 && found.iter().all(|entry| entry.is_finite())).then_some(found)
    }
}

/// Returns the entries of the state matrix, followed by the rates.
fn collect_entries(linear: &Linearisation) -> Vec<f64> {
    [&linear.a[..], &linear.rates].concat()
}
