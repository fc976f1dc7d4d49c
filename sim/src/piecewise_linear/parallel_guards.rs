//! Families of parallel switching surfaces, and the position (cell) of a motion relative to the surfaces of
//! each family.

use eomgen_codegen::program::affine::{AffineEvaluator, AffineSystem};

use super::event_function::{Limits, Linear};
use crate::ode::{Event, SurfaceMode};

/// Family of parallel switching surfaces: thresholds of one linear function.
#[derive(Clone, Debug)]
pub(super) struct ParallelGuards {
    /// First surface; the functions of the others differ from its function by constants.
    pub first: usize,
    /// Indices of the surfaces at each distinct threshold, in ascending order of the thresholds (rank).
    pub ranks: Vec<Vec<usize>>,
}

/// Position of a motion relative to the thresholds of a family.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) enum Cell {
    /// Above this number of thresholds, below the others.
    Between(usize),
    /// Held on the threshold of this rank.
    On(usize),
    /// On the threshold of this rank, where other surfaces hold the motion; true on its upper side. The surface
    /// exerts its maximum force.
    AtLimit(usize, bool),
}

impl Cell {
    /// Returns the cell beyond the upper or the lower limit of this cell.
    pub fn adjacent(self, upper: bool) -> Self {
        match (self, upper) {
            (Self::Between(above), true) => Self::Between(above + 1),
            (Self::Between(above), false) => Self::Between(above - 1),
            (Self::On(rank) | Self::AtLimit(rank, _), true) => Self::Between(rank + 1),
            (Self::On(rank) | Self::AtLimit(rank, _), false) => Self::Between(rank),
        }
    }

    /// Returns the rank of the threshold that the function equals, if any.
    pub fn threshold_rank(self) -> Option<usize> {
        match self {
            Self::Between(_) => None,
            Self::On(rank) | Self::AtLimit(rank, _) => Some(rank),
        }
    }
}

/// Finds the families of a model's surfaces at its current parameters.
pub(super) fn find_families(
    evaluator: &AffineEvaluator,
    system: &AffineSystem,
) -> Vec<ParallelGuards> {
    let mut families: Vec<ParallelGuards> = Vec::new();
    for (guard, &first) in evaluator.guard_groups().iter().enumerate() {
        let threshold = |guard: usize| -system.guards.constant[guard];
        match families.iter_mut().find(|family| family.first == first) {
            None => families.push(ParallelGuards {
                first,
                ranks: vec![vec![guard]],
            }),
            Some(family) => {
                let found = family
                    .ranks
                    .iter()
                    .position(|rank| threshold(rank[0]) >= threshold(guard));
                match found {
                    Some(rank) if threshold(family.ranks[rank][0]) == threshold(guard) => {
                        family.ranks[rank].push(guard);
                    }
                    Some(rank) => family.ranks.insert(rank, vec![guard]),
                    None => family.ranks.push(vec![guard]),
                }
            }
        }
    }
    families
}

impl ParallelGuards {
    /// Writes the sides of the family's surfaces: 0 below, 1 above. A surface that holds the motion gets
    /// `held`.
    pub fn write_sides(&self, cell: Cell, held: f64, sides: &mut [f64]) {
        for (rank, guards) in self.ranks.iter().enumerate() {
            let side = match cell {
                Cell::Between(above) => f64::from(u8::from(rank < above)),
                Cell::On(on) if on == rank => held,
                Cell::AtLimit(on, upper) if on == rank => f64::from(u8::from(upper)),
                Cell::On(on) | Cell::AtLimit(on, _) => f64::from(u8::from(rank < on)),
            };
            for guard in guards {
                sides[*guard] = side;
            }
        }
    }

    /// Returns the mode of the surfaces at a rank.
    pub fn mode(&self, cell: Cell, rank: usize) -> SurfaceMode {
        let is_positive = match cell {
            Cell::On(on) | Cell::AtLimit(on, _) if on == rank => return SurfaceMode::Held,
            Cell::Between(above) => rank < above,
            Cell::On(on) | Cell::AtLimit(on, _) => rank < on,
        };
        SurfaceMode::from_side(if is_positive { 1.0 } else { -1.0 })
    }

    /// Returns the surfaces whose mode differs between two cells, as events at a time (s).
    pub fn mode_changes(&self, from: Cell, to: Cell, t: f64) -> impl Iterator<Item = Event> {
        let guards = self.ranks.iter().enumerate();
        let guards =
            guards.flat_map(|(rank, guards)| guards.iter().map(move |guard| (rank, *guard)));
        let events = guards.map(move |(rank, guard)| Event {
            t,
            guard,
            from: self.mode(from, rank),
            to: self.mode(to, rank),
        });
        events.filter(|event| event.from != event.to)
    }

    /// Returns the common function of the surfaces, without its constant.
    pub fn function(&self, system: &AffineSystem) -> Linear {
        let mut linear = Linear::row(&system.guards, self.first);
        linear.constant = 0.0;
        linear
    }

    /// Returns the threshold of a rank.
    pub fn threshold(&self, system: &AffineSystem, rank: usize) -> f64 {
        -system.guards.constant[self.ranks[rank][0]]
    }

    /// Returns the limits of a function that is above this number of thresholds.
    pub fn limits(&self, system: &AffineSystem, family: usize, above: usize) -> Limits {
        Limits {
            family,
            low: match above {
                0 => f64::NEG_INFINITY,
                _ => self.threshold(system, above - 1),
            },
            high: match self.ranks.get(above) {
                None => f64::INFINITY,
                Some(_) => self.threshold(system, above),
            },
        }
    }
}
