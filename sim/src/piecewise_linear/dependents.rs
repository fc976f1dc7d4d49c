//! Surfaces whose functions depend on the sides of others, as that of sign(deadzone(p, b)) does, or
//! only on inputs. Such a function can be constant within a regime and equal to a threshold. It
//! then has no side and needs no search. Whenever another surface is crossed, or an input jumps,
//! the cell of the function is determined again: by its value, and on a threshold by its rates.

use nalgebra::Complex;

use super::coincidence::{Crossing, coincident_rank};
use super::parallel_guards::Cell;
use super::propagator::Propagator;

/// A value is on a threshold if it differs by no more than this part of its terms.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// State of a motion when cells are determined.
#[derive(Clone, Copy)]
pub(super) struct StateAt<'a> {
    pub state: &'a [f64],
    pub inputs: &'a [f64],
    pub phases: &'a [Complex<f64>],
}

/// Reason for a decision.
#[derive(Clone, Copy)]
pub(super) enum DecisionCause<'a> {
    /// A motion that begins.
    Start,
    /// Inputs that changed, or a function that a jump led over its limit, in the regime with
    /// this outline.
    Jump(usize),
    /// A surface that is crossed.
    Crossing(&'a Crossing),
}

impl Propagator {
    /// Returns true if any surface depends on others.
    pub(super) fn has_dependents(&self) -> bool {
        self.dependent.contains(&true)
    }

    /// Decides the cells of dependent functions, and of all at a start, inner ones first; until
    /// they agree with each other, or as often as there are any.
    pub(super) fn settle(
        &mut self,
        cells: &mut [Cell],
        asking: DecisionCause<'_>,
        standing: StateAt<'_>,
    ) {
        for _ in 0..=cells.len() {
            let before = cells.to_vec();
            for family in 0..cells.len() {
                if self.dependent[family] || matches!(asking, DecisionCause::Start) {
                    cells[family] = self.decide_cell(family, cells, asking, standing);
                }
            }
            if cells == before {
                return;
            }
        }
    }

    /// Decides only those that have one value throughout the regime with these cells.
    pub(super) fn settle_resting(&mut self, cells: &mut [Cell], standing: StateAt<'_>) {
        for _ in 0..=cells.len() {
            let before = cells.to_vec();
            for family in 0..cells.len() {
                if self.dependent[family] {
                    let outline = self.outline(cells);
                    if let Some(cell) = self.outlines[outline].resting(family, standing.inputs) {
                        cells[family] = cell;
                    }
                }
            }
            if cells == before {
                return;
            }
        }
    }

    /// Returns true if any function feels on which side of its threshold a family is that is held
    /// there: others may then be in other cells on either side, and no combination of two regimes
    /// tells the motion.
    pub(super) fn is_felt(&mut self, cells: &[Cell], family: usize) -> bool {
        let Cell::On(rank) = cells[family] else {
            return false;
        };
        let mut beside = |cell: Cell| {
            let mut cells = cells.to_vec();
            cells[family] = cell;
            self.outline(&cells)
        };
        let [below, above] = [Cell::Between(rank), Cell::Between(rank + 1)].map(&mut beside);
        let (below, above) = (&self.outlines[below], &self.outlines[above]);
        (0..cells.len()).any(|other| !below.same_function(above, other))
    }

    fn decide_cell(
        &mut self,
        family: usize,
        cells: &[Cell],
        asking: DecisionCause<'_>,
        standing: StateAt<'_>,
    ) -> Cell {
        let present = cells[family];
        let here = self.outline(cells);
        let outline = &self.outlines[here];
        if let Some(cell) = outline.resting(family, standing.inputs) {
            return cell;
        }
        let before = match asking {
            DecisionCause::Start => None,
            DecisionCause::Jump(before) => Some(before),
            DecisionCause::Crossing(crossing) => {
                if crossing.family == family {
                    return present;
                }
                if let Some((rank, _)) = coincident_rank(outline, family, crossing) {
                    return self.follow_rates(family, rank, cells, standing);
                }
                Some(crossing.outline)
            }
        };
        if before.is_some_and(|before| outline.same_function(&self.outlines[before], family)) {
            return present;
        }
        let function = &outline.functions[family];
        let value = function.value(standing.state, standing.inputs, standing.phases);
        let thresholds = &outline.thresholds[family];
        let size = match before {
            // A motion begins where it is said to.
            None => 0.0,
            Some(_) => function.size(standing.state, standing.inputs, standing.phases),
        };
        let tied = thresholds.iter().position(|threshold| {
            (value - threshold).abs() <= ROUNDING * size.max(threshold.abs())
        });
        match tied {
            Some(rank) if before.is_some() && is_beside(present, rank) => present,
            Some(rank) => self.follow_rates(family, rank, cells, standing),
            None => outline.cell_at(family, value),
        }
    }

    /// Returns the cell into which the rates on both sides of a threshold lead a function that is
    /// on it.
    fn follow_rates(
        &mut self,
        family: usize,
        rank: usize,
        cells: &[Cell],
        standing: StateAt<'_>,
    ) -> Cell {
        let mut with = |cell: Cell| {
            let mut cells = cells.to_vec();
            cells[family] = cell;
            self.settle_resting(&mut cells, standing);
            cells[family] = cell;
            let outline = self.outline(&cells);
            self.rate_in(outline, &self.outlines[outline].functions[family], standing)
        };
        let (below, slack_below) = with(Cell::Between(rank));
        let (above, slack_above) = with(Cell::Between(rank + 1));
        let slack = slack_below.max(slack_above);
        if above > slack && below >= -slack || below > slack && above >= -slack {
            Cell::Between(rank + 1)
        } else if above < -slack && below > slack {
            Cell::On(rank)
        } else if below < -slack && above <= slack || !is_beside(cells[family], rank) {
            Cell::Between(rank)
        } else {
            cells[family]
        }
    }
}

/// Returns true if a cell borders on a threshold.
fn is_beside(cell: Cell, rank: usize) -> bool {
    match cell {
        Cell::Between(above) => above == rank || above == rank + 1,
        Cell::On(on) | Cell::Bearing(on, _) => on == rank,
    }
}
