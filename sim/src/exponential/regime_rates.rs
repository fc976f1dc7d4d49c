//! Rates of a regime as matrices, reduced to the surfaces that hold the motion, and the balancing of these
//! matrices for their exponential.

use eomgen_codegen::program::affine::{AffineEvaluator, AffineSystem};
use nalgebra::{DMatrix, DVector, DVectorView, RowDVector};

use crate::balancing::{MAX_ENTRY_PER_S, balance, scale_matrix};

use super::surfaces::{Row, Side, Surfaces};

/// Smallest relative difference between the forces on the two sides of a surface; smaller differences are
/// rounding.
const MIN_RELATIVE_JUMP: f64 = 1e-9;

/// Number of terms of the exponential series for a part of a step. A step turns no mode by more than about one
/// radian, and 1/14! is of the order of rounding.
pub(super) const TERMS: usize = 14;

/// Maximum number of doublings of the steps of tangent vectors.
pub(super) const MAX_DOUBLINGS: usize = 6;

/// Rates of a regime as matrices.
#[derive(Clone)]
pub(super) struct Rates {
    /// Matrix that maps the state to the rates.
    pub state: DMatrix<f64>,
    /// Matrix that maps (1, inputs) to the rates.
    pub given: DMatrix<f64>,
}

impl Rates {
    /// Returns true if all entries are finite.
    pub fn are_finite(&self) -> bool {
        let entries = self.state.iter().chain(self.given.iter());
        entries.copied().all(f64::is_finite)
    }

    /// Returns both matrices as the upper rows of a square matrix; the other rows are 0.
    pub fn joined_matrix(&self) -> DMatrix<f64> {
        let (n, given) = self.given.shape();
        let mut whole = DMatrix::zeros(n + given, n + given);
        whole.view_mut((0, 0), (n, n)).copy_from(&self.state);
        whole.view_mut((0, n), (n, given)).copy_from(&self.given);
        whole
    }

    pub fn new(system: &AffineSystem) -> Self {
        let n = system.states;
        let inputs = system.rates.inputs.len() / n.max(1);
        Self {
            state: DMatrix::from_row_slice(n, n, &system.rates.state),
            given: DMatrix::from_fn(n, inputs + 1, |row, column| match column {
                0 => system.rates.constant[row],
                _ => system.rates.inputs[row * inputs + column - 1],
            }),
        }
    }
}

/// Returns the rates with these sides, the surfaces' functions, and the data of holding surfaces.
pub(super) fn compute_held_rates(
    evaluator: &mut AffineEvaluator,
    surfaces: &Surfaces,
    sides: &[Side],
) -> Option<(Rates, Vec<Row>, HeldRates)> {
    let system = evaluator.system(&surfaces.guard_sides(sides, |_| 0.0));
    let mut rates = Rates::new(&system);
    let functions = surfaces.rows(&system);
    let held = hold_on_surfaces(evaluator, surfaces, sides, &functions, &mut rates)?;
    Some((rates, functions, held))
}

/// Surfaces that hold a motion. Their holding forces are measured by the reduction of the rates of their
/// functions.
pub(super) struct HeldRates {
    /// For each holding surface: its index, its holding force relative to the lower side, and the difference of
    /// the forces on both sides.
    pub forces: Vec<(usize, Row, Row)>,
    /// Effect of the rates on the holding forces, one row per surface.
    pub factor: DMatrix<f64>,
    /// Effect of a holding force on the rates, one column per surface.
    pub directions: DMatrix<f64>,
}

/// Reduces the rates to those on the holding surfaces of `sides`.
fn hold_on_surfaces(
    evaluator: &mut AffineEvaluator,
    surfaces: &Surfaces,
    sides: &[Side],
    functions: &[Row],
    rates: &mut Rates,
) -> Option<HeldRates> {
    let indices: Vec<usize> = (0..sides.len())
        .filter(|place| sides[*place] == Side::Held)
        .collect();
    let n = rates.state.nrows();
    let mut directions = DMatrix::zeros(n, indices.len());
    let mut differences = Vec::with_capacity(indices.len());
    for (column, held) in indices.iter().enumerate() {
        let numbers = surfaces.guard_sides(sides, |place| f64::from(u8::from(place == *held)));
        let other = Rates::new(&evaluator.system(&numbers));
        let difference = SideDifference::new(rates, &other, &functions[*held]);
        directions.set_column(column, &difference.find_direction()?);
        differences.push(difference.compute_function_reduction());
    }
    let rows = DMatrix::from_fn(indices.len(), n, |r, c| functions[indices[r]].state[c]);
    let factor = match indices.is_empty() {
        true => rows,
        false => -(&rows * &directions).try_inverse()? * rows,
    };
    let of_state = &factor * &rates.state;
    let of_given = &factor * &rates.given;
    rates.state += &directions * &of_state;
    rates.given += &directions * &of_given;
    let row = |place: usize| Row {
        state: of_state.row(place).iter().copied().collect(),
        given: of_given.row(place).iter().copied().collect(),
    };
    let forces = indices.iter().zip(differences).enumerate();
    Some(HeldRates {
        forces: forces
            .map(|(index, (place, difference))| (*place, row(index), difference))
            .collect(),
        factor,
        directions,
    })
}

/// Returns true if a surface can hold a motion by forces whose direction depends on the state or the inputs.
/// The held motion is then not linear.
pub(super) fn is_held_in_varying_direction(
    evaluator: &mut AffineEvaluator,
    surfaces: &Surfaces,
    surface: usize,
    others: Side,
) -> bool {
    let count = surfaces.guards.len();
    let mut rates_on = |side: Side| {
        let sides: Vec<Side> = (0..count)
            .map(|place| if place == surface { side } else { others })
            .collect();
        let system = evaluator.system(&surfaces.guard_sides(&sides, |_| 0.0));
        (Rates::new(&system), surfaces.rows(&system))
    };
    let (above, _) = rates_on(Side::Above);
    let (below, functions) = rates_on(Side::Below);
    let difference = SideDifference::new(&below, &above, &functions[surface]);
    difference.find_direction().is_none() && difference.changes_function()
}

/// Difference of the rates above and below a surface, on the surface. States are scaled to similar size.
struct SideDifference {
    /// Matrix that maps the state and (1, inputs) to the difference. Columns at the level of rounding are 0.
    columns: DMatrix<f64>,
    /// Rounding of each column.
    roundings: Vec<f64>,
    /// Function of the surface, as a row over the states.
    function: RowDVector<f64>,
    /// Powers of two that scale the states.
    scale: Vec<f64>,
}

impl SideDifference {
    fn new(below: &Rates, above: &Rates, function: &Row) -> Self {
        let scale = find_state_scale(&below.state);
        let states = scale.len();
        let scaled = |rates: &Rates| {
            let [states, given] = [&rates.state, &rates.given].map(DMatrix::ncols);
            DMatrix::from_fn(states, states + given, |row, column| {
                let entry = match column < states {
                    true => rates.state[(row, column)] * scale[column],
                    false => rates.given[(row, column - states)],
                };
                entry / scale[row]
            })
        };
        let [one, other] = [below, above].map(scaled);
        let sizes = one.abs().sup(&other.abs());
        let largest = sizes.columns(0, states).amax();
        let size = |column: usize| match column < states {
            true => largest,
            false => sizes.column(column).amax(),
        };
        let entries = function.state.iter().zip(&scale);
        let entries = entries.map(|(entry, scale)| entry * scale);
        let mut found = Self {
            roundings: (0..sizes.ncols())
                .map(|column| MIN_RELATIVE_JUMP * size(column))
                .collect(),
            columns: other - one,
            function: RowDVector::from_iterator(states, entries),
            scale,
        };
        found.remove_multiples(function);
        for (mut column, rounding) in found.columns.column_iter_mut().zip(&found.roundings) {
            if column.amax() <= *rounding {
                column.fill(0.0);
            }
        }
        found
    }

    /// Subtracts the multiples of the function, which vanish on the surface.
    fn remove_multiples(&mut self, function: &Row) {
        let place = self.function.transpose().iamax();
        let entry = self.function[place];
        if entry == 0.0 {
            return;
        }
        let multiple = self.columns.column(place) / entry;
        let entries: Vec<f64> = self
            .function
            .iter()
            .chain(&function.given)
            .copied()
            .collect();
        for (mut column, entry) in self.columns.column_iter_mut().zip(entries) {
            column -= &multiple * entry;
        }
    }

    /// Returns the reduction of the function's rate by the difference: positive if this rate is lower
    /// above the surface than below.
    fn compute_function_reduction(&self) -> Row {
        let states = self.scale.len();
        let rates = -&self.function * &self.columns;
        let by_state = rates.iter().zip(&self.scale);
        Row {
            state: by_state.map(|(rate, scale)| rate / scale).collect(),
            given: rates.iter().skip(states).copied().collect(),
        }
    }

    /// Returns the direction of the difference, scaled such that it reduces the function's rate by 1. Returns
    /// `None` if the direction is not constant on the surface or does not change the function.
    fn find_direction(&self) -> Option<DVector<f64>> {
        let columns = self.columns.column_iter().zip(&self.roundings);
        let present = columns.filter(|(column, _)| column.amax() > 0.0);
        let (clearest, _) = present.max_by(|a, b| {
            let [a, b] = [a, b].map(|(column, rounding)| column.amax() / *rounding);
            a.total_cmp(&b)
        })?;
        let rate = self.find_function_change(clearest)?;
        let direction = clearest / -rate;
        let mut columns = self.columns.column_iter().zip(&self.roundings);
        let is_constant = columns.all(|(column, rounding)| {
            let rate = (&self.function * column)[0];
            (column + &direction * rate).amax() <= *rounding
        });
        let scale = DVector::from_column_slice(&self.scale);
        is_constant.then(|| direction.component_mul(&scale))
    }

    /// Returns true if the difference changes the rate of the function.
    fn changes_function(&self) -> bool {
        let mut columns = self.columns.column_iter();
        columns.any(|column| self.find_function_change(column).is_some())
    }

    /// Returns the change of the function's rate by a column; `None` if it is rounding.
    fn find_function_change(&self, column: DVectorView<'_, f64>) -> Option<f64> {
        let rate = (&self.function * column)[0];
        let size = (self.function.abs() * column.abs())[0];
        (rate.abs() > MIN_RELATIVE_JUMP * size).then_some(rate)
    }
}

/// Returns powers of two that scale states of different units to similar size.
pub(super) fn find_state_scale(rates: &DMatrix<f64>) -> Vec<f64> {
    let one = vec![1.0; rates.nrows()];
    match rates.iter().all(|entry| entry.abs() < MAX_ENTRY_PER_S) {
        true => balance(rates, one),
        false => one,
    }
}

/// Returns powers of two that balance the matrix of [`Rates::joined_matrix`] for its exponential.
pub(super) fn find_flow_scale(whole: &DMatrix<f64>, states: usize, step: f64) -> Vec<f64> {
    let rates = whole.view((0, 0), (states, states)).into_owned();
    let mut scale = find_state_scale(&rates);
    let largest = scale_matrix(&rates, &scale).amax().max(1.0 / step);
    for column in whole.column_iter().skip(states) {
        let entries = column.iter().zip(&scale);
        let size = entries
            .map(|(entry, scale)| (entry / scale).abs())
            .fold(0.0, f64::max);
        let is_used = size > 0.0 && size.is_finite();
        scale.push(if is_used {
            (largest / size).log2().floor().exp2()
        } else {
            1.0
        });
    }
    scale
}
