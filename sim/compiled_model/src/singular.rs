//! Singular positions, in which constraints depend on each other.
//!
//! With the rows R of the constraints in the metric of the inertias, F = (R R^T)^(-1/2) R has orthonormal rows
//! that turn smoothly along a motion. Where R loses rank and regains it, as that of a parallelogram does that
//! folds flat, a direction of F changes its sign: F_1 F_2^T of the states before and after has the eigenvalue
//! -1 there, however long the step between them is. Between two states the coordinates are interpolated by
//! their rates.

use eomgen_analysis::qr_iteration::symmetric_eigen;
use eomgen_codegen::independence::rows::{ConstraintRows, norm};
use eomgen_codegen::program::evaluator::Point;
use eomgen_sim::inputs::HeldInputs;
use nalgebra::{DMatrix, DVector};

/// Rows of two states of which no direction turned by more than 60 degrees.
const TURNED_LITTLE: f64 = 0.5;

/// Halvings of a step in the search for a singular position.
const MOST_HALVINGS: u32 = 40;

/// Least singular value of the scaled constraint derivatives below which a stop of the solver is put down to them.
/// The rounding of accelerations grows with its reciprocal squared: at 1e-2 it reaches 1e-12, and steps at usual
/// tolerances fail before the position itself is reached.
const SINGULAR: f64 = 1e-2;

/// A constraint is named with others if its part in their combination is no less beside the largest.
const TAKES_PART: f64 = 0.1;

/// A state that a motion came to.
struct Passed {
    t: f64,
    state: Vec<f64>,
    /// F.
    frame: DMatrix<f64>,
}

/// Follows the rows of the constraints along a motion.
pub(crate) struct SingularityWatch {
    rows: ConstraintRows,
    /// The names of the constraints.
    names: Vec<String>,
    /// The largest length of each row so far: one may vanish by itself.
    lengths: Vec<f64>,
    last: Option<Passed>,
    found: Option<(f64, String)>,
}

impl SingularityWatch {
    pub(crate) fn new(rows: ConstraintRows, names: Vec<String>) -> Self {
        Self {
            rows,
            lengths: vec![0.0; names.len()],
            names,
            last: None,
            found: None,
        }
    }

    /// The time (s) of a singular position that the motion has passed, and what is to be said of it.
    pub(crate) fn found(&self) -> Option<(f64, &str)> {
        let (t, reason) = self.found.as_ref()?;
        Some((*t, reason))
    }

    /// Whether the motion has passed a singular position on its way to a state, which is the next to begin
    /// from.
    pub(crate) fn passes(&mut self, t: f64, state: &[f64], inputs: &HeldInputs) -> bool {
        let Some(here) = self.at(t, state.to_vec(), inputs) else {
            return false;
        };
        let last = self.last.take().filter(|last| last.t < t);
        let passed = last.and_then(|last| {
            let middle = self.between(&last, &here, inputs)?;
            let first = self.search(&last, &middle, inputs, MOST_HALVINGS);
            first.or_else(|| self.search(&middle, &here, inputs, MOST_HALVINGS))
        });
        if let Some(passed) = &passed {
            let rows = self.scaled_rows(passed.t, &passed.state, inputs);
            let least = least(&rows);
            self.found = least.map(|(_, combined)| (passed.t, self.reason(passed.t, &combined)));
        }
        self.last = Some(here);
        passed.is_some()
    }

    /// What is to be said of constraints that depend on each other at a state; nothing where none do.
    pub(crate) fn reason_at(
        &mut self,
        t: f64,
        state: &[f64],
        inputs: &HeldInputs,
    ) -> Option<String> {
        let rows = self.scaled_rows(t, state, inputs);
        if rows.iter().any(|entry| !entry.is_finite()) {
            return None;
        }
        let (value, combined) = least(&rows)?;
        (value <= SINGULAR).then(|| self.reason(t, &combined))
    }

    fn scaled_rows(&mut self, t: f64, state: &[f64], inputs: &HeldInputs) -> DMatrix<f64> {
        let inputs = &inputs.at(t);
        let rows = self.rows.rows(Point { t, state, inputs });
        for (length, row) in self.lengths.iter_mut().zip(&rows) {
            *length = length.max(norm(row));
        }
        let columns = rows.first().map_or(0, Vec::len);
        DMatrix::from_fn(rows.len(), columns, |row, column| {
            rows[row][column] / self.lengths[row].max(f64::MIN_POSITIVE)
        })
    }

    fn at(&mut self, t: f64, state: Vec<f64>, inputs: &HeldInputs) -> Option<Passed> {
        let rows = self.scaled_rows(t, &state, inputs);
        if rows.iter().any(|entry| !entry.is_finite()) {
            return None;
        }
        let mut squares = symmetric_eigen(&(&rows * rows.transpose()))?;
        for value in squares.eigenvalues.iter_mut() {
            *value = value.max(f64::MIN_POSITIVE).sqrt().recip();
        }
        let frame = squares.recompose() * rows;
        Some(Passed { t, state, frame })
    }

    /// The state in the middle between two, by the cubic through coordinates and rates of both.
    fn between(&mut self, a: &Passed, b: &Passed, inputs: &HeldInputs) -> Option<Passed> {
        let degrees = a.frame.ncols();
        let (step, mut state) = (b.t - a.t, a.state.clone());
        for k in 0..degrees {
            let (from, to) = (a.state[k], b.state[k]);
            let (rate, rate_to) = (a.state[degrees + k], b.state[degrees + k]);
            state[k] = 0.5 * (from + to) + 0.125 * step * (rate - rate_to);
            state[degrees + k] = 1.5 * (to - from) / step - 0.25 * (rate + rate_to);
        }
        self.at(a.t + 0.5 * step, state, inputs)
    }

    /// The singular position between two states, if there is one.
    fn search(
        &mut self,
        a: &Passed,
        b: &Passed,
        inputs: &HeldInputs,
        halvings: u32,
    ) -> Option<Passed> {
        let turned = &a.frame * b.frame.transpose();
        let symmetric = 0.5 * (&turned + turned.transpose());
        if symmetric_eigen(&symmetric)?.eigenvalues.min() > TURNED_LITTLE {
            return None;
        }
        let middle = self.between(a, b, inputs)?;
        if halvings == 0 || middle.t <= a.t || middle.t >= b.t {
            return Some(middle);
        }
        let first = self.search(a, &middle, inputs, halvings - 1);
        first.or_else(|| self.search(&middle, b, inputs, halvings - 1))
    }

    fn reason(&self, t: f64, combined: &DVector<f64>) -> String {
        let parts = self.names.iter().zip(combined.iter());
        let names: Vec<String> = parts
            .filter(|(_, part)| part.abs() > TAKES_PART * combined.amax())
            .map(|(name, _)| format!("`{name}`"))
            .collect();
        let what = match &names[..] {
            [one] => {
                format!("the constraint {one} holds nothing any more, as its derivatives are all 0")
            }
            several => format!(
                "the constraints {} are no longer independent, as the derivative of one is made of those of the others",
                several.join(", ")
            ),
        };
        format!(
            "at t = {t:?} s the motion comes to a singular position: {what} there, and no accelerations follow; \
             shorten the time, or keep the motion away from there (a stop, another start by --initial)"
        )
    }
}

/// Returns the smallest singular value of a matrix with its combination of rows; `None` if the iteration does not
/// converge.
fn least(rows: &DMatrix<f64>) -> Option<(f64, DVector<f64>)> {
    let squares = symmetric_eigen(&(rows * rows.transpose()))?;
    let (least, value) = squares.eigenvalues.argmin();
    let combined = squares.eigenvectors.column(least).into_owned();
    Some((value.max(0.0).sqrt(), combined))
}
