//! State and directions of differentiation for the evaluation of expressions. Field values do not
//! depend on the row (w is linear in the modes), so they are computed once per state.

use super::conditioned::Conditioned;
use super::evaluate::Number;
use super::integrals::IntegralTable;
use super::switches::PrescribedSides;
use super::system::System;
use super::tree::Leaf;
use nalgebra::{DVector, DVectorView};

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Direction {
    /// No direction: the derivative part is 0.
    Zero,
    /// Along the motion: coordinates change with the rates, rates with the accelerations.
    Time,
    Position(usize),
    Rate(usize),
    State(usize),
    Input(usize),
    /// Explicit time.
    ExplicitTime,
    /// Field value at the current position; its rate is constant.
    LeafPosition(Leaf),
    LeafRate(Leaf),
}

/// Value and time derivative of a quantity, each with derivatives in two directions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion {
    pub value: Number,
    pub rate: Number,
}

impl Motion {
    pub fn constant(value: Conditioned) -> Self {
        let zero = Conditioned::default();
        Self {
            value: Number::new(value, zero, zero, zero),
            rate: Number::new(zero, zero, zero, zero),
        }
    }

    pub fn new((value, rate): (f64, f64), [first, second]: [(f64, f64); 2]) -> Self {
        let number = |re: f64, first: f64, second: f64| {
            Number::new(re.into(), first.into(), second.into(), 0.0.into())
        };
        Self {
            value: number(value, first.0, second.0),
            rate: number(rate, first.1, second.1),
        }
    }
}

#[derive(Clone, Debug)]
struct FieldValues {
    derivative: u8,
    value: DVector<f64>,
    rate: DVector<f64>,
    second: DVector<f64>,
}

/// State with intermediate results that all rows share.
#[derive(Debug)]
pub(super) struct Scene<'s> {
    pub system: &'s System,
    /// Time, in s.
    pub time: f64,
    pub inputs: &'s [f64],
    /// Derivatives of integrals, computed on first use.
    pub integrals: Vec<IntegralTable>,
    /// Multipliers of the constraints, if an expression needs them.
    pub multipliers: Vec<Conditioned>,
    /// Prescribed sides of piecewise functions; `None` if the state determines the sides.
    pub prescribed_sides: Option<PrescribedSides<'s>>,
    position: &'s [f64],
    rate: &'s [f64],
    first_order: &'s [f64],
    acceleration: Option<&'s [f64]>,
    values: Vec<Vec<FieldValues>>,
}

impl<'s> Scene<'s> {
    /// Creates the scene of a state. Without accelerations, rates are constant.
    pub fn new(
        system: &'s System,
        time: f64,
        state: &'s [f64],
        acceleration: Option<&'s [f64]>,
        inputs: &'s [f64],
    ) -> Self {
        let (position, rest) = state.split_at(system.size.min(state.len()));
        let (rate, first_order) = rest.split_at(system.size.min(rest.len()));
        let mut scene = Self {
            system,
            time,
            inputs,
            integrals: Vec::new(),
            multipliers: Vec::new(),
            prescribed_sides: None,
            position,
            rate,
            first_order,
            acceleration,
            values: Vec::new(),
        };
        scene.values = (0..system.places.len())
            .map(|set| scene.sample_fields(set))
            .collect();
        scene
            .integrals
            .resize_with(system.integrals.len(), IntegralTable::default);
        scene
    }

    fn sample_fields(&self, set: usize) -> Vec<FieldValues> {
        let Some(places) = self.system.places.get(set) else {
            return Vec::new();
        };
        let modes = self.system.modes(places.field);
        let project = |derivative, amplitudes: Option<&[f64]>| {
            let amplitudes = amplitudes.and_then(|all| all.get(modes.clone()));
            match (places.shapes(derivative), amplitudes) {
                (Some(shapes), Some(amplitudes)) => {
                    shapes.tr_mul(&DVectorView::from_slice(amplitudes, amplitudes.len()))
                }
                _ => DVector::zeros(places.positions.len()),
            }
        };
        places
            .derivatives()
            .map(|derivative| FieldValues {
                derivative,
                value: project(derivative, Some(self.position)),
                rate: project(derivative, Some(self.rate)),
                second: project(derivative, self.acceleration),
            })
            .collect()
    }

    pub fn coordinate(&self, index: usize, directions: [Direction; 2]) -> Motion {
        let [first, second] = directions.map(|direction| self.coordinate_seed(index, direction));
        let at = |values: &[f64]| values.get(index).copied().unwrap_or(f64::NAN);
        Motion::new((at(self.position), at(self.rate)), [first, second])
    }

    fn coordinate_seed(&self, index: usize, direction: Direction) -> (f64, f64) {
        let at = |values: &[f64]| values.get(index).copied().unwrap_or(f64::NAN);
        match direction {
            Direction::Time => (at(self.rate), self.acceleration.map_or(0.0, at)),
            Direction::Position(row) if row == index => (1.0, 0.0),
            Direction::Rate(row) if row == index => (0.0, 1.0),
            _ => (0.0, 0.0),
        }
    }

    /// Returns an input with given rates, with derivatives in two directions.
    pub fn prescribed_input(
        &self,
        input: usize,
        (rate_input, second): (usize, Option<usize>),
        directions: [Direction; 2],
    ) -> Motion {
        let at = |place: usize| self.inputs.get(place).copied().unwrap_or(f64::NAN);
        let (value, rate) = (at(input), at(rate_input));
        // If the second derivative is missing, no expression with this rate is differentiated with respect to time, so
        // 0 is never used.
        let second = second.map_or(0.0, at);
        let seeds = directions.map(|direction| match direction {
            Direction::Time => (rate, second),
            Direction::Input(moved) => {
                let seed = |place| if moved == place { 1.0 } else { 0.0 };
                (seed(input), seed(rate_input))
            }
            _ => (0.0, 0.0),
        });
        Motion::new((value, rate), seeds)
    }

    pub fn constant_input(&self, input: usize, directions: [Direction; 2]) -> Motion {
        let value = self.inputs.get(input).copied().unwrap_or(f64::NAN);
        let seeds = directions.map(|direction| match direction {
            Direction::Input(moved) if moved == input => (1.0, 0.0),
            _ => (0.0, 0.0),
        });
        Motion::new((value, 0.0), seeds)
    }

    /// Returns a first-order state that has the time derivative `rate`, with derivatives in two directions.
    pub fn state(&self, index: usize, rate: f64, directions: [Direction; 2]) -> Number {
        let seeds = directions.map(|direction| match direction {
            Direction::State(row) if row == index => 1.0,
            Direction::Time => rate,
            _ => 0.0,
        });
        let value = self.first_order.get(index).copied().unwrap_or(f64::NAN);
        Motion::new((value, 0.0), seeds.map(|seed| (seed, 0.0))).value
    }

    /// Returns a field value at position `node` of `set` with derivatives in two directions.
    pub fn field(&self, leaf: Leaf, set: usize, node: usize, directions: [Direction; 2]) -> Motion {
        let values = self.values.get(set).and_then(|all| {
            all.iter()
                .find(|values| values.derivative == leaf.derivative)
        });
        let at = |values: Option<&DVector<f64>>| {
            values
                .and_then(|values| values.get(node))
                .copied()
                .unwrap_or(f64::NAN)
        };
        let [first, second] = directions.map(|direction| match direction {
            Direction::Time => (
                at(values.map(|values| &values.rate)),
                at(values.map(|values| &values.second)),
            ),
            Direction::Position(row) => (self.shape_of_row(leaf, set, node, row), 0.0),
            Direction::Rate(row) => (0.0, self.shape_of_row(leaf, set, node, row)),
            Direction::LeafPosition(other) if other == leaf => (1.0, 0.0),
            Direction::LeafRate(other) if other == leaf => (0.0, 1.0),
            _ => (0.0, 0.0),
        });
        let value = at(values.map(|values| &values.value));
        let rate = at(values.map(|values| &values.rate));
        Motion::new((value, rate), [first, second])
    }

    /// Returns the factor of coordinate `row` in a field value; 0 if it is not a mode of the field.
    fn shape_of_row(&self, leaf: Leaf, set: usize, node: usize, row: usize) -> f64 {
        let modes = self.system.modes(leaf.field);
        if modes.contains(&row) {
            self.shape(leaf, set, node, row - modes.start)
        } else {
            0.0
        }
    }

    pub fn shape(&self, leaf: Leaf, set: usize, node: usize, mode: usize) -> f64 {
        self.system
            .places
            .get(set)
            .and_then(|places| places.shapes(leaf.derivative))
            .and_then(|shapes| shapes.get((mode, node)))
            .copied()
            .unwrap_or(f64::NAN)
    }

    pub fn time_seed(direction: Direction) -> f64 {
        if matches!(direction, Direction::Time | Direction::ExplicitTime) {
            1.0
        } else {
            0.0
        }
    }
}
