//! Families of shapes whose columns stand beside each other in one regression. Which families, and
//! what follows from their sizes, is decided elsewhere.

use crate::ids::{BasisFunctionId, FamilyId};
use nalgebra::{DMatrix, DVector};

use crate::fit::linearised::Linearisation;
use crate::fit::residuals::correlation;
use crate::residual_force::basis_functions::{Family, Over};
use crate::residual_force::equations::{Equations, OperatingPoint};
use crate::residual_force::force_response::{ForceColumns, force_responses};
use crate::residual_force::regression::{Regression, Sizes};
use crate::thresholds;

/// ForceColumns of families with where each family's stand.
pub(crate) struct FamilyRegression {
    pub families: Vec<Family>,
    pub firsts: Vec<usize>,
    pub regression: Regression,
    pub blocks: Vec<Option<DMatrix<f64>>>,
}

impl FamilyRegression {
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

    pub fn range(&self, family: FamilyId) -> std::ops::Range<usize> {
        let first = self.firsts[family];
        first..first + self.families[family].count()
    }

    pub fn shared(&self, family: FamilyId) -> Sizes {
        let functions: Vec<BasisFunctionId> =
            self.range(family).map(BasisFunctionId::new).collect();
        self.regression.shared(&functions)
    }

    /// The part of the squares that a family explains, beyond what as many numbers do by chance.
    pub fn part(&self, family: FamilyId) -> f64 {
        let found = self.shared(family);
        let chance = noise(self, found.decrease) * found.values.len() as f64;
        (found.decrease - chance) / self.regression.squares
    }

    /// Over how many samples what a family leaves is correlated.
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

    /// What the variance of an uncorrelated unit residual is multiplied with: by the size of
    /// what a family leaves, the samples over which that is correlated and what a straight line
    /// does not see.
    pub fn inflation(&self, of: Linearisation<'_>, family: FamilyId) -> f64 {
        let variance = noise(self, self.shared(family).decrease);
        variance * self.correlation(of, family, 1.0) * thresholds::WIDER * thresholds::WIDER
    }

    pub fn find(&self, wanted: impl Fn(Over) -> bool) -> Option<FamilyId> {
        let position = self.families.iter().position(|family| wanted(family.over));
        position.map(FamilyId::new)
    }
}

/// The mean square of the residuals once so much is explained.
pub(crate) fn noise(regressed: &FamilyRegression, decrease: f64) -> f64 {
    ((regressed.regression.squares - decrease) / regressed.regression.numbers).max(1.0)
}
