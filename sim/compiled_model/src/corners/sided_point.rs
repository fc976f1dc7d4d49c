//! Model at a position and time with given sides of its surfaces: rates for given momenta.

use eomgen_codegen::independence::dependence::find_dependent_rows;
use eomgen_codegen::independence::vectors::norm;
use eomgen_codegen::program::evaluator::{CornerValues, Evaluator, Point};
use nalgebra::{DMatrix, DVector};

/// Largest remainder of a dependent constraint row, relative to its norm.
const MAX_DEPENDENT_REMAINDER: f64 = 1e-9;

/// Contact at which bodies touch at rest. It acts during the jump if it pushes.
#[derive(Clone, Debug)]
pub(crate) struct TouchingContact {
    /// Rate of the distance at zero rates of the coordinates.
    pub drift: f64,
    /// Derivatives of the distance with respect to the coordinates.
    pub row: DVector<f64>,
}

/// Model at a position and time with given sides of its surfaces.
pub(super) struct SidedPoint<'e> {
    pub evaluator: &'e mut Evaluator,
    pub t: f64,
    pub state: Vec<f64>,
    /// Inputs of the model, then the sides.
    pub inputs: Vec<f64>,
    pub contacts: &'e [TouchingContact],
    /// True for active contacts.
    pub acts: Vec<bool>,
}

impl<'e> SidedPoint<'e> {
    /// Sets the contacts at which bodies touch at rest. All are active at first.
    pub(super) fn with_contacts(mut self, contacts: &'e [TouchingContact]) -> Self {
        self.contacts = contacts;
        self.acts = vec![true; contacts.len()];
        self
    }
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

    /// Returns the equations for the rates with the present sides. `None` if the mass matrix is not positive definite.
    pub(super) fn build_balance(&mut self) -> Option<Balance> {
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
        let constraints = values.constraints.iter().map(|(rate, row)| {
            let row = DVector::from_column_slice(row);
            (None, rate - row.dot(&rates), row)
        });
        let acting = self.contacts.iter().zip(&self.acts).enumerate();
        let acting = acting.filter(|(_, (_, acts))| **acts);
        let acting =
            acting.map(|(place, (contact, _))| (Some(place), contact.drift, contact.row.clone()));
        let rows = select_independent_rows(constraints.chain(acting).collect(), &mass);
        let count = rows.len();
        let constraints = DMatrix::from_fn(count, degrees, |row, column| rows[row].2[column]);
        let mut matrix = DMatrix::zeros(degrees + count, degrees + count);
        matrix.view_mut((0, 0), (degrees, degrees)).copy_from(&mass);
        let below = &mut matrix.view_mut((degrees, 0), (count, degrees));
        below.copy_from(&constraints);
        let beside = &mut matrix.view_mut((0, degrees), (degrees, count));
        beside.copy_from(&(-constraints.transpose()));
        Some(Balance {
            constant_momenta: momenta - &mass * &rates,
            drift: DVector::from_iterator(count, rows.iter().map(|row| row.1)),
            contacts: rows.iter().map(|row| row.0).collect(),
            matrix: matrix.lu(),
            mass,
            values,
        })
    }
}

/// Row of a constraint or contact: contact index, rate at zero rates, derivatives with respect to the coordinates.
type Row = (Option<usize>, f64, DVector<f64>);

/// Returns the linearly independent rows.
fn select_independent_rows(rows: Vec<Row>, mass: &DMatrix<f64>) -> Vec<Row> {
    let inertia = mass.diagonal();
    let scaled = rows.iter().map(|(_, _, row)| {
        let entries = row.iter().zip(inertia.iter());
        let mut scaled: Vec<f64> = entries.map(|(entry, mass)| entry / mass.sqrt()).collect();
        let length = norm(&scaled);
        scaled.iter_mut().for_each(|entry| *entry /= length);
        scaled
    });
    let dependent = find_dependent_rows(&scaled.collect::<Vec<_>>(), MAX_DEPENDENT_REMAINDER);
    let places = rows.into_iter().enumerate();
    let independent = places.filter(|(place, _)| !dependent.contains(place));
    independent.map(|(_, row)| row).collect()
}

/// Equations M q' - A^T mu = p - b, A q' = -a_t for the rates at given momenta p. A has the rows of the constraints and
/// of the active contacts.
pub(super) struct Balance {
    pub values: CornerValues,
    mass: DMatrix<f64>,
    /// Momenta b at zero rates.
    constant_momenta: DVector<f64>,
    /// Rates a_t of the constraints at zero rates of the coordinates.
    pub drift: DVector<f64>,
    /// Contact index of each row.
    contacts: Vec<Option<usize>>,
    matrix: nalgebra::LU<f64, nalgebra::Dyn, nalgebra::Dyn>,
}

impl Balance {
    /// Returns the rates at given momenta, and the impulses of the rows.
    pub(super) fn solve_rates(
        &self,
        momenta: &DVector<f64>,
    ) -> Option<(DVector<f64>, DVector<f64>)> {
        self.solve(&(momenta - &self.constant_momenta), &-&self.drift)
    }

    /// Returns the changes of the rates and of the row impulses due to a unit impulse along a row.
    pub(super) fn column(&self, row: &DVector<f64>) -> Option<(DVector<f64>, DVector<f64>)> {
        self.solve(row, &DVector::zeros(self.drift.len()))
    }

    /// Creates the jump that these equations give.
    pub(super) fn jump(self, passage: Passage, impulses: DVector<f64>) -> Jump {
        Jump {
            passage,
            impulses,
            contacts: self.contacts,
            mass: self.mass,
            constant_momenta: self.constant_momenta,
        }
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

/// Result of a motion that reaches a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Passage {
    /// The motion continues beyond the surface.
    Transmitted,
    /// The motion returns: its energy does not suffice, or its rate already leads back.
    Returned,
}

/// Jump of the rates at a surface.
pub(super) struct Jump {
    pub passage: Passage,
    /// Impulse of each row.
    pub impulses: DVector<f64>,
    /// Contact index of each row.
    pub contacts: Vec<Option<usize>>,
    pub mass: DMatrix<f64>,
    /// Momenta at zero rates.
    pub constant_momenta: DVector<f64>,
}

impl Jump {
    /// Returns the impulse of a contact; 0 if the contact is inactive or depends on others.
    pub(super) fn impulse_at(&self, contact: usize) -> f64 {
        let mut rows = self.contacts.iter().zip(&self.impulses);
        let found = rows.find(|(own, _)| **own == Some(contact));
        found.map_or(0.0, |(_, impulse)| *impulse)
    }
}
