//! Screening: what each candidate does to the windows' outputs, to first order, with initial
//! states and nuisances free to take up what they can. From these responses follow how much
//! of the misfit each candidate, or a set of them, may explain, and which look alike. Whoever
//! passes is fitted in earnest elsewhere.

use nalgebra::{DMatrix, DVector};

use crate::bounded::least_squares;
use crate::candidates::Candidate;
use crate::fitting::{Fit, Setting};
use crate::response::{At, Base, Trial, responses};
use crate::rule;

/// A screened candidate.
#[derive(Clone, Debug)]
pub struct Response {
    /// The candidate's place in the list.
    pub candidate: usize,
    /// Its unknowns.
    pub trials: Vec<Trial>,
    /// Where its columns stand.
    columns: std::ops::Range<usize>,
    /// The part of what it does that initial states and nuisances cannot do as well.
    pub visible: f64,
    /// How much it lowers the sum of squares alone, in noises squared.
    pub gain: f64,
    /// The size at which it does.
    pub values: Vec<f64>,
}

/// All responses.
#[derive(Clone)]
pub struct Screen {
    /// Products of all columns: nuisances, candidates, the residual last.
    products: DMatrix<f64>,
    nuisances: usize,
    bounds: Vec<(f64, f64)>,
    /// The candidates that do something, in their order.
    pub responses: Vec<Response>,
    /// The candidates that do nothing that could be seen, with why.
    pub silent: Vec<(usize, String)>,
    /// How many numbers were looked at.
    pub numbers: f64,
}

/// Screens candidates at a fit.
pub fn screen(setting: &Setting<'_>, fit: &Fit, candidates: &[Candidate]) -> Screen {
    let at = At::of(setting, fit);
    let (base, places, estimate) = (&at.base, &at.places, &at.estimate);
    let found = responses(&at, setting, fit, candidates);
    let nuisances = fit.unknowns.len();
    let mut responses = Vec::new();
    let mut silent = Vec::new();
    let mut blocks = Vec::new();
    let mut columns = nuisances;
    for (candidate, found) in found.into_iter().enumerate() {
        match found {
            Ok((trials, block)) => {
                let scaling = trials.iter().filter(|trial| !trial.is_shape).count();
                responses.push(Response {
                    candidate,
                    trials,
                    columns: columns..columns + scaling,
                    visible: 0.0,
                    gain: 0.0,
                    values: Vec::new(),
                });
                columns += scaling;
                blocks.push(block);
            }
            Err(reason) => silent.push((candidate, reason)),
        }
    }
    let mut products = products(fit, places, base, &blocks, columns);
    let mut bounds = Vec::new();
    for (place, unknown) in fit.unknowns.iter().enumerate() {
        let value = estimate.theta[place];
        bounds.push((unknown.bounds.0 - value, unknown.bounds.1 - value));
        if let Some((mean, sd)) = unknown.prior {
            let weight = fit.prior_weight / (sd * sd);
            products[(place, place)] += weight;
            products[(place, columns)] += weight * (value - mean);
            products[(columns, place)] += weight * (value - mean);
            products[(columns, columns)] += weight * (value - mean).powi(2);
        }
    }
    for response in &responses {
        let scaling = response.trials.iter().filter(|trial| !trial.is_shape);
        bounds.extend(scaling.map(|trial| trial.unknown.bounds));
    }
    let mut screen = Screen {
        products,
        nuisances,
        bounds,
        responses,
        silent,
        numbers: base.iter().flatten().map(|b| b.residual.len() as f64).sum(),
    };
    screen.judge();
    screen
}

/// Products of all columns with the initial states eliminated.
fn products(
    fit: &Fit,
    places: &[usize],
    base: &Base,
    blocks: &[Vec<DMatrix<f64>>],
    columns: usize,
) -> DMatrix<f64> {
    let nuisances = fit.unknowns.len();
    let mut products = DMatrix::zeros(columns + 1, columns + 1);
    for (window, base) in (0..places.len()).zip(base) {
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
        products += base.products(&matrix);
    }
    products
}

impl Screen {
    /// How well each candidate does alone.
    fn judge(&mut self) {
        let alone = self.left(&[]).0;
        for place in 0..self.responses.len() {
            let (left, values) = self.left(&[place]);
            let visible = self.visible(place);
            let response = &mut self.responses[place];
            response.gain = alone - left;
            response.values = values;
            response.visible = visible;
        }
    }

    /// The sum of squares that a set of responses leaves, and their sizes in order.
    pub fn left(&self, set: &[usize]) -> (f64, Vec<f64>) {
        let mut places: Vec<usize> = (0..self.nuisances).collect();
        for response in set {
            places.extend(self.responses[*response].columns.clone());
        }
        let last = self.products.ncols() - 1;
        let (a, b) = self.system(&places, last);
        let bounds: Vec<(f64, f64)> = places
            .iter()
            .map(|place| {
                (
                    self.bounds[*place].0.min(0.0),
                    self.bounds[*place].1.max(0.0),
                )
            })
            .collect();
        let x = least_squares(&a, &b, &bounds);
        let left = (&a * &x - &b).norm_squared() - b.norm_squared() + self.products[(last, last)];
        (left, x.iter().skip(self.nuisances).copied().collect())
    }

    /// The same with a parameter of the model set to 0, its term deleted; none where that is
    /// not admissible.
    pub fn without(&self, nuisance: usize, value: f64) -> Option<Self> {
        let (low, high) = self.bounds[nuisance];
        if value == 0.0 || !(low..=high).contains(&-value) {
            return None;
        }
        let last = self.products.ncols() - 1;
        let mut products = self.products.clone();
        let column = products.column(nuisance) * -value;
        let mut residual = products.column_mut(last);
        residual += column;
        let row = products.row(nuisance) * -value;
        let mut residual = products.row_mut(last);
        residual += row;
        let mut bounds = self.bounds.clone();
        bounds[nuisance] = (0.0, 0.0);
        Some(Self {
            products,
            bounds,
            nuisances: self.nuisances,
            responses: self.responses.clone(),
            silent: Vec::new(),
            numbers: self.numbers,
        })
    }

    /// A and b whose least squares are those of some columns against the residual, to be
    /// lowered to its negative.
    fn system(&self, places: &[usize], last: usize) -> (DMatrix<f64>, DVector<f64>) {
        let count = places.len();
        let scale: Vec<f64> = places
            .iter()
            .map(|p| self.products[(*p, *p)].sqrt().max(f64::MIN_POSITIVE))
            .collect();
        let gram = DMatrix::from_fn(count, count, |r, c| {
            let ridge = if r == c { rule::RIDGE } else { 0.0 };
            self.products[(places[r], places[c])] / (scale[r] * scale[c]) + ridge
        });
        let right = DVector::from_fn(count, |r, _| -self.products[(places[r], last)] / scale[r]);
        let Some(factor) = gram.cholesky() else {
            return (DMatrix::zeros(count, count), DVector::zeros(count));
        };
        let lower = factor.l();
        let b = lower
            .solve_lower_triangular(&right)
            .unwrap_or_else(|| DVector::zeros(count));
        let a = DMatrix::from_fn(count, count, |r, c| lower[(c, r)] * scale[c]);
        (a, b)
    }

    /// The part of a response's square that the nuisances cannot do as well.
    fn visible(&self, place: usize) -> f64 {
        let direction = self.direction(place);
        let own = self.product(&direction, &direction);
        let rest = self.without_nuisances(&direction, &direction);
        if own > 0.0 {
            (rest / own).max(0.0)
        } else {
            0.0
        }
    }

    /// A response at its best size as a combination of columns.
    fn direction(&self, place: usize) -> DVector<f64> {
        let response = &self.responses[place];
        let mut direction = DVector::zeros(self.products.ncols());
        let all_zero = response.values.iter().all(|v| *v == 0.0);
        for (number, column) in response.columns.clone().enumerate() {
            direction[column] = if all_zero || response.values.is_empty() {
                1.0 / self.products[(column, column)]
                    .sqrt()
                    .max(f64::MIN_POSITIVE)
            } else {
                response.values[number]
            };
        }
        direction
    }

    fn product(&self, a: &DVector<f64>, b: &DVector<f64>) -> f64 {
        (a.transpose() * &self.products * b)[(0, 0)]
    }

    fn without_nuisances(&self, a: &DVector<f64>, b: &DVector<f64>) -> f64 {
        let n = self.nuisances;
        let whole = self.product(a, b);
        let cross = |v: &DVector<f64>| (&self.products * v).rows(0, n).into_owned();
        let mut block = self.products.view((0, 0), (n, n)).into_owned();
        for place in 0..n {
            block[(place, place)] *= 1.0 + rule::RIDGE;
        }
        match block.cholesky() {
            Some(factor) => whole - cross(a).dot(&factor.solve(&cross(b))),
            None => whole,
        }
    }

    /// How much two responses look alike, 0 to 1, once the nuisances are taken out.
    pub fn similarity(&self, a: usize, b: usize) -> f64 {
        let (a, b) = (self.direction(a), self.direction(b));
        let sizes = self.without_nuisances(&a, &a) * self.without_nuisances(&b, &b);
        if sizes > 0.0 {
            (self.without_nuisances(&a, &b) / sizes.sqrt()).abs()
        } else {
            0.0
        }
    }
}
