//! Elimination of the initial state from the derivatives of a window by a QR factorisation
//! (variable projection: Golub and Pereyra, SIAM J. Numer. Anal. 10, 1973). The result depends only
//! on the unknowns.

use crate::ids::{UnknownId, WindowId};
use nalgebra::{DMatrix, DVector};

use crate::fit::prior::InitialStatePrior;
use crate::fit::sensitivity::WindowDerivatives;

/// Derivatives of a window with the initial state eliminated.
pub struct ReducedBlock {
    /// R of the QR factorisation of [derivatives with respect to state, derivatives with respect to unknowns,
    /// residual], with the rows of the priors.
    pub factor: DMatrix<f64>,
    /// Independent directions of the initial state.
    directions: DMatrix<f64>,
}

/// Eliminates the initial state of a window.
pub fn eliminate_initial_state(
    linear: &WindowDerivatives,
    prior: &InitialStatePrior,
    window: WindowId,
    start: &[f64],
) -> ReducedBlock {
    let states = linear.by_state.ncols();
    let unknowns = linear.by_unknown.ncols();
    let rows = linear.residual.len();
    let prior_rows = linear.directions.nrows();
    let mut matrix = DMatrix::zeros(
        (rows + prior_rows).max(states + unknowns + 1),
        states + unknowns + 1,
    );
    matrix
        .view_mut((0, 0), (rows, states))
        .copy_from(&linear.by_state);
    matrix
        .view_mut((0, states), (rows, unknowns))
        .copy_from(&linear.by_unknown);
    matrix
        .view_mut((0, states + unknowns), (rows, 1))
        .copy_from(&linear.residual);
    if let Some(mean) = prior.mean.get(window.index()) {
        let weights = prior.deviation_rows(window);
        if states > 0 {
            matrix
                .view_mut((rows, 0), (prior_rows, states))
                .copy_from(&(&weights * &linear.directions));
            let deviation = DVector::from_fn(prior_rows, |state, _| start[state] - mean[state]);
            let last = (rows, states + unknowns);
            matrix
                .view_mut(last, (prior_rows, 1))
                .copy_from(&(weights * deviation));
        }
    }
    ReducedBlock {
        factor: matrix.qr().r(),
        directions: linear.directions.clone(),
    }
}

impl ReducedBlock {
    /// Returns the columns of the unknowns and of the residual after the elimination.
    pub fn reduced_columns(&self) -> DMatrix<f64> {
        let states = self.directions.ncols();
        let remaining = self.factor.ncols() - states;
        self.factor
            .view((states, states), (remaining, remaining))
            .into_owned()
    }

    /// Returns the step of the initial state, along its directions, for a step of the unknowns.
    /// `damping` is in weights of the prior.
    pub fn solve_initial_state_step(
        &self,
        unknowns: &DVector<f64>,
        damping: f64,
        prior: &InitialStatePrior,
    ) -> Option<DVector<f64>> {
        let (n, p) = (self.directions.ncols(), unknowns.len());
        let damped_rows = self.directions.nrows();
        let mut rows = DMatrix::zeros((n + damped_rows).max(2), n + 1);
        rows.view_mut((0, 0), (n, n))
            .copy_from(&self.factor.view((0, 0), (n, n)));
        let right =
            -(self.factor.view((0, n), (n, p)) * unknowns + self.factor.column(n + p).rows(0, n));
        rows.view_mut((0, n), (n, 1)).copy_from(&right);
        if !prior.sd.is_empty() && n > 0 {
            let damped = prior.damping_rows() * &self.directions * damping.sqrt();
            rows.view_mut((n, 0), (damped_rows, n)).copy_from(&damped);
        }
        let factor = rows.qr().r();
        let right = factor.column(n).rows(0, n).into_owned();
        let step = factor.view((0, 0), (n, n)).solve_upper_triangular(&right)?;
        Some(&self.directions * step)
    }
}

/// Derivatives of a window, with a factorisation that eliminates the initial state from any column.
#[derive(Clone)]
pub struct StateProjection {
    /// Residual.
    pub residual: DVector<f64>,
    /// Derivatives with respect to the unknowns.
    pub by_unknown: DMatrix<f64>,
    /// Derivatives along the directions of the initial state; the rows of the priors are below.
    by_state: DMatrix<f64>,
    /// Residuals of the prior rows.
    prior_residual: DVector<f64>,
}

impl StateProjection {
    /// Factorises the derivatives of a window.
    pub fn new(
        linear: &WindowDerivatives,
        prior: &InitialStatePrior,
        window: WindowId,
        start: &[f64],
    ) -> Self {
        let (rows, states) = linear.by_state.shape();
        let prior_rows = linear.directions.nrows();
        let mut by_state = DMatrix::zeros(rows + prior_rows, states);
        by_state
            .view_mut((0, 0), (rows, states))
            .copy_from(&linear.by_state);
        let mut prior_residual = DVector::zeros(prior_rows);
        if let Some(mean) = prior.mean.get(window.index()) {
            let weights = prior.deviation_rows(window);
            if states > 0 {
                let deviation = DVector::from_fn(prior_rows, |state, _| start[state] - mean[state]);
                by_state
                    .view_mut((rows, 0), (prior_rows, states))
                    .copy_from(&(&weights * &linear.directions));
                prior_residual.copy_from(&(weights * deviation));
            }
        }
        Self {
            residual: linear.residual.clone(),
            by_unknown: linear.by_unknown.clone(),
            by_state,
            prior_residual,
        }
    }

    /// Returns the products of all pairs of columns after the elimination. The residual is the last
    /// column.
    pub fn compute_products(&self, columns: &DMatrix<f64>) -> DMatrix<f64> {
        let (rows, count) = columns.shape();
        let states = self.by_state.ncols();
        let mut whole = columns.transpose() * columns;
        whole[(count - 1, count - 1)] += self.prior_residual.norm_squared();
        if states == 0 {
            return whole;
        }
        let q = self.by_state.clone().qr().q();
        let mut along = q.rows(0, rows).transpose() * columns;
        let of_prior = q.rows(rows, q.nrows() - rows).transpose() * &self.prior_residual;
        let mut last = along.column_mut(count - 1);
        last += of_prior;
        whole - along.transpose() * along
    }

    /// Returns the part of a residual that the initial state cannot remove.
    pub fn project(&self, residual: &DVector<f64>) -> DVector<f64> {
        let rows = residual.len();
        if self.by_state.ncols() == 0 {
            return residual.clone();
        }
        let q = self.by_state.clone().qr().q();
        let (of_residual, of_prior) = (q.rows(0, rows), q.rows(rows, q.nrows() - rows));
        let along =
            of_residual.transpose() * residual + of_prior.transpose() * &self.prior_residual;
        residual - of_residual * along
    }
}

/// Returns the triangular factor of two stacked blocks of rows.
pub fn compute_triangular_factor(a: &DMatrix<f64>, b: &DMatrix<f64>) -> DMatrix<f64> {
    let columns = a.ncols();
    let mut both = DMatrix::zeros((a.nrows() + b.nrows()).max(columns), columns);
    both.view_mut((0, 0), a.shape()).copy_from(a);
    both.view_mut((a.nrows(), 0), b.shape()).copy_from(b);
    both.qr().r()
}

/// Contribution of the prior of a nuisance to products of columns.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PriorTerm {
    /// Reciprocal of the variance, times the weight of the priors.
    pub weight: f64,
    /// Deviation of the nuisance from its prior mean, SI.
    pub deviation: f64,
}

/// Adds a prior to the products of a nuisance with itself and with the residual, which is the last
/// column. A negative weight subtracts it.
pub(crate) fn add_prior(products: &mut DMatrix<f64>, nuisance: UnknownId, prior: PriorTerm) {
    let PriorTerm { weight, deviation } = prior;
    let (row, last) = (nuisance.index(), products.ncols() - 1);
    products[(row, row)] += weight;
    products[(row, last)] += weight * deviation;
    products[(last, row)] += weight * deviation;
    products[(last, last)] += weight * deviation * deviation;
}
