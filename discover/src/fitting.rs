//! A specification fitted to the records: from its text to unknowns with their uncertainty
//! and to what is left on the records it was fitted to and on the others. What the results
//! mean is judged in [`crate::judge`].

use model_spec::source::Source;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::approach::{Follow, approach, approach_by_secants, secants};
use crate::candidates::Candidate;
use crate::crew::Linear;
use crate::dataset::{Dataset, Start};
use crate::estimate::{self, Estimate, StartPrior, prior_of_start, stacked};
use crate::plant::{Plant, is_linear};
use crate::response::mapped;
use crate::rule;
use crate::shooting::Shooting;
use crate::starts;
use crate::unknowns::Unknown;
use crate::windows::Windows;

/// The parts of a window over which initial states are fitted, one after the other.
const HORIZONS: [f64; 4] = [0.08, 0.25, 0.5, 1.0];

/// Others, for another try: where impacts fold the outputs, one way may end in the wrong fold
/// and another in the right one.
const OTHER_HORIZONS: [f64; 5] = [0.05, 0.12, 0.3, 0.7, 1.0];

/// The part of a window on which unknowns are first approached, and the horizons up to it.
pub const FIRST_PART: (f64, usize) = (0.25, 2);

/// The most steps while unknowns are far away, and close by.
const STEPS: (usize, usize) = (5, 4);

/// The most further steps over beginnings of windows before whole ones are looked at.
const FURTHER_STEPS: usize = 12;

/// Steps of a sketch where initial states are read from the record.
const SKETCHING_STEPS: usize = 3;

/// What leaves more than this many noises is not worth being followed anew.
const FAR: f64 = 8.0;

/// Windows are followed anew so often at most, while that lowers the cost by this part.
const REFRESHES: usize = 2;
const WORTH_A_REFRESH: f64 = 0.005;

/// Into so many blocks a set of windows is parted to judge what differs by chance.
const BLOCKS: usize = 40;

/// What all fits to one dataset share.
pub struct Setting<'d> {
    /// The dataset.
    pub dataset: &'d Dataset,
    /// The noise of each channel, SI.
    pub noise: Vec<f64>,
    /// The windows to fit to.
    pub train: Windows<'d>,
    /// The windows held out.
    pub test: Windows<'d>,
    /// The order of the model's fields, if not their own.
    pub order: Option<usize>,
    /// The specification's path, for messages.
    pub path: String,
    /// The states of the specification's own model; others are candidates'.
    pub states: Vec<String>,
}

/// What is left on one set of records.
#[derive(Clone, Debug, Default)]
pub struct Rest {
    /// Initial states, unknowns and sums of squares.
    pub estimate: Estimate,
    /// Residuals of each window, in noises.
    pub residuals: Vec<Vec<f64>>,
    /// For each block of time the sum of squares.
    pub blocks: Vec<f64>,
    /// The root mean square of each channel, SI.
    pub channels: Vec<f64>,
    /// The same in noises.
    pub in_noises: Vec<f64>,
    /// The root mean square of all, in noises.
    pub pooled: f64,
    /// How many samples a residual is correlated over.
    pub correlation: f64,
}

/// A fitted specification.
pub struct Fit {
    /// The text.
    pub text: String,
    /// The text without terms that are not linear between switches, where that is possible.
    pub linear: String,
    /// Its model, ready to run.
    pub plant: Plant,
    /// What was estimated.
    pub unknowns: Vec<Unknown>,
    /// One standard deviation of each, with correlated residuals allowed for.
    pub sd: Vec<f64>,
    /// The range of each state.
    pub ranges: Vec<f64>,
    /// What was known of the training windows' initial states.
    pub prior: StartPrior,
    /// How much priors count.
    pub prior_weight: f64,
    /// What is left on the training records.
    pub train: Rest,
    /// What is left on the test records.
    pub test: Rest,
}

impl Fit {
    /// What is left on all records, in noises.
    pub fn left(&self) -> f64 {
        (0.5 * (self.train.pooled.powi(2) + self.test.pooled.powi(2))).sqrt()
    }

    /// Unknowns to begin with where something is added: parameters and sensors that took up what
    /// it does begin anew.
    pub fn anew(&self) -> Vec<f64> {
        let known = self.unknowns.iter().zip(&self.train.estimate.theta);
        known
            .map(|(unknown, value)| unknown.prior.map_or(*value, |(mean, _)| mean))
            .collect()
    }

    /// The values of some unknowns as a specification states them, SI.
    pub fn stated(&self, places: &[usize]) -> Vec<f64> {
        let theta = &self.train.estimate.theta;
        let of = |place: &usize| self.unknowns[*place].what.stated(theta[*place]);
        places.iter().map(of).collect()
    }
}

/// A specification fitted to the beginnings of the windows.
pub struct Sketch {
    /// The sum of squares that is left there, in noises, with what priors add.
    pub left: f64,
    /// What is known of the initial states of whole windows, where they begin there already.
    whole: Option<StartPrior>,
    /// Whether further steps over beginnings of windows would help little.
    is_there: bool,
    text: String,
    linear: String,
    plant: Plant,
    unknowns: Vec<Unknown>,
    ranges: Vec<f64>,
    theta: Vec<f64>,
    starts: Vec<Vec<f64>>,
}

impl<'d> Setting<'d> {
    /// The setting of a dataset and of a specification's text.
    pub fn new(dataset: &'d Dataset, order: Option<usize>, path: &str, text: &str) -> Self {
        let states = || {
            let model = model_spec::check(Source::new(path, text)).ok()?.model;
            Some(model.state_names(&model.orders(order).ok()?))
        };
        Self {
            // What is wrong with a text is said where it is derived.
            states: states().unwrap_or_default(),
            dataset,
            noise: dataset
                .channels
                .iter()
                .map(|channel| channel.noise)
                .collect(),
            train: Windows::cut(&dataset.train, dataset.window),
            test: Windows::cut(&dataset.test, dataset.window),
            order,
            path: path.to_owned(),
        }
    }

    /// The model of a text, ready to run on these records. `linear`: the text without terms
    /// that are not linear between switches, where there are such.
    ///
    /// # Errors
    /// What is wrong with the text.
    pub fn plant(&self, text: &str, linear: Option<&str>) -> Result<Plant, String> {
        let channels = &self.dataset.channels;
        let mut plant = Plant::of(text, linear, &self.path, self.order, channels)?;
        let record = &self.dataset.train[0];
        let first = self.first_state(&plant, record);
        plant.choose_steps(record, &first, &self.noise);
        Ok(plant)
    }

    /// A specification's text and its linear part's with a candidate at these values.
    ///
    /// # Errors
    /// A place of the edits that the text lacks, in words.
    pub fn with(
        &self,
        (text, linear): (&str, &str),
        candidate: &Candidate,
        values: &[f64],
    ) -> Result<(String, String), String> {
        let written = |text| candidate.written(text, &self.path, values, "");
        let extended = written(text).map_err(|error| error.to_string())?;
        // What is linear between switches itself belongs to the linear part.
        let linear = match written(linear) {
            Ok(extended) if is_linear(&extended, &self.path, self.order) => extended,
            _ => linear.to_owned(),
        };
        Ok((extended, linear))
    }

    /// The first state of a record, as far as it is known.
    pub fn first_state(&self, plant: &Plant, record: &crate::dataset::Record) -> Vec<f64> {
        starts::first_state(plant, record, &self.dataset.channels, &self.dataset.initial)
    }

    /// Whether initial states are fitted.
    pub fn fits_starts(&self) -> bool {
        self.dataset.start == Start::Fitted
    }

    /// Windows to be explained by a plant.
    pub fn shooting<'a>(
        &'a self,
        plant: &'a Plant,
        windows: &'a Windows<'a>,
        unknowns: &'a [Unknown],
        ranges: &'a [f64],
    ) -> Shooting<'a> {
        Shooting {
            plant,
            windows,
            noise: &self.noise,
            unknowns,
            margin: (rule::LONGEST_DELAY as usize, rule::LONGEST_LEAD as usize),
            ranges: self.fits_starts().then_some(ranges),
            part: 1.0,
            prior_weight: 1.0,
        }
    }

    /// Initial states of all windows at these unknowns.
    fn starts(
        &self,
        shooting: &Shooting<'_>,
        theta: &[f64],
        ranges: &[f64],
        horizons: &[f64],
        before: Option<&[Vec<f64>]>,
    ) -> Result<(StartPrior, Vec<Vec<f64>>), String> {
        if !self.fits_starts() {
            let read =
                starts::read_smoothed(shooting.plant, shooting.windows, &self.dataset.channels);
            return Ok((StartPrior::default(), read.map_err(not_shown)?));
        }
        let records = shooting.windows.records.iter();
        let firsts: Vec<Vec<f64>> = records
            .map(|r| self.first_state(shooting.plant, r))
            .collect();
        Ok(starts::followed(
            shooting, theta, &firsts, ranges, horizons, before,
        ))
    }

    /// Initial states of all windows at these unknowns, found as they are in a fit.
    ///
    /// # Errors
    /// If they are to be read from the record and no channel shows a coordinate.
    pub fn all_starts(
        &self,
        shooting: &Shooting<'_>,
        theta: &[f64],
        ranges: &[f64],
    ) -> Result<Vec<Vec<f64>>, String> {
        let ladders = [&HORIZONS[..], &OTHER_HORIZONS];
        let ladders = if self.fits_starts() {
            &ladders[..]
        } else {
            &ladders[..1]
        };
        let found: Vec<Result<Estimate, String>> = ladders
            .par_iter()
            .map(|horizons| {
                let (_, starts) = self.starts(shooting, theta, ranges, horizons, None)?;
                let prior = StartPrior::default();
                Ok(estimate::evaluated(
                    shooting,
                    &prior,
                    theta.to_vec(),
                    starts,
                ))
            })
            .collect();
        let found = found
            .into_iter()
            .collect::<Result<Vec<Estimate>, String>>()?;
        let best = (0..shooting.windows.list.len()).map(|window| {
            let order =
                |a: &&Estimate, b: &&Estimate| a.squares[window].total_cmp(&b.squares[window]);
            let best = found.iter().min_by(order);
            best.map_or_else(Vec::new, |found| found.starts[window].clone())
        });
        Ok(best.collect())
    }

    /// Fits a specification: its unknowns from `theta`, then what is left.
    ///
    /// # Errors
    /// What is wrong with the text, or why no motion can be followed.
    pub fn fit(
        &self,
        texts: (String, String),
        unknowns: Vec<Unknown>,
        theta: &[f64],
    ) -> Result<Fit, String> {
        self.complete(self.sketch(texts, unknowns, &[theta.to_vec()])?)
    }

    /// Fits the model's unknowns to the beginnings of the windows, which tells good ones from
    /// bad ones at a part of the cost. `texts`: the specification's, and its linear part's;
    /// `begins`: unknowns to begin with, of which the best is taken.
    ///
    /// # Errors
    /// As for [`Setting::fit`].
    pub fn sketch(
        &self,
        (text, linear): (String, String),
        unknowns: Vec<Unknown>,
        begins: &[Vec<f64>],
    ) -> Result<Sketch, String> {
        let plant = self.plant(&text, Some(&linear))?;
        let ranges = self.ranges(&plant, &plant.values);
        let shooting = self.shooting(&plant, &self.train, &unknowns, &ranges);
        let (found, is_there) = if self.fits_starts() {
            let shooting = Shooting {
                part: FIRST_PART.0,
                ..shooting
            };
            let follow = self.follow(&shooting, &ranges, FIRST_PART.1);
            let found = approach(&shooting, begins, &follow, STEPS.0);
            (found.estimate, found.is_there)
        } else {
            let theta = begins.first().map_or(&[][..], Vec::as_slice);
            let (prior, starts) = self.starts(&shooting, theta, &ranges, &HORIZONS, None)?;
            let found = estimate::estimate(&shooting, &prior, theta, &starts, SKETCHING_STEPS);
            (found, true)
        };
        // How far states go may depend on what was found: a joint yields so much the more.
        let ranges = self.ranges(&plant, &shooting.values(&found.theta));
        Ok(Sketch {
            left: found.cost,
            whole: None,
            is_there,
            starts: found.starts,
            theta: found.theta,
            text,
            linear,
            plant,
            unknowns,
            ranges,
        })
    }

    /// The model's unknowns as they are expected, with whole windows begun where those of a fit
    /// begin: close to a fit a straight line says enough. `left`: what it promises to leave.
    ///
    /// # Errors
    /// As for [`Setting::fit`].
    pub fn expected(
        &self,
        (text, linear): (String, String),
        unknowns: Vec<Unknown>,
        theta: Vec<f64>,
        (fit, left): (&Fit, f64),
    ) -> Result<Sketch, String> {
        let plant = self.plant(&text, Some(&linear))?;
        let bare = self.shooting(&plant, &self.train, &unknowns, &[]);
        let ranges = self.ranges(&plant, &bare.values(&theta));
        let mapped = |states: &[Vec<f64>]| -> Vec<Vec<f64>> {
            states
                .iter()
                .map(|state| mapped(fit, &plant, state))
                .collect()
        };
        let prior = StartPrior {
            mean: mapped(&fit.prior.mean),
            sd: match fit.prior.sd.is_empty() {
                true => Vec::new(),
                false => starts::spread(&ranges),
            },
        };
        Ok(Sketch {
            left,
            whole: Some(prior),
            is_there: true,
            starts: mapped(&fit.train.estimate.starts),
            theta,
            text,
            linear,
            plant,
            unknowns,
            ranges,
        })
    }

    /// Initial states that follow unknowns, by so many horizons.
    fn follow<'f>(
        &'f self,
        shooting: &'f Shooting<'f>,
        ranges: &'f [f64],
        horizons: usize,
    ) -> Box<Follow<'f>> {
        Box::new(move |theta, before| {
            let horizons = &HORIZONS[..horizons];
            self.starts(shooting, theta, ranges, horizons, before)
                .unwrap_or_default()
        })
    }

    /// Fits everything to the whole windows, from a sketch.
    ///
    /// # Errors
    /// As for [`Setting::fit`].
    pub fn complete(&self, sketch: Sketch) -> Result<Fit, String> {
        let Sketch {
            text,
            linear,
            plant,
            unknowns,
            ranges,
            theta,
            starts,
            whole,
            is_there,
            left,
        } = sketch;
        let mut all = self.shooting(&plant, &self.train, &unknowns, &ranges);
        let begins_whole = whole.is_some();
        let mut by_secants = false;
        let (mut prior, near) = match whole {
            None if self.fits_starts() => {
                let first = Shooting {
                    part: FIRST_PART.0,
                    ..all
                };
                let theta = self.begun(&first, (theta, left), &ranges, is_there);
                let follow = self.follow(&all, &ranges, HORIZONS.len());
                let mut near = approach(&all, &[theta], &follow, STEPS.0);
                // What is not linear costs ten times as much.
                if plant.is_linear() {
                    approach_by_secants(&all, &mut near, &follow);
                }
                by_secants = true;
                (near.prior, near.estimate)
            }
            whole => {
                let prior = whole.unwrap_or_default();
                let near = estimate::evaluated(&all, &prior, theta, starts);
                (prior, near)
            }
        };
        let is_far = !begins_whole && near.cost > FAR * FAR * self.train.numbers();
        let free = match is_far {
            true => near,
            false => estimate::estimate(&all, &prior, &near.theta, &near.starts, STEPS.1),
        };
        let mut rest = self.rest(&all, free);
        // What is left where records are believed as if noise were all that they hold says how
        // far they may be believed against the priors.
        all.prior_weight = (rest.pooled * rest.pooled).max(1.0) * rest.correlation;
        for _ in 0..REFRESHES {
            let Estimate { theta, starts, .. } = &rest.estimate;
            let found = estimate::estimate(&all, &prior, theta, starts, STEPS.1);
            if is_far {
                rest = self.rest(&all, found);
                break;
            }
            let before = found.cost;
            let (new_prior, found) = self.refreshed(&all, &ranges, prior, found);
            prior = new_prior;
            let settled = found.cost > (1.0 - WORTH_A_REFRESH) * before;
            rest = self.rest(&all, found);
            if settled {
                break;
            }
        }
        let prior_weight = all.prior_weight;
        // Tangents that led nowhere know nothing of uncertainties either.
        let derivatives = match by_secants {
            true => {
                let follow = self.follow(&all, &ranges, HORIZONS.len());
                secants(&all, &rest.estimate, &follow)
            }
            false => {
                let level = estimate::level(&all, &rest.estimate);
                all.linear(&rest.estimate.theta, &rest.estimate.starts, level)
            }
        };
        let sd = self.uncertainty(&all, &prior, &rest.estimate, &derivatives);
        let train = rest;
        let held_out = self.shooting(&plant, &self.test, &unknowns, &ranges);
        let starts = self.all_starts(&held_out, &train.estimate.theta, &ranges)?;
        let test = estimate::evaluated(
            &held_out,
            &StartPrior::default(),
            train.estimate.theta.clone(),
            starts,
        );
        let test = self.rest(&held_out, test);
        // A fit worse than noise does not know its unknowns better than its own misfit allows.
        let inflation = (train.pooled * train.pooled).max(1.0) * train.correlation;
        Ok(Fit {
            sd: sd
                .iter()
                .map(|sd| rule::WIDER * sd * inflation.sqrt())
                .collect(),
            text,
            linear,
            unknowns,
            ranges,
            prior,
            prior_weight,
            train,
            test,
            plant,
        })
    }

    /// Unknowns from a sketch of the beginnings of windows, as far as these lead: longer windows are
    /// folded until it is near. `left`: what the sketch leaves.
    fn begun(
        &self,
        first: &Shooting<'_>,
        (theta, left): (Vec<f64>, f64),
        ranges: &[f64],
        is_there: bool,
    ) -> Vec<f64> {
        let near = rule::AT_FLOOR * rule::AT_FLOOR * first.part * self.train.numbers();
        if is_there && left < near {
            return theta;
        }
        let follow = self.follow(first, ranges, FIRST_PART.1);
        let steps = if is_there { 0 } else { FURTHER_STEPS };
        let mut begun = approach(first, &[theta], &follow, steps);
        approach_by_secants(first, &mut begun, &follow);
        begun.estimate.theta
    }

    /// The windows followed anew at an estimate: those that are better for it begin there.
    fn refreshed(
        &self,
        shooting: &Shooting<'_>,
        ranges: &[f64],
        mut prior: StartPrior,
        found: Estimate,
    ) -> (StartPrior, Estimate) {
        if !self.fits_starts() {
            return (prior, found);
        }
        let Ok((anew, starts)) = self.starts(shooting, &found.theta, ranges, &OTHER_HORIZONS, None)
        else {
            return (prior, found);
        };
        let new = estimate::evaluated(shooting, &anew, found.theta.clone(), starts);
        let mut starts = found.starts.clone();
        for (place, start) in starts.iter_mut().enumerate() {
            let before = found.squares[place] + prior_of_start(&prior, place, start);
            let after = new.squares[place] + prior_of_start(&anew, place, &new.starts[place]);
            if after < before {
                start.clone_from(&new.starts[place]);
                prior.mean[place].clone_from(&anew.mean[place]);
            }
        }
        // What is known of a window from the one before holds at these unknowns, not at others.
        let carried = starts::carried(shooting, &found.theta, &starts);
        for (mean, carried) in prior.mean.iter_mut().zip(carried) {
            if let Some(carried) = carried {
                *mean = carried;
            }
        }
        let found = estimate::evaluated(shooting, &prior, found.theta, starts);
        (prior, found)
    }

    /// So much of each window at a fit: what is known of initial states, and states that suit
    /// these parts.
    pub fn beginnings(&self, fit: &Fit, part: f64) -> (StartPrior, Estimate) {
        if part == 1.0 || !self.fits_starts() {
            return (fit.prior.clone(), fit.train.estimate.clone());
        }
        let whole = self.shooting(&fit.plant, &self.train, &fit.unknowns, &fit.ranges);
        let shooting = Shooting { part, ..whole };
        let theta = fit.train.estimate.theta.clone();
        let follow = self.follow(&shooting, &fit.ranges, FIRST_PART.1);
        let (prior, starts) = follow(&theta, None);
        let estimate = estimate::evaluated(&shooting, &prior, theta, starts);
        (prior, estimate)
    }

    /// The range of each state in the training records. That of a coordinate which a candidate
    /// adds, and which nobody has seen move yet, counts several times.
    pub fn ranges(&self, plant: &Plant, values: &[f64]) -> Vec<f64> {
        let first = self.first_state(plant, &self.dataset.train[0]);
        let mut ranges = starts::ranges(plant, values, &self.dataset.train, &first);
        for (range, state) in ranges.iter_mut().zip(&plant.states) {
            if !self.states.contains(state) {
                *range *= rule::ADDED_STATE;
            }
        }
        ranges
    }

    /// One standard deviation of each unknown, were the residuals white noise.
    fn uncertainty(
        &self,
        shooting: &Shooting<'_>,
        prior: &StartPrior,
        found: &Estimate,
        linear: &[Option<Linear>],
    ) -> Vec<f64> {
        let count = shooting.unknowns.len();
        let mut factor = DMatrix::zeros(count + 1, count + 1);
        for (place, linear) in linear.iter().enumerate() {
            if let Some(linear) = linear {
                let window = estimate::reduced(linear, prior, place, &found.starts[place]);
                factor = stacked(&factor, &window.unknowns());
            }
        }
        let mut rows = DMatrix::zeros(count, count + 1);
        for (place, unknown) in shooting.unknowns.iter().enumerate() {
            let sd = unknown.prior.map_or(f64::INFINITY, |(_, sd)| sd);
            rows[(place, place)] = shooting.prior_weight.sqrt() / sd;
        }
        let factor = stacked(&factor, &rows);
        let square = factor.view((0, 0), (count, count)).into_owned();
        (0..count)
            .map(|place| {
                let unit = DVector::from_fn(count, |row, _| f64::from(u8::from(row == place)));
                let solved = square.transpose().solve_lower_triangular(&unit);
                solved.map_or(f64::INFINITY, |v| v.norm())
            })
            .collect()
    }

    /// What an estimate leaves.
    pub fn rest(&self, shooting: &Shooting<'_>, estimate: Estimate) -> Rest {
        let channels = shooting.channels();
        let residuals = shooting.residuals(&estimate.theta, &estimate.starts);
        let residuals: Vec<Vec<f64>> = residuals
            .into_iter()
            .map(|r| r.map(|r| r.values).unwrap_or_default())
            .collect();
        let mut sums = vec![(0.0, 0.0); channels];
        for (window, residual) in shooting.windows.list.iter().zip(&residuals) {
            for (place, value) in residual.iter().enumerate() {
                if window.measured[place].is_finite() {
                    let sum = &mut sums[place % channels];
                    *sum = (sum.0 + value * value, sum.1 + 1.0);
                }
            }
        }
        let mean_square = |(sum, count): (f64, f64)| if count > 0.0 { sum / count } else { 0.0 };
        let squares: Vec<f64> = sums.iter().map(|sum| mean_square(*sum)).collect();
        let pooled = (squares.iter().sum::<f64>() / channels.max(1) as f64).sqrt();
        Rest {
            blocks: blocks(&residuals),
            channels: squares
                .iter()
                .zip(&self.noise)
                .map(|(s, noise)| s.sqrt() * noise)
                .collect(),
            in_noises: squares.iter().map(|s| s.sqrt()).collect(),
            pooled,
            correlation: correlation(&residuals, channels),
            residuals,
            estimate,
        }
    }
}

fn not_shown(state: String) -> String {
    format!(
        "windows.start = \"smoothed\" needs a channel for every coordinate, and none shows \
         `{state}`; expected start = \"fitted\""
    )
}

/// Sums of squares of blocks of time: windows parted, or put together, into about so many.
fn blocks(residuals: &[Vec<f64>]) -> Vec<f64> {
    let parts = BLOCKS.div_ceil(residuals.len().max(1));
    let of_window = |residual: &Vec<f64>| {
        let size = residual.len().div_ceil(parts).max(1);
        let sums = residual
            .chunks(size)
            .map(|part| part.iter().map(|r| r * r).sum::<f64>());
        sums.collect::<Vec<f64>>()
    };
    residuals.iter().flat_map(of_window).collect()
}

/// The samples over which a residual is correlated: one plus twice the sum of its positive
/// autocorrelations, up to the first that is not, for the channel where it is longest.
pub(crate) fn correlation(residuals: &[Vec<f64>], channels: usize) -> f64 {
    let of_channel = |channel: usize| {
        let columns: Vec<Vec<f64>> = residuals
            .iter()
            .map(|r| r.iter().skip(channel).step_by(channels).copied().collect())
            .collect();
        let longest = columns.iter().map(Vec::len).max().unwrap_or(0);
        let at = |lag: usize| -> f64 {
            let products = columns.iter().map(|c| {
                c.iter()
                    .zip(c.iter().skip(lag))
                    .map(|(a, b)| a * b)
                    .sum::<f64>()
            });
            products.sum()
        };
        let whole = at(0);
        let mut time = 1.0;
        for lag in 1..longest / 2 {
            let part = at(lag) / whole;
            // What white noise shows by chance is none.
            if part.is_nan() || part < 0.05 {
                break;
            }
            time += 2.0 * part;
        }
        time
    };
    (0..channels).map(of_channel).fold(1.0, f64::max)
}
