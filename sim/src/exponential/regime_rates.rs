//! The rates of a regime as matrices, with the surfaces that hold the motion, and the scale in which
//! their exponential is taken.

use eomgen_codegen::program::affine::{AffineEvaluator, AffineSystem};
use nalgebra::{DMatrix, DVector, RowDVector};

use crate::balancing::{MAX_ENTRY_PER_S, balance, scale_matrix};

use super::surfaces::{Row, Side, Surfaces};

/// Smallest relative difference between the forces on the two sides of a surface. Smaller ones are
/// rounding.
const MIN_RELATIVE_JUMP: f64 = 1e-9;

/// Terms of a series for a part of a step: a step turns no mode by more than about one
/// radian, and 1/14! is rounding's size.
pub(super) const TERMS: usize = 14;

/// Steps that neighbouring motions make at once are doubled so often at most.
pub(super) const DOUBLINGS: usize = 6;

/// The rates of a regime as matrices.
#[derive(Clone)]
pub(super) struct Rates {
    /// By the state.
    pub state: DMatrix<f64>,
    /// By a unit constant and the inputs.
    pub given: DMatrix<f64>,
}

impl Rates {
    /// Returns true if all entries are finite.
    pub fn are_finite(&self) -> bool {
        let entries = self.state.iter().chain(self.given.iter());
        entries.copied().all(f64::is_finite)
    }

    /// Both blocks as rows of a square matrix; the others are 0.
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

/// Returns the rates with these sides, the surfaces' functions, and how surfaces hold the motion.
pub(super) fn held_rates(
    evaluator: &mut AffineEvaluator,
    surfaces: &Surfaces,
    sides: &[Side],
) -> Option<(Rates, Vec<Row>, HeldRates)> {
    let system = evaluator.system(&surfaces.guard_sides(sides, |_| 0.0));
    let mut rates = Rates::new(&system);
    let functions = surfaces.rows(&system);
    let held = hold(evaluator, surfaces, sides, &functions, &mut rates)?;
    Some((rates, functions, held))
}

/// Surfaces that hold a motion.
pub(super) struct HeldRates {
    /// For each of them its place and its side.
    pub sides: Vec<(usize, Row)>,
    /// Effect of the rates on these sides, a row for each.
    pub factor: DMatrix<f64>,
    /// Effect of a side on the rates, a column for each.
    pub jumps: DMatrix<f64>,
}

/// Makes the rates those of a state that is held where the sides say so.
fn hold(
    evaluator: &mut AffineEvaluator,
    surfaces: &Surfaces,
    sides: &[Side],
    functions: &[Row],
    rates: &mut Rates,
) -> Option<HeldRates> {
    let places: Vec<usize> = (0..sides.len())
        .filter(|place| sides[*place] == Side::Held)
        .collect();
    let n = rates.state.nrows();
    if places.is_empty() {
        return Some(HeldRates {
            sides: Vec::new(),
            factor: DMatrix::zeros(0, n),
            jumps: DMatrix::zeros(n, 0),
        });
    }
    let mut jumps = DMatrix::zeros(n, places.len());
    for (column, held) in places.iter().enumerate() {
        let numbers = surfaces.guard_sides(sides, |place| f64::from(u8::from(place == *held)));
        let other = Rates::new(&evaluator.system(&numbers));
        let difference = SideDifference::new(rates, &other, &functions[*held]);
        jumps.set_column(column, &difference.constant_jump()?);
    }
    let rows = DMatrix::from_fn(places.len(), n, |r, c| functions[places[r]].state[c]);
    let inverse = (&rows * &jumps).try_inverse()?;
    let factor = -inverse * rows;
    let of_state = &factor * &rates.state;
    let of_given = &factor * &rates.given;
    rates.state += &jumps * &of_state;
    rates.given += &jumps * &of_given;
    let row = |place: usize| Row {
        state: of_state.row(place).iter().copied().collect(),
        given: of_given.row(place).iter().copied().collect(),
    };
    let held = places.iter().enumerate();
    Some(HeldRates {
        sides: held.map(|(k, p)| (*p, row(k))).collect(),
        factor,
        jumps,
    })
}

/// Returns true if the forces of a surface can hold a motion but depend on the state or the inputs on the surface: its
/// share is then not linear.
pub(super) fn is_held_by_varying_forces(
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
    difference.constant_jump().is_none() && difference.changes_function()
}

/// Difference between the rates above a surface and those below, on the surface.
struct SideDifference<'f> {
    function: &'f Row,
    /// Powers of two that bring states of different units to like size.
    scale: Vec<f64>,
    /// Difference by the state, without the part that vanishes on the surface.
    state: DMatrix<f64>,
    /// Difference by a unit constant and the inputs, in the same way.
    given: DMatrix<f64>,
    /// Largest scaled rate by the state.
    state_size: f64,
    /// Magnitudes of the rates by a unit constant and the inputs.
    given_sizes: DMatrix<f64>,
}

impl<'f> SideDifference<'f> {
    fn new(below: &Rates, above: &Rates, function: &'f Row) -> Self {
        let scale = state_scale(&below.state);
        let [one, other] = [below, above].map(|rates| scale_matrix(&rates.state, &scale).amax());
        let mut found = Self {
            state: &above.state - &below.state,
            given: &above.given - &below.given,
            state_size: one.max(other),
            given_sizes: above.given.abs().sup(&below.given.abs()),
            scale,
            function,
        };
        found.remove_multiples();
        found
    }

    /// Subtracts the multiples of the function, which vanish on the surface.
    fn remove_multiples(&mut self) {
        let entries = self.function.state.iter().zip(&self.scale);
        let sizes = entries.map(|(entry, scale)| (entry * scale).abs());
        let largest = sizes.enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
        let Some((place, _)) = largest.filter(|(_, size)| *size > 0.0) else {
            return;
        };
        let multiple = self.state.column(place) / self.function.state[place];
        for (matrix, row) in [
            (&mut self.state, &self.function.state),
            (&mut self.given, &self.function.given),
        ] {
            for (mut column, entry) in matrix.column_iter_mut().zip(row) {
                column -= &multiple * *entry;
            }
        }
    }

    /// Returns the difference if it is constant on the surface.
    fn constant_jump(&self) -> Option<DVector<f64>> {
        let state = scale_matrix(&self.state, &self.scale);
        let is_constant = state.amax() <= MIN_RELATIVE_JUMP * self.state_size;
        let inputs = 1..self.given.ncols();
        let mut inputs = inputs.map(|input| {
            let sizes = self.given_sizes.column(input);
            self.given.column(input).amax() <= MIN_RELATIVE_JUMP * sizes.amax()
        });
        (is_constant && inputs.all(|is_constant| is_constant)).then(|| self.given.column(0).into())
    }

    /// Returns true if the difference changes the rate of the function.
    fn changes_function(&self) -> bool {
        let row = RowDVector::from_row_slice(&self.function.state);
        let changes = |difference: &DMatrix<f64>| {
            let change = &row * difference;
            let size = row.abs() * difference.abs();
            let mut entries = change.iter().zip(size.iter());
            entries.any(|(change, size)| change.abs() > MIN_RELATIVE_JUMP * size)
        };
        let state = scale_matrix(&self.state, &self.scale);
        let is_rounding = state.amax() <= MIN_RELATIVE_JUMP * self.state_size;
        !is_rounding && changes(&self.state) || changes(&self.given)
    }
}

/// Powers of two that bring states of different units to like size.
pub(super) fn state_scale(rates: &DMatrix<f64>) -> Vec<f64> {
    let one = vec![1.0; rates.nrows()];
    match rates.iter().all(|entry| entry.abs() < MAX_ENTRY_PER_S) {
        true => balance(rates, one),
        false => one,
    }
}

/// Powers of two that balance such a matrix for its exponential.
pub(super) fn flow_scale(whole: &DMatrix<f64>, states: usize, step: f64) -> Vec<f64> {
    let rates = whole.view((0, 0), (states, states)).into_owned();
    let mut scale = state_scale(&rates);
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
