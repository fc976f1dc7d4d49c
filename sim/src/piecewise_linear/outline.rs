//! A regime in outline: its equations without what is prepared for stepping, to decide whether
//! it is the one to be entered.

use codegen::program::affine::AffineSystem;

use super::dependents::Standing;
use super::derivative::Rates;
use super::functional::Linear;
use super::groups::Place;
use super::propagator::Propagator;
use super::regime::rates;
use super::sliding::slide;

/// The roundings of a sum of products of size 1.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// The equations with the groups at some places.
pub(super) struct Outline {
    system: AffineSystem,
    /// Each group's function.
    pub functions: Vec<Linear>,
    /// Each group's thresholds, by rank.
    pub thresholds: Vec<Vec<f64>>,
}

impl Propagator {
    /// The outline with these places, made if it is new.
    pub(super) fn outline(&mut self, places: &[Place]) -> usize {
        if let Some(&known) = self.outlined.get(places) {
            return known;
        }
        let mut sides = vec![0.0; self.evaluator.guard_count()];
        for (group, place) in self.groups.iter().zip(places) {
            group.write_sides(*place, 0.0, &mut sides);
        }
        let below = self.evaluator.system(&sides);
        let held = places.iter().any(|place| matches!(place, Place::On(_)));
        let sliding = held
            .then(|| slide(&mut self.evaluator, &self.groups, places))
            .flatten();
        let ranks = |index: usize| {
            let group = &self.groups[index];
            let ranks = 0..group.ranks.len();
            ranks.map(|rank| group.threshold(&below, rank)).collect()
        };
        let count = self.groups.len();
        let outline = Outline {
            functions: self.groups.iter().map(|g| g.function(&below)).collect(),
            thresholds: (0..count).map(ranks).collect(),
            system: sliding.map_or(below, |sliding| sliding.system),
        };
        self.outlines.push(outline);
        let index = self.outlines.len() - 1;
        self.outlined.insert(places.to_vec(), index);
        index
    }
}

impl Outline {
    /// The place of a group whose function has one value while the inputs are held.
    pub fn resting(&self, group: usize, inputs: &[f64]) -> Option<Place> {
        let function = &self.functions[group];
        function
            .is_still()
            .then(|| self.place_at(group, function.value(&[], inputs, &[])))
    }

    /// The place of a group whose function has this value: not above a threshold that it equals.
    pub fn place_at(&self, group: usize, value: f64) -> Place {
        let thresholds = self.thresholds[group].iter();
        Place::Between(thresholds.filter(|threshold| value > **threshold).count())
    }

    /// Whether a group's function and thresholds are those of another outline.
    pub fn same_function(&self, other: &Self, group: usize) -> bool {
        self.functions[group] == other.functions[group]
            && self.thresholds[group] == other.thresholds[group]
    }

    /// The rate of a function that is due to the state's, and what rounding may make of it.
    pub fn rate(&self, function: &Linear, standing: Standing<'_>) -> (f64, f64) {
        let Rates { values, sizes } = self.rates(standing);
        let factors = function.state.iter();
        let rate = factors.clone().zip(values).map(|(a, b)| a * b).sum();
        let size: f64 = factors.zip(sizes).map(|(a, b)| (a * b).abs()).sum();
        (rate, ROUNDING * size)
    }

    /// The rates of the state.
    pub fn rates(&self, standing: Standing<'_>) -> Rates {
        let Standing {
            state,
            inputs,
            phases,
        } = standing;
        let mut values = vec![0.0; self.system.states];
        rates(&self.system, state, inputs, phases, &mut values);
        let rows = 0..self.system.states;
        let row = |row| Linear::row(&self.system.rates, row).size(state, inputs, phases);
        Rates {
            values,
            sizes: rows.map(row).collect(),
        }
    }
}
