//! What candidates do to the windows' outputs, to first order: by neighbouring motions that
//! they drive, where the fitted model is marched and the candidate adds no state; otherwise by
//! motions of the candidate's own model.

use nalgebra::DMatrix;

use crate::catalogue::candidate::{Candidate, CandidateParameter};
use crate::fit::full::Fit;
use crate::fit::gauss_newton;
use crate::fit::sensitivity::Crew;
use crate::fit::shooting::Shooting;
use crate::fit::variable_projection::Eliminator;
use crate::model::plant::Plant;
use crate::model::problem::Setting;
use crate::model::unknowns::{Unknown, What};
use crate::search::perturbed_response::tried;
use crate::search::variational_response::driven;
use crate::thresholds;

/// Windows that are looked at, at most; they are spread evenly.
const MOST_WINDOWS: usize = 40;

/// Windows that are enough to compare a few equations.
const FEW_WINDOWS: usize = 20;

/// A candidate's parameter is tried at the size that moves the outputs by this part of the
/// misfit.
pub(crate) const TRIAL: f64 = 0.3;

/// A candidate's parameter with its bounds and the size tried, SI.
#[derive(Clone, Debug)]
pub struct Trial {
    /// The unknown.
    pub unknown: Unknown,
    /// Its value where the effect is absent, SI.
    pub base: f64,
    /// Whether it shapes the effect without scaling it; its value is then kept.
    pub is_shape: bool,
}

/// A candidate's parameters, and for each window a column per parameter that scales it.
pub type Columns = (Vec<Trial>, Vec<DMatrix<f64>>);

/// A window at the fit: residual, derivatives by state and by unknowns.
pub type Base = Vec<Option<Eliminator>>;

/// Where candidates are looked at: beginnings of windows, over which a motion is nearly linear
/// in whatever changes it, with initial states that suit these parts.
pub struct At {
    /// The part of each window that is looked at.
    pub part: f64,
    /// The windows.
    pub places: Vec<usize>,
    /// The estimate there.
    pub estimate: gauss_newton::Estimate,
    /// Residuals and derivatives.
    pub base: Base,
    /// The size of the residuals, in noises.
    pub level: f64,
}

impl At {
    /// The beginnings of the windows at a fit, so much of each.
    pub fn of(setting: &Setting<'_>, fit: &Fit, part: f64) -> Self {
        let (prior, estimate) = setting.beginnings(fit, part);
        let whole = setting.shooting(&fit.plant, &setting.train, &fit.unknowns, &fit.ranges);
        let shooting = Shooting { part, ..whole };
        let all = setting.train.list.len();
        let count = all.min(MOST_WINDOWS);
        let places: Vec<usize> = (0..count).map(|k| k * all / count).collect();
        let level = gauss_newton::level(&shooting, &estimate) / part.sqrt();
        let mut crew = Crew::new(&shooting, &estimate.theta, level);
        let base = places
            .iter()
            .map(|place| {
                let start = &estimate.starts[*place];
                let linear = crew.as_mut()?.linear(*place, start)?;
                Some(Eliminator::new(&linear, &prior, *place, start))
            })
            .collect();
        Self {
            part,
            places,
            estimate,
            base,
            level,
        }
    }
}

impl At {
    /// Every other window where there are many.
    pub fn thinned(&self) -> Self {
        let every = self.places.len().div_ceil(FEW_WINDOWS).max(1);
        let places = self.places.iter().step_by(every).copied();
        Self {
            part: self.part,
            places: places.collect(),
            estimate: self.estimate.clone(),
            base: self.base.iter().step_by(every).cloned().collect(),
            level: self.level,
        }
    }
}

/// The responses of all candidates.
pub fn responses(
    at: &At,
    setting: &Setting<'_>,
    fit: &Fit,
    candidates: &[Candidate],
) -> Vec<Result<Columns, String>> {
    let mut found = driven(at, setting, fit, candidates);
    let rest: Vec<usize> = (0..candidates.len())
        .filter(|place| found[*place].is_none())
        .collect();
    let others: Vec<Candidate> = rest
        .iter()
        .map(|place| candidates[*place].clone())
        .collect();
    let tried = tried(at, setting, fit, &others);
    for (place, response) in rest.into_iter().zip(tried) {
        found[place] = Some(response);
    }
    found.into_iter().flatten().collect()
}

/// What is said of a candidate that does nothing.
pub(crate) fn silent() -> String {
    "nothing in the record would show it: it does not change the outputs".to_owned()
}

/// The value of a parameter where its effect is absent, or nearly.
pub(crate) fn absent(parameter: &CandidateParameter) -> f64 {
    match (parameter.inverse, parameter.shape) {
        (_, Some(shape)) => shape,
        (true, None) => 1e12,
        (false, None) => parameter.base(),
    }
}

/// A candidate's parameter as an unknown.
pub(crate) fn trial(parameter: &CandidateParameter) -> Trial {
    let low = match (parameter.inverse, parameter.positive) {
        (true, _) => 1e-12,
        (false, true) => 0.0,
        (false, false) => f64::NEG_INFINITY,
    };
    let name = parameter.name.clone();
    let base = parameter.base();
    let bounds = match (parameter.shape, &parameter.shifts) {
        (Some(shape), _) => (
            thresholds::SHAPE_RANGE.0 * shape,
            thresholds::SHAPE_RANGE.1 * shape,
        ),
        (None, Some(shifts)) => shifts.bounds,
        (None, None) => (low, f64::INFINITY),
    };
    let unknown = Unknown {
        label: format!("`{name}`"),
        what: if parameter.inverse {
            What::Inverse(name)
        } else {
            What::Parameter(name)
        },
        start: parameter.shape.unwrap_or(base.max(low)),
        prior: None,
        bounds,
        limits: bounds,
        scale: match (parameter.shape, parameter.inverse) {
            (Some(shape), _) => shape,
            (None, true) => 1e-4,
            (None, false) if base == 0.0 => 1.0,
            (None, false) => base.abs(),
        },
    };
    Trial {
        unknown,
        base,
        is_shape: parameter.shape.is_some(),
    }
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
