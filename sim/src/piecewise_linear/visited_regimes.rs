//! Regimes of a model: each is created when a motion first enters it, and kept. Also determines the regime in
//! which a motion starts.

use nalgebra::Complex;

use super::adjacent_regimes::AdjacentRegime;
use super::clock::Clock;
use super::coincidence::factor;
use super::decomposition::DecompositionError;
use super::dependents::{DecisionCause, StateAt};
use super::error::ExactError;
use super::event_function::{Limits, Linear};
use super::parallel_guards::Cell;
use super::propagator::Propagator;
use super::regime::Regime;
use super::sliding::derive_sliding;

/// A regime that a motion has entered. Hybrid systems theory calls it a *mode*; here modes are vibration modes.
pub(super) struct VisitedRegime {
    pub cells: Vec<Cell>,
    pub regime: Regime,
    /// Function of each family in this regime.
    pub functions: Vec<Linear>,
    /// Step-table index at which the last search ended.
    pub step: usize,
    /// Adjacent regime for each function and limit, once known.
    pub adjacent: Vec<[Option<AdjacentRegime>; 2]>,
}

impl Propagator {
    /// Returns the index of the regime with these cells; creates it if necessary.
    pub(super) fn regime(&mut self, cells: &[Cell], t: f64) -> Result<usize, ExactError> {
        if let Some(&known) = self.known.get(cells) {
            return Ok(known);
        }
        let mut sides = vec![0.0; self.evaluator.guard_count()];
        let held = cells.iter().position(|cell| matches!(cell, Cell::On(_)));
        let (system, mut parts) = match held {
            None => {
                for (family, cell) in self.families.iter().zip(cells) {
                    family.write_sides(*cell, 0.0, &mut sides);
                }
                (self.evaluator.system(&sides), Vec::new())
            }
            Some(family) => {
                let guard = self.families[family].first;
                if self.has_dependents()
                    && (0..cells.len()).any(|family| self.affects_other_functions(cells, family))
                {
                    return Err(ExactError::Sticking { t, guard });
                }
                let sliding = derive_sliding(&mut self.evaluator, &self.families, cells)
                    .ok_or(ExactError::Sticking { t, guard })?;
                (sliding.system, sliding.parts)
            }
        };
        let functions: Vec<Linear> = self
            .families
            .iter()
            .map(|family| family.function(&system))
            .collect();
        let mut events = Vec::new();
        for (index, (family, cell)) in self.families.iter().zip(cells).enumerate() {
            events.push(match cell {
                Cell::Between(above) => {
                    let function = functions[index].clone();
                    let limits = if self.is_at_rest(&functions, cells, index) {
                        Limits::none(index)
                    } else {
                        family.limits(&system, index, *above)
                    };
                    (function, limits)
                }
                Cell::AtLimit(..) => (functions[index].clone(), Limits::none(index)),
                Cell::On(_) => (
                    parts.remove(0),
                    Limits {
                        family: index,
                        low: 0.0,
                        high: 1.0,
                    },
                ),
            });
        }
        let regime = Regime::new(system, events, self.slow).map_err(|failure| match failure {
            DecompositionError::NotFinite => ExactError::NotFinite,
            DecompositionError::NotConverged => ExactError::NotConverged,
        })?;
        let adjacent = vec![[None; 2]; regime.event_functions.len()];
        self.regimes.push(VisitedRegime {
            cells: cells.to_vec(),
            regime,
            functions,
            step: 0,
            adjacent,
        });
        let index = self.regimes.len() - 1;
        self.known.insert(cells.to_vec(), index);
        Ok(index)
    }

    /// Returns true if a function is constant in the regime with these cells: it does not depend on state and
    /// time, or it is proportional to a held function.
    fn is_at_rest(&self, functions: &[Linear], cells: &[Cell], family: usize) -> bool {
        let held = |(other, cell): (&Linear, &Cell)| {
            matches!(cell, Cell::On(_)) && factor(&functions[family], other).is_some()
        };
        let mut others = functions.iter().zip(cells);
        self.has_dependents()
            && (self.dependent[family] && functions[family].is_still() || others.any(held))
    }

    /// Returns the cells of all families at a state, and the families and ranks of thresholds that are met
    /// exactly. A value on a threshold counts as below it.
    pub(super) fn find_cells_at(
        &mut self,
        state: &[f64],
        inputs: &[f64],
        phases: &[Complex<f64>],
    ) -> (Vec<Cell>, Vec<(usize, usize)>) {
        let mut sides = vec![0.0; self.evaluator.guard_count()];
        let mut cells = vec![Cell::Between(0); self.families.len()];
        let mut tied = Vec::new();
        // A function may depend on the cells of others, so this repeats until all agree.
        for _ in 0..=self.families.len() {
            for (family, cell) in self.families.iter().zip(&cells) {
                family.write_sides(*cell, 0.0, &mut sides);
            }
            let system = self.evaluator.system(&sides);
            tied.clear();
            let mut found = Vec::new();
            for (index, family) in self.families.iter().enumerate() {
                let value = family.function(&system).value(state, inputs, phases);
                let mut above = 0;
                for rank in 0..family.ranks.len() {
                    let threshold = family.threshold(&system, rank);
                    if (value - threshold).abs() <= 4.0 * f64::EPSILON * threshold.abs() {
                        tied.push((index, rank));
                    } else if value > threshold {
                        above = rank + 1;
                    }
                }
                found.push(Cell::Between(above));
            }
            if found == cells {
                break;
            }
            cells = found;
        }
        (cells, tied)
    }

    /// Returns the regime of a motion that starts at a state.
    pub(super) fn find_regime_at(
        &mut self,
        clock: Clock,
        state: &[f64],
        inputs: &[f64],
    ) -> Result<usize, ExactError> {
        let phases = self.phases_at(clock);
        if self.has_dependents() {
            let point = StateAt {
                state,
                inputs,
                phases: &phases,
            };
            let mut cells = vec![Cell::Between(0); self.families.len()];
            self.determine_cells(&mut cells, DecisionCause::Start, point);
            return self.regime(&cells, clock.time());
        }
        let (mut cells, tied) = self.find_cells_at(state, inputs, &phases);
        if tied.len() > 1 {
            let point = StateAt {
                state,
                inputs,
                phases: &phases,
            };
            if let Some(cells) = self.start_together(&cells, &tied, point) {
                return self.regime(&cells, clock.time());
            }
        }
        let mut found = self.regime(&cells, clock.time())?;
        for (family, rank) in tied {
            let mut side = |propagator: &mut Self, cell: Cell| {
                cells[family] = cell;
                propagator.regime(&cells, clock.time())
            };
            let (down, up) = (
                side(self, Cell::Between(rank))?,
                side(self, Cell::Between(rank + 1))?,
            );
            let below = self.rate(down, family, state, inputs, &phases);
            let above = self.rate(up, family, state, inputs, &phases);
            found = if above > 0.0 && below >= 0.0 {
                side(self, Cell::Between(rank + 1))?
            } else if above < 0.0 && below > 0.0 {
                side(self, Cell::On(rank))?
            } else {
                side(self, Cell::Between(rank))?
            };
        }
        Ok(found)
    }
}
