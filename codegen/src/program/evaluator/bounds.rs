//! Bounds of observables, switching functions and distances of impacts over a time interval, by interval arithmetic
//! with rates (R. E. Moore, *Methods and Applications of Interval Analysis*, mean-value form).

use super::bounds_memory::BoundsMemory;
use super::enclosure::Enclosure;
use super::{Evaluator, Stage};
use crate::program::{Arguments, Extent, Op, ValueId};

/// Bounds of time, state and inputs over a time interval.
#[derive(Clone, Copy, Debug)]
pub struct Stretch<'a> {
    /// Time in s.
    pub t: Enclosure,
    /// State: coordinates, modes, the rates of both, first-order states.
    pub state: &'a [Enclosure],
    /// Inputs in the order of the program.
    pub inputs: &'a [Enclosure],
}

impl Evaluator {
    /// Writes the bounds of the switching functions to `out`, [`Evaluator::guard_count`] entries.
    pub fn bound_guards(&mut self, stretch: &Stretch<'_>, out: &mut [Enclosure]) {
        self.compute_bounds(Stage::Guards, stretch);
        let guards = self.program.guards.iter().map(|guard| guard.value);
        self.copy_bounds(guards, out);
    }

    /// Writes the bounds of the distances of impacts to `out`, one entry for each impact.
    pub fn bound_distances(&mut self, stretch: &Stretch<'_>, out: &mut [Enclosure]) {
        self.compute_bounds(Stage::Distances, stretch);
        let distances = self.program.impacts.iter().map(|impact| impact.distance);
        self.copy_bounds(distances, out);
    }

    /// Writes the bounds of the observables to `out`, in their order.
    pub fn bound_observables(&mut self, stretch: &Stretch<'_>, out: &mut [Enclosure]) {
        self.compute_bounds(Stage::Observables, stretch);
        let observables = self.program.observable_values.iter().copied();
        self.copy_bounds(observables, out);
    }

    fn copy_bounds(&self, ids: impl Iterator<Item = ValueId>, out: &mut [Enclosure]) {
        let length = |id: ValueId| self.program.value(id).extent.length();
        let numbers = ids.flat_map(|id| (0..length(id)).map(move |index| (id, index)));
        for (slot, (id, index)) in out.iter_mut().zip(numbers) {
            *slot = self.bound(id, index);
        }
    }

    fn compute_bounds(&mut self, stage: Stage, stretch: &Stretch<'_>) {
        let steps = std::mem::take(&mut self.stages[stage as usize]);
        if self.bounds.is_none() {
            let known = [Stage::Guards, Stage::Distances, Stage::Observables];
            let known = known.map(|known| match known == stage {
                true => &steps[..],
                false => &self.stages[known as usize],
            });
            self.bounds = Some(BoundsMemory::new(&self.program, known));
        }
        for id in &steps {
            self.bound_value(*id, stretch);
        }
        self.stages[stage as usize] = steps;
    }

    /// Returns the bounds of an element of a value; a scalar has the same bounds for all indices.
    fn bound(&self, id: ValueId, index: usize) -> Enclosure {
        let value = self.program.value(id);
        if value.parameter_only {
            return Enclosure::constant(self.element(id, index));
        }
        let index = match value.extent {
            Extent::Scalar => 0,
            _ => index,
        };
        let memory = self.bounds.as_ref();
        memory.map_or(Enclosure::UNKNOWN, |memory| memory.bound(id, index))
    }

    fn bound_value(&mut self, id: ValueId, stretch: &Stretch<'_>) {
        for index in 0..self.program.value(id).extent.length() {
            let bound = self.bound_element(id, index, stretch);
            if let Some(memory) = &mut self.bounds {
                memory.set_bound(id, index, bound);
            }
        }
    }

    fn bound_element(&self, id: ValueId, index: usize, stretch: &Stretch<'_>) -> Enclosure {
        let degrees = self.program.degrees_of_freedom();
        let of = |id: ValueId| self.bound(id, index);
        let entry = |place: usize| stretch.state.get(place).copied();
        let known = match &self.program.value(id).op {
            Op::Constant(number) => Some(Enclosure::constant(*number)),
            Op::Coordinate(place) => entry(place.index()),
            Op::Rate(place) => entry(degrees + place.index()),
            Op::ModeCoordinates(field) => entry(self.program.mode_offset(*field) + index),
            Op::ModeRates(field) => entry(degrees + self.program.mode_offset(*field) + index),
            Op::State(place) => entry(2 * degrees + place.index()),
            Op::Input(place) => stretch.inputs.get(place.index()).copied(),
            Op::Time => Some(stretch.t),
            Op::Negate(a) => Some(of(*a).negate()),
            Op::Add(a, b) => Some(of(*a).add_enclosure(of(*b))),
            Op::Subtract(a, b) => Some(of(*a).subtract(of(*b))),
            Op::Multiply(a, b) if a == b => Some(of(*a).raise(Enclosure::constant(2.0))),
            Op::Multiply(a, b) => Some(of(*a).multiply(of(*b))),
            Op::Divide(a, b) => Some(of(*a).divide(of(*b))),
            Op::Power(a, b) => Some(of(*a).raise(of(*b))),
            Op::Call(function, arguments) => Some(match *arguments {
                Arguments::One([a]) => Enclosure::call(*function, &[of(a)]),
                Arguments::Two([a, b]) => Enclosure::call(*function, &[of(a), of(b)]),
            }),
            Op::Select {
                a,
                b,
                then,
                otherwise,
            } => Some(Enclosure::select(of(*a), of(*b), of(*then), of(*otherwise))),
            Op::Total(a) => {
                let elements = 0..self.program.value(*a).extent.length();
                let sum = elements.fold(Enclosure::constant(0.0), |sum, element| {
                    sum.add_enclosure(self.bound(*a, element))
                });
                Some(sum)
            }
            Op::Apply {
                matrix,
                transposed,
                vector,
            } => self.bound_product((*matrix, *transposed), *vector, index),
            _ => None,
        };
        known.unwrap_or(Enclosure::UNKNOWN)
    }

    /// Returns the bounds of an element of a matrix, or its transpose, times a vector.
    fn bound_product(
        &self,
        (matrix, transposed): (ValueId, bool),
        vector: ValueId,
        index: usize,
    ) -> Option<Enclosure> {
        let Extent::Matrix(rows, columns) = self.program.value(matrix).extent else {
            return None;
        };
        let terms = match transposed {
            true => rows,
            false => columns,
        };
        let sum = (0..terms).fold(Enclosure::constant(0.0), |sum, term| {
            let place = match transposed {
                true => term * columns + index,
                false => index * columns + term,
            };
            let product = self.bound(matrix, place).multiply(self.bound(vector, term));
            sum.add_enclosure(product)
        });
        Some(sum)
    }
}
