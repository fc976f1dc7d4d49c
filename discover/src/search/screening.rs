//! Screening: first-order responses of the candidates with free initial states and nuisances. They
//! predict which part of the misfit candidates or sets of candidates explain, and how similar
//! candidates are. Selected candidates are fitted in full elsewhere.

use crate::ids::{CandidateId, ResponseId, UnknownId};
use crate::interval::Interval;
use crate::model::unknowns::NormalPrior;
use std::borrow::Cow;

use nalgebra::{DMatrix, DVector};

use crate::catalogue::candidate::Candidate;
use crate::catalogue::candidate_unknown::CandidateUnknown;
use crate::error::DiscoverError;
use crate::fit::bounded_least_squares::solve_least_squares;
use crate::fit::fit_result::Fit;
use crate::fit::linearised_fit::{LinearisedFit, ProjectedWindows};
use crate::fit::variable_projection::{PriorTerm, add_prior};
use crate::model::problem::EstimationProblem;
use crate::search::response::CandidateResponse;
use crate::search::responses::compute_responses;
use crate::thresholds;

/// Screened candidate with its response.
#[derive(Clone, Debug)]
pub struct ScreenedResponse {
    /// Index of the candidate.
    pub candidate: CandidateId,
    /// Unknowns of the candidate.
    pub candidate_unknowns: Vec<CandidateUnknown>,
    /// Columns of the candidate in the products.
    columns: std::ops::Range<usize>,
    /// Nuisance whose prior is removed, if this is the effect.
    pub dropped_prior: Option<UnknownId>,
    /// Fraction of the response that initial states and nuisances cannot reproduce.
    pub unexplained_fraction: f64,
    /// Decrease of the sum of squares due to this candidate, in squared standard deviations.
    pub cost_decrease: f64,
    /// Predicted sizes of the parameters.
    pub sizes: Vec<f64>,
}

/// Linear prediction for a set of responses.
#[derive(Clone, Debug)]
pub struct LinearPrediction {
    /// Remaining sum of squares, in squared standard deviations, with the priors.
    pub cost: f64,
    /// Difference of each parameter from its value without the effect, in the order of the
    /// responses, SI.
    pub sizes: Vec<f64>,
}

/// Products of columns without the priors of some nuisances.
struct ProductsWithoutPriors<'s> {
    products: Cow<'s, DMatrix<f64>>,
    nuisances: Vec<UnknownId>,
}

/// A candidate without a visible response.
#[derive(Clone, Debug)]
pub struct UnexcitedCandidate {
    /// Index of the candidate.
    pub candidate: CandidateId,
    /// Reason.
    pub reason: DiscoverError,
}

/// Responses of all candidates.
#[derive(Clone)]
pub struct Screening {
    /// Products of all columns: nuisances, candidates, residual.
    products: DMatrix<f64>,
    nuisances: usize,
    /// Contribution of the prior of each nuisance to the products.
    priors: Vec<PriorTerm>,
    bounds: Vec<Interval>,
    /// Bounds of each nuisance without its prior.
    limits: Vec<Interval>,
    /// Candidates with a response, in their order.
    pub responses: Vec<ScreenedResponse>,
    /// Candidates without a visible response.
    pub unexcited: Vec<UnexcitedCandidate>,
    /// Number of measured values.
    pub number_count: f64,
}

/// Screens candidates at a fit over a fraction of each window.
pub fn screen_candidates(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    candidates: &[Candidate],
    part: f64,
) -> Screening {
    let at = LinearisedFit::linearise_fit(problem, fit, part);
    let (base, estimate) = (&at.projections, &at.estimate);
    let own: Vec<Candidate> = (candidates.iter().filter(|c| c.dropped_prior.is_none()))
        .cloned()
        .collect();
    let mut found = compute_responses(&at, problem, fit, &own).into_iter();
    let nuisances = fit.unknowns.len();
    let mut responses = Vec::new();
    let mut not_excited = Vec::new();
    let mut blocks = Vec::new();
    let mut columns = nuisances;
    for (candidate, of) in CandidateId::first(candidates.len()).zip(candidates) {
        let mut response = ScreenedResponse {
            candidate,
            candidate_unknowns: Vec::new(),
            columns: columns..columns,
            dropped_prior: None,
            unexplained_fraction: 0.0,
            cost_decrease: 0.0,
            sizes: Vec::new(),
        };
        if let Some(what) = &of.dropped_prior {
            let same = fit.unknowns().find(|(_, unknown)| unknown.kind == *what);
            response.dropped_prior = same.map(|(id, _)| id);
            responses.push(response);
            continue;
        }
        match found.next() {
            Some(Ok(CandidateResponse {
                candidate_unknowns,
                window_columns: block,
            })) => {
                let scaling = candidate_unknowns
                    .iter()
                    .filter(|candidate_unknown| !candidate_unknown.is_shape)
                    .count();
                columns += scaling;
                response.columns.end = columns;
                response.candidate_unknowns = candidate_unknowns;
                responses.push(response);
                blocks.push(block);
            }
            Some(Err(reason)) => not_excited.push(UnexcitedCandidate { candidate, reason }),
            None => {}
        }
    }
    let mut products = compute_products(fit, base, &blocks, columns);
    let (mut bounds, mut limits, mut priors) = (Vec::new(), Vec::new(), Vec::new());
    for (id, unknown) in fit.unknowns() {
        let value = estimate.theta[id];
        bounds.push(unknown.bounds.shift_origin_to(value));
        limits.push(unknown.bounds_without_prior.shift_origin_to(value));
        let prior = unknown.prior.map(|NormalPrior { mean, sd }| PriorTerm {
            weight: fit.prior_weight / (sd * sd),
            deviation: value - mean,
        });
        let prior = prior.unwrap_or_default();
        add_prior(&mut products, id, prior);
        priors.push(prior);
    }
    for response in &responses {
        let scaling = response
            .candidate_unknowns
            .iter()
            .filter(|candidate_unknown| !candidate_unknown.is_shape);
        bounds.extend(scaling.map(|candidate_unknown| {
            let bounds = candidate_unknown.unknown.bounds;
            bounds.shift_origin_to(candidate_unknown.base)
        }));
    }
    let mut screening = Screening {
        products,
        nuisances,
        priors,
        bounds,
        limits,
        responses,
        unexcited: not_excited,
        number_count: base.iter().flatten().map(|b| b.residual.len() as f64).sum(),
    };
    screening.predict_singles();
    screening
}

/// Returns the products of all columns with the initial states eliminated.
fn compute_products(
    fit: &Fit,
    base: &ProjectedWindows,
    blocks: &[Vec<DMatrix<f64>>],
    columns: usize,
) -> DMatrix<f64> {
    let nuisances = fit.unknowns.len();
    let mut products = DMatrix::zeros(columns + 1, columns + 1);
    for (window, base) in base.iter().enumerate() {
        let Some(base) = base else { continue };
        let rows = base.residual.len();
        let mut matrix = DMatrix::zeros(rows, columns + 1);
        matrix.columns_mut(0, nuisances).copy_from(&base.by_unknown);
        let mut column = nuisances;
        for block in blocks {
            let block = &block[window];
            if block.nrows() == rows {
                matrix.columns_mut(column, block.ncols()).copy_from(block);
            }
            column += block.ncols();
        }
        matrix.column_mut(columns).copy_from(&base.residual);
        products += base.compute_products(&matrix);
    }
    products
}

impl Screening {
    /// Predicts the cost with each single candidate.
    fn predict_singles(&mut self) {
        let alone = self.predict(&[]).cost;
        for id in ResponseId::first(self.responses.len()) {
            let LinearPrediction {
                cost,
                sizes: values,
            } = self.predict(&[id]);
            let unexplained_fraction = self.compute_unexplained_fraction(id);
            let response = &mut self.responses[id];
            response.cost_decrease = alone - cost;
            response.sizes = values;
            response.unexplained_fraction = unexplained_fraction;
        }
    }

    /// Returns the products without the priors that the given candidates remove.
    fn remove_priors(&self, responses: &[ResponseId]) -> ProductsWithoutPriors<'_> {
        let nuisances: Vec<UnknownId> = (responses.iter())
            .filter_map(|response| self.responses[*response].dropped_prior)
            .collect();
        let mut products = Cow::Borrowed(&self.products);
        for nuisance in &nuisances {
            let prior = self.priors[*nuisance];
            let removed = PriorTerm {
                weight: -prior.weight,
                ..prior
            };
            add_prior(products.to_mut(), *nuisance, removed);
        }
        ProductsWithoutPriors {
            products,
            nuisances,
        }
    }

    /// Returns the linear prediction for a set of responses.
    pub fn predict(&self, responses: &[ResponseId]) -> LinearPrediction {
        let mut columns: Vec<usize> = (0..self.nuisances).collect();
        for response in responses {
            columns.extend(self.responses[*response].columns.clone());
        }
        let dropped = self.remove_priors(responses);
        let products = &dropped.products;
        let last = products.ncols() - 1;
        let LeastSquares { a, b } = create_least_squares(products, &columns);
        let bounds: Vec<Interval> = columns
            .iter()
            .map(|column| {
                let interval = match dropped.nuisances.contains(&UnknownId::new(*column)) {
                    true => self.limits[*column],
                    false => self.bounds[*column],
                };
                interval.extend_to_zero()
            })
            .collect();
        let x = solve_least_squares(&a, &b, &bounds);
        let cost = (&a * &x - &b).norm_squared() - b.norm_squared() + products[(last, last)];
        let mut added = x.iter().skip(self.nuisances);
        let sizes = responses.iter().flat_map(|response| {
            let response = &self.responses[*response];
            match response.dropped_prior {
                Some(nuisance) => vec![x[nuisance.index()]],
                None => added
                    .by_ref()
                    .take(response.columns.len())
                    .copied()
                    .collect(),
            }
        });
        let sizes = sizes.collect();
        LinearPrediction { cost, sizes }
    }

    /// Returns the screening with a model parameter fixed at a value and its term deleted; `None`
    /// if the value is not admissible.
    pub fn with_nuisance_fixed_at(&self, nuisance: UnknownId, value: f64) -> Option<Self> {
        let Interval { low, high } = self.bounds[nuisance];
        if value == 0.0 || !(low..=high).contains(&-value) {
            return None;
        }
        let last = self.products.ncols() - 1;
        let mut products = self.products.clone();
        let column = products.column(nuisance.index()) * -value;
        let mut residual = products.column_mut(last);
        residual += column;
        let row = products.row(nuisance.index()) * -value;
        let mut residual = products.row_mut(last);
        residual += row;
        let mut bounds = self.bounds.clone();
        bounds[nuisance] = Interval::ZERO;
        Some(Self {
            products,
            bounds,
            limits: self.limits.clone(),
            nuisances: self.nuisances,
            priors: self.priors.clone(),
            responses: self.responses.clone(),
            unexcited: Vec::new(),
            number_count: self.number_count,
        })
    }

    /// Returns the screening with a fixed nuisance.
    pub fn with_nuisance_fixed(mut self, nuisance: UnknownId) -> Self {
        self.bounds[nuisance] = Interval::ZERO;
        self
    }

    /// Returns the fraction of the squared response that nuisances cannot reproduce.
    fn compute_unexplained_fraction(&self, response: ResponseId) -> f64 {
        let dropped = self.remove_priors(&[response]);
        let direction = self.build_direction(&dropped.products, response);
        let own = compute_product(&dropped.products, &direction, &direction);
        let unexplained = self.project_out_nuisances(&dropped, &direction, &direction);
        if own > 0.0 {
            (unexplained / own).max(0.0)
        } else {
            0.0
        }
    }

    /// Returns true if the responses cancel: for these sizes, after elimination of the nuisances,
    /// each is much larger than their sum.
    pub fn is_cancelling(&self, responses: &[ResponseId], sizes: &[f64]) -> bool {
        let dropped = self.remove_priors(responses);
        let count = dropped.products.ncols();
        let mut sizes = sizes.iter();
        let directions = responses.iter().map(|response| {
            let mut direction = DVector::zeros(count);
            for (column, size) in self.find_columns(*response).zip(sizes.by_ref()) {
                direction[column] = *size;
            }
            direction
        });
        let directions: Vec<DVector<f64>> = directions.collect();
        let square = |direction: &DVector<f64>| {
            let square = self.project_out_nuisances(&dropped, direction, direction);
            square.max(0.0)
        };
        let least = directions.iter().map(square).fold(f64::INFINITY, f64::min);
        let sum = directions
            .iter()
            .fold(DVector::zeros(count), |sum, direction| sum + direction);
        least > thresholds::MIN_CANCELLATION_RATIO.powi(2) * square(&sum)
    }

    /// Returns the columns of a response, or the column of the nuisance whose prior it removes.
    fn find_columns(&self, response: ResponseId) -> std::ops::Range<usize> {
        let response = &self.responses[response];
        match response.dropped_prior {
            Some(nuisance) => nuisance.index()..nuisance.index() + 1,
            None => response.columns.clone(),
        }
    }

    /// Returns the response with its predicted sizes as a combination of columns.
    fn build_direction(&self, products: &DMatrix<f64>, id: ResponseId) -> DVector<f64> {
        let response = &self.responses[id];
        let mut direction = DVector::zeros(products.ncols());
        let all_zero = response.sizes.iter().all(|v| *v == 0.0);
        for (number, column) in self.find_columns(id).enumerate() {
            direction[column] = if all_zero || response.sizes.is_empty() {
                1.0 / products[(column, column)].sqrt().max(f64::MIN_POSITIVE)
            } else {
                response.sizes[number]
            };
        }
        direction
    }

    /// Returns the product of two directions after elimination of the nuisances. Nuisances whose
    /// priors are removed are not eliminated.
    fn project_out_nuisances(
        &self,
        dropped: &ProductsWithoutPriors<'_>,
        a: &DVector<f64>,
        b: &DVector<f64>,
    ) -> f64 {
        let products = &*dropped.products;
        let rows: Vec<usize> = UnknownId::first(self.nuisances)
            .filter(|nuisance| !dropped.nuisances.contains(nuisance))
            .map(UnknownId::index)
            .collect();
        let n = rows.len();
        let whole = compute_product(products, a, b);
        let cross = |v: &DVector<f64>| (products * v).select_rows(&rows);
        let block = DMatrix::from_fn(n, n, |r, c| {
            let ridge = if r == c {
                1.0 + thresholds::MIN_COLUMN_REMAINDER
            } else {
                1.0
            };
            ridge * products[(rows[r], rows[c])]
        });
        match block.cholesky() {
            Some(factor) => whole - cross(a).dot(&factor.solve(&cross(b))),
            None => whole,
        }
    }

    /// Returns the similarity of two responses, 0 to 1, after elimination of the nuisances: the
    /// degree to which one reproduces the other. A candidate with several parameters can reproduce
    /// a candidate with fewer parameters, even if its own predicted response differs.
    pub fn compute_similarity(&self, a: ResponseId, b: ResponseId) -> f64 {
        let dropped = self.remove_priors(&[a, b]);
        let by_b = self.compute_cosine(&dropped, a, b);
        by_b.max(self.compute_cosine(&dropped, b, a))
    }

    /// Returns the cosine of the angle between the predicted response of a candidate and the
    /// nearest response that another candidate can produce.
    fn compute_cosine(
        &self,
        dropped: &ProductsWithoutPriors<'_>,
        response: ResponseId,
        other: ResponseId,
    ) -> f64 {
        let products = &*dropped.products;
        let wanted = self.build_direction(products, response);
        let columns: Vec<DVector<f64>> = (self.find_columns(other))
            .map(|column| {
                let size = products[(column, column)].sqrt().max(f64::MIN_POSITIVE);
                let mut unit = DVector::zeros(products.ncols());
                unit[column] = 1.0 / size;
                unit
            })
            .collect();
        let count = columns.len();
        let gram = DMatrix::from_fn(count, count, |r, c| {
            let ridge = if r == c {
                thresholds::MIN_COLUMN_REMAINDER
            } else {
                0.0
            };
            self.project_out_nuisances(dropped, &columns[r], &columns[c]) + ridge
        });
        let right = DVector::from_fn(count, |r, _| {
            self.project_out_nuisances(dropped, &columns[r], &wanted)
        });
        let size = self.project_out_nuisances(dropped, &wanted, &wanted);
        match gram.cholesky() {
            Some(factor) if size > 0.0 => {
                let done = right.dot(&factor.solve(&right));
                (done / size).max(0.0).sqrt().min(1.0)
            }
            _ => 0.0,
        }
    }
}

fn compute_product(products: &DMatrix<f64>, a: &DVector<f64>, b: &DVector<f64>) -> f64 {
    a.dot(&(products * b))
}

/// Least-squares problem min |a x - b|.
struct LeastSquares {
    a: DMatrix<f64>,
    b: DVector<f64>,
}

/// Returns the least-squares problem of some columns and the negative residual.
fn create_least_squares(products: &DMatrix<f64>, columns: &[usize]) -> LeastSquares {
    let (count, last) = (columns.len(), products.ncols() - 1);
    let scale: Vec<f64> = columns
        .iter()
        .map(|p| products[(*p, *p)].sqrt().max(f64::MIN_POSITIVE))
        .collect();
    let gram = DMatrix::from_fn(count, count, |r, c| {
        let ridge = if r == c {
            thresholds::MIN_COLUMN_REMAINDER
        } else {
            0.0
        };
        products[(columns[r], columns[c])] / (scale[r] * scale[c]) + ridge
    });
    let right = DVector::from_fn(count, |r, _| -products[(columns[r], last)] / scale[r]);
    let Some(factor) = gram.cholesky() else {
        return LeastSquares {
            a: DMatrix::zeros(count, count),
            b: DVector::zeros(count),
        };
    };
    let lower = factor.l();
    let b = lower
        .solve_lower_triangular(&right)
        .unwrap_or_else(|| DVector::zeros(count));
    let a = DMatrix::from_fn(count, count, |r, c| lower[(c, r)] * scale[c]);
    LeastSquares { a, b }
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::{ScreenedResponse, Screening};
    use crate::ids::{CandidateId, ResponseId};

    /// Creates a screening from columns, of which the last is the residual, with the column range
    /// and predicted sizes of each response.
    fn screening(columns: &DMatrix<f64>, of: &[(std::ops::Range<usize>, &[f64])]) -> Screening {
        let response =
            |(candidate, (columns, values)): (usize, &(std::ops::Range<usize>, &[f64]))| {
                ScreenedResponse {
                    candidate: CandidateId::new(candidate),
                    candidate_unknowns: Vec::new(),
                    columns: columns.clone(),
                    dropped_prior: None,
                    unexplained_fraction: 1.0,
                    cost_decrease: 0.0,
                    sizes: values.to_vec(),
                }
            };
        Screening {
            products: columns.transpose() * columns,
            nuisances: 0,
            priors: Vec::new(),
            bounds: Vec::new(),
            limits: Vec::new(),
            responses: of.iter().enumerate().map(response).collect(),
            unexcited: Vec::new(),
            number_count: columns.nrows() as f64,
        }
    }

    fn response(index: usize) -> ResponseId {
        ResponseId::new(index)
    }

    #[test]
    fn similarity_to_several_parameters_is_a_projection() {
        // Responses: one with two parameters x and y and predicted response x; one with 3 x + 4 y;
        // one with z.
        let columns = DMatrix::from_row_slice(
            3,
            5,
            &[
                1.0, 0.0, 3.0, 0.0, 1.0, //
                0.0, 1.0, 4.0, 0.0, 0.0, //
                0.0, 0.0, 0.0, 2.0, 0.0,
            ],
        );
        let of: [(std::ops::Range<usize>, &[f64]); 3] =
            [(0..2, &[1.0, 0.0]), (2..3, &[0.2]), (3..4, &[1.0])];
        let screening = screening(&columns, &of);
        assert!((screening.compute_similarity(response(0), response(1)) - 1.0).abs() < 1e-6);
        assert!((screening.compute_similarity(response(1), response(0)) - 1.0).abs() < 1e-6);
        assert!(
            screening.compute_similarity(response(0), response(2)) < 1e-6
                && screening.compute_similarity(response(1), response(2)) < 1e-6
        );
    }

    #[test]
    fn opposite_responses_cancel() {
        // Two nearly equal responses and a different one.
        let columns = DMatrix::from_row_slice(2, 4, &[1.0, 1.0, 0.0, 1.0, 0.0, 0.1, 1.0, 1.0]);
        let of: [(std::ops::Range<usize>, &[f64]); 3] =
            [(0..1, &[1.0]), (1..2, &[1.0]), (2..3, &[1.0])];
        let screening = screening(&columns, &of);
        let cancels = |a: usize, b: usize, sizes: [f64; 2]| {
            screening.is_cancelling(&[response(a), response(b)], &sizes)
        };
        assert!(cancels(0, 1, [10.0, -10.0]));
        assert!(!cancels(0, 1, [10.0, 10.0]), "they add up");
        assert!(!cancels(0, 1, [10.0, -3.0]), "most of one stays");
        assert!(!cancels(0, 2, [10.0, -10.0]), "they differ");
    }

    #[test]
    fn similarity_of_single_responses_is_their_cosine() {
        let columns = DMatrix::from_row_slice(2, 3, &[1.0, 3.0, 1.0, 0.0, 4.0, 1.0]);
        let of: [(std::ops::Range<usize>, &[f64]); 2] = [(0..1, &[-2.0]), (1..2, &[5.0])];
        // Expected value: the cosine in a triangle with sides 3, 4 and 5.
        assert!(
            (screening(&columns, &of).compute_similarity(response(0), response(1)) - 0.6).abs()
                < 1e-6
        );
    }
}
