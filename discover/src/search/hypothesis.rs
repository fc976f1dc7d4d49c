//! Candidates to be fitted together: their unknowns, the specification with them, and how a fit
//! begins.

use crate::fit::preliminary::Sketch;
use crate::model::unknowns::Unknown;
use crate::search::acceptance::Own;
use crate::search::fitted::{Round, Trial};

/// Candidates to be fitted together, and a parameter whose term they replace.
#[derive(Clone)]
pub(crate) struct Set {
    /// The candidates' places among the screened.
    pub responses: Vec<usize>,
    /// The place of the parameter.
    pub deleted: Option<usize>,
    /// The candidates' promised sizes, in order.
    pub sizes: Vec<f64>,
}

impl Round<'_> {
    /// The unknowns of a set's effects in a fit with them.
    pub(crate) fn own(&self, set: &Set) -> Vec<Own> {
        let mut next = self.task.fit.unknowns.len();
        let mut own = Vec::new();
        for (effect, response) in set.responses.iter().enumerate() {
            let response = &self.screen.responses[*response];
            if let Some(place) = response.released
                && let Some((mean, sd)) = self.task.fit.unknowns[place].prior
            {
                own.push(Own {
                    place,
                    effect,
                    base: mean,
                    is_shape: false,
                    prior: Some(sd),
                });
            }
            for trial in &response.trials {
                own.push(Own {
                    place: next,
                    effect,
                    base: trial.base,
                    is_shape: trial.is_shape,
                    prior: None,
                });
                next += 1;
            }
        }
        own
    }

    /// A sketch with a set's candidates.
    pub(crate) fn sketch(&self, set: &Set) -> Result<Sketch, String> {
        let (setting, fit) = (self.task.setting, self.task.fit);
        let (unknowns, theta) = self.unknowns(set, self.parts[0]);
        let texts = self.texts(set, &unknowns, &theta)?;
        // What swings in coordinates of its own is far from the fit however little it does.
        let adds_states = set.responses.iter().any(|response| {
            let parameters = &self.candidate(*response).parameters;
            parameters.iter().any(|parameter| parameter.inverse)
        });
        if self.is_whole && set.deleted.is_none() && !adds_states {
            let left = self.screen.left(&set.responses).0;
            return setting.expected(texts, unknowns, theta, (fit, left));
        }
        let others = self.parts[1..]
            .iter()
            .map(|part| self.unknowns(set, *part).1);
        let begins: Vec<Vec<f64>> = std::iter::once(theta).chain(others).collect();
        let mut sketch = setting.sketch(texts, unknowns, &begins)?;
        if self.is_whole {
            // Beside others that are promised and not begun.
            sketch.left = self.screen.left(&set.responses).0;
        }
        Ok(sketch)
    }

    /// A sketch with a set's candidates, shapes so many times their usual sizes.
    pub(crate) fn shaped_as(&self, set: &Set, times: f64) -> Result<Sketch, String> {
        let (unknowns, mut theta) = self.unknowns(set, 1.0);
        for own in self.own(set).iter().filter(|own| own.is_shape) {
            theta[own.place] = unknowns[own.place].admissible(times * theta[own.place]);
        }
        let texts = self.texts(set, &unknowns, &theta)?;
        self.task.setting.sketch(texts, unknowns, &[theta])
    }

    /// The specification's texts with a set's candidates, at these values of the unknowns.
    fn texts(
        &self,
        set: &Set,
        unknowns: &[Unknown],
        theta: &[f64],
    ) -> Result<(String, String), String> {
        let fit = self.task.fit;
        let mut texts = (fit.text.clone(), fit.linear.clone());
        let mut next = fit.unknowns.len();
        for response in &set.responses {
            let response = &self.screen.responses[*response];
            if response.released.is_some() {
                continue;
            }
            let own = next..next + response.trials.len();
            next = own.end;
            let values: Vec<f64> = own
                .map(|place| unknowns[place].what.stated(theta[place]))
                .collect();
            let candidate = &self.candidates[response.candidate];
            texts = self
                .task
                .setting
                .with((&texts.0, &texts.1), candidate, &values)?;
        }
        Ok(texts)
    }

    /// A set of one candidate, begun with the motions of a trial of another. `left`: what that
    /// promises to leave; `shaped`: how many times its usual size a shape is.
    pub(crate) fn begun_at(
        &self,
        set: &Set,
        (trial, left): (&Trial, f64),
        shaped: f64,
    ) -> Result<Sketch, String> {
        let (unknowns, mut theta) = self.unknowns(set, 1.0);
        let count = self.task.fit.unknowns.len();
        theta[..count].copy_from_slice(&trial.fit.train.estimate.theta[..count]);
        for own in self.own(set).iter().filter(|own| own.is_shape) {
            theta[own.place] = unknowns[own.place].admissible(shaped * theta[own.place]);
        }
        let texts = self.texts(set, &unknowns, &theta)?;
        self.task
            .setting
            .expected(texts, unknowns, theta, (&trial.fit, left))
    }

    /// The unknowns with a set's candidates and their values, so much of the promised sizes from
    /// absent.
    fn unknowns(&self, set: &Set, part: f64) -> (Vec<Unknown>, Vec<f64>) {
        let fit = self.task.fit;
        let mut unknowns = fit.unknowns.clone();
        let mut theta = fit.anew();
        if let Some(place) = set.deleted {
            unknowns[place].bounds = (0.0, 0.0);
            theta[place] = 0.0;
        }
        let mut sizes = set.sizes.iter().map(|size| part * size);
        for response in &set.responses {
            let response = &self.screen.responses[*response];
            if let Some(place) = response.released {
                let size = sizes.next().unwrap_or(0.0);
                unknowns[place] = unknowns[place].released();
                theta[place] = unknowns[place].admissible(fit.train.estimate.theta[place] + size);
                continue;
            }
            for trial in &response.trials {
                let size = match trial.is_shape {
                    true => trial.unknown.start - trial.base,
                    false => sizes.next().unwrap_or(0.0),
                };
                let size = if size == 0.0 {
                    part * trial.unknown.scale
                } else {
                    size
                };
                theta.push(trial.unknown.admissible(trial.base + size));
                let mut unknown = trial.unknown.clone();
                unknown.scale = size.abs().max(1e-3 * unknown.scale);
                unknowns.push(unknown);
            }
        }
        (unknowns, theta)
    }
}
