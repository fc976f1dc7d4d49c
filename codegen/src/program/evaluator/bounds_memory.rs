//! Memory for the bounds of values.

use super::enclosure::Enclosure;
use crate::program::{Program, ValueId};

/// Bounds of the values in some stages.
pub(super) struct BoundsMemory {
    /// Index of the first bound of each value; `None` for values without memory.
    places: Vec<Option<usize>>,
    bounds: Vec<Enclosure>,
}

impl BoundsMemory {
    /// Allocates memory for the steps of the stages.
    pub(super) fn new(program: &Program, steps: [&[ValueId]; 3]) -> Self {
        let mut places = vec![None; program.values.len()];
        let mut size = 0;
        for id in steps.into_iter().flatten() {
            if places[id.index()].is_none() {
                places[id.index()] = Some(size);
                size += program.value(*id).extent.length();
            }
        }
        Self {
            places,
            bounds: vec![Enclosure::UNKNOWN; size],
        }
    }

    /// Returns the bounds of an element of a value; [`Enclosure::UNKNOWN`] for a value without memory.
    pub(super) fn bound(&self, id: ValueId, index: usize) -> Enclosure {
        let place = self.places[id.index()];
        place.map_or(Enclosure::UNKNOWN, |place| self.bounds[place + index])
    }

    /// Sets the bounds of an element of a value.
    pub(super) fn set_bound(&mut self, id: ValueId, index: usize, bound: Enclosure) {
        if let Some(place) = self.places[id.index()] {
            self.bounds[place + index] = bound;
        }
    }
}
