//! The corner conditions at one surface: rates beyond it, or reflected from it.

use eomgen_codegen::independence::dependence::dependent_rows;
use eomgen_codegen::independence::vectors::norm;
use eomgen_codegen::program::evaluator::{CornerValues, Evaluator, Point};
use nalgebra::{DMatrix, DVector};

/// Difference of Hamiltonians, relative to their magnitude, that counts as rounding.
const ENERGY_ROUNDING: f64 = 1e-13;

/// Largest remainder of a dependent row of the constraints, relative to its length.
const MAX_DEPENDENT_REMAINDER: f64 = 1e-9;

/// Model with given sides of its surfaces, at a position and time.
pub(super) struct SidedPoint<'e> {
    pub evaluator: &'e mut Evaluator,
    pub t: f64,
    pub state: Vec<f64>,
    /// Inputs of the model, then the sides.
    pub inputs: Vec<f64>,
}

impl SidedPoint<'_> {
    pub(super) fn values(&mut self) -> Option<CornerValues> {
        let (t, state, inputs) = (self.t, &self.state[..], &self.inputs[..]);
        self.evaluator.corners(Point { t, state, inputs })
    }

    fn degrees(&self) -> usize {
        self.evaluator.program().degrees_of_freedom()
    }

    pub(super) fn rates(&self) -> DVector<f64> {
        let degrees = self.degrees();
        DVector::from_column_slice(&self.state[degrees..2 * degrees])
    }

    pub(super) fn set_rates(&mut self, rates: &DVector<f64>) {
        let degrees = self.degrees();
        self.state[degrees..2 * degrees].copy_from_slice(rates.as_slice());
    }

    /// Returns the equations for rates with these sides. `None` if the mass matrix is not positive definite.
    pub(super) fn balance(&mut self) -> Option<Balance> {
        let degrees = self.degrees();
        let values = self.values()?;
        let mut mass = vec![0.0; degrees * degrees];
        let (t, state, inputs) = (self.t, &self.state[..], &self.inputs[..]);
        let point = Point { t, state, inputs };
        self.evaluator.mass_matrix(point, &mut mass);
        let mass = DMatrix::from_row_slice(degrees, degrees, &mass);
        mass.clone().cholesky()?;
        let rates = self.rates();
        let momenta = DVector::from_column_slice(&values.momenta);
        let rows = independent_constraints(&values, &mass);
        let count = rows.len();
        let constraints = DMatrix::from_fn(count, degrees, |row, column| rows[row].1[column]);
        let all = DVector::from_iterator(count, rows.iter().map(|row| row.0));
        let mut matrix = DMatrix::zeros(degrees + count, degrees + count);
        matrix.view_mut((0, 0), (degrees, degrees)).copy_from(&mass);
        let below = &mut matrix.view_mut((degrees, 0), (count, degrees));
        below.copy_from(&constraints);
        let beside = &mut matrix.view_mut((0, degrees), (degrees, count));
        beside.copy_from(&(-constraints.transpose()));
        Some(Balance {
            constant_momenta: momenta - mass * &rates,
            drift: all - constraints * &rates,
            matrix: matrix.lu(),
            values,
        })
    }
}

/// Returns the rates of the constraints with their rows, without those that depend on the others.
fn independent_constraints<'v>(
    values: &'v CornerValues,
    mass: &DMatrix<f64>,
) -> Vec<&'v (f64, Vec<f64>)> {
    let inertia = mass.diagonal();
    let scaled = values.constraints.iter().map(|(_, row)| {
        let entries = row.iter().zip(inertia.iter());
        let mut scaled: Vec<f64> = entries.map(|(entry, mass)| entry / mass.sqrt()).collect();
        let length = norm(&scaled);
        scaled.iter_mut().for_each(|entry| *entry /= length);
        scaled
    });
    let dependent = dependent_rows(&scaled.collect::<Vec<_>>(), MAX_DEPENDENT_REMAINDER);
    let places = (0..values.constraints.len()).filter(|place| !dependent.contains(place));
    places.map(|place| &values.constraints[place]).collect()
}

/// Equations M q' - A^T mu = p - b, A q' = -a_t for the rates at given momenta.
pub(super) struct Balance {
    pub values: CornerValues,
    /// Momenta b at zero rates.
    constant_momenta: DVector<f64>,
    /// Rates a_t of the constraints at zero rates of the coordinates.
    drift: DVector<f64>,
    matrix: nalgebra::LU<f64, nalgebra::Dyn, nalgebra::Dyn>,
}

impl Balance {
    /// Returns the rates at these momenta, and the work of the constraints' impulses by time.
    pub(super) fn rates_at(&self, momenta: &DVector<f64>) -> Option<(DVector<f64>, f64)> {
        let (rates, impulses) = self.solve(&(momenta - &self.constant_momenta), &-&self.drift)?;
        Some((rates, impulses.dot(&self.drift)))
    }

    /// Returns the change of the rates by a unit impulse along a row.
    pub(super) fn column(&self, row: &DVector<f64>) -> Option<DVector<f64>> {
        Some(self.solve(row, &DVector::zeros(self.drift.len()))?.0)
    }

    fn solve(
        &self,
        momenta: &DVector<f64>,
        constraints: &DVector<f64>,
    ) -> Option<(DVector<f64>, DVector<f64>)> {
        let (degrees, count) = (momenta.len(), constraints.len());
        let mut right = DVector::zeros(degrees + count);
        right.rows_mut(0, degrees).copy_from(momenta);
        right.rows_mut(degrees, count).copy_from(constraints);
        let found = self.matrix.solve(&right)?;
        let is_finite = found.iter().all(|entry| entry.is_finite());
        let (rates, impulses) = (found.rows(0, degrees), found.rows(degrees, count));
        is_finite.then(|| (rates.into_owned(), impulses.into_owned()))
    }
}

/// Result of an arrival at a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Passage {
    /// The motion continues beyond the surface.
    Transmitted,
    /// The motion returns: its energy does not suffice, or its rate leads back already.
    Returned,
}

/// Applies the corner conditions at the surface `place` to the rates of a point, whose side there changes to
/// `side` if the motion passes. `None` if the rates do not follow from the momenta beyond.
///
/// With the rates v0 at unchanged momenta, D = dv/dlambda and a = dg/dq D, the energy balance is
/// c + r lambda + a lambda^2/2 = 0, where r is the rate of g at v0 and c the change of H there. The rate of g
/// at the solutions is +-sqrt(r^2 - 2 a c); beyond the surface it keeps its sign.
pub(super) fn pass(point: &mut SidedPoint<'_>, place: usize, side: f64) -> Option<Passage> {
    let first_side = point.inputs.len() - sides(point.evaluator);
    let direction = if side > 0.0 { 1.0 } else { -1.0 };
    let near = point.balance()?;
    let (arrival, row) = &near.values.surfaces[place];
    let row = DVector::from_column_slice(row);
    if direction * arrival <= 0.0 {
        return Some(Passage::Returned);
    }
    let rates = point.rates();
    let own_rate = arrival - row.dot(&rates);
    let old_side = std::mem::replace(&mut point.inputs[first_side + place], side);
    let far = point.balance()?;
    let momenta = DVector::from_column_slice(&near.values.momenta);
    let (free, work) = far.rates_at(&momenta)?;
    let column = far.column(&row)?;
    let yielding = row.dot(&column);
    point.set_rates(&free);
    if yielding <= 0.0 {
        return Some(Passage::Transmitted);
    }
    let (before, after) = (near.values.hamiltonian, point.values()?.hamiltonian);
    let mut excess = after - before + work;
    let magnitude = before.abs() + after.abs() + work.abs() + momenta.dot(&rates).abs();
    if excess.abs() <= ENERGY_ROUNDING * magnitude {
        excess = 0.0;
    }
    let rate = row.dot(&free) + own_rate;
    let squared = rate * rate - 2.0 * yielding * excess;
    if squared >= 0.0 {
        let beyond = direction * squared.sqrt();
        let impulse = match direction * rate > 0.0 {
            true => -2.0 * excess / (rate + beyond),
            false => (beyond - rate) / yielding,
        };
        point.set_rates(&(free + column * impulse));
        return Some(Passage::Transmitted);
    }
    point.inputs[first_side + place] = old_side;
    let column = near.column(&row)?;
    point.set_rates(&(&rates - &column * (2.0 * arrival / row.dot(&column))));
    Some(Passage::Returned)
}

/// Returns the number of sides among the inputs of a program.
pub(super) fn sides(evaluator: &Evaluator) -> usize {
    let corners = evaluator.program().outputs.corners.as_ref();
    corners.map_or(0, |corners| corners.surfaces.len())
}
