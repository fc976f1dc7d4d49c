//! Detection of singular positions, at which constraints depend on each other.
//!
//! Let R be the rows of the constraints in the metric of the inertias. Then F = (R R^T)^(-1/2) R has orthonormal rows
//! that turn smoothly along a motion. If R loses rank and regains it, as when a parallelogram folds flat, one direction
//! of F changes its sign. F_1 F_2^T of the states before and after then has the eigenvalue -1, for any step length.
//! Inside a step, coordinates follow the cubic through the coordinates and rates at both ends.
//!
//! If constraints depend on each other at every state, R contains only independent rows, chosen at the start of each
//! interval. At a singular position every choice loses rank.
//!
//! The rounding error of accelerations grows with the reciprocal square of the least singular value of R, so steps may
//! fail before the position is reached. The motion is then extrapolated from the coordinates, rates and accelerations
//! of its last state.

use eomgen_analysis::qr_iteration::symmetric_eigen;
use eomgen_codegen::independence::rows::ConstraintRows;
use eomgen_codegen::independence::vectors::norm;
use eomgen_codegen::program::evaluator::Point;
use eomgen_model_spec::argument::Argument;
use eomgen_sim::inputs::HeldInputs;
use nalgebra::{DMatrix, DVector, Dyn, RowDVector, SymmetricEigen};

use crate::constraint_rank::ConstraintRank;

/// Smallest eigenvalue of the symmetric part of F_1 F_2^T if no direction has turned by more than 60 degrees.
const MIN_TURN_EIGENVALUE: f64 = 0.5;

const MAX_HALVINGS: u32 = 40;

/// Constraints count as dependent if the least singular value of the scaled rows is below this limit.
const SINGULAR_VALUE_LIMIT: f64 = 1e-3;

/// Least singular value of the scaled rows below which accelerations have no accurate digits: the square root of the
/// unit roundoff.
const UNDETERMINED_VALUE_LIMIT: f64 = 1.5e-8;

/// Least singular value of the scaled rows below which a step ends the motion if its straight continuation reaches a
/// singular position. Accelerations have eight accurate digits there, and fewer after every shorter step.
const IMMINENT_VALUE_LIMIT: f64 = 1e-4;

/// A motion is extrapolated to a singular position if the least singular value of the scaled rows is below this limit.
const NEAR_SINGULAR_VALUE_LIMIT: f64 = 0.1;

/// Maximum number of doublings of the extrapolated time, which starts at its rounding error.
const MAX_DOUBLINGS: i32 = 52;

/// Number of states kept before the current one: the starts of this step and of the preceding step.
const KEPT_STATES: usize = 2;

struct WatchedState {
    t: f64,
    state: Vec<f64>,
    /// Scaled rows R of all constraints.
    rows: DMatrix<f64>,
    /// Orthonormal rows F if all constraints are independent.
    frame: Option<DMatrix<f64>>,
    /// Least singular value of the scaled rows, without singular values that vanish at every state.
    least: f64,
    /// Combination of the constraints that belongs to the least singular value.
    dependent_combination: DVector<f64>,
}

/// States on a path as a function of time (s).
type Path<'p> = dyn Fn(f64) -> Vec<f64> + 'p;

/// Detector of singular positions along a motion.
pub(crate) struct SingularityWatch {
    rows: ConstraintRows,
    names: Vec<String>,
    /// Number of constraints that depend on the others at every state.
    excess: usize,
    /// Largest length of each row so far, because a single row may vanish.
    lengths: Vec<f64>,
    passed: Vec<WatchedState>,
    found: Option<(f64, String)>,
}

impl SingularityWatch {
    /// Creates a detector for constraints; `excess` of them depend on the others at every state.
    pub(crate) fn new(rows: ConstraintRows, names: Vec<String>, excess: usize) -> Self {
        Self {
            rows,
            excess,
            lengths: vec![0.0; names.len()],
            names,
            passed: Vec::new(),
            found: None,
        }
    }

    /// Returns true if the motion passes a singular position between the last state and the given one.
    pub(crate) fn passes_singularity(
        &mut self,
        t: f64,
        state: &[f64],
        inputs: &HeldInputs,
    ) -> bool {
        // The solver rejected the steps to later times.
        self.passed.retain(|earlier| earlier.t < t);
        let Some(here) = self.watch_state(t, state.to_vec(), inputs) else {
            return false;
        };
        if here.least <= UNDETERMINED_VALUE_LIMIT {
            self.found = Some(self.describe_singularity(&here));
            return true;
        }
        if here.least <= IMMINENT_VALUE_LIMIT {
            let straight = vec![0.0; here.state.len()];
            if let Some(fold) = self.find_singularity_ahead(&here, &straight, inputs) {
                self.found = Some(self.describe_singularity(&fold));
                return true;
            }
        }
        if let Some(last) = self.passed.pop() {
            let path = interpolate_cubic(&last, &here, self.degrees());
            let fold = self.find_singularity_between(&last, &here, &path, inputs);
            self.passed.push(last);
            if let Some(fold) = fold {
                self.found = Some(self.describe_singularity(&fold));
                return true;
            }
        }
        self.passed.push(here);
        let forgotten = self.passed.len().saturating_sub(KEPT_STATES);
        self.passed.drain(..forgotten);
        false
    }

    /// Returns the time (s) of the singular position that stopped the motion, and a message; `None` if there is none.
    /// The solver stopped at `t` (s) and `state`, with the given rates.
    pub(crate) fn find_end(
        &mut self,
        (t, state): (f64, &[f64]),
        rates: &[f64],
        inputs: &HeldInputs,
    ) -> Option<(f64, String)> {
        let ahead = self
            .watch_state(t, state.to_vec(), inputs)
            .and_then(|last| {
                if last.least > NEAR_SINGULAR_VALUE_LIMIT {
                    return None;
                }
                let fold = self.find_singularity_ahead(&last, rates, inputs);
                let fold = fold.or((last.least <= SINGULAR_VALUE_LIMIT).then_some(last))?;
                Some(self.describe_singularity(&fold))
            });
        ahead.or_else(|| self.found.clone())
    }

    fn compute_scaled_rows(&mut self, t: f64, state: &[f64], inputs: &HeldInputs) -> DMatrix<f64> {
        let inputs = &inputs.evaluate(t);
        let rows = self.rows.rows(Point { t, state, inputs });
        for (length, row) in self.lengths.iter_mut().zip(&rows) {
            *length = length.max(norm(row));
        }
        let columns = rows.first().map_or(0, Vec::len);
        DMatrix::from_fn(rows.len(), columns, |row, column| {
            rows[row][column] / self.lengths[row].max(f64::MIN_POSITIVE)
        })
    }

    fn watch_state(
        &mut self,
        t: f64,
        state: Vec<f64>,
        inputs: &HeldInputs,
    ) -> Option<WatchedState> {
        let rows = self.compute_scaled_rows(t, &state, inputs);
        if rows.iter().any(|entry| !entry.is_finite()) {
            return None;
        }
        let rank = ConstraintRank::new(&rows, self.excess)?;
        Some(WatchedState {
            t,
            state,
            frame: (self.excess == 0).then(|| compute_orthonormal_rows(rank.squares, &rows)),
            rows,
            least: rank.least,
            dependent_combination: rank.dependent_combination,
        })
    }

    /// Returns the frames F of two states, for the same constraints.
    fn compute_frames(&self, a: &WatchedState, b: &WatchedState) -> Option<[DMatrix<f64>; 2]> {
        if let (Some(a), Some(b)) = (&a.frame, &b.frame) {
            return Some([a.clone(), b.clone()]);
        }
        let count = a.rows.nrows();
        let mut places = RowDVector::from_fn(count, |_, place| place as f64);
        let factors = a.rows.transpose().col_piv_qr();
        factors.p().permute_columns(&mut places);
        let best = places.iter().take(count - self.excess);
        let best: Vec<usize> = best.map(|place| *place as usize).collect();
        let frame = |state: &WatchedState| {
            let rows = state.rows.select_rows(&best);
            let squares = symmetric_eigen(&(&rows * rows.transpose()))?;
            Some(compute_orthonormal_rows(squares, &rows))
        };
        Some([frame(a)?, frame(b)?])
    }

    fn find_singularity_between(
        &mut self,
        a: &WatchedState,
        b: &WatchedState,
        path: &Path<'_>,
        inputs: &HeldInputs,
    ) -> Option<WatchedState> {
        let t = 0.5 * (a.t + b.t);
        let middle = self.watch_state(t, path(t), inputs)?;
        let first = self.search((a, &middle), path, inputs, MAX_HALVINGS);
        first.or_else(|| self.search((&middle, b), path, inputs, MAX_HALVINGS))
    }

    /// Returns the singular position that the extrapolated motion reaches, if there is one.
    fn find_singularity_ahead(
        &mut self,
        last: &WatchedState,
        rates: &[f64],
        inputs: &HeldInputs,
    ) -> Option<WatchedState> {
        let degrees = self.degrees();
        let path = |t: f64| {
            let (time, mut state) = (t - last.t, last.state.clone());
            for k in 0..degrees {
                let (rate, acceleration) = (last.state[degrees + k], rates[degrees + k]);
                state[k] += time * (rate + 0.5 * time * acceleration);
                state[degrees + k] += time * acceleration;
            }
            state
        };
        for doubling in 0..MAX_DOUBLINGS {
            let t = last.t + f64::EPSILON * last.t.abs() * 2.0_f64.powi(doubling);
            let there = self.watch_state(t, path(t), inputs)?;
            let fold = self.search((last, &there), &path, inputs, MAX_HALVINGS);
            if fold.is_some() || there.least > 2.0 * NEAR_SINGULAR_VALUE_LIMIT {
                return fold;
            }
        }
        None
    }

    fn degrees(&self) -> usize {
        self.rows.degrees_of_freedom()
    }

    fn search(
        &mut self,
        (a, b): (&WatchedState, &WatchedState),
        path: &Path<'_>,
        inputs: &HeldInputs,
        halvings: u32,
    ) -> Option<WatchedState> {
        let [from, to] = self.compute_frames(a, b)?;
        let turned = from * to.transpose();
        let symmetric = 0.5 * (&turned + turned.transpose());
        if symmetric_eigen(&symmetric)?.eigenvalues.min() > MIN_TURN_EIGENVALUE {
            return None;
        }
        let t = a.t + 0.5 * (b.t - a.t);
        let middle = self.watch_state(t, path(t), inputs)?;
        if halvings == 0 || t <= a.t || t >= b.t {
            return Some(middle);
        }
        let first = self.search((a, &middle), path, inputs, halvings - 1);
        let found = first.or_else(|| self.search((&middle, b), path, inputs, halvings - 1));
        // Errors of the coordinates replace a singular position by a fast turn of F nearby.
        found.or((middle.least <= SINGULAR_VALUE_LIMIT).then_some(middle))
    }

    fn describe_singularity(&self, fold: &WatchedState) -> (f64, String) {
        (fold.t, self.reason(fold.t, &fold.dependent_combination))
    }

    fn reason(&self, t: f64, combined: &DVector<f64>) -> String {
        let what = ConstraintRank::describe(combined, self.names.iter());
        format!(
            "at t = {t:?} s the motion reaches a singular position: {what}. The accelerations are not determined there; \
             shorten the time, or avoid the position (add a stop, or choose another initial state with {})",
            Argument::State
        )
    }
}

/// Returns (R R^T)^(-1/2) R for the rows R, from the eigenvalues of R R^T.
fn compute_orthonormal_rows(
    mut squares: SymmetricEigen<f64, Dyn>,
    rows: &DMatrix<f64>,
) -> DMatrix<f64> {
    for value in squares.eigenvalues.iter_mut() {
        *value = value.max(f64::MIN_POSITIVE).sqrt().recip();
    }
    squares.recompose() * rows
}

fn interpolate_cubic(
    a: &WatchedState,
    b: &WatchedState,
    degrees: usize,
) -> impl Fn(f64) -> Vec<f64> + use<> {
    let (begin, step) = (a.t, b.t - a.t);
    let (from, to) = (a.state.clone(), b.state.clone());
    move |t| {
        let part = (t - begin) / step;
        let mut state = from.clone();
        for k in 0..degrees {
            let (rate, rate_to) = (step * from[degrees + k], step * to[degrees + k]);
            let moved = to[k] - from[k];
            let (square, cube) = (
                3.0 * moved - 2.0 * rate - rate_to,
                rate + rate_to - 2.0 * moved,
            );
            state[k] = from[k] + part * (rate + part * (square + part * cube));
            state[degrees + k] = (rate + part * (2.0 * square + 3.0 * part * cube)) / step;
        }
        state
    }
}
