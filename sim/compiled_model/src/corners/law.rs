//! The corner conditions at one surface: rates beyond it, or reflected from it.

use eomgen_codegen::independence::dependence::dependent_rows;
use eomgen_codegen::independence::vectors::norm;
use eomgen_codegen::program::evaluator::{CornerValues, Evaluator, Point};
use nalgebra::{DMatrix, DVector};

/// Difference of Hamiltonians, relative to their magnitude, that counts as rounding.
const ENERGY_ROUNDING: f64 = 1e-13;

/// Largest remainder of a dependent row of the constraints, relative to its length.
const MAX_DEPENDENT_REMAINDER: f64 = 1e-9;

/// Number of changes of the contacts that act, for each contact. Where contacts depend on each other the changes may
/// have no end.
const MAX_CHANGES_PER_CONTACT: usize = 4;

/// Number of contacts of which all combinations are tried then.
const MAX_COMBINED_CONTACTS: usize = 10;

/// Largest pull of a contact, and speed into it, that count as rounding, relative to the motion.
const CONTACT_ROUNDING: f64 = 1e-9;

/// Contact at which bodies touch at rest: it acts during the jump if it pushes.
#[derive(Clone, Debug)]
pub(crate) struct TouchingContact {
    /// Rate of the distance at zero rates of the coordinates.
    pub drift: f64,
    /// Derivatives of the distance by the coordinates.
    pub row: DVector<f64>,
}

/// Model with given sides of its surfaces, at a position and time.
pub(super) struct SidedPoint<'e> {
    pub evaluator: &'e mut Evaluator,
    pub t: f64,
    pub state: Vec<f64>,
    /// Inputs of the model, then the sides.
    pub inputs: Vec<f64>,
    pub contacts: &'e [TouchingContact],
    /// True for the contacts that act.
    pub acts: Vec<bool>,
}

impl<'e> SidedPoint<'e> {
    /// Sets the contacts at which bodies touch at rest. All act at first.
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
        let constraints = values.constraints.iter().map(|(rate, row)| {
            let row = DVector::from_column_slice(row);
            (None, rate - row.dot(&rates), row)
        });
        let acting = self.contacts.iter().zip(&self.acts).enumerate();
        let acting = acting.filter(|(_, (_, acts))| **acts);
        let acting =
            acting.map(|(place, (contact, _))| (Some(place), contact.drift, contact.row.clone()));
        let rows = independent_rows(constraints.chain(acting).collect(), &mass);
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

    /// Returns a contact that pulls, or into which bodies move, after a jump from the rates `before`.
    fn find_contradiction(&self, before: &DVector<f64>, jump: &Jump) -> Option<Option<usize>> {
        let after = self.rates();
        let measure = ContactMeasure::new(jump, &[before, &after], self.contacts)?;
        let contradicts = |place: &usize| {
            let contact = &self.contacts[*place];
            match self.acts[*place] {
                true => measure.impulse(contact, jump.impulse_at(*place)) < -CONTACT_ROUNDING,
                false => measure.rate(contact, &after) < -CONTACT_ROUNDING,
            }
        };
        Some((0..self.contacts.len()).find(contradicts))
    }
}

/// Rates and impulses of contacts relative to the motion, in the norm of the kinetic energy.
struct ContactMeasure {
    inverse: nalgebra::Cholesky<f64, nalgebra::Dyn>,
    /// Largest length of the rates, of those without momenta, and of the speeds of the contacts' surfaces.
    size: f64,
}

impl ContactMeasure {
    fn new(jump: &Jump, rates: &[&DVector<f64>], contacts: &[TouchingContact]) -> Option<Self> {
        let inverse = jump.mass.clone().cholesky()?;
        let free = inverse.solve(&jump.constant_momenta);
        let rates = rates.iter().copied().chain([&free]);
        let lengths = rates.map(|rates| rates.dot(&(&jump.mass * rates)).sqrt());
        let size = lengths.fold(f64::MIN_POSITIVE, f64::max);
        let own = Self { inverse, size };
        let speeds = contacts.iter();
        let speeds = speeds.map(|contact| contact.drift.abs() / own.length(contact));
        let size = speeds.fold(size, f64::max);
        Some(Self { size, ..own })
    }

    /// Returns the length of the row of a contact.
    fn length(&self, contact: &TouchingContact) -> f64 {
        contact.row.dot(&self.inverse.solve(&contact.row)).sqrt()
    }

    fn rate(&self, contact: &TouchingContact, rates: &DVector<f64>) -> f64 {
        (contact.drift + contact.row.dot(rates)) / (self.length(contact) * self.size)
    }

    fn impulse(&self, contact: &TouchingContact, impulse: f64) -> f64 {
        impulse * self.length(contact) / self.size
    }
}

/// Row of a constraint or contact: its contact, its rate at zero rates, its derivatives by the coordinates.
type Row = (Option<usize>, f64, DVector<f64>);

/// Returns the rows without those that depend on the others.
fn independent_rows(rows: Vec<Row>, mass: &DMatrix<f64>) -> Vec<Row> {
    let inertia = mass.diagonal();
    let scaled = rows.iter().map(|(_, _, row)| {
        let entries = row.iter().zip(inertia.iter());
        let mut scaled: Vec<f64> = entries.map(|(entry, mass)| entry / mass.sqrt()).collect();
        let length = norm(&scaled);
        scaled.iter_mut().for_each(|entry| *entry /= length);
        scaled
    });
    let dependent = dependent_rows(&scaled.collect::<Vec<_>>(), MAX_DEPENDENT_REMAINDER);
    let places = rows.into_iter().enumerate();
    let independent = places.filter(|(place, _)| !dependent.contains(place));
    independent.map(|(_, row)| row).collect()
}

/// Equations M q' - A^T mu = p - b, A q' = -a_t for the rates at given momenta. A has the rows of the constraints and of
/// the contacts that act.
pub(super) struct Balance {
    pub values: CornerValues,
    mass: DMatrix<f64>,
    /// Momenta b at zero rates.
    constant_momenta: DVector<f64>,
    /// Rates a_t of the constraints at zero rates of the coordinates.
    drift: DVector<f64>,
    /// Contact of each row.
    contacts: Vec<Option<usize>>,
    matrix: nalgebra::LU<f64, nalgebra::Dyn, nalgebra::Dyn>,
}

impl Balance {
    /// Returns the rates at these momenta, and the impulses of the rows.
    pub(super) fn rates_at(&self, momenta: &DVector<f64>) -> Option<(DVector<f64>, DVector<f64>)> {
        self.solve(&(momenta - &self.constant_momenta), &-&self.drift)
    }

    /// Returns the changes of the rates and of the impulses of the rows by a unit impulse along a row.
    pub(super) fn column(&self, row: &DVector<f64>) -> Option<(DVector<f64>, DVector<f64>)> {
        self.solve(row, &DVector::zeros(self.drift.len()))
    }

    fn jump(self, passage: Passage, impulses: DVector<f64>) -> Jump {
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

/// Result of an arrival at a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Passage {
    /// The motion continues beyond the surface.
    Transmitted,
    /// The motion returns: its energy does not suffice, or its rate leads back already.
    Returned,
}

/// Jump of the rates at a surface.
struct Jump {
    passage: Passage,
    /// Impulse of each row.
    impulses: DVector<f64>,
    /// Contact of each row.
    contacts: Vec<Option<usize>>,
    mass: DMatrix<f64>,
    /// Momenta at zero rates.
    constant_momenta: DVector<f64>,
}

impl Jump {
    fn impulse_at(&self, contact: usize) -> f64 {
        let mut rows = self.contacts.iter().zip(&self.impulses);
        let found = rows.find(|(own, _)| **own == Some(contact));
        found.map_or(0.0, |(_, impulse)| *impulse)
    }
}

/// Applies the corner conditions at the surface `place`, with the contacts that push and do not pull. `None` if the rates
/// do not follow from the momenta beyond, or no choice of contacts is free of contradiction.
pub(super) fn pass(point: &mut SidedPoint<'_>, place: usize, side: f64) -> Option<Passage> {
    let jump = apply_with_contacts(point, |point| cross(point, place, side))?;
    Some(jump.passage)
}

/// Changes the rates for given momenta, with the contacts that push and do not pull.
pub(super) fn keep_momenta(point: &mut SidedPoint<'_>, momenta: &DVector<f64>) -> Option<()> {
    apply_with_contacts(point, |point| {
        let balance = point.balance()?;
        let (rates, impulses) = balance.rates_at(momenta)?;
        point.set_rates(&rates);
        Some(balance.jump(Passage::Transmitted, impulses))
    })?;
    Some(())
}

/// Applies a jump, and lets contacts act or part until none pulls and bodies move into none (least index first, as in
/// K. G. Murty's method for complementarity problems, which ends if the contacts are independent). Otherwise a
/// combination of independent contacts does.
fn apply_with_contacts(
    point: &mut SidedPoint<'_>,
    mut apply: impl FnMut(&mut SidedPoint<'_>) -> Option<Jump>,
) -> Option<Jump> {
    let (state, inputs, before) = (point.state.clone(), point.inputs.clone(), point.rates());
    let count = point.acts.len();
    for _ in 0..=MAX_CHANGES_PER_CONTACT * count {
        let jump = apply(point)?;
        let Some(place) = point.find_contradiction(&before, &jump)? else {
            return Some(jump);
        };
        point.acts[place] = !point.acts[place];
        point.state.clone_from(&state);
        point.inputs.clone_from(&inputs);
    }
    if count > MAX_COMBINED_CONTACTS {
        return None;
    }
    for combination in 0..1_u32 << count {
        for (place, acts) in point.acts.iter_mut().enumerate() {
            *acts = combination >> place & 1 == 1;
        }
        let jump = apply(point)?;
        let is_independent =
            jump.contacts.iter().flatten().count() == combination.count_ones() as usize;
        if is_independent && point.find_contradiction(&before, &jump)?.is_none() {
            return Some(jump);
        }
        point.state.clone_from(&state);
        point.inputs.clone_from(&inputs);
    }
    None
}

/// Applies the corner conditions at the surface `place`, with the contacts that act, to the rates of a point, whose side there changes to
/// `side` if the motion passes. `None` if the rates do not follow from the momenta beyond.
///
/// With the rates v0 at unchanged momenta, D = dv/dlambda and a = dg/dq D, the energy balance is
/// c + r lambda + a lambda^2/2 = 0, where r is the rate of g at v0 and c the change of H there. The rate of g
/// at the solutions is +-sqrt(r^2 - 2 a c); beyond the surface it keeps its sign.
fn cross(point: &mut SidedPoint<'_>, place: usize, side: f64) -> Option<Jump> {
    let first_side = point.inputs.len() - sides(point.evaluator);
    let direction = if side > 0.0 { 1.0 } else { -1.0 };
    let near = point.balance()?;
    let (arrival, row) = &near.values.surfaces[place];
    let row = DVector::from_column_slice(row);
    if direction * arrival <= 0.0 {
        let none = DVector::zeros(near.drift.len());
        return Some(near.jump(Passage::Returned, none));
    }
    let rates = point.rates();
    let own_rate = arrival - row.dot(&rates);
    let old_side = std::mem::replace(&mut point.inputs[first_side + place], side);
    let far = point.balance()?;
    let momenta = DVector::from_column_slice(&near.values.momenta);
    let (free, impulses) = far.rates_at(&momenta)?;
    let work = impulses.dot(&far.drift);
    let (column, reactions) = far.column(&row)?;
    let yielding = row.dot(&column);
    point.set_rates(&free);
    if yielding <= 0.0 {
        return Some(far.jump(Passage::Transmitted, impulses));
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
        return Some(far.jump(Passage::Transmitted, impulses + reactions * impulse));
    }
    point.inputs[first_side + place] = old_side;
    let (column, reactions) = near.column(&row)?;
    let impulse = -2.0 * arrival / row.dot(&column);
    point.set_rates(&(&rates + &column * impulse));
    Some(near.jump(Passage::Returned, reactions * impulse))
}

/// Returns the number of sides among the inputs of a program.
pub(super) fn sides(evaluator: &Evaluator) -> usize {
    let corners = evaluator.program().outputs.corners.as_ref();
    corners.map_or(0, |corners| corners.surfaces.len())
}
