//! Surfaces whose functions depend on the sides of other surfaces, as in sign(deadzone(p, b)), or only on
//! inputs. Such a function can be constant within a regime and equal to a threshold. It then has no side and
//! needs no search. Its cell is determined again whenever another surface is crossed or an input jumps: by its
//! value, and on a threshold by its rates.

use nalgebra::Complex;

use super::coincidence::{Crossing, find_coincident_rank};
use super::parallel_guards::Cell;
use super::propagator::Propagator;

/// Largest difference between a value and its threshold that counts as zero, as a fraction of the magnitude of
/// its terms.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// State, inputs and phases at which cells are determined.
#[derive(Clone, Copy)]
pub(super) struct StateAt<'a> {
    pub state: &'a [f64],
    pub inputs: &'a [f64],
    pub phases: &'a [Complex<f64>],
}

/// Reason why cells are determined again.
#[derive(Clone, Copy)]
pub(super) enum DecisionCause<'a> {
    /// Start of a motion.
    Start,
    /// Jump of inputs, or of a function over its limit, in the regime with this outline.
    Jump(usize),
    /// Crossing of a surface.
    Crossing(&'a Crossing),
}

impl Propagator {
    /// Returns true if any surface depends on other surfaces.
    pub(super) fn has_dependents(&self) -> bool {
        self.dependent.contains(&true)
    }

    /// Determines the cells of dependent functions, at a start of all functions, in the order of the families.
    /// Repeats this until the cells agree with each other, at most once per family and once more.
    pub(super) fn determine_cells(
        &mut self,
        cells: &mut [Cell],
        cause: DecisionCause<'_>,
        point: StateAt<'_>,
    ) {
        for _ in 0..=cells.len() {
            let before = cells.to_vec();
            for family in 0..cells.len() {
                if self.dependent[family] || matches!(cause, DecisionCause::Start) {
                    cells[family] = self.decide_cell(family, cells, cause, point);
                }
            }
            if cells == before {
                return;
            }
        }
    }

    /// Determines the cells of dependent functions that are constant throughout their regime.
    pub(super) fn determine_constant_cells(&mut self, cells: &mut [Cell], point: StateAt<'_>) {
        for _ in 0..=cells.len() {
            let before = cells.to_vec();
            for family in 0..cells.len() {
                if self.dependent[family] {
                    let outline = self.outline(cells);
                    if let Some(cell) =
                        self.outlines[outline].find_constant_cell(family, point.inputs)
                    {
                        cells[family] = cell;
                    }
                }
            }
            if cells == before {
                return;
            }
        }
    }

    /// Returns true if the function of another family depends on the side of a family that is held on its
    /// threshold. The other family may then be in different cells on the two sides, and no combination of two
    /// regimes describes the motion.
    pub(super) fn affects_other_functions(&mut self, cells: &[Cell], family: usize) -> bool {
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
        (0..cells.len()).any(|other| !below.has_same_function(above, other))
    }

    fn decide_cell(
        &mut self,
        family: usize,
        cells: &[Cell],
        cause: DecisionCause<'_>,
        point: StateAt<'_>,
    ) -> Cell {
        let present = cells[family];
        let here = self.outline(cells);
        let outline = &self.outlines[here];
        if let Some(cell) = outline.find_constant_cell(family, point.inputs) {
            return cell;
        }
        let before = match cause {
            DecisionCause::Start => None,
            DecisionCause::Jump(before) => Some(before),
            DecisionCause::Crossing(crossing) => {
                if crossing.family == family {
                    return present;
                }
                if let Some((rank, _)) = find_coincident_rank(outline, family, crossing) {
                    return self.decide_cell_by_rates(family, rank, cells, point);
                }
                Some(crossing.outline)
            }
        };
        if before.is_some_and(|before| outline.has_same_function(&self.outlines[before], family)) {
            return present;
        }
        let function = &outline.functions[family];
        let value = function.value(point.state, point.inputs, point.phases);
        let thresholds = &outline.thresholds[family];
        let size = match before {
            // The start is on a threshold only if the value equals it exactly.
            None => 0.0,
            Some(_) => function.size(point.state, point.inputs, point.phases),
        };
        let tied = thresholds.iter().position(|threshold| {
            (value - threshold).abs() <= ROUNDING * size.max(threshold.abs())
        });
        match tied {
            Some(rank) if before.is_some() && is_beside(present, rank) => present,
            Some(rank) => self.decide_cell_by_rates(family, rank, cells, point),
            None => outline.cell_at(family, value),
        }
    }

    /// Returns the cell into which the rates on both sides of a threshold move a function that is on the
    /// threshold.
    fn decide_cell_by_rates(
        &mut self,
        family: usize,
        rank: usize,
        cells: &[Cell],
        point: StateAt<'_>,
    ) -> Cell {
        let mut with = |cell: Cell| {
            let mut cells = cells.to_vec();
            cells[family] = cell;
            self.determine_constant_cells(&mut cells, point);
            cells[family] = cell;
            let outline = self.outline(&cells);
            self.rate_in(outline, &self.outlines[outline].functions[family], point)
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

/// Returns true if a threshold bounds a cell.
fn is_beside(cell: Cell, rank: usize) -> bool {
    match cell {
        Cell::Between(above) => above == rank || above == rank + 1,
        Cell::On(on) | Cell::AtLimit(on, _) => on == rank,
    }
}
