//! Proposal of the next experiment: an admissible input that separates the members of a class,
//! simulated with the fitted models.
//!
//! The files in the order of their dependence: [`waveform`] (forms of an input), [`bounds`],
//! [`proposal`] (admissible inputs), [`prediction`] (response of a fitted model), [`separation`]
//! (residual of another model after a fit to this response), [`discrimination`] (input that
//! separates best), [`detection`] (input that shows an undetectable effect best), `experiment_csv`
//! (the CSV file), [`next_experiment`] (the result).

pub mod bounds;
pub mod detection;
pub mod discrimination;
mod experiment_csv;
pub mod next_experiment;
pub mod prediction;
pub mod proposal;
pub mod separation;
pub mod waveform;

use eomgen_model_spec::unit::Unit;
use rayon::prelude::*;

use crate::catalogue::candidate::Candidate;
use crate::error::DiscoverError;
use crate::experiment::bounds::Bounds;
use crate::experiment::detection::{Detection, HiddenEffect, PredictedExperiment};
use crate::experiment::discrimination::{Discrimination, Members, NoExperiment, PairSeparation};
use crate::experiment::next_experiment::{
    ClassMember, DetectableSize, ExperimentFile, Experiments, MemberPair, NextExperiment,
};
use crate::experiment::prediction::{Prediction, Predictor};
use crate::experiment::proposal::Proposal;
use crate::experiment::separation::{Rival, Separation};
use crate::fit::fit_result::Fit;
use crate::ids::EffectId;
use crate::model::unknowns::UnknownKind;
use crate::search::context::RoundContext;
use crate::search::member_fits::MemberFit;
use crate::search::search_result::SearchResult;
use crate::thresholds;

/// Proposes the next experiments for the result of a search. `context`: context of the search;
/// `classes`: members of the class of each accepted effect.
pub fn propose_experiments(
    context: RoundContext<'_>,
    found: &SearchResult,
    classes: &[Vec<MemberFit>],
) -> Experiments {
    let problem = context.problem;
    let model = found.null_fit.model.specification();
    let inputs = &model.inputs;
    let units = inputs.iter();
    let units = units.map(|input| Unit::coherent(input.unit.dimension).text);
    let units: Vec<String> = units.collect();
    let inputs: Vec<String> = inputs.iter().map(|input| input.name.clone()).collect();
    let bounds = Bounds::from_dataset(problem, &inputs, &found.null_fit.model.sensors);
    let times = bounds.sample_times();
    let impossible = match problem.dataset.gives_motion() {
        true => Some("no experiment is computed for a given motion".to_owned()),
        false if model.prescribed_inputs().next().is_some() => {
            Some("no experiment is computed for a prescribed motion".to_owned())
        }
        false => bounds.explain_too_short(problem.dataset.window),
    };
    let family = match impossible {
        Some(_) => Vec::new(),
        None => Proposal::list_all(&bounds, &times),
    };
    let plan = ExperimentSearch {
        impossible,
        context,
        inputs,
        units,
        bounds,
        times,
        family,
    };
    let mut experiments = Experiments::default();
    for (effect, class) in EffectId::first(found.accepted.len()).zip(classes) {
        let next = match class.is_empty() {
            true => None,
            false => Some(plan.propose_for_class(found, (effect, class), &mut experiments.files)),
        };
        experiments.for_effects.push(next);
    }
    plan.propose_for_untestable(found, &mut experiments);
    experiments
}

/// Search for admissible experiments and their results.
struct ExperimentSearch<'r> {
    context: RoundContext<'r>,
    /// Names of the inputs of the model.
    inputs: Vec<String>,
    /// SI unit of each input.
    units: Vec<String>,
    bounds: Bounds,
    /// Reason why no experiment within the bounds is possible, if known.
    impossible: Option<String>,
    times: Vec<f64>,
    family: Vec<Proposal>,
}

impl ExperimentSearch<'_> {
    /// Returns a result with the reason if no experiment is possible.
    fn explain_no_experiment(&self) -> Option<NextExperiment> {
        let reason = match (&self.impossible, self.family.is_empty()) {
            (Some(reason), _) => reason.clone(),
            (None, true) => NoExperiment::NoInput.to_string(),
            (None, false) => return None,
        };
        Some(NextExperiment::without_experiment(&reason, &self.bounds))
    }

    /// Proposes an experiment that separates the members of an accepted effect's class.
    fn propose_for_class(
        &self,
        found: &SearchResult,
        (effect, class): (EffectId, &[MemberFit]),
        files: &mut Vec<ExperimentFile>,
    ) -> NextExperiment {
        let accepted = &found.accepted[effect];
        if let Some(none) = self.explain_no_experiment() {
            return none;
        }
        (self.context.progress)(&format!(
            "searching for an experiment that separates {} from {} others",
            accepted.candidate.label(),
            class.len()
        ));
        let mut members = vec![(
            ClassMember::from_candidate(&accepted.candidate),
            found.best_fit(),
        )];
        let mut left_out = Vec::new();
        for MemberFit { candidate, fitted } in class {
            match fitted {
                Some((fit, _)) => members.push((ClassMember::from_candidate(candidate), fit)),
                None => left_out.push(ClassMember::from_candidate(candidate)),
            }
        }
        if members.len() < 2 {
            return NextExperiment::without_experiment(
                "no other effect of the set could be fitted together with the later effects",
                &self.bounds,
            );
        }
        let (at, fits): (Vec<ClassMember>, Vec<&Fit>) = members.into_iter().unzip();
        let problem = self.context.problem;
        let rivals = fits
            .into_iter()
            .map(|fit| Rival::with_records(problem, fit));
        let members = Members {
            problem,
            rivals: rivals.collect(),
        };
        match members.find_best_experiment(&self.bounds, &self.times, &self.family) {
            Ok(best) => self.report_separations(&at, left_out, best, files),
            Err(reason) => NextExperiment::without_experiment(&reason.to_string(), &self.bounds),
        }
    }

    /// Returns the experiment of a class as a result. If the experiment separates a pair, its file
    /// is written.
    fn report_separations(
        &self,
        at: &[ClassMember],
        left_out: Vec<ClassMember>,
        best: Discrimination,
        files: &mut Vec<ExperimentFile>,
    ) -> NextExperiment {
        let proposal = &self.family[best.proposal];
        let channels = &self.context.problem.dataset.channels;
        let separates = |pair: &&PairSeparation| {
            pair.smaller_separation() >= thresholds::MIN_SEPARATION_IN_NOISE
        };
        let is_enough = best.pairs.iter().any(|pair| separates(&pair));
        let counted = best
            .pairs
            .iter()
            .filter(|pair| !is_enough || separates(pair));
        let least =
            counted.min_by(|a, b| a.smaller_separation().total_cmp(&b.smaller_separation()));
        let file = least.filter(|_| is_enough).map(|least| {
            self.write_experiment(
                proposal,
                least.members.map(|member| at[member].label()),
                [
                    best.predictions[least.members[0]].clone(),
                    least.separations[0].sensor_outputs.clone(),
                ],
                files,
            )
        });
        let pair = |pair: &PairSeparation| {
            let [a, b] = pair.members.map(|member| at[member].clone());
            let [of_b, of_a] = &pair.separations;
            let create_pair =
                |truth: &ClassMember, rival: &ClassMember, of: &Separation| MemberPair {
                    truth: truth.clone(),
                    rival: rival.clone(),
                    separation: of.rms_in_noise,
                    channel: channels[of.channel].name.clone(),
                };
            [create_pair(&a, &b, of_b), create_pair(&b, &a, of_a)]
        };
        NextExperiment {
            file,
            input: Some(proposal.name.clone()),
            waveform: Some(proposal.description.clone()),
            separation: least.map(PairSeparation::smaller_separation),
            pairs: best.pairs.iter().flat_map(pair).collect(),
            failed_members: left_out,
            detectable: None,
            reason: None,
            bounds_source: self.bounds.sources.clone(),
        }
    }

    /// Returns the index of the file of an experiment. A file with the same text is reused.
    fn write_experiment(
        &self,
        proposal: &Proposal,
        members: [String; 2],
        predicted: [Vec<Vec<f64>>; 2],
        files: &mut Vec<ExperimentFile>,
    ) -> usize {
        let text = experiment_csv::write_experiment_csv(
            (&self.bounds, &self.times),
            proposal,
            &self.inputs,
            &self.context.problem.dataset.experiment_units,
        );
        if let Some(known) = files.iter().position(|file| file.text == text) {
            return known;
        }
        files.push(ExperimentFile {
            name: ExperimentFile::numbered_name(files.len()),
            text,
            input: proposal.name.clone(),
            unit: self.units[proposal.input_index].clone(),
            times: self.times.clone(),
            values: proposal.values.clone(),
            members,
            predictions: predicted,
        });
        files.len() - 1
    }

    /// Proposes experiments that detect the effects that the records cannot show, one for each
    /// effect and site.
    fn propose_for_untestable(&self, found: &SearchResult, experiments: &mut Experiments) {
        let problem = self.context.problem;
        experiments.for_rejected = vec![None; found.rejected.len()];
        let mut wanted: Vec<usize> = Vec::new();
        for (index, rejected) in found.rejected.iter().enumerate() {
            let is_known = |other: &usize| {
                found.rejected[*other]
                    .candidate
                    .is_same_effect_as(&rejected.candidate)
            };
            if rejected.is_untestable && !wanted.iter().any(is_known) {
                wanted.push(index);
            }
        }
        wanted.truncate(thresholds::MAX_DETECTION_SEARCHES);
        if let Some(none) = self.explain_no_experiment() {
            for index in &wanted {
                experiments.for_rejected[*index] = Some(none.clone());
            }
            return;
        }
        if wanted.is_empty() {
            return;
        }
        (self.context.progress)(&format!(
            "searching for experiments that show {} effects that the records cannot show",
            wanted.len()
        ));
        let without = Rival::with_priors(found.best_fit());
        let family = self.predict_largest(found.best_fit());
        let sought = wanted.par_iter().map(|index| {
            let candidate = &found.rejected[*index].candidate;
            let hidden = HiddenEffect::with_candidate(problem, &without, candidate)?;
            let best = hidden.find_best_experiment((&self.bounds, &self.times), &family);
            Ok((hidden, best))
        });
        let sought: Vec<Result<(HiddenEffect<'_>, Option<Detection>), DiscoverError>> =
            sought.collect();
        for (index, sought) in wanted.into_iter().zip(sought) {
            let candidate = &found.rejected[index].candidate;
            let next = match sought {
                Ok((hidden, best)) => {
                    self.find_detecting(&hidden, candidate, best, &mut experiments.files)
                }
                Err(error) => NextExperiment::without_experiment(&error.to_string(), &self.bounds),
            };
            experiments.for_rejected[index] = Some(next);
        }
    }

    /// Returns for each waveform and input the experiment with the largest amplitude that stays
    /// within the limits.
    fn predict_largest(&self, fit: &Fit) -> Vec<PredictedExperiment<'_>> {
        let numbered: Vec<(usize, &Proposal)> = self.family.iter().enumerate().collect();
        let is_same = |one: &(usize, &Proposal), other: &(usize, &Proposal)| {
            one.1.input_index == other.1.input_index && one.1.waveform == other.1.waveform
        };
        let forms: Vec<&[(usize, &Proposal)]> = numbered.chunk_by(is_same).collect();
        let largest = |sizes: &&[(usize, &'_ Proposal)]| {
            let mut predictor = Predictor::from_fit(self.context.problem, fit)?;
            let mut sizes = sizes.iter();
            sizes.find_map(|(index, proposal)| {
                let without = predictor.predict(&self.bounds, &self.times, proposal);
                Some((*index, without.ok()?))
            })
        };
        let found: Vec<Option<(usize, Prediction)>> = forms.par_iter().map(largest).collect();
        let admitted = found.into_iter().flatten();
        admitted
            .map(|(index, without)| PredictedExperiment {
                index,
                proposal: &self.family[index],
                prediction: without,
            })
            .collect()
    }

    /// Returns the experiment that detects an effect best.
    fn find_detecting(
        &self,
        hidden: &HiddenEffect<'_>,
        candidate: &Candidate,
        best: Option<Detection>,
        files: &mut Vec<ExperimentFile>,
    ) -> NextExperiment {
        let Some(best) = best else {
            let reason = "no tested input within the bounds shows it";
            return NextExperiment::without_experiment(reason, &self.bounds);
        };
        let proposal = &self.family[best.proposal];
        let is_enough = best.separation.rms_in_noise >= thresholds::MIN_LINEAR_SEPARATION;
        let file = is_enough.then(|| {
            let label = ClassMember::from_candidate(candidate).label();
            self.write_experiment(
                proposal,
                [format!("with {label}"), "without it".to_owned()],
                [
                    best.predictions.clone(),
                    best.separation.sensor_outputs.clone(),
                ],
                files,
            )
        });
        NextExperiment {
            file,
            input: Some(proposal.name.clone()),
            waveform: Some(proposal.description.clone()),
            separation: Some(best.separation.rms_in_noise),
            pairs: Vec::new(),
            failed_members: Vec::new(),
            detectable: is_enough
                .then(|| self.find_detectable_size(candidate, hidden.value_at_size(best.size)))
                .flatten(),
            reason: None,
            bounds_source: self.bounds.sources.clone(),
        }
    }

    /// Returns the smallest detectable value of the quantity that scales an effect, in its unit.
    fn find_detectable_size(&self, candidate: &Candidate, value: f64) -> Option<DetectableSize> {
        let shown = |what: &str, from: f64, unit: &str| {
            Some(DetectableSize {
                parameter: what.to_owned(),
                smallest: from,
                unit: unit.to_owned(),
            })
        };
        let channels = &self.context.problem.dataset.channels;
        match &candidate.dropped_prior {
            None => {
                let scaling = candidate
                    .parameters
                    .iter()
                    .find(|of| of.shape_size.is_none())?;
                shown(&scaling.name, scaling.units_per_si() * value, &scaling.unit)
            }
            Some(UnknownKind::Gain(_)) => shown("gain", value, "1"),
            Some(UnknownKind::Bias(channel)) => shown("bias", value, &channels[*channel].unit),
            Some(UnknownKind::Delay(_) | UnknownKind::InputDelay) => shown("delay", value, "s"),
            Some(UnknownKind::Parameter(name) | UnknownKind::InverseParameter(name)) => {
                let model = self.context.fit.model.specification();
                let parameter = model.parameters.iter().find(|of| of.name == *name)?;
                let unit = &parameter.unit;
                shown(name, unit.from_si(value), &unit.text)
            }
        }
    }
}
