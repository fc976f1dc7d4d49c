//! Regression of several families of basis functions at once.

use crate::ids::{BasisFunctionId, FamilyId};
use nalgebra::{DMatrix, DVector};

use crate::fit::linearised::Linearisation;
use crate::fit::residuals::correlation;
use crate::residual_force::basis_functions::{Family, Over};
use crate::residual_force::equations::{Equations, OperatingPoint};
use crate::residual_force::force_response::{ForceColumns, force_responses};
use crate::residual_force::regression::{Regression, Sizes};
use crate::thresholds;

/// Regression of families with the position of their columns.
pub(crate) struct FamilyRegression {
    /// Families of basis functions.
    pub families: Vec<Family>,
    /// First column of each family.
    pub firsts: Vec<usize>,
    /// Regression of all columns.
    pub regression: Regression,
    /// Columns of each window.
    pub blocks: Vec<Option<DMatrix<f64>>>,
}

impl FamilyRegression {
    /// Fits families of basis functions; `None` if tangent vectors are not available.
    pub fn at(of: Linearisation<'_>, equations: &Equations, families: Vec<Family>) -> Option<Self> {
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
                family.at(&operating_points[family.equation], slots);
            }
        };
        let columns = ForceColumns {
            equations: own,
            weights: &weights,
        };
        let blocks = force_responses(of, equations, &columns)?;
        let regression = Regression::new(of.at, of.fit, &blocks)?;
        Some(Self {
            families,
            firsts,
            regression,
            blocks,
        })
    }

    /// Returns the columns of a family.
    pub fn range(&self, family: FamilyId) -> std::ops::Range<usize> {
        let first = self.firsts[family];
        first..first + self.families[family].count()
    }

    /// Returns the coefficients of a family, equal in all windows.
    pub fn shared(&self, family: FamilyId) -> Sizes {
        let functions: Vec<BasisFunctionId> =
            self.range(family).map(BasisFunctionId::new).collect();
        self.regression.shared(&functions)
    }

    /// Returns the fraction of the squares that a family explains, less the fraction expected by
    /// chance.
    pub fn part(&self, family: FamilyId) -> f64 {
        let found = self.shared(family);
        let chance = noise(self, found.decrease) * found.values.len() as f64;
        (found.decrease - chance) / self.regression.squares
    }

    /// Returns the number of samples over which the residual of a family is correlated.
    pub fn correlation(&self, of: Linearisation<'_>, family: FamilyId, level: f64) -> f64 {
        let blocks = self.blocks.iter().flatten();
        let count = blocks.map(DMatrix::ncols).next().unwrap_or(0);
        let range = self.range(family);
        let whole = |sizes: Option<&Sizes>| {
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
                .remaining(of.at, &self.blocks, values, shared)
        };
        let residuals = match self.families[family].over {
            Over::Time => {
                let found = self.regression.each(range.clone(), level);
                remaining(&|window| whole(found.windows[window].as_ref()), false)
            }
            _ => {
                let found = self.shared(family);
                remaining(&|_| whole(Some(&found)), true)
            }
        };
        correlation(&residuals, of.problem.noise.len())
    }

    /// Returns the factor on the variance of a white unit residual: the residual of a family, its
    /// correlation and the linearisation error.
    pub fn inflation(&self, of: Linearisation<'_>, family: FamilyId) -> f64 {
        let variance = noise(self, self.shared(family).decrease);
        variance * self.correlation(of, family, 1.0) * thresholds::WIDER * thresholds::WIDER
    }

    /// Returns the first family with a matching argument.
    pub fn find(&self, wanted: impl Fn(Over) -> bool) -> Option<FamilyId> {
        let position = self.families.iter().position(|family| wanted(family.over));
        position.map(FamilyId::new)
    }
}

/// Returns the mean square of the residuals after a decrease of the squares.
pub(crate) fn noise(regressed: &FamilyRegression, decrease: f64) -> f64 {
    ((regressed.regression.squares - decrease) / regressed.regression.numbers).max(1.0)
}
