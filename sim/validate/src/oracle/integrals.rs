//! Derivatives of integrals, computed once per state for all rows. An integrand depends on the modes only through field
//! values at the same position. Therefore its derivative with respect to mode j is its derivative with respect to each
//! field value times phi_j. This needs a few evaluations per node and one product with the table of shapes, not one
//! evaluation per node and row.
//!
//! The magnitude of an integral is the magnitude of its largest addend, including weight and shape. Second derivatives
//! by two modes have the magnitude of their value, because cancellation by orthogonality depends on the quadrature, not
//! on the model.

use super::conditioned::Conditioned;
use super::evaluate::{Frame, Number, Pass};
use super::scene::{Direction, Scene};
use super::system::Integral;
use super::tree::Leaf;
use nalgebra::{DMatrix, DVector};
use std::cell::OnceCell;

#[derive(Debug, Default)]
pub(super) struct IntegralTable {
    value: OnceCell<Conditioned>,
    by_position: OnceCell<Rows>,
    by_rate: OnceCell<Rows>,
    by_two_rates: OnceCell<Hessian>,
}

/// First derivatives by every coordinate or rate, and their rates along the motion.
#[derive(Debug)]
struct Rows {
    along_motion: Conditioned,
    by_row: Entries,
    along_motion_by_row: Entries,
}

#[derive(Clone, Debug)]
struct Entries {
    value: DVector<f64>,
    magnitude: DVector<f64>,
}

impl Entries {
    fn zeros(count: usize) -> Self {
        Self {
            value: DVector::zeros(count),
            magnitude: DVector::zeros(count),
        }
    }

    fn from_addends(addends: &[Number], part: impl Fn(&Number) -> Conditioned) -> Self {
        let parts: Vec<Conditioned> = addends.iter().map(part).collect();
        let entries = |entry: fn(&Conditioned) -> f64| {
            DVector::from_iterator(parts.len(), parts.iter().map(entry))
        };
        Self {
            value: entries(|part| part.value),
            magnitude: entries(|part| part.magnitude),
        }
    }

    fn get(&self, row: usize) -> Option<Conditioned> {
        let value = self.value.get(row)?;
        Some(Conditioned::new(*value, *self.magnitude.get(row)?))
    }

    fn sum_entries(&self) -> Conditioned {
        Conditioned::new(self.value.sum(), self.magnitude.max())
    }

    fn add(&mut self, row: usize, addend: Conditioned) {
        if let Some(sum) = self.get(row) {
            let sum = sum + addend;
            self.value[row] = sum.value;
            self.magnitude[row] = sum.magnitude;
        }
    }
}

#[derive(Debug)]
struct Hessian {
    value: DMatrix<f64>,
    magnitude: DMatrix<f64>,
}

impl Hessian {
    fn zeros(size: usize) -> Self {
        Self {
            value: DMatrix::zeros(size, size),
            magnitude: DMatrix::zeros(size, size),
        }
    }

    fn get(&self, place: (usize, usize)) -> Option<Conditioned> {
        let value = self.value.get(place)?;
        Some(Conditioned::new(*value, *self.magnitude.get(place)?))
    }

    fn add(&mut self, value: &DMatrix<f64>, magnitude: &DMatrix<f64>) {
        self.value += value;
        self.magnitude
            .zip_apply(magnitude, |own, other| *own = own.max(other));
    }
}

#[derive(Clone, Copy, Debug)]
enum Channel {
    Coordinate(usize),
    Leaf(Leaf),
}

impl Channel {
    fn position(self) -> Direction {
        match self {
            Self::Coordinate(row) => Direction::Position(row),
            Self::Leaf(leaf) => Direction::LeafPosition(leaf),
        }
    }

    fn rate(self) -> Direction {
        match self {
            Self::Coordinate(row) => Direction::Rate(row),
            Self::Leaf(leaf) => Direction::LeafRate(leaf),
        }
    }
}

impl Scene<'_> {
    /// Returns integral `index` in two directions; `None` if these derivatives are not cached.
    pub fn integral(&self, index: usize, directions: [Direction; 2]) -> Option<Number> {
        let integral = self.system.integrals.get(index)?;
        let table = self.integrals.get(index)?;
        let [first, second] = directions;
        let (lesser, greater) = if direction_rank(first) <= direction_rank(second) {
            (first, second)
        } else {
            (second, first)
        };
        let mixed = match (lesser, greater) {
            // Cached integrals do not depend on first-order states.
            (Direction::Zero | Direction::State(_), _) => Conditioned::default(),
            (Direction::Time, Direction::Position(row)) => self
                .by_position(table, integral)
                .along_motion_by_row
                .get(row)?,
            (Direction::Time, Direction::Rate(row)) => {
                self.by_rate(table, integral).along_motion_by_row.get(row)?
            }
            (Direction::Rate(row), Direction::Rate(column)) => {
                self.by_two_rates(table, integral).get((row, column))?
            }
            _ => return None,
        };
        Some(Number::new(
            *table.value.get_or_init(|| self.integral_value(integral)),
            self.first_derivative(table, integral, first)?,
            self.first_derivative(table, integral, second)?,
            mixed,
        ))
    }

    fn first_derivative(
        &self,
        table: &IntegralTable,
        integral: &Integral,
        direction: Direction,
    ) -> Option<Conditioned> {
        match direction {
            Direction::Zero | Direction::State(_) => Some(Conditioned::default()),
            Direction::Time => Some(self.by_rate(table, integral).along_motion),
            Direction::Position(row) => self.by_position(table, integral).by_row.get(row),
            Direction::Rate(row) => self.by_rate(table, integral).by_row.get(row),
            Direction::LeafPosition(_)
            | Direction::LeafRate(_)
            | Direction::Input(_)
            | Direction::ExplicitTime => None,
        }
    }

    fn by_position<'t>(&self, table: &'t IntegralTable, integral: &Integral) -> &'t Rows {
        table
            .by_position
            .get_or_init(|| self.rows(integral, Channel::position))
    }

    fn by_rate<'t>(&self, table: &'t IntegralTable, integral: &Integral) -> &'t Rows {
        table
            .by_rate
            .get_or_init(|| self.rows(integral, Channel::rate))
    }

    fn by_two_rates<'t>(&self, table: &'t IntegralTable, integral: &Integral) -> &'t Hessian {
        table.by_two_rates.get_or_init(|| self.hessian(integral))
    }

    fn integral_value(&self, integral: &Integral) -> Conditioned {
        let pass = Pass::new(self, Direction::Zero, Direction::Zero);
        let addends = self.addends(integral, &pass);
        addends.iter().map(|addend| addend.re).sum()
    }

    fn addends(&self, integral: &Integral, pass: &Pass<'_>) -> Vec<Number> {
        let weights = self
            .system
            .places
            .get(integral.set)
            .map_or(&[][..], |places| &places.weights);
        let outer = &Frame::Outside;
        weights
            .iter()
            .enumerate()
            .map(|(node, weight)| {
                let frame = Frame::Place { node, outer };
                pass.evaluate::<Number>(&integral.body, &frame) * *weight
            })
            .collect()
    }

    fn rows(&self, integral: &Integral, direction: fn(Channel) -> Direction) -> Rows {
        let still = Pass::new(self, Direction::Time, Direction::Zero);
        let addends = self.addends(integral, &still);
        let mut rows = Rows {
            along_motion: addends.iter().map(|addend| addend.eps1).sum(),
            by_row: Entries::zeros(self.system.size),
            along_motion_by_row: Entries::zeros(self.system.size),
        };
        for channel in integral.channels() {
            let pass = Pass::new(self, Direction::Time, direction(channel));
            let addends = self.addends(integral, &pass);
            let first = Entries::from_addends(&addends, |addend| addend.eps2);
            let mixed = Entries::from_addends(&addends, |addend| addend.eps1eps2);
            self.add_first_derivatives(integral, channel, &first, &mut rows.by_row);
            self.add_first_derivatives(integral, channel, &mixed, &mut rows.along_motion_by_row);
        }
        rows
    }

    /// Adds the derivatives by the field value `channel` at every node to the derivatives by every row.
    fn add_first_derivatives(
        &self,
        integral: &Integral,
        channel: Channel,
        by_place: &Entries,
        rows: &mut Entries,
    ) {
        match channel {
            Channel::Coordinate(row) => rows.add(row, by_place.sum_entries()),
            Channel::Leaf(leaf) => {
                if let Some(shapes) = self.shapes(integral, leaf) {
                    let start = self.system.modes(leaf.field).start;
                    let mut part = rows.value.rows_mut(start, shapes.nrows());
                    part.gemv(1.0, shapes, &by_place.value, 1.0);
                    let mut part = rows.magnitude.rows_mut(start, shapes.nrows());
                    for (shapes, magnitude) in shapes.column_iter().zip(&by_place.magnitude) {
                        part.zip_apply(&shapes, |own, shape| {
                            *own = own.max(shape.abs() * magnitude);
                        });
                    }
                }
            }
        }
    }

    fn shapes(&self, integral: &Integral, leaf: Leaf) -> Option<&DMatrix<f64>> {
        self.system
            .places
            .get(integral.set)?
            .shapes(leaf.derivative)
    }

    fn hessian(&self, integral: &Integral) -> Hessian {
        let mut hessian = Hessian::zeros(self.system.size);
        let channels: Vec<Channel> = integral.channels().collect();
        for (index, row) in channels.iter().enumerate() {
            for (number, column) in channels.iter().enumerate().skip(index) {
                let pass = Pass::new(self, row.rate(), column.rate());
                let by_place =
                    Entries::from_addends(&self.addends(integral, &pass), |addend| addend.eps1eps2);
                let block = self.second_derivatives(integral, [*row, *column], &by_place);
                if number > index {
                    hessian.add(&block.value.transpose(), &block.magnitude.transpose());
                }
                hessian.add(&block.value, &block.magnitude);
            }
        }
        hessian
    }

    fn second_derivatives(
        &self,
        integral: &Integral,
        [row, column]: [Channel; 2],
        by_place: &Entries,
    ) -> Hessian {
        let size = self.system.size;
        let mut block = Hessian::zeros(size);
        match (row, column) {
            (Channel::Leaf(left), Channel::Leaf(right)) => {
                let tables = self
                    .shapes(integral, left)
                    .zip(self.shapes(integral, right));
                if let Some((left_shapes, right_shapes)) = tables {
                    let mut weighted = right_shapes.transpose();
                    for (mut place, weight) in weighted.row_iter_mut().zip(&by_place.value) {
                        place *= *weight;
                    }
                    let start = self.system.modes(left.field).start;
                    block
                        .value
                        .view_mut((start, start), (left_shapes.nrows(), right_shapes.nrows()))
                        .gemm(1.0, left_shapes, &weighted, 0.0);
                }
            }
            (Channel::Coordinate(index), other) | (other, Channel::Coordinate(index)) => {
                let mut rows = Entries::zeros(size);
                self.add_first_derivatives(integral, other, by_place, &mut rows);
                if index < size {
                    block.value.set_column(index, &rows.value);
                    block.magnitude.set_column(index, &rows.magnitude);
                }
            }
        }
        block
    }
}

impl Integral {
    fn channels(&self) -> impl Iterator<Item = Channel> {
        let coordinates = self.coordinates.iter().copied().map(Channel::Coordinate);
        coordinates.chain(self.leaves.iter().copied().map(Channel::Leaf))
    }
}

fn direction_rank(direction: Direction) -> u8 {
    match direction {
        Direction::Zero | Direction::State(_) | Direction::Input(_) | Direction::ExplicitTime => 0,
        Direction::Time => 1,
        Direction::Position(_) | Direction::LeafPosition(_) => 2,
        Direction::Rate(_) | Direction::LeafRate(_) => 3,
    }
}
