//! Switching surfaces in groups of parallel ones, and where a motion stands among them.

use codegen::program::affine::{AffineEvaluator, AffineSystem};

use super::functional::{Limits, Linear};

/// Parallel switching surfaces: thresholds of one linear function.
#[derive(Clone, Debug)]
pub(super) struct Group {
    /// The first surface: the others differ from it by constants.
    pub first: usize,
    /// The surfaces at each distinct threshold, in ascending order of the thresholds.
    pub ranks: Vec<Vec<usize>>,
}

/// Where a motion stands within a group.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) enum Place {
    /// Above as many thresholds as the number says, below the others.
    Between(usize),
    /// Held on the threshold of this rank.
    On(usize),
}

impl Place {
    /// The place beyond a limit, the upper or the lower one.
    pub fn beyond(self, upper: bool) -> Self {
        match (self, upper) {
            (Self::Between(above), true) => Self::Between(above + 1),
            (Self::Between(above), false) => Self::Between(above - 1),
            (Self::On(rank), true) => Self::Between(rank + 1),
            (Self::On(rank), false) => Self::Between(rank),
        }
    }
}

/// The groups of a model's surfaces at its present parameters.
pub(super) fn groups(evaluator: &AffineEvaluator, system: &AffineSystem) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for (guard, &first) in evaluator.guard_groups().iter().enumerate() {
        let threshold = |guard: usize| -system.guards.constant[guard];
        match groups.iter_mut().find(|group| group.first == first) {
            None => groups.push(Group {
                first,
                ranks: vec![vec![guard]],
            }),
            Some(group) => {
                let place = group
                    .ranks
                    .iter()
                    .position(|rank| threshold(rank[0]) >= threshold(guard));
                match place {
                    Some(place) if threshold(group.ranks[place][0]) == threshold(guard) => {
                        group.ranks[place].push(guard);
                    }
                    Some(place) => group.ranks.insert(place, vec![guard]),
                    None => group.ranks.push(vec![guard]),
                }
            }
        }
    }
    groups
}

impl Group {
    /// Writes the sides of the group's surfaces; `held` is that of those it is held on.
    pub fn write_sides(&self, place: Place, held: f64, sides: &mut [f64]) {
        for (rank, guards) in self.ranks.iter().enumerate() {
            let side = match place {
                Place::Between(above) => f64::from(u8::from(rank < above)),
                Place::On(on) if on == rank => held,
                Place::On(on) => f64::from(u8::from(rank < on)),
            };
            for guard in guards {
                sides[*guard] = side;
            }
        }
    }

    /// The function whose thresholds the surfaces are.
    pub fn function(&self, system: &AffineSystem) -> Linear {
        let mut linear = Linear::row(&system.guards, self.first);
        linear.constant = 0.0;
        linear
    }

    /// The threshold of a rank.
    pub fn threshold(&self, system: &AffineSystem, rank: usize) -> f64 {
        -system.guards.constant[self.ranks[rank][0]]
    }

    /// What bounds the function above so many thresholds.
    pub fn limits(&self, system: &AffineSystem, group: usize, above: usize) -> Limits {
        Limits {
            group,
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
