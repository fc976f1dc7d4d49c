//! Fits before they are made in earnest: to the beginnings of windows, or as a straight line promises
//! them.

use crate::fit::continuation::approach;
use crate::fit::full::Fit;
use crate::fit::gauss_newton::{self, StartPrior};
use crate::fit::initial_states;
use crate::fit::shooting::Shooting;
use crate::model::plant::Plant;
use crate::model::problem::{FIRST_PART, HORIZONS, Setting};
use crate::model::unknowns::Unknown;
use crate::search::response::mapped;

/// The most steps while unknowns are far away.
pub(crate) const STEPS: usize = 5;

/// Steps of a sketch where initial states are read from the record.
const SKETCHING_STEPS: usize = 3;

/// A specification fitted to the beginnings of the windows.
pub struct Sketch {
    /// The sum of squares that is left there, in noises, with what priors add.
    pub left: f64,
    /// What is known of the initial states of whole windows, where they begin there already.
    pub(crate) whole: Option<StartPrior>,
    /// Whether further steps over beginnings of windows would help little.
    pub(crate) is_there: bool,
    pub(crate) text: String,
    pub(crate) linear: String,
    pub(crate) plant: Plant,
    pub(crate) unknowns: Vec<Unknown>,
    pub(crate) ranges: Vec<f64>,
    pub(crate) theta: Vec<f64>,
    pub(crate) starts: Vec<Vec<f64>>,
}

impl Setting<'_> {
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
            let found = approach(&shooting, begins, &follow, STEPS);
            (found.estimate, found.is_there)
        } else {
            let theta = begins.first().map_or(&[][..], Vec::as_slice);
            let (prior, starts) = self.starts(&shooting, theta, &ranges, &HORIZONS, None)?;
            let found = gauss_newton::estimate(&shooting, &prior, theta, &starts, SKETCHING_STEPS);
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
                false => initial_states::spread(&ranges),
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
}
