//! Transition at a surface: into the regime beyond it, or onto the surface if the rates beyond it point back.

use super::coincidence::{Crossing, find_coincident_rank};
use super::dependents::{DecisionCause, StateAt};
use super::error::ExactError;
use super::event_function::Linear;
use super::parallel_guards::Cell;
use super::propagator::Propagator;
use super::saltation;

/// A limit that a motion has reached.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limit {
    /// Index of the regime that the motion leaves.
    pub before: usize,
    /// Index of the function that reached its limit, and of its family.
    pub event_function: usize,
    pub family: usize,
    /// True for the upper limit.
    pub upper: bool,
    /// True if a jump exceeded the limit.
    pub by_jump: bool,
    /// Time, s.
    pub t: f64,
}

/// Continuation of a motion after a limit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Transition {
    /// Index of the regime that the motion enters.
    pub after: usize,
    /// Index of the saltation matrix, if it is constant.
    pub saltation: Option<usize>,
    /// True if functions of other families may jump.
    pub moves_others: bool,
}

impl Limit {
    /// Returns the rank of the reached threshold, given the cell of its family.
    pub fn rank(&self, cell: Cell) -> usize {
        match (cell, self.upper) {
            (Cell::Between(above), true) => above,
            (Cell::Between(above), false) => above - 1,
            (Cell::On(rank) | Cell::AtLimit(rank, _), _) => rank,
        }
    }

    /// Returns the side of the surface beyond the limit, 1 or -1.
    pub fn outward(&self) -> f64 {
        if self.upper { 1.0 } else { -1.0 }
    }
}

impl Propagator {
    /// Determines the transition of a motion at a limit of its regime.
    pub(super) fn transition(
        &mut self,
        limit: &Limit,
        point: StateAt<'_>,
    ) -> Result<Transition, ExactError> {
        if self.has_dependents() {
            let after = self.adjacent_with_dependents(limit, point)?;
            return Ok(Transition {
                after,
                saltation: self.saltation(limit, after),
                moves_others: true,
            });
        }
        let Limit { before, family, .. } = *limit;
        let known = self.regimes[before].adjacent[limit.event_function][usize::from(limit.upper)];
        let adjacent = match known {
            Some(adjacent) => adjacent,
            None => self.find_adjacent(limit)?,
        };
        let mut transition = Transition {
            after: adjacent.regime,
            saltation: adjacent.saltation,
            moves_others: adjacent.moves_others,
        };
        if adjacent.meets_others
            && let Some(cells) = self.decide_simultaneously(limit, point)
        {
            transition.after = self.regime(&cells, limit.t)?;
            transition.saltation = None;
            transition.moves_others = true;
        } else if adjacent.jumps && !limit.by_jump {
            let StateAt {
                state,
                inputs,
                phases,
            } = point;
            let rate = |index: usize| self.rate(index, family, state, inputs, phases);
            let (here, there) = (rate(before), rate(adjacent.regime));
            // A motion that has just left the surface, or barely reaches it, has a rate within rounding.
            let slack = self.rate_rounding(adjacent.regime, family, state);
            if there * limit.outward() < -slack && here * limit.outward() > -slack {
                let mut cells = self.regimes[before].cells.clone();
                cells[family] = Cell::On(limit.rank(cells[family]));
                transition.after = self.regime(&cells, limit.t)?;
                transition.saltation = None;
                transition.moves_others = true;
            }
        }
        Ok(transition)
    }

    /// Returns the regime beyond a limit if functions depend on the sides of other surfaces.
    fn adjacent_with_dependents(
        &mut self,
        limit: &Limit,
        point: StateAt<'_>,
    ) -> Result<usize, ExactError> {
        let family = limit.family;
        let cells = self.regimes[limit.before].cells.clone();
        let outline = self.outline(&cells);
        let rank = limit.rank(cells[family]);
        let crossing = Crossing {
            family,
            function: self.outlines[outline].functions[family].clone(),
            threshold: self.outlines[outline].thresholds[family][rank],
            outline,
        };
        let mut after = cells.clone();
        after[family] = cells[family].adjacent(limit.upper);
        if limit.by_jump {
            self.determine_cells(&mut after, DecisionCause::Jump(outline), point);
            return self.regime(&after, limit.t);
        }
        self.determine_cells(&mut after, DecisionCause::Crossing(&crossing), point);
        if matches!(cells[family], Cell::Between(_))
            && self.points_back(limit, &crossing, &after, point)
        {
            let held = self.find_held_cells(limit, &crossing, &cells, point);
            let (t, guard) = (limit.t, self.families[family].ranks[rank][0]);
            let held = held.ok_or(ExactError::Sticking { t, guard })?;
            return self.regime(&held, limit.t);
        }
        self.regime(&after, limit.t)
    }

    /// Returns true if the rates beyond a surface point back to it and the rates before it point towards it.
    fn points_back(
        &mut self,
        limit: &Limit,
        crossing: &Crossing,
        after: &[Cell],
        point: StateAt<'_>,
    ) -> bool {
        let after = self.outline(after);
        let (here, _) = self.rate_in(crossing.outline, &crossing.function, point);
        let (there, slack) = self.rate_in(after, &crossing.function, point);
        there * limit.outward() < -slack && here * limit.outward() > -slack
    }

    /// Returns the cells held on the surface whose rates point back. This is the crossed surface or, among
    /// coincident surfaces, the outermost one whose side alone has this effect.
    fn find_held_cells(
        &mut self,
        limit: &Limit,
        crossing: &Crossing,
        cells: &[Cell],
        point: StateAt<'_>,
    ) -> Option<Vec<Cell>> {
        let others = (0..cells.len())
            .rev()
            .filter(|index| *index != limit.family);
        for index in std::iter::once(limit.family).chain(others) {
            if index != limit.family && !self.dependent[index] {
                continue;
            }
            let outline = &self.outlines[crossing.outline];
            let Some((rank, factor)) = find_coincident_rank(outline, index, crossing) else {
                continue;
            };
            let upper = limit.upper == (factor > 0.0);
            let inside = Cell::Between(if upper { rank } else { rank + 1 });
            if cells[index] != inside {
                continue;
            }
            let mut alone = cells.to_vec();
            alone[index] = inside.adjacent(upper);
            if self.points_back(limit, crossing, &alone, point) {
                alone[index] = Cell::On(rank);
                return (!self.affects_other_functions(&alone, index)).then_some(alone);
            }
        }
        None
    }

    /// Returns the rate of a function in an outline, and its rounding error.
    pub(super) fn rate_in(
        &self,
        outline: usize,
        function: &Linear,
        point: StateAt<'_>,
    ) -> (f64, f64) {
        let (rate, rounding) = self.outlines[outline].rate(function, point);
        (rate + self.explicit_rate(function, point.phases), rounding)
    }

    /// Returns the index of the saltation matrix of a transition, if it is constant.
    fn saltation(&mut self, limit: &Limit, after: usize) -> Option<usize> {
        let key = (limit.before, limit.event_function, limit.upper, after);
        if let Some(&known) = self.saltation_of.get(&key) {
            return known;
        }
        let visited = &self.regimes[limit.before];
        let event_function = &visited.regime.event_functions[limit.event_function];
        let limits = &event_function.limits;
        let held = matches!(self.regimes[after].cells[limit.family], Cell::On(_));
        let constant = saltation::find_constant_saltation(
            &visited.regime.system,
            &self.regimes[after].regime.system,
            &event_function.linear,
            if limit.upper { limits.high } else { limits.low },
        );
        let kept = constant.filter(|_| !held).map(|u| {
            self.saltations.push(u);
            self.saltations.len() - 1
        });
        self.saltation_of.insert(key, kept);
        kept
    }
}
