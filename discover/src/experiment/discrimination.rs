//! Search for the experiment that separates the members of a class best. It maximises the smallest
//! separation over those pairs that some experiment separates.

use rayon::prelude::*;

use crate::experiment::bounds::Bounds;
use crate::experiment::prediction::{Exclusion, Prediction, Predictor};
use crate::experiment::proposal::Proposal;
use crate::experiment::separation::{Rival, Separation};
use crate::model::problem::EstimationProblem;
use crate::thresholds;

/// Fitted models of the members of a class, which the records do not separate.
pub struct Members<'f> {
    /// Problem of all fits.
    pub problem: &'f EstimationProblem<'f>,
    /// Fit of each member.
    pub rivals: Vec<Rival<'f>>,
}

/// Experiment with its separations.
#[derive(Clone, Debug)]
pub struct Discrimination {
    /// Index of the proposal.
    pub proposal: usize,
    /// Separation of each pair of members.
    pub pairs: Vec<PairSeparation>,
    /// Predicted sensor outputs of each member, one column per channel.
    pub predictions: Vec<Vec<Vec<f64>>>,
}

/// Separations of two members.
#[derive(Clone, Debug)]
pub struct PairSeparation {
    /// Indices of the members.
    pub members: [usize; 2],
    /// Residual of the second member after a fit to the prediction of the first, and vice versa.
    pub separations: [Separation; 2],
}

impl PairSeparation {
    /// Returns the smaller separation, in standard deviations of the noise. The smaller one counts,
    /// because the correct member is unknown.
    pub fn smaller_separation(&self) -> f64 {
        let [one, other] = &self.separations;
        one.rms_in_noise.min(other.rms_in_noise)
    }
}

/// Reason why no experiment is proposed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NoExperiment {
    /// The model has no driven input with a range.
    NoInput,
    /// All tested inputs violate limits. Contains their number and the quantity whose limit most of
    /// them violate.
    LeavesLimits(usize, String),
    /// The simulation fails for all tested inputs. Contains their number.
    SimulationFailed(usize),
}

impl Members<'_> {
    /// Returns the experiment of a family that separates the members best. Pairs that no experiment
    /// separates are ignored.
    ///
    /// # Errors
    ///
    /// The reason why no experiment is proposed.
    pub fn find_best_experiment(
        &self,
        bounds: &Bounds,
        times: &[f64],
        family: &[Proposal],
    ) -> Result<Discrimination, NoExperiment> {
        let predicted: Vec<Result<Vec<f64>, Exclusion>> = (family.par_iter())
            .map(|proposal| self.predict_distances(bounds, times, proposal))
            .collect();
        let count = self.list_pairs().len();
        let mut most = vec![0.0_f64; count];
        for predicted in predicted.iter().flatten() {
            for (most, own) in most.iter_mut().zip(predicted) {
                *most = most.max(*own);
            }
        }
        let mut counted: Vec<usize> = (0..count)
            .filter(|pair| most[*pair] >= thresholds::MIN_SEPARATION_IN_NOISE)
            .collect();
        if counted.is_empty() {
            counted = (0..count).collect();
        }
        let least = |of: &dyn Fn(usize) -> f64| {
            let of_pairs = counted.iter().map(|pair| of(*pair));
            of_pairs.fold(f64::INFINITY, f64::min)
        };
        let mut ranking: Vec<(f64, usize)> = (predicted.iter().enumerate())
            .filter_map(|(index, predicted)| {
                let predicted = predicted.as_ref().ok()?;
                Some((least(&|pair| predicted[pair]), index))
            })
            .collect();
        ranking.sort_by(|a, b| b.0.total_cmp(&a.0));
        ranking.truncate(thresholds::MAX_REFITTED_EXPERIMENTS);
        let refitted = ranking.iter().filter_map(|(_, index)| {
            self.compute_separations(bounds, times, (*index, &family[*index]))
        });
        let best = refitted.max_by(|a, b| {
            let least = |of: &Discrimination| least(&|pair| of.pairs[pair].smaller_separation());
            least(a).total_cmp(&least(b))
        });
        best.ok_or_else(|| describe_exclusions(&predicted))
    }

    /// Returns all pairs of members.
    fn list_pairs(&self) -> Vec<[usize; 2]> {
        let count = self.rivals.len();
        let pairs = (0..count).flat_map(|a| (a + 1..count).map(move |b| [a, b]));
        pairs.collect()
    }

    /// Predicts an experiment with each member.
    fn predict_members(
        &self,
        bounds: &Bounds,
        times: &[f64],
        proposal: &Proposal,
    ) -> Result<Vec<Prediction>, Exclusion> {
        let predicted = |rival: &Rival<'_>| {
            let predictor = Predictor::from_fit(self.problem, rival.fit);
            let mut predictor = predictor.ok_or(Exclusion::SimulationFailed)?;
            predictor.predict(bounds, times, proposal)
        };
        self.rivals.iter().map(predicted).collect()
    }

    /// Returns the linearised separation of the members of each pair.
    fn predict_distances(
        &self,
        bounds: &Bounds,
        times: &[f64],
        proposal: &Proposal,
    ) -> Result<Vec<f64>, Exclusion> {
        let predictions = self.predict_members(bounds, times, proposal)?;
        let leaves = |truth: usize, rival: usize| {
            let model = &self.rivals[truth].fit.model;
            let prediction = &predictions[truth];
            self.rivals[rival].predict_linear_rms(self.problem, model, prediction)
        };
        let of = |[a, b]: [usize; 2]| Some(leaves(a, b)?.min(leaves(b, a)?));
        let pairs = self.list_pairs().into_iter();
        pairs
            .map(|pair| of(pair).ok_or(Exclusion::SimulationFailed))
            .collect()
    }

    /// Computes the separation of each pair with fitted rivals; `None` if a motion cannot be
    /// simulated.
    fn compute_separations(
        &self,
        bounds: &Bounds,
        times: &[f64],
        (index, proposal): (usize, &Proposal),
    ) -> Option<Discrimination> {
        let predictions = self.predict_members(bounds, times, proposal).ok()?;
        let separation = |truth: usize, rival: usize| {
            let model = &self.rivals[truth].fit.model;
            self.rivals[rival].compute_separation(self.problem, model, &predictions[truth])
        };
        let of = |[a, b]: [usize; 2]| {
            Some(PairSeparation {
                members: [a, b],
                separations: [separation(a, b)?, separation(b, a)?],
            })
        };
        let pairs: Option<Vec<PairSeparation>> = self.list_pairs().into_iter().map(of).collect();
        let seen = |of: &Prediction| of.records[0].channels.clone();
        Some(Discrimination {
            proposal: index,
            pairs: pairs?,
            predictions: predictions.iter().map(seen).collect(),
        })
    }
}

/// Summarises why all experiments are excluded, with the most frequent cause.
fn describe_exclusions<T>(predicted: &[Result<T, Exclusion>]) -> NoExperiment {
    let mut left: Vec<(&str, usize)> = Vec::new();
    for of in predicted {
        let Err(Exclusion::LeavesLimits(name)) = of else {
            continue;
        };
        match left.iter_mut().find(|(known, _)| known == name) {
            Some((_, count)) => *count += 1,
            None => left.push((name, 1)),
        }
    }
    match left.iter().max_by_key(|(_, count)| *count) {
        Some((name, _)) => NoExperiment::LeavesLimits(predicted.len(), (*name).to_owned()),
        None => NoExperiment::SimulationFailed(predicted.len()),
    }
}
