//! Search for the experiment that shows an undetectable effect best. For each experiment, the model
//! without the effect is fitted to the predicted record with the effect. The detectable size is the
//! smallest size with the required separation; the best experiment has the smallest detectable
//! size.

use rayon::prelude::*;

use crate::catalogue::candidate::Candidate;
use crate::catalogue::candidate_unknown::CandidateUnknown;
use crate::error::DiscoverError;
use crate::experiment::bounds::Bounds;
use crate::experiment::prediction::{Prediction, Predictor};
use crate::experiment::proposal::Proposal;
use crate::experiment::separation::{Rival, Separation};
use crate::fit::shooting::Shooting;
use crate::ids::UnknownId;
use crate::interval::Interval;
use crate::model::estimation_model::EstimationModel;
use crate::model::problem::EstimationProblem;
use crate::model::unknowns::Unknown;
use crate::thresholds;

/// Maximum number of trials for a size with a small but measurable change of the outputs.
const MAX_SIZE_TRIALS: usize = 8;

/// Maximum number of corrections of the detectable size, range of the factor of each correction,
/// and factors at which the corrections end.
const MAX_CORRECTIONS: usize = 4;
const CORRECTION_RANGE: Interval = Interval::new(0.2, 5.0);
const FINAL_CORRECTIONS: Interval = Interval::new(0.9, 1.1);

/// Experiment with its prediction by a fitted model.
pub struct PredictedExperiment<'p> {
    /// Index of the proposal.
    pub index: usize,
    /// Proposed input.
    pub proposal: &'p Proposal,
    /// Prediction without the effect.
    pub prediction: Prediction,
}

/// Effect that the records cannot show at any size.
pub struct HiddenEffect<'f> {
    problem: &'f EstimationProblem<'f>,
    /// Fitted model without the effect.
    without: &'f Rival<'f>,
    representation: EffectRepresentation,
    /// Unknown that scales the effect.
    unknown: Unknown,
    /// Value of the unknown without the effect, SI.
    base: f64,
}

/// Representation of an effect in the model.
enum EffectRepresentation {
    /// Separate terms in the equations.
    Model {
        model: Box<EstimationModel>,
        /// Parameter values without the effect, SI.
        values: Vec<f64>,
    },
    /// Unknown of the model without the effect.
    Unknown(UnknownId),
}

/// Experiment that shows an effect.
#[derive(Clone, Debug)]
pub struct Detection {
    /// Index of the proposal.
    pub proposal: usize,
    /// Smallest detectable size, SI; the trial size if no experiment shows the effect.
    pub size: f64,
    /// Residual of the model without the effect at this size.
    pub separation: Separation,
    /// Predicted sensor outputs with the effect, one column per channel.
    pub predictions: Vec<Vec<f64>>,
}

/// Prediction of an experiment with a small size of the effect.
struct SmallEffectTrial<'t> {
    index: usize,
    proposal: &'t Proposal,
    size: f64,
    /// RMS change of the outputs, in standard deviations.
    moved: f64,
    present: Prediction,
    /// RMS residual of the model without the effect before a fit, per unit of size.
    most: f64,
}

impl<'f> HiddenEffect<'f> {
    /// Adds a candidate to a fit.
    ///
    /// # Errors
    ///
    /// Errors of the specification with the candidate.
    pub fn with_candidate(
        problem: &'f EstimationProblem<'f>,
        without: &'f Rival<'f>,
        candidate: &Candidate,
    ) -> Result<Self, DiscoverError> {
        let fit = without.fit;
        let theta = &fit.train.estimate.theta;
        if let Some(what) = &candidate.dropped_prior {
            let mut unknowns = fit.unknowns();
            let (id, unknown) = { &mut unknowns }
                .find(|(_, unknown)| unknown.kind == *what)
                .ok_or(DiscoverError::NotExcited)?;
            return Ok(Self {
                problem,
                without,
                representation: EffectRepresentation::Unknown(id),
                unknown: unknown.clone(),
                base: theta[id],
            });
        }
        let unknowns = candidate
            .parameters
            .iter()
            .map(CandidateUnknown::from_parameter);
        let unknowns: Vec<CandidateUnknown> = unknowns.collect();
        let scaling = unknowns.iter().find(|of| !of.is_shape);
        let scaling = scaling.ok_or(DiscoverError::NotExcited)?;
        // The effect is derived with a nonzero size; its actual size is set later.
        let present = unknowns.iter().map(|of| {
            let value = match of.is_shape {
                true => of.unknown.start,
                false => of.unknown.clamp(of.base + of.unknown.scale),
            };
            of.unknown.kind.value_in_specification(value)
        });
        let texts = candidate.add_to_texts(problem, &fit.texts, &present.collect::<Vec<f64>>())?;
        let model = problem.compile_model(&texts.full, Some(&texts.linear))?;
        let shooting = Shooting::new(problem, &model, &problem.train, &fit.unknowns, &[]);
        let mut values = shooting.parameter_values(theta);
        for (parameter, of) in candidate.parameters.iter().zip(&unknowns) {
            if !of.is_shape {
                let absent = parameter.neutral_value();
                model.set_value(&mut values, &parameter.name, absent);
            }
        }
        Ok(Self {
            problem,
            without,
            representation: EffectRepresentation::Model {
                model: Box::new(model),
                values,
            },
            unknown: scaling.unknown.clone(),
            base: scaling.base,
        })
    }

    /// Returns the scaling parameter for a given size, in the form used in the specification, SI.
    pub fn value_at_size(&self, size: f64) -> f64 {
        let value = self.unknown.clamp(self.base + size);
        self.unknown.kind.value_in_specification(value)
    }

    /// Returns the model with the effect.
    fn model(&self) -> &EstimationModel {
        match &self.representation {
            EffectRepresentation::Model { model, .. } => model,
            EffectRepresentation::Unknown(_) => &self.without.fit.model,
        }
    }

    /// Predicts an experiment with the effect at a given size; `None` if the size is out of bounds.
    fn predict_with_effect(
        &self,
        (bounds, times): (&Bounds, &[f64]),
        proposal: &Proposal,
        size: f64,
    ) -> Option<Prediction> {
        let fit = self.without.fit;
        let mut theta = fit.train.estimate.theta.clone();
        let values = match &self.representation {
            EffectRepresentation::Model { model, values } => {
                let mut values = values.clone();
                if let Some(name) = self.unknown.kind.parameter_name() {
                    model.set_value(&mut values, name, self.value_at_size(size));
                }
                values
            }
            EffectRepresentation::Unknown(id) => {
                theta[*id] = self.base + size;
                fit.training_shooting(self.problem).parameter_values(&theta)
            }
        };
        let predictor = Predictor::with_model(self.problem, (fit, &theta), self.model(), &values);
        predictor?.predict(bounds, times, proposal).ok()
    }

    /// Predicts an experiment with a small size of the effect. `start`: first trial size.
    fn try_small_size<'t>(
        &self,
        within: (&Bounds, &[f64]),
        played: &'t PredictedExperiment<'_>,
        start: f64,
    ) -> Option<SmallEffectTrial<'t>> {
        let (size, moved, present) = self.find_small_size(within, played, start)?;
        let most = self
            .without
            .predict_unfitted_rms(self.problem, self.model(), &present)?;
        Some(SmallEffectTrial {
            index: played.index,
            proposal: played.proposal,
            size,
            moved,
            present,
            most: most / size.abs(),
        })
    }

    /// Finds a size with a small but measurable change of the outputs of an experiment. Returns the
    /// size, the RMS change and the prediction.
    fn find_small_size(
        &self,
        within: (&Bounds, &[f64]),
        played: &PredictedExperiment<'_>,
        start: f64,
    ) -> Option<(f64, f64, Prediction)> {
        let mut size = start;
        for _ in 0..MAX_SIZE_TRIALS {
            let Some(present) = self.predict_with_effect(within, played.proposal, size) else {
                size *= 0.1;
                continue;
            };
            let moved = self.compute_rms_change(&played.prediction, &present);
            if thresholds::SMALL_EFFECT_FACTORS.clamp(moved) == moved {
                return Some((size, moved, present));
            }
            size *= (thresholds::SMALL_EFFECT_IN_NOISE / moved).clamp(1e-3, 1e3);
        }
        None
    }

    /// Returns the RMS difference of two predictions, in standard deviations of the noise.
    fn compute_rms_change(&self, one: &Prediction, other: &Prediction) -> f64 {
        let columns = one.records[0]
            .channels
            .iter()
            .zip(&other.records[0].channels);
        let columns = columns.zip(&self.problem.noise);
        let (mut sum, mut count) = (0.0, 0.0);
        for ((one, other), noise) in columns {
            let squares = one.iter().zip(other);
            sum += squares.map(|(a, b)| ((a - b) / noise).powi(2)).sum::<f64>();
            count += one.len() as f64;
        }
        (sum / count).sqrt()
    }

    /// Returns the experiment with the largest residual after a linear fit, per unit of size, and
    /// this RMS residual. All experiments have a small size. Derivatives are expensive and
    /// therefore computed only for experiments that may be the best.
    fn select_most_visible<'t>(
        &self,
        mut tried: Vec<SmallEffectTrial<'t>>,
    ) -> Option<(SmallEffectTrial<'t>, f64)> {
        tried.sort_by(|a, b| b.most.total_cmp(&a.most));
        let mut best: Option<(SmallEffectTrial<'t>, f64)> = None;
        for of in tried {
            let known = best.as_ref().map(|(best, left)| left / best.size.abs());
            if known.is_some_and(|known| of.most <= known) {
                break;
            }
            let left = (self.without).predict_linear_rms(self.problem, self.model(), &of.present);
            if let Some(left) = left
                && known.is_none_or(|known| left / of.size.abs() > known)
            {
                best = Some((of, left));
            }
        }
        best
    }

    /// Returns the experiment with the smallest detectable size; `None` if no experiment is
    /// admissible or has an effect.
    pub fn find_best_experiment(
        &self,
        within: (&Bounds, &[f64]),
        family: &[PredictedExperiment<'_>],
    ) -> Option<Detection> {
        // The small size of one experiment is a good first trial size for the others.
        let usual = 1e-3 * self.unknown.scale;
        let (mut first, mut others) = (None, family);
        while let (None, Some((played, rest))) = (&first, others.split_first()) {
            (first, others) = (self.try_small_size(within, played, usual), rest);
        }
        let start = first.as_ref().map_or(usual, |first| first.size);
        let others = others.par_iter();
        let others = others.filter_map(|played| self.try_small_size(within, played, start));
        let others: Vec<SmallEffectTrial<'_>> = others.collect();
        let (tried, left) = self.select_most_visible(first.into_iter().chain(others).collect())?;
        let SmallEffectTrial {
            index,
            proposal,
            size,
            moved,
            ..
        } = tried;
        let is_own = left * left > thresholds::MIN_UNEXPLAINED_FRACTION * moved * moved;
        let mut size = match is_own {
            true => size * thresholds::MIN_SEPARATION_IN_NOISE / left,
            false => size,
        };
        let refitted = |size: f64| {
            let prediction = self.predict_with_effect(within, proposal, size)?;
            let separation =
                self.without
                    .compute_separation(self.problem, self.model(), &prediction)?;
            Some((prediction, separation))
        };
        let (mut prediction, mut separation) = refitted(size)?;
        for _ in 0..MAX_CORRECTIONS {
            let factor = thresholds::MIN_SEPARATION_IN_NOISE / separation.rms_in_noise;
            if !is_own || FINAL_CORRECTIONS.clamp(factor) == factor {
                break;
            }
            let Some(found) = refitted(size * CORRECTION_RANGE.clamp(factor)) else {
                break;
            };
            size *= CORRECTION_RANGE.clamp(factor);
            (prediction, separation) = found;
        }
        Some(Detection {
            proposal: index,
            size,
            separation,
            predictions: prediction.records[0].channels.clone(),
        })
    }
}
