//! One regime of a piecewise-linear model, prepared for steps of one length: x' = A x + B u, where u contains a
//! unit constant and the inputs. On holding surfaces, the rates are the convex combination of the rates on both
//! sides that stays on the surfaces.

use eomgen_analysis::qr_iteration;
use eomgen_codegen::program::affine::AffineEvaluator;
use nalgebra::DMatrix;

use crate::balancing::scale_matrix;

use super::kernels::Columns;
use super::parameter_derivatives::RegimeDerivative;
use super::regime_rates::{
    HeldRates, MAX_DOUBLINGS, Rates, compute_held_rates, find_flow_scale, find_state_scale,
};
use super::surfaces::{Row, Side, Surfaces, dot};

/// Matrices of one regime.
#[derive(Clone, Debug)]
pub struct Regime {
    /// Length of a step, s.
    pub length: f64,
    /// Matrix A of the rates, states x states.
    pub matrix: Columns,
    /// Matrix B, which maps (1, inputs) to the rates.
    pub given: DMatrix<f64>,
    /// Map from the state to the state after a step, followed by the surfaces' functions and their rates there.
    pub step: Columns,
    /// Contribution of (1, inputs), held over the step, to the rows of `step`.
    pub step_given: Columns,
    /// Contribution of accelerations, held over the step, to the rows of `step`.
    pub step_force: Columns,
    /// Matrices of 1, 2, 4 ... steps, for tangent vectors.
    pub doubled: Vec<DoubledStep>,
    /// Derivatives with respect to the parameters of the tangent vectors.
    pub(super) by_parameter: Vec<RegimeDerivative>,
    /// Functions of the surfaces.
    pub functions: Vec<Row>,
    /// Rates of the surfaces' functions.
    pub rates: Vec<Row>,
    /// Surfaces that hold the motion.
    pub held: Vec<HeldSurface>,
    /// Effect of external accelerations on the holding forces, one row per holding surface, and effect of the
    /// holding forces on the accelerations, one column per surface.
    force_effects: (DMatrix<f64>, DMatrix<f64>),
}

/// Matrices for several steps at once.
#[derive(Clone, Debug)]
pub struct DoubledStep {
    /// Map from the state at the start to the state at the end.
    pub state: Columns,
    /// Contribution of (1, inputs), held over these steps.
    pub given: Columns,
    /// Contribution of accelerations held over these steps.
    pub force: Columns,
}

/// A surface that holds a motion. Its holding force lies between the forces on both sides. It is measured by
/// the reduction of the rate of the surface's function, relative to the lower side.
#[derive(Clone, Debug)]
pub struct HeldSurface {
    /// Index of the surface.
    pub surface: usize,
    /// Holding force. If it becomes negative, breakaway to the lower side occurs.
    pub above_low: HoldingForce,
    /// Holding force minus the force on the upper side. If it becomes positive, breakaway to the
    /// upper side occurs.
    pub above_high: HoldingForce,
    /// Shortest change of the state that increases the surface's function by one.
    pub across: Vec<f64>,
}

/// A holding force and its rate, 1/s times the unit of the force.
#[derive(Clone, Debug)]
pub struct HoldingForce {
    pub value: Row,
    pub rate: Row,
}

impl HeldSurface {
    fn new(
        surface: usize,
        (force, difference): (Row, &Row),
        function: &Row,
        rates: &Rates,
    ) -> Self {
        let above_high = force.subtract(difference);
        let holding = |value: Row| HoldingForce {
            rate: compute_function_rate(&value, rates),
            value,
        };
        Self {
            surface,
            above_low: holding(force),
            above_high: holding(above_high),
            across: find_shortest_change(&function.state),
        }
    }

    /// Returns the holding force relative to the force on a side.
    pub fn force_relative_to(&self, side: Side) -> &HoldingForce {
        match side {
            Side::Above => &self.above_high,
            Side::Below | Side::Held => &self.above_low,
        }
    }

    /// Returns the difference of the forces on both sides, and the share of the upper side in the holding
    /// force.
    pub fn compute_difference_and_share(&self, state: &[f64], inputs: &[f64]) -> (f64, f64) {
        let [low, high] = [&self.above_low, &self.above_high]
            .map(|force| force.value.evaluate_with_inputs(state, inputs));
        let difference = low - high;
        let share = if difference == 0.0 {
            0.0
        } else {
            low / difference
        };
        (difference, share)
    }
}

impl Regime {
    /// Creates the regime with these sides, for steps of `step` s. Returns `None` if the surfaces cannot hold
    /// the motion as given by `sides`, or a matrix is not finite.
    pub fn new(
        evaluator: &mut AffineEvaluator,
        surfaces: &Surfaces,
        sides: &[Side],
        step: f64,
    ) -> Option<Self> {
        let (rates, functions, held) = compute_held_rates(evaluator, surfaces, sides)?;
        let HeldRates {
            forces,
            factor,
            directions,
        } = held;
        if !rates.are_finite() {
            return None;
        }
        let held = forces.into_iter().map(|(surface, force, difference)| {
            HeldSurface::new(surface, (force, &difference), &functions[surface], &rates)
        });
        let held = held.collect();
        let n = rates.state.nrows();
        let degrees = evaluator.degrees_of_freedom();
        let forced = evaluator.model_states() - degrees;
        let holding_force_change = (
            factor.columns(degrees, forced).into_owned(),
            directions.rows(degrees, forced).into_owned(),
        );
        let given = rates.given.ncols();
        let columns = n + given + forced;
        let mut whole = rates.joined_matrix().resize(columns, columns, 0.0);
        for index in 0..forced {
            whole[(degrees + index, n + given + index)] = 1.0;
        }
        let flow = compute_exponential(&whole, n, step);
        let mut doubled = Vec::with_capacity(MAX_DOUBLINGS);
        let mut longer = flow.clone();
        for _ in 0..MAX_DOUBLINGS {
            doubled.push(DoubledStep {
                state: Columns::from_entries(n, n, |r, c| longer[(r, c)]),
                given: Columns::from_entries(n, given, |r, c| longer[(r, n + c)]),
                force: Columns::from_entries(n, forced, |r, c| longer[(r, n + given + c)]),
            });
            longer = &longer * &longer;
        }
        let speeds: Vec<Row> = functions
            .iter()
            .map(|row| compute_function_rate(row, &rates))
            .collect();
        let below: Vec<&Row> = functions.iter().chain(&speeds).collect();
        let row_of = |row: usize, column: usize, own: Option<usize>| {
            if row < n {
                return flow[(row, column)];
            }
            let function = below[row - n];
            let sum: f64 = (0..n).map(|k| function.state[k] * flow[(k, column)]).sum();
            sum + own.map_or(0.0, |index| function.given[index])
        };
        let rows = n + below.len();
        Some(Self {
            length: step,
            matrix: Columns::from_entries(n, n, |r, c| rates.state[(r, c)]),
            step: Columns::from_entries(rows, n, |r, c| row_of(r, c, None)),
            step_given: Columns::from_entries(rows, given, |r, c| row_of(r, n + c, Some(c))),
            step_force: Columns::from_entries(rows, forced, |r, c| row_of(r, n + given + c, None)),
            doubled,
            by_parameter: Vec::new(),
            given: rates.given,
            functions,
            rates: speeds,
            held,
            force_effects: holding_force_change,
        })
    }
}

impl Regime {
    /// Subtracts the reaction of holding surfaces from external accelerations, and writes the change of their
    /// holding forces to `forces`.
    pub fn subtract_held(&self, accelerations: &mut [f64], forces: &mut Vec<f64>) {
        forces.clear();
        if self.held.is_empty() {
            return;
        }
        let (factor, directions) = &self.force_effects;
        for row in factor.row_iter() {
            let products = row.iter().zip(accelerations.iter());
            forces.push(products.map(|(a, b)| a * b).sum());
        }
        for (column, force) in directions.column_iter().zip(forces.iter()) {
            let sums = accelerations.iter_mut().zip(column.iter());
            sums.for_each(|(slot, entry)| *slot += entry * force);
        }
    }

    /// Writes the rates at a state with (1, inputs) `given`; `out` has an entry for each row of the matrix.
    pub fn rates(&self, state: &[f64], given: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        for (column, value) in self.given.column_iter().zip(given) {
            let sums = out.iter_mut().zip(column.iter());
            sums.for_each(|(o, c)| *o += c * value);
        }
        self.matrix.add_product(state, out);
    }
}

/// Returns the shortest change of the state that increases a function by one.
fn find_shortest_change(function: &[f64]) -> Vec<f64> {
    let square = dot(function, function);
    function.iter().map(|entry| entry / square).collect()
}

/// Returns the rate of a function for these rates of the state.
fn compute_function_rate(row: &Row, rates: &Rates) -> Row {
    let times = |matrix: &DMatrix<f64>| -> Vec<f64> {
        let columns = matrix.column_iter();
        columns
            .map(|column| column.iter().zip(&row.state).map(|(a, b)| a * b).sum())
            .collect()
    };
    Row {
        state: times(&rates.state),
        given: times(&rates.given),
    }
}

/// Returns exp(W h) of a matrix whose first `states` rows are rates; its other rows are 0. The matrix is
/// balanced first because its norm determines the number of squarings.
fn compute_exponential(whole: &DMatrix<f64>, states: usize, step: f64) -> DMatrix<f64> {
    let scale = find_flow_scale(whole, states, step);
    let flow = (scale_matrix(whole, &scale) * step).exp();
    let back: Vec<f64> = scale.iter().map(|factor| 1.0 / factor).collect();
    scale_matrix(&flow, &back)
}

/// Returns the largest magnitude of the eigenvalues of the rates over all regimes, 1/s.
pub fn fastest_rate(evaluator: &mut AffineEvaluator, surfaces: &Surfaces) -> f64 {
    let count = surfaces.guards.len();
    let mut fastest: f64 = 0.0;
    for case in 0..count + 2 {
        let side = |index: usize| match case == count + 1 || index == case {
            true => Side::Above,
            false => Side::Below,
        };
        let sides: Vec<Side> = (0..count).map(side).collect();
        let system = evaluator.system(&surfaces.guard_sides(&sides, |_| 0.0));
        let rates = Rates::new(&system);
        if rates.state.iter().all(|entry| entry.is_finite()) {
            // If the eigenvalue iteration does not converge, no step is short enough.
            let balanced = scale_matrix(&rates.state, &find_state_scale(&rates.state));
            let eigenvalues = qr_iteration::eigenvalues(&balanced);
            let sizes = eigenvalues.map(|all| all.iter().map(|e| e.norm()).fold(0.0, f64::max));
            fastest = fastest.max(sizes.unwrap_or(f64::INFINITY));
        }
    }
    fastest
}
