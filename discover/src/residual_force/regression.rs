//! Regression of the residuals on unknown forces, with free initial states and nuisances. Linear
//! least squares on products of columns from which the initial state of each window is eliminated.

use crate::ids::BasisFunctionId;
use crate::model::unknowns::NormalPrior;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::fit::fit_result::Fit;
use crate::fit::linearised_fit::LinearisedFit;
use crate::fit::variable_projection::{PriorTerm, StateProjection, add_prior};
use crate::thresholds;

/// Fractions of a nuisance's squares that are tried as a ridge. A ridge is needed if initial states
/// have nearly the same response as a nuisance.
const RIDGES: [f64; 3] = [thresholds::MIN_COLUMN_REMAINDER, 1e-8, 1e-5];

/// Products of force columns with each other and with the residual.
pub struct Regression {
    /// Products of the force columns after elimination of the nuisances.
    gram: DMatrix<f64>,
    /// Negative products of the force columns with the residual.
    right: DVector<f64>,
    /// Sum of squares after elimination of initial states and nuisances, in squared standard
    /// deviations.
    pub remaining_squares: f64,
    /// Number of measured values.
    pub number_count: f64,
    /// Products of the nuisances: Cholesky factor of their Gram matrix, and products with force
    /// columns and residual.
    nuisances: Option<(Cholesky<f64, Dyn>, DMatrix<f64>)>,
    /// Sum of squares after elimination of initial states with fixed nuisances, in squared standard
    /// deviations.
    held: f64,
    /// Products of the force columns of each window with fixed nuisances; the residual is last.
    windows: Vec<DMatrix<f64>>,
}

/// Coefficients of basis functions.
#[derive(Clone, Debug)]
pub struct Coefficients {
    /// Values.
    pub values: DVector<f64>,
    /// Covariance, for a residual of unit variance.
    pub covariance: DMatrix<f64>,
    /// Decrease of the sum of squares.
    pub decrease: f64,
}

/// Coefficients that differ between windows.
pub struct WindowCoefficients {
    /// Coefficients of each window; `None` if its simulation failed.
    pub windows: Vec<Option<Coefficients>>,
    /// Explained fraction of the squares, minus the fraction expected by chance.
    pub explained_fraction: f64,
}

/// A coefficient in one window.
#[derive(Clone, Copy, Debug)]
pub struct WindowCoefficient {
    /// Value.
    pub value: f64,
    /// Variance, for a residual of unit variance.
    pub variance: f64,
}

impl Regression {
    /// Creates the regression from the columns of each window. All windows have the same number of
    /// columns. `None` if no window has columns.
    pub fn new(at: &LinearisedFit, fit: &Fit, columns: &[Option<DMatrix<f64>>]) -> Option<Self> {
        let count = columns.iter().flatten().map(DMatrix::ncols).next()?;
        let theta = &at.estimate.theta;
        // A nuisance at its bound is free as well, because the missing force may have moved it
        // there.
        let n = fit.unknowns.len();
        let mut products = DMatrix::zeros(n + count + 1, n + count + 1);
        let mut windows = Vec::with_capacity(columns.len());
        let mut numbers = 0.0;
        for (base, block) in at.projections.iter().zip(columns) {
            let (Some(base), Some(block)) = (base, block) else {
                windows.push(DMatrix::zeros(0, 0));
                continue;
            };
            let rows = base.residual.len();
            let mut matrix = DMatrix::zeros(rows, n + count + 1);
            matrix.columns_mut(0, n).copy_from(&base.by_unknown);
            matrix.columns_mut(n, count).copy_from(block);
            matrix.column_mut(n + count).copy_from(&base.residual);
            let own = base.compute_products(&matrix);
            windows.push(own.view((n, n), (count + 1, count + 1)).into_owned());
            products += own;
            numbers += rows as f64;
        }
        let held = products[(n + count, n + count)];
        for (id, unknown) in fit.unknowns() {
            if let Some(NormalPrior { mean, sd }) = unknown.prior {
                let prior = PriorTerm {
                    weight: fit.prior_weight / (sd * sd),
                    deviation: theta[id] - mean,
                };
                add_prior(&mut products, id, prior);
            }
        }
        let mut reduced = products.view((n, n), (count + 1, count + 1)).into_owned();
        let mut nuisances = None;
        if n > 0 {
            let factored = |ridge: f64| {
                let own = DMatrix::from_fn(n, n, |r, c| {
                    let ridge = if r == c { 1.0 + ridge } else { 1.0 };
                    ridge * products[(r, c)]
                });
                own.cholesky()
            };
            let cross = products.view((0, n), (n, count + 1)).into_owned();
            let factor = RIDGES.into_iter().find_map(factored)?;
            reduced -= cross.transpose() * factor.solve(&cross);
            nuisances = Some((factor, cross));
        }
        Some(Self {
            gram: reduced.view((0, 0), (count, count)).into_owned(),
            right: -reduced.view((0, count), (count, 1)).column(0),
            remaining_squares: reduced[(count, count)],
            number_count: numbers,
            nuisances,
            held,
            windows,
        })
    }

    /// Fits linear combinations of columns with coefficients that are equal in all windows. `of`:
    /// one row per column and one column per combination.
    pub fn fit_combinations(
        &self,
        indices: std::ops::Range<usize>,
        of: &DMatrix<f64>,
    ) -> Coefficients {
        let count = indices.len();
        let gram = self
            .gram
            .view((indices.start, indices.start), (count, count));
        let right = self.right.rows(indices.start, count);
        solve_normal_equations(
            &(of.transpose() * gram * of),
            &(of.transpose() * right),
            0.0,
        )
    }

    /// Fits basis functions with equal coefficients in all windows.
    pub fn fit_shared(&self, functions: &[BasisFunctionId]) -> Coefficients {
        let count = functions.len();
        let gram = DMatrix::from_fn(count, count, |r, c| {
            self.gram[(functions[r].index(), functions[c].index())]
        });
        let right = DVector::from_fn(count, |r, _| self.right[functions[r].index()]);
        solve_normal_equations(&gram, &right, 0.0)
    }

    /// Fits coefficients that differ between windows, with fixed nuisances and a common prior
    /// variance, so that unobservable coefficients remain small. `noise`: mean square of the noise.
    pub fn fit_per_window(
        &self,
        indices: std::ops::Range<usize>,
        noise: f64,
    ) -> WindowCoefficients {
        let (first, count) = (indices.start, indices.len());
        let systems = self.windows.iter().map(|window| {
            let last = window.ncols().checked_sub(1)?;
            let gram = window.view((first, first), (count, count)).into_owned();
            Some((gram, -window.view((first, last), (count, 1)).column(0)))
        });
        let systems: Vec<Option<(DMatrix<f64>, DVector<f64>)>> = systems.collect();
        let available = || systems.iter().flatten();
        let numbers = (available().count() * count).max(1) as f64;
        let trace: f64 = available().map(|(gram, _)| gram.trace()).sum();
        let mut ridge = 1e-3 * trace / numbers;
        for _ in 0..thresholds::VARIANCE_ITERATION_COUNT {
            let all = available().map(|(gram, right)| {
                let found = solve_normal_equations(gram, right, ridge);
                found.values.norm_squared() + noise * found.covariance.trace()
            });
            let square = all.sum::<f64>() / numbers;
            if square <= 0.0 {
                break;
            }
            ridge = noise / square;
        }
        let (mut decrease, mut freedom) = (0.0, 0.0);
        let windows: Vec<Option<Coefficients>> = (systems.iter())
            .map(|system| {
                let (gram, right) = system.as_ref()?;
                let found = solve_normal_equations(gram, right, ridge);
                let doubled = 2.0 * found.values.dot(right);
                decrease += doubled - found.values.dot(&(gram * &found.values));
                freedom += (gram * &found.covariance).trace();
                Some(found)
            })
            .collect();
        WindowCoefficients {
            windows,
            explained_fraction: (decrease - noise * freedom) / self.held,
        }
    }

    /// Fits one linear combination of columns in each window, with fixed nuisances.
    pub fn fit_combination_per_window(
        &self,
        indices: std::ops::Range<usize>,
        of: &DVector<f64>,
    ) -> Vec<Option<WindowCoefficient>> {
        let (first, count) = (indices.start, indices.len());
        let one = |window: &DMatrix<f64>| {
            let last = window.ncols().checked_sub(1)?;
            let square = of.dot(&(window.view((first, first), (count, count)) * of));
            let right = -of.dot(&window.view((first, last), (count, 1)).column(0));
            (square > 0.0).then(|| WindowCoefficient {
                value: right / square,
                variance: 1.0 / square,
            })
        };
        self.windows.iter().map(one).collect()
    }

    /// Returns the residual of each window after subtraction of all columns, in standard
    /// deviations. `shared`: true if the coefficients are equal in all windows and the nuisances
    /// are fitted again.
    pub fn compute_remaining(
        &self,
        at: &LinearisedFit,
        columns: &[Option<DMatrix<f64>>],
        values: &dyn Fn(usize) -> DVector<f64>,
        shared: bool,
    ) -> Vec<Vec<f64>> {
        let count = self.gram.ncols();
        let nuisances = self.nuisances.as_ref().filter(|_| shared);
        let nuisances = nuisances.map(|(factor, cross)| {
            -factor.solve(&(cross.columns(0, count) * values(0) + cross.column(count)))
        });
        let windows = at.projections.iter().zip(columns).enumerate();
        let one = |(window, (base, block)): (usize, (&Option<StateProjection>, &Option<_>))| {
            let (Some(base), Some(block)) = (base, block) else {
                return Vec::new();
            };
            let mut residual = &base.residual + block * values(window);
            if let Some(nuisances) = &nuisances {
                residual += &base.by_unknown * nuisances;
            }
            base.project(&residual).iter().copied().collect()
        };
        windows.map(one).collect()
    }
}

/// Solves the normal equations. A coefficient whose column is negligible is 0 and has no variance.
fn solve_normal_equations(gram: &DMatrix<f64>, right: &DVector<f64>, ridge: f64) -> Coefficients {
    let count = right.len();
    let largest = gram.diagonal().iter().copied().fold(0.0, f64::max);
    let does: Vec<bool> = (0..count)
        .map(|k| gram[(k, k)] > thresholds::MIN_COLUMN_REMAINDER * largest)
        .collect();
    let scale: Vec<f64> = (0..count)
        .map(|k| {
            if does[k] {
                (gram[(k, k)] + ridge).sqrt()
            } else {
                1.0
            }
        })
        .collect();
    let whole = DMatrix::from_fn(count, count, |r, c| match (r == c, does[r] && does[c]) {
        (true, true) => 1.0 + thresholds::MIN_COLUMN_REMAINDER,
        (true, false) => 1.0,
        (false, true) => gram[(r, c)] / (scale[r] * scale[c]),
        (false, false) => 0.0,
    });
    let scaled = DVector::from_fn(
        count,
        |k, _| if does[k] { right[k] / scale[k] } else { 0.0 },
    );
    let Some(factor) = whole.cholesky() else {
        return Coefficients {
            values: DVector::zeros(count),
            covariance: DMatrix::zeros(count, count),
            decrease: 0.0,
        };
    };
    let mut values = factor.solve(&scaled);
    let mut covariance = factor.inverse();
    let decrease = values.dot(&scaled);
    for r in 0..count {
        values[r] /= scale[r];
        for c in 0..count {
            let known = if does[r] && does[c] { 1.0 } else { 0.0 };
            covariance[(r, c)] *= known / (scale[r] * scale[c]);
        }
    }
    Coefficients {
        values,
        covariance,
        decrease,
    }
}
