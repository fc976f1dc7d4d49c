//! Outline of a regime: its equations without the preparation for stepping. It suffices to determine the regime
//! that a motion enters.

use eomgen_codegen::program::affine::AffineSystem;

use super::dependents::StateAt;
use super::derivative::Rates;
use super::event_function::Linear;
use super::parallel_guards::Cell;
use super::propagator::Propagator;
use super::regime::rates;
use super::sliding::derive_sliding;

/// Rounding error of a sum of products of magnitude 1.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Equations for given cells of the families.
pub(super) struct Outline {
    system: AffineSystem,
    /// Function of each family.
    pub functions: Vec<Linear>,
    /// Thresholds of each family, by rank.
    pub thresholds: Vec<Vec<f64>>,
}

impl Propagator {
    /// Returns the index of the outline with these cells; creates it if necessary.
    pub(super) fn outline(&mut self, cells: &[Cell]) -> usize {
        if let Some(&known) = self.outlined.get(cells) {
            return known;
        }
        let mut sides = vec![0.0; self.evaluator.guard_count()];
        for (family, cell) in self.families.iter().zip(cells) {
            family.write_sides(*cell, 0.0, &mut sides);
        }
        let below = self.evaluator.system(&sides);
        let held = cells.iter().any(|cell| matches!(cell, Cell::On(_)));
        let sliding = held
            .then(|| derive_sliding(&mut self.evaluator, &self.families, cells))
            .flatten();
        let ranks = |index: usize| {
            let family = &self.families[index];
            let ranks = 0..family.ranks.len();
            ranks.map(|rank| family.threshold(&below, rank)).collect()
        };
        let count = self.families.len();
        let outline = Outline {
            functions: self.families.iter().map(|g| g.function(&below)).collect(),
            thresholds: (0..count).map(ranks).collect(),
            system: sliding.map_or(below, |sliding| sliding.system),
        };
        self.outlines.push(outline);
        let index = self.outlines.len() - 1;
        self.outlined.insert(cells.to_vec(), index);
        index
    }
}

impl Outline {
    /// Returns the cell of a family whose function is constant while the inputs are held; `None` if it varies.
    pub fn find_constant_cell(&self, family: usize, inputs: &[f64]) -> Option<Cell> {
        let function = &self.functions[family];
        function
            .is_still()
            .then(|| self.cell_at(family, function.value(&[], inputs, &[])))
    }

    /// Returns the cell for a value of the family's function. A value equal to a threshold counts as below it.
    pub fn cell_at(&self, family: usize, value: f64) -> Cell {
        let thresholds = self.thresholds[family].iter();
        Cell::Between(thresholds.filter(|threshold| value > **threshold).count())
    }

    /// Returns true if a family has the same function and thresholds as in another outline.
    pub fn has_same_function(&self, other: &Self, family: usize) -> bool {
        self.functions[family] == other.functions[family]
            && self.thresholds[family] == other.thresholds[family]
    }

    /// Returns the rate of a function due to the rates of the state, and the rounding error of this rate.
    pub fn rate(&self, function: &Linear, point: StateAt<'_>) -> (f64, f64) {
        let Rates { values, sizes } = self.rates(point);
        let factors = function.state.iter();
        let rate = factors.clone().zip(values).map(|(a, b)| a * b).sum();
        let size: f64 = factors.zip(sizes).map(|(a, b)| (a * b).abs()).sum();
        (rate, ROUNDING * size)
    }

    /// Returns the rates of the state.
    pub fn rates(&self, point: StateAt<'_>) -> Rates {
        let StateAt {
            state,
            inputs,
            phases,
        } = point;
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
