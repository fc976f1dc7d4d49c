//! A specification fitted to the records: from its text to unknowns with their uncertainty
//! and to what is left on the records it was fitted to and on the others. What the results
//! mean is judged in [`crate::search::acceptance`].

use nalgebra::{DMatrix, DVector};

use crate::fit::continuation::{approach, approach_by_secants, secants};
use crate::fit::gauss_newton::{self, Estimate, StartPrior, prior_of_start};
use crate::fit::initial_states;
use crate::fit::preliminary::{STEPS, Sketch};
use crate::fit::residuals::Rest;
use crate::fit::sensitivity::Linear;
use crate::fit::shooting::Shooting;
use crate::fit::variable_projection::{reduced, stacked};
use crate::model::plant::Plant;
use crate::model::problem::{FIRST_PART, HORIZONS, OTHER_HORIZONS, Setting};
use crate::model::unknowns::Unknown;
use crate::thresholds;

/// The most steps close by.
const LAST_STEPS: usize = 4;

/// The most further steps over beginnings of windows before whole ones are looked at.
const FURTHER_STEPS: usize = 12;

/// What leaves more than this many noises is not worth being followed anew.
const FAR: f64 = 8.0;

/// Windows are followed anew so often at most, while that lowers the cost by this part.
const REFRESHES: usize = 2;
const WORTH_A_REFRESH: f64 = 0.005;

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

/// Where whole windows are fitted from.
struct Near {
    /// What is known of their initial states.
    prior: StartPrior,
    /// The estimate so far.
    estimate: Estimate,
    /// Whether its windows were followed anew.
    is_followed: bool,
    /// Whether it leaves too much to be worth more.
    is_far: bool,
}

impl Setting<'_> {
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

    /// Fits everything to the whole windows, from a sketch.
    ///
    /// # Errors
    /// As for [`Setting::fit`].
    pub fn complete(&self, sketch: Sketch) -> Result<Fit, String> {
        let mut all = self.shooting(&sketch.plant, &self.train, &sketch.unknowns, &sketch.ranges);
        let near = self.near(&all, &sketch);
        let is_followed = near.is_followed;
        let (prior, train) = self.settled(&mut all, near);
        let prior_weight = all.prior_weight;
        let estimate = &train.estimate;
        let level = gauss_newton::level(&all, estimate);
        let tangents = all.linear(&estimate.theta, &estimate.starts, level);
        let mut sd = self.uncertainty(&all, &prior, estimate, &tangents);
        if is_followed {
            // Tangents through impacts grow without bound, secants of motions that ended in other
            // folds are too steep: either would make unknowns too certain.
            let follow = self.follow(&all, &sketch.ranges, HORIZONS.len());
            let secants = secants(&all, estimate, tangents, &follow);
            let others = self.uncertainty(&all, &prior, estimate, &secants);
            for (sd, other) in sd.iter_mut().zip(others) {
                *sd = sd.max(other);
            }
        }
        let held_out = Shooting {
            windows: &self.test,
            prior_weight: 1.0,
            ..all
        };
        let theta = train.estimate.theta.clone();
        let starts = self.all_starts(&held_out, &theta, &sketch.ranges)?;
        let test = gauss_newton::evaluated(&held_out, &StartPrior::default(), theta, starts);
        let test = self.rest(&held_out, test);
        // A fit worse than noise does not know its unknowns better than its own misfit allows.
        let inflation = (train.pooled * train.pooled).max(1.0) * train.correlation;
        Ok(Fit {
            sd: sd
                .iter()
                .map(|sd| thresholds::WIDER * sd * inflation.sqrt())
                .collect(),
            text: sketch.text,
            linear: sketch.linear,
            unknowns: sketch.unknowns,
            ranges: sketch.ranges,
            prior,
            prior_weight,
            train: train.whole(),
            test: test.whole(),
            plant: sketch.plant,
        })
    }

    /// What a sketch comes to over whole windows, before they are fitted together.
    fn near(&self, all: &Shooting<'_>, sketch: &Sketch) -> Near {
        if let (None, true) = (&sketch.whole, self.fits_starts()) {
            let theta = self.begun(all, sketch);
            let follow = self.follow(all, &sketch.ranges, HORIZONS.len());
            let mut near = approach(all, &[theta], &follow, STEPS);
            // What is not linear costs ten times as much.
            if sketch.plant.is_linear() {
                approach_by_secants(all, &mut near, &follow);
            }
            return Near {
                is_far: near.estimate.cost > FAR * FAR * self.train.numbers(),
                prior: near.prior,
                estimate: near.estimate,
                is_followed: true,
            };
        }
        let prior = sketch.whole.clone().unwrap_or_default();
        let (theta, starts) = (sketch.theta.clone(), sketch.starts.clone());
        let estimate = gauss_newton::evaluated(all, &prior, theta, starts);
        Near {
            is_far: sketch.whole.is_none() && estimate.cost > FAR * FAR * self.train.numbers(),
            prior,
            estimate,
            is_followed: false,
        }
    }

    /// Whole windows fitted, and those followed anew that are better for it, as long as that helps.
    fn settled(&self, all: &mut Shooting<'_>, near: Near) -> (StartPrior, Rest) {
        let (mut prior, estimate) = (near.prior, near.estimate);
        let free = match near.is_far {
            true => estimate,
            false => {
                gauss_newton::estimate(all, &prior, &estimate.theta, &estimate.starts, LAST_STEPS)
            }
        };
        let mut rest = self.rest(all, free);
        // What is left where records are believed as if noise were all that they hold says how
        // far they may be believed against the priors.
        all.prior_weight = (rest.pooled * rest.pooled).max(1.0) * rest.correlation;
        for _ in 0..REFRESHES {
            let Estimate { theta, starts, .. } = &rest.estimate;
            let found = gauss_newton::estimate(all, &prior, theta, starts, LAST_STEPS);
            if near.is_far {
                return (prior, self.rest(all, found));
            }
            let before = found.cost;
            let (new_prior, found) = self.refreshed(all, prior, found);
            prior = new_prior;
            let is_settled = found.cost > (1.0 - WORTH_A_REFRESH) * before;
            rest = self.rest(all, found);
            if is_settled {
                break;
            }
        }
        (prior, rest)
    }

    /// Unknowns from a sketch of the beginnings of windows, as far as these lead: longer windows are
    /// folded until it is near.
    fn begun(&self, all: &Shooting<'_>, sketch: &Sketch) -> Vec<f64> {
        let first = Shooting {
            part: FIRST_PART.0,
            ..*all
        };
        let theta = sketch.theta.clone();
        let near = thresholds::AT_FLOOR * thresholds::AT_FLOOR * first.part * self.train.numbers();
        if sketch.is_there && sketch.left < near {
            return theta;
        }
        let follow = self.follow(&first, &sketch.ranges, FIRST_PART.1);
        let steps = if sketch.is_there { 0 } else { FURTHER_STEPS };
        let mut begun = approach(&first, &[theta], &follow, steps);
        approach_by_secants(&first, &mut begun, &follow);
        begun.estimate.theta
    }

    /// The windows followed anew at an estimate: those that are better for it begin there.
    fn refreshed(
        &self,
        shooting: &Shooting<'_>,
        mut prior: StartPrior,
        found: Estimate,
    ) -> (StartPrior, Estimate) {
        // Initial states that are read from the record are not followed.
        let Some(ranges) = shooting.ranges else {
            return (prior, found);
        };
        let Ok((anew, starts)) = self.starts(shooting, &found.theta, ranges, &OTHER_HORIZONS, None)
        else {
            return (prior, found);
        };
        let new = gauss_newton::evaluated(shooting, &anew, found.theta.clone(), starts);
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
        let carried = initial_states::carried(shooting, &found.theta, &starts);
        for (mean, carried) in prior.mean.iter_mut().zip(carried) {
            if let Some(carried) = carried {
                *mean = carried;
            }
        }
        let found = gauss_newton::evaluated(shooting, &prior, found.theta, starts);
        (prior, found)
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
                let window = reduced(linear, prior, place, &found.starts[place]);
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
}
