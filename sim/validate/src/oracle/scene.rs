//! One state at which expressions are evaluated, and the directions in which they are
//! differentiated there. Field values at all places are formed once per state: w is
//! linear in the modes, so neither w nor its rate depends on the row under test.

use super::conditioned::Conditioned;
use super::evaluate::Number;
use super::integrals::IntegralTable;
use super::switches::Imposed;
use super::system::System;
use super::tree::Leaf;
use nalgebra::{DVector, DVectorView};

/// A direction of differentiation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Direction {
    /// None: the derivative part stays 0.
    Still,
    /// Along the motion: coordinates move with the rates, rates with the accelerations.
    Time,
    /// A generalised coordinate, its rate held.
    Position(usize),
    /// The rate of a generalised coordinate.
    Rate(usize),
    /// A state of first order.
    State(usize),
    /// An input, the others held.
    Input(usize),
    /// The time where an expression names it, everything else held.
    Clock,
    /// A field value at the current place, its rate held.
    LeafPosition(Leaf),
    /// The rate of a field value at the current place.
    LeafRate(Leaf),
}

/// A quantity that moves: its value and its time derivative, each with derivative parts
/// in two directions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion {
    /// The value.
    pub value: Number,
    /// The time derivative.
    pub rate: Number,
}

impl Motion {
    /// A value that changes in no direction.
    pub fn still(value: Conditioned) -> Self {
        let zero = Conditioned::default();
        Self {
            value: Number::new(value, zero, zero, zero),
            rate: Number::new(zero, zero, zero, zero),
        }
    }

    /// A value with its rate, and how fast each changes in two directions.
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

/// Field values of one order of derivative at all positions of a place set.
#[derive(Clone, Debug)]
struct Values {
    derivative: u8,
    value: DVector<f64>,
    rate: DVector<f64>,
    second: DVector<f64>,
}

/// A state with what can be formed once for all rows.
#[derive(Debug)]
pub(super) struct Scene<'s> {
    /// The variant.
    pub system: &'s System,
    /// The time, in s.
    pub time: f64,
    /// Inputs in the order of the model.
    pub inputs: &'s [f64],
    /// Derivatives of integrals, formed when first asked for.
    pub integrals: Vec<IntegralTable>,
    /// Multipliers of the constraints, where they are asked for.
    pub multipliers: Vec<Conditioned>,
    /// Sides that piecewise functions take whatever the state says, if any.
    pub imposed: Option<Imposed<'s>>,
    position: &'s [f64],
    rate: &'s [f64],
    /// States of first order.
    first_order: &'s [f64],
    acceleration: Option<&'s [f64]>,
    values: Vec<Vec<Values>>,
}

impl<'s> Scene<'s> {
    /// A state (coordinates, their rates, states of first order); without accelerations rates are constant.
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
            imposed: None,
            position,
            rate,
            first_order,
            acceleration,
            values: Vec::new(),
        };
        scene.values = (0..system.places.len())
            .map(|set| scene.sample(set))
            .collect();
        scene
            .integrals
            .resize_with(system.integrals.len(), IntegralTable::default);
        scene
    }

    /// The field's values at one place set.
    fn sample(&self, set: usize) -> Vec<Values> {
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
            .map(|derivative| Values {
                derivative,
                value: project(derivative, Some(self.position)),
                rate: project(derivative, Some(self.rate)),
                second: project(derivative, self.acceleration),
            })
            .collect()
    }

    /// A generalised coordinate in two directions.
    pub fn coordinate(&self, index: usize, directions: [Direction; 2]) -> Motion {
        let [first, second] = directions.map(|direction| self.seed(index, direction));
        let at = |values: &[f64]| values.get(index).copied().unwrap_or(f64::NAN);
        Motion::new((at(self.position), at(self.rate)), [first, second])
    }

    /// How fast a coordinate and its rate change in a direction.
    fn seed(&self, index: usize, direction: Direction) -> (f64, f64) {
        let at = |values: &[f64]| values.get(index).copied().unwrap_or(f64::NAN);
        match direction {
            Direction::Time => (at(self.rate), self.acceleration.map_or(0.0, at)),
            Direction::Position(row) if row == index => (1.0, 0.0),
            Direction::Rate(row) if row == index => (0.0, 1.0),
            _ => (0.0, 0.0),
        }
    }

    /// An input that moves at the rates given with it, in two directions.
    pub fn prescribed(
        &self,
        input: usize,
        (rate_input, second): (usize, Option<usize>),
        directions: [Direction; 2],
    ) -> Motion {
        let at = |place: usize| self.inputs.get(place).copied().unwrap_or(f64::NAN);
        let (value, rate) = (at(input), at(rate_input));
        // What holds a rate without the next one is nowhere differentiated by the time.
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

    /// An input that is held along the motion, in two directions.
    pub fn held(&self, input: usize, directions: [Direction; 2]) -> Motion {
        let value = self.inputs.get(input).copied().unwrap_or(f64::NAN);
        let seeds = directions.map(|direction| match direction {
            Direction::Input(moved) if moved == input => (1.0, 0.0),
            _ => (0.0, 0.0),
        });
        Motion::new((value, 0.0), seeds)
    }

    /// A state of first order and how fast it changes in two directions, where it moves at `rate`.
    pub fn state(&self, index: usize, rate: f64, directions: [Direction; 2]) -> Number {
        let seeds = directions.map(|direction| match direction {
            Direction::State(row) if row == index => 1.0,
            Direction::Time => rate,
            _ => 0.0,
        });
        let value = self.first_order.get(index).copied().unwrap_or(f64::NAN);
        Motion::new((value, 0.0), seeds.map(|seed| (seed, 0.0))).value
    }

    /// A field value at place `node` of `set` in two directions.
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

    /// The shape that multiplies generalised coordinate `row` in a field value: 0 unless
    /// it is one of the field's modes.
    fn shape_of_row(&self, leaf: Leaf, set: usize, node: usize, row: usize) -> f64 {
        let modes = self.system.modes(leaf.field);
        if modes.contains(&row) {
            self.shape(leaf, set, node, row - modes.start)
        } else {
            0.0
        }
    }

    /// The shape of `mode` at place `node` of `set`.
    pub fn shape(&self, leaf: Leaf, set: usize, node: usize, mode: usize) -> f64 {
        self.system
            .places
            .get(set)
            .and_then(|places| places.shapes(leaf.derivative))
            .and_then(|shapes| shapes.get((mode, node)))
            .copied()
            .unwrap_or(f64::NAN)
    }

    /// How fast the time changes in a direction.
    pub fn time_seed(direction: Direction) -> f64 {
        if matches!(direction, Direction::Time | Direction::Clock) {
            1.0
        } else {
            0.0
        }
    }
}
