//! The next experiment: for what the records do not tell apart an input within bounds that does,
//! simulated with the fitted models.
//!
//! The files, in the order in which they read each other: [`waveform`] (forms of an input), [`bounds`]
//! (within which it stays), [`proposal`] (inputs within these), [`prediction`] (what a fitted model
//! does then), [`separation`] (what another leaves of that, once it is fitted to it as well),
//! [`discrimination`] (the input that separates best), `members` (fits of a class), `played` (the
//! file), [`next`] (the result).

pub mod bounds;
pub mod discrimination;
mod members;
pub mod next;
mod played;
pub mod prediction;
pub mod proposal;
pub mod separation;
pub mod waveform;

use crate::experiment::bounds::Bounds;
use crate::experiment::discrimination::{Discrimination, Members, PairSeparation};
use crate::experiment::members::equivalent_fits;
use crate::experiment::next::{ExperimentFile, Experiments, MemberAt, NextExperiment, Pair};
use crate::experiment::proposal::Proposal;
use crate::experiment::separation::{Rival, Separation};
use crate::fit::fitted::Fit;
use crate::ids::EffectId;
use crate::search::context::Context;
use crate::search::found::Found;
use crate::thresholds;

/// The next experiments for what was found. `context`: that of the search.
pub fn experiments(context: Context<'_>, found: &Found) -> Experiments {
    let problem = context.problem;
    let inputs = found.null.model.specification().inputs.iter();
    let inputs: Vec<String> = inputs.map(|input| input.name.clone()).collect();
    let bounds = Bounds::of(problem, &inputs);
    let times = bounds.times();
    let family = Proposal::family(&bounds, &times);
    let plan = Plan {
        context,
        inputs,
        bounds,
        times,
        family,
    };
    let mut experiments = Experiments::default();
    for effect in EffectId::first(found.accepted.len()) {
        let next = match found.accepted[effect].equivalent.is_empty() {
            true => None,
            false => Some(plan.of_class(found, effect, &mut experiments.files)),
        };
        experiments.of_effects.push(next);
    }
    experiments
}

/// What may be played.
struct Plan<'r> {
    context: Context<'r>,
    /// The model's inputs.
    inputs: Vec<String>,
    bounds: Bounds,
    times: Vec<f64>,
    family: Vec<Proposal>,
}

impl Plan<'_> {
    /// What separates the members of an accepted effect's class.
    fn of_class(
        &self,
        found: &Found,
        effect: EffectId,
        files: &mut Vec<ExperimentFile>,
    ) -> NextExperiment {
        let accepted = &found.accepted[effect];
        (self.context.progress)(&format!(
            "seeking an experiment that tells {} from {} more",
            accepted.candidate.label(),
            accepted.equivalent.len()
        ));
        let equivalent = equivalent_fits(self.context, found, effect);
        let mut members = vec![(MemberAt::of(&accepted.candidate), found.best())];
        let mut left_out = Vec::new();
        for (candidate, fit) in &equivalent {
            match fit {
                Some(fit) => members.push((MemberAt::of(candidate), fit)),
                None => left_out.push(MemberAt::of(candidate)),
            }
        }
        if members.len() < 2 {
            return NextExperiment::none(
                "none of the others could be fitted beside what was found later",
                &self.bounds,
            );
        }
        let (at, fits): (Vec<MemberAt>, Vec<&Fit>) = members.into_iter().unzip();
        let problem = self.context.problem;
        let rivals = fits.into_iter().map(|fit| Rival::of(problem, fit));
        let members = Members {
            problem,
            rivals: rivals.collect(),
        };
        match members.best(&self.bounds, &self.times, &self.family) {
            Ok(best) => self.told(&at, left_out, best, files),
            Err(reason) => NextExperiment::none(&reason.to_string(), &self.bounds),
        }
    }

    /// An experiment of a class as a result; a file if it separates some.
    fn told(
        &self,
        at: &[MemberAt],
        left_out: Vec<MemberAt>,
        best: Discrimination,
        files: &mut Vec<ExperimentFile>,
    ) -> NextExperiment {
        let proposal = &self.family[best.proposal];
        let channels = &self.context.problem.dataset.channels;
        let separates = |pair: &&PairSeparation| pair.least() >= thresholds::SEPARATES;
        let is_enough = best.pairs.iter().any(|pair| separates(&pair));
        let counted = best
            .pairs
            .iter()
            .filter(|pair| !is_enough || separates(pair));
        let least = counted.min_by(|a, b| a.least().total_cmp(&b.least()));
        let file = least.filter(|_| is_enough).map(|least| {
            let text = played::text(
                (&self.bounds, &self.times),
                proposal,
                &self.inputs,
                &self.context.problem.dataset.played,
            );
            let file = ExperimentFile {
                name: ExperimentFile::numbered(files.len()),
                text,
                input: proposal.name.clone(),
                times: self.times.clone(),
                values: proposal.values.clone(),
                members: least.members.map(|member| at[member].clone()),
                predicted: [
                    best.predicted[least.members[0]].clone(),
                    least.separations[0].seen.clone(),
                ],
            };
            files.push(file);
            files.len() - 1
        });
        let pair = |pair: &PairSeparation| {
            let [a, b] = pair.members.map(|member| at[member].clone());
            let [of_b, of_a] = &pair.separations;
            let told = |truth: &MemberAt, rival: &MemberAt, of: &Separation| Pair {
                truth: truth.clone(),
                rival: rival.clone(),
                separation: of.size,
                channel: channels[of.channel].name.clone(),
            };
            [told(&a, &b, of_b), told(&b, &a, of_a)]
        };
        NextExperiment {
            file,
            input: Some(proposal.name.clone()),
            form: Some(proposal.form.clone()),
            separation: least.map(PairSeparation::least),
            pairs: best.pairs.iter().flat_map(pair).collect(),
            left_out,
            reason: None,
            bounds: self.bounds.words.clone(),
        }
    }
}
