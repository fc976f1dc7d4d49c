//! Regression of several families of basis functions at once.

use crate::ids::{BasisFunctionId, FamilyId};
use nalgebra::{DMatrix, DVector};

use crate::fit::linearised_fit::Linearisation;
use crate::fit::residuals::compute_correlation_samples;
use crate::residual_force::basis_functions::{BasisFamily, ForceArgument};
use crate::residual_force::equations::{EquationSet, OperatingPoint};
use crate::residual_force::force_response::{ForceColumns, compute_force_responses};
use crate::residual_force::regression::{Coefficients, Regression};
use crate::thresholds;

/// Regression of families and the index of the first column of each family.
pub(crate) struct FamilyRegression {
    /// Families of basis functions.
    pub families: Vec<BasisFamily>,
    /// First column of each family.
    pub first_columns: Vec<usize>,
    /// Regression of all columns.
    pub regression: Regression,
    /// Columns of each window.
    pub window_columns: Vec<Option<DMatrix<f64>>>,
}

impl FamilyRegression {
    /// Fits families of basis functions; `None` if tangent vectors are not available.
    pub fn fit_families(
        of: Linearisation<'_>,
        equations: &EquationSet,
        families: Vec<BasisFamily>,
    ) -> Option<Self> {
        let mut firsts = Vec::new();
        let mut count = 0;
        let mut own = Vec::new();
        for family in &families {
            firsts.push(count);
            count += family.count();
            own.extend(vec![family.equation; family.count()]);
        }
        let weights = |operating_points: &[OperatingPoint], _: &[f64], out: &mut [f64]| {
            for (family, first) in families.iter().zip(&firsts) {
                let slots = &mut out[*first..first + family.count()];
                family.evaluate(&operating_points[family.equation], slots);
            }
        };
        let columns = ForceColumns {
            equations: own,
            fill_weights: &weights,
        };
        let blocks = compute_force_responses(of, equations, &columns)?;
        let regression = Regression::new(of.point, of.fit, &blocks)?;
        Some(Self {
            families,
            first_columns: firsts,
            regression,
            window_columns: blocks,
        })
    }

    /// Returns the columns of a family.
    pub fn column_range(&self, family: FamilyId) -> std::ops::Range<usize> {
        let first = self.first_columns[family];
        first..first + self.families[family].count()
    }

    /// Returns the coefficients of a family, which are equal in all windows.
    pub fn fit_shared_coefficients(&self, family: FamilyId) -> Coefficients {
        let functions: Vec<BasisFunctionId> = self
            .column_range(family)
            .map(BasisFunctionId::new)
            .collect();
        self.regression.fit_shared(&functions)
    }

    /// Returns the fraction of the squares explained by a family, minus the fraction expected by
    /// chance.
    pub fn explained_fraction(&self, family: FamilyId) -> f64 {
        let found = self.fit_shared_coefficients(family);
        let chance =
            compute_remaining_mean_square(self, found.decrease) * found.values.len() as f64;
        (found.decrease - chance) / self.regression.remaining_squares
    }

    /// Returns the correlation length of the residual of a family, in samples.
    pub fn compute_correlation_length(
        &self,
        of: Linearisation<'_>,
        family: FamilyId,
        level: f64,
    ) -> f64 {
        let blocks = self.window_columns.iter().flatten();
        let count = blocks.map(DMatrix::ncols).next().unwrap_or(0);
        let range = self.column_range(family);
        let whole = |sizes: Option<&Coefficients>| {
            let mut values = DVector::zeros(count);
            if let Some(sizes) = sizes {
                values
                    .rows_mut(range.start, range.len())
                    .copy_from(&sizes.values);
            }
            values
        };
        let remaining = |values: &dyn Fn(usize) -> DVector<f64>, shared: bool| {
            self.regression
                .compute_remaining(of.point, &self.window_columns, values, shared)
        };
        let residuals = match self.families[family].argument {
            ForceArgument::Time => {
                let found = self.regression.fit_per_window(range.clone(), level);
                remaining(&|window| whole(found.windows[window].as_ref()), false)
            }
            _ => {
                let found = self.fit_shared_coefficients(family);
                remaining(&|_| whole(Some(&found)), true)
            }
        };
        compute_correlation_samples(&residuals, of.problem.noise.len())
    }

    /// Returns the factor on the variance of white residuals of unit variance. It contains the
    /// residual of a family, its correlation and the linearisation error.
    pub fn variance_inflation(&self, of: Linearisation<'_>, family: FamilyId) -> f64 {
        let variance =
            compute_remaining_mean_square(self, self.fit_shared_coefficients(family).decrease);
        variance
            * self.compute_correlation_length(of, family, 1.0)
            * thresholds::UNCERTAINTY_FACTOR
            * thresholds::UNCERTAINTY_FACTOR
    }

    /// Returns the first family with a matching argument.
    pub fn find_family(&self, wanted: impl Fn(ForceArgument) -> bool) -> Option<FamilyId> {
        let position = self
            .families
            .iter()
            .position(|family| wanted(family.argument));
        position.map(FamilyId::new)
    }
}

/// Returns the mean square of the residuals after the sum of squares has decreased by `decrease`.
pub(crate) fn compute_remaining_mean_square(regressed: &FamilyRegression, decrease: f64) -> f64 {
    ((regressed.regression.remaining_squares - decrease) / regressed.regression.number_count)
        .max(1.0)
}
