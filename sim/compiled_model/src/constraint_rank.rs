//! Rank of constraints at a state.
//!
//! At a singular position the derivatives of the constraints are linearly dependent, or the derivative of one
//! constraint vanishes. The least singular value is zero there and grows with the distance on both sides.

use eomgen_analysis::qr_iteration::symmetric_eigen;
use eomgen_codegen::independence::vectors::norm;
use eomgen_codegen::program::evaluator::Point;
use nalgebra::{DMatrix, DVector, Dyn, SymmetricEigen};

use crate::displacements::DISPLACEMENT;
use crate::motion_model::MotionModel;

/// Smallest growth of the least singular value from a singular position to both displaced points. A regular value
/// changes by a fraction of about [`DISPLACEMENT`].
const MIN_GROWTH: f64 = 2.0;

/// Smallest coefficient of a constraint in the dependent combination, relative to the largest, for which an error names
/// the constraint.
const MIN_NAMED_COEFFICIENT: f64 = 0.1;

/// Least singular value of scaled constraint rows.
pub(crate) struct ConstraintRank {
    /// Least singular value, without singular values that vanish at every state.
    pub least: f64,
    /// Combination of the constraints that belongs to the least singular value.
    pub dependent_combination: DVector<f64>,
    /// Eigenvalues and eigenvectors of the product of the rows with their transpose.
    pub squares: SymmetricEigen<f64, Dyn>,
}

impl ConstraintRank {
    /// Computes the rank of `rows`, of which `excess` rows depend on the others at every state. Returns `None` if the
    /// iteration does not converge.
    pub fn new(rows: &DMatrix<f64>, excess: usize) -> Option<Self> {
        let squares = symmetric_eigen(&(rows * rows.transpose()))?;
        let mut order: Vec<usize> = (0..squares.eigenvalues.len()).collect();
        order.sort_by(|a, b| squares.eigenvalues[*a].total_cmp(&squares.eigenvalues[*b]));
        let place = *order.get(excess)?;
        Some(Self {
            least: squares.eigenvalues[place].max(0.0).sqrt(),
            dependent_combination: squares.eigenvectors.column(place).into_owned(),
            squares,
        })
    }

    /// Describes the dependence of the constraints with the given names.
    pub fn describe<'n>(
        combination: &DVector<f64>,
        names: impl Iterator<Item = &'n String>,
    ) -> String {
        let named: Vec<String> = names
            .zip(combination.iter())
            .filter(|(_, part)| part.abs() > MIN_NAMED_COEFFICIENT * combination.amax())
            .map(|(name, _)| format!("`{name}`"))
            .collect();
        match &named[..] {
            [one] => {
                format!("the constraint {one} has no effect, because its derivative is zero")
            }
            several => format!(
                "the constraints {} depend on each other, because their derivatives are linearly dependent",
                several.join(", ")
            ),
        }
    }
}

impl dyn MotionModel + '_ {
    /// Describes the dependence of the constraints if a point is a singular position. `direction` is a displacement of
    /// the states, in SI units.
    pub(crate) fn describe_singular_position(
        &self,
        point: Point<'_>,
        direction: &[f64],
    ) -> Option<String> {
        let mut rows = self.constraint_rows()?;
        let labels = self.labels();
        let degrees = rows.degrees_of_freedom();
        let mut rows_at = |displacement: f64| {
            let mut state = point.state.to_vec();
            for (value, part) in state.iter_mut().zip(direction).take(degrees) {
                *value += displacement * part;
            }
            let state = &state;
            rows.rows(Point { state, ..point })
        };
        let all = [0.0, -DISPLACEMENT, DISPLACEMENT].map(&mut rows_at);
        let lengths = |row: usize| all.iter().map(|rows| norm(&rows[row])).fold(0.0, f64::max);
        let ranks = all.iter().map(|rows| {
            let scaled = DMatrix::from_fn(rows.len(), degrees, |row, column| {
                rows[row][column] / lengths(row)
            });
            let is_finite = scaled.iter().all(|entry| entry.is_finite());
            is_finite.then(|| ConstraintRank::new(&scaled, labels.constraint_excess))?
        });
        let ranks: Option<Vec<ConstraintRank>> = ranks.collect();
        let (here, displaced) = ranks.as_deref()?.split_first()?;
        let grows = |there: &ConstraintRank| there.least > MIN_GROWTH * here.least;
        let names = labels.constraints.iter().map(|constraint| &constraint.name);
        displaced
            .iter()
            .all(grows)
            .then(|| ConstraintRank::describe(&here.dependent_combination, names))
    }
}
