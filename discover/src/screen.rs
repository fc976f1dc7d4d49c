//! Screening: what each candidate does to the windows' outputs, to first order, with initial
//! states and nuisances free to take up what they can. From these responses follow how much
//! of the misfit each candidate, or a set of them, may explain, and which look alike. Whoever
//! passes is fitted in earnest elsewhere.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::bounded::least_squares;
use crate::candidates::Candidate;
use crate::estimate;
use crate::fitting::{Fit, Setting};
use crate::plant::Plant;
use crate::rule;
use crate::crew::Crew;
use crate::shooting::Shooting;
use crate::unknowns::{Unknown, What};

/// Windows that are screened on; they are spread evenly.
const MOST_WINDOWS: usize = 12;

/// A candidate's parameter is tried at the size that moves the outputs by this part of the
/// misfit.
const TRIAL: f64 = 0.3;

/// Attempts to find that size, each at most so many powers of ten further.
const ATTEMPTS: (usize, f64) = (8, 1e6);

/// A candidate's parameter with its bounds and the size tried, SI.
#[derive(Clone, Debug)]
pub struct Trial {
    /// The unknown, absent where it is 0.
    pub unknown: Unknown,
    /// Whether it shapes the effect without scaling it; its value is then kept.
    pub is_shape: bool,
}

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
    /// How many of the training numbers were looked at.
    pub share: f64,
}

/// Screens candidates at a fit.
pub fn screen(setting: &Setting<'_>, fit: &Fit, candidates: &[Candidate]) -> Screen {
    let shooting = setting.shooting(&fit.plant, &setting.train, &fit.unknowns, &fit.ranges);
    let estimate = &fit.train.estimate;
    let all = setting.train.list.len();
    let count = all.min(MOST_WINDOWS);
    let places: Vec<usize> = (0..count).map(|k| k * all / count).collect();
    let level = estimate::level(&shooting, estimate);
    let base = base(&shooting, fit, &places, level);
    let found = found(setting, fit, candidates, &places, &base, level);
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
    let mut products = products(fit, &places, &base, &blocks, columns);
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
        share: count as f64 / all as f64,
    };
    screen.judge();
    screen
}

/// The responses of all candidates. Those of one effect at one place that differ in the order
/// alone are of one size: it is searched for once.
fn found(
    setting: &Setting<'_>,
    fit: &Fit,
    candidates: &[Candidate],
    places: &[usize],
    base: &Base,
    level: f64,
) -> Vec<Result<Columns, String>> {
    let alike = |a: &Candidate, b: &Candidate| {
        let angle = |c: &Candidate| c.order.as_ref().map(|(angle, _)| angle.clone());
        a.effect == b.effect && a.on == b.on && angle(a) == angle(b)
    };
    let groups: Vec<&[Candidate]> = candidates.chunk_by(alike).collect();
    let found: Vec<Vec<Result<Columns, String>>> = groups
        .par_iter()
        .map(|group| {
            let mut sizes: Vec<f64> = Vec::new();
            let of_group = group.iter().map(|candidate| {
                let found = response(setting, fit, candidate, places, base, (level, &sizes));
                if let Ok((trials, _)) = &found {
                    sizes = trials.iter().map(|trial| trial.unknown.scale).collect();
                }
                found
            });
            of_group.collect()
        })
        .collect();
    found.into_iter().flatten().collect()
}

/// A candidate's parameters, and for each window a column per parameter that scales it.
type Columns = (Vec<Trial>, Vec<DMatrix<f64>>);

/// A window at the fit: residual, derivatives by state and by unknowns.
type Base = Vec<Option<estimate::Eliminator>>;

fn base(shooting: &Shooting<'_>, fit: &Fit, places: &[usize], level: f64) -> Base {
    let estimate = &fit.train.estimate;
    let mut crew = Crew::new(shooting, &estimate.theta, level);
    places
        .iter()
        .map(|place| {
            let linear = crew.as_mut()?.linear(*place, &estimate.starts[*place])?;
            Some(estimate::Eliminator::new(
                &linear,
                &fit.prior,
                *place,
                &estimate.starts[*place],
            ))
        })
        .collect()
}

/// What a candidate does in each window, a column per parameter that scales it.
fn response(
    setting: &Setting<'_>,
    fit: &Fit,
    candidate: &Candidate,
    places: &[usize],
    base: &Base,
    (level, sizes): (f64, &[f64]),
) -> Result<Columns, String> {
    let start: Vec<f64> = candidate
        .parameters
        .iter()
        .map(|p| absent(p.inverse, p.shape))
        .collect();
    let text = candidate
        .written(&fit.text, &setting.path, &start, "")
        .map_err(|e| e.to_string())?;
    let plant = setting.plant(&text)?;
    let mut trials: Vec<Trial> = candidate.parameters.iter().map(trial).collect();
    for (trial, size) in trials.iter_mut().zip(sizes) {
        trial.unknown.scale = *size;
    }
    let extended: Vec<Unknown> = fit
        .unknowns
        .iter()
        .cloned()
        .chain(trials.iter().map(|t| t.unknown.clone()))
        .collect();
    let ranges = mapped(fit, &plant, &fit.ranges);
    let shooting = setting.shooting(&plant, &setting.train, &extended, &ranges);
    let nuisances = fit.unknowns.len();
    let mut columns = vec![Vec::new(); places.len()];
    for place in 0..trials.len() {
        if trials[place].is_shape {
            continue;
        }
        let theta = |size: f64| {
            let mut theta = fit.train.estimate.theta.clone();
            theta.extend(trials.iter().map(|trial| trial.unknown.start));
            theta[nuisances + place] = size;
            theta
        };
        // The size is found on the first, the middle and the last of the windows.
        let few = [0, places.len() / 2, places.len() - 1];
        let size = trial_size(trials[place].unknown.scale, level, |size| {
            let changes = changes(
                &shooting,
                fit,
                &theta(size),
                few.iter().map(|k| (places[*k], &base[*k])),
            )?;
            let numbers: f64 = changes.iter().map(|c| c.len() as f64).sum();
            let square: f64 = changes.iter().map(DVector::norm_squared).sum();
            Some((square / numbers).sqrt())
        });
        let Some(size) = size else {
            return Err(
                "nothing in the record would show it: it does not change the outputs".to_owned(),
            );
        };
        let pairs = places.iter().copied().zip(base.iter());
        let changes = changes(&shooting, fit, &theta(size), pairs)
            .ok_or("the motion with it cannot be followed")?;
        for (window, change) in columns.iter_mut().zip(changes) {
            window.push(change / size);
        }
        trials[place].unknown.scale = size;
    }
    let blocks = columns.iter().map(|columns| {
        let rows = columns.first().map_or(0, |c: &DVector<f64>| c.len());
        DMatrix::from_fn(rows, columns.len(), |r, c| columns[c][r])
    });
    Ok((trials, blocks.collect()))
}

/// The value of a parameter where its effect is absent, or nearly.
fn absent(inverse: bool, shape: Option<f64>) -> f64 {
    match (inverse, shape) {
        (_, Some(shape)) => shape,
        (true, None) => 1e12,
        (false, None) => 0.0,
    }
}

fn trial(parameter: &crate::candidates::CandidateParameter) -> Trial {
    let low = match (parameter.inverse, parameter.positive) {
        (true, _) => 1e-12,
        (false, true) => 0.0,
        (false, false) => f64::NEG_INFINITY,
    };
    let name = parameter.name.clone();
    let unknown = Unknown {
        what: if parameter.inverse {
            What::Inverse(name)
        } else {
            What::Parameter(name)
        },
        start: parameter.shape.unwrap_or(low.max(0.0)),
        prior: None,
        bounds: match parameter.shape {
            Some(shape) => (rule::SHAPE_RANGE.0 * shape, rule::SHAPE_RANGE.1 * shape),
            None => (low, f64::INFINITY),
        },
        scale: parameter
            .shape
            .unwrap_or(if parameter.inverse { 1e-4 } else { 1.0 }),
    };
    Trial {
        unknown,
        is_shape: parameter.shape.is_some(),
    }
}

/// Changes of the residuals in some windows; none if a motion cannot be followed.
fn changes<'b>(
    shooting: &Shooting<'_>,
    fit: &Fit,
    theta: &[f64],
    windows: impl Iterator<Item = (usize, &'b Option<estimate::Eliminator>)>,
) -> Option<Vec<DVector<f64>>> {
    let mut crew = Crew::frozen(shooting, theta, 1.0)?;
    let mut changes = Vec::new();
    for (place, base) in windows {
        let Some(base) = base else {
            changes.push(DVector::zeros(0));
            continue;
        };
        let start = mapped(fit, shooting.plant, &fit.train.estimate.starts[place]);
        let residual = crew.residual(place, &start)?;
        changes.push(DVector::from_vec(residual.values) - &base.residual);
    }
    Some(changes)
}

/// A state of the fit's plant as one of another plant: what that has beside is 0.
pub fn mapped(fit: &Fit, plant: &Plant, state: &[f64]) -> Vec<f64> {
    if state.is_empty() {
        return Vec::new();
    }
    let value = |name: &String| {
        let place = fit.plant.states.iter().position(|known| known == name);
        place.map_or(0.0, |place| state[place])
    };
    plant.states.iter().map(value).collect()
}

/// The size of a parameter that moves the outputs as wanted; none if none does.
fn trial_size(start: f64, level: f64, moved: impl Fn(f64) -> Option<f64>) -> Option<f64> {
    let wanted = TRIAL * level;
    let mut size = start;
    for _ in 0..ATTEMPTS.0 {
        let factor = match moved(size) {
            Some(change) if change > 0.2 * wanted && change < 5.0 * wanted => return Some(size),
            Some(change) if change.is_finite() && change > 0.0 => wanted / change,
            Some(_) => ATTEMPTS.1,
            None => 1e-3,
        };
        size *= factor.clamp(1.0 / ATTEMPTS.1, ATTEMPTS.1);
    }
    None
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
            response.gain = (alone - left) / self.share;
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
            share: self.share,
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
