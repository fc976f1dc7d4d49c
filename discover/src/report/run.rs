//! Comparison and search, from a specification and records to a result.

use eomgen_records::dataset::Dataset;
use maud::Markup;

use crate::catalogue::effect::Effect;
use crate::catalogue::user_effects;
use crate::empirical::unnamed;
use crate::error::DiscoverError;
use crate::experiment::experiments;
use crate::experiment::next::Experiments;
use crate::fit::contradiction::{contradictions, stated};
use crate::fit::fitted::Fit;
use crate::fit::noise_floor::{NoiseFloor, noise_floor};
use crate::fit::null_model::null_fit;
use crate::ids::UnknownId;
use crate::model::channel_checks;
use crate::model::input_faults::with_declared;
use crate::model::problem::EstimationProblem;
use crate::model::stop::Stop;
use crate::model::unknowns::note_of_input_delay;
use crate::report::discovery::{
    Certainty, bound_notes, closure, effects, gap, nuisances, refitted, rejected, sensors, steps,
};
use crate::report::experiment::drawn;
use crate::report::late_channels::note_of_late_channels;
use crate::report::left::{Left, Stage};
use crate::report::location::located;
use crate::report::motion_noise::notes_of_motion_noise;
use crate::report::origin::{Origin, Specification};
use crate::report::overlay::overlay;
use crate::report::pictures::{figures, force_section};
use crate::report::playback::Playback;
use crate::report::resimulation::resimulated;
use crate::report::result::{Compared, Comparison, Discovery, Nuisance, Pictures, Verdict};
use crate::report::units::notes_of_units;
use crate::report::write_back::extended;
use crate::residual_force::residual_force;
use crate::residual_force::types::ResidualForce;
use crate::residual_force::wording::described_after;
use crate::search::context::Context;
use crate::search::search;
use crate::search::unconfirmed::Unconfirmed;

/// Receiver of progress lines.
pub type Progress<'p> = dyn Fn(&str) + Sync + 'p;

/// A fit, the floor there, and the residual force.
struct Null {
    fit: Fit,
    floor: NoiseFloor,
    force: Option<ResidualForce>,
}

/// Compares a specification with records. `seed`: seed of the bootstrap of the noise floor.
///
/// # Errors
///
/// Wrong labels of the records, or a model that cannot be simulated on them.
pub fn compare(
    specification: Specification<'_>,
    dataset: &Dataset,
    seed: u64,
    progress: &Progress<'_>,
) -> Result<Comparison, DiscoverError> {
    let Specification { path, text, order } = specification;
    let text = &with_declared(text, path, &dataset.inputs)?;
    let problem = EstimationProblem::new(dataset, order, path, text);
    let Null { fit, floor, force } = null(&problem, text, seed, progress)?;
    let pictures = Pictures {
        playback: Playback::None,
        overlay: overlay(&problem, &fit, None),
        residuals: figures(&problem, &fit, None),
        experiments: Markup::default(),
        force: force.as_ref().map(|force| {
            let equation = force.profiled_equation().to_owned();
            (equation, force_section(force, None))
        }),
    };
    let nuisances = nuisances(&problem, &fit);
    let mut notes = [dataset.notes.clone(), bound_notes(&nuisances)].concat();
    notes.extend(note_of_input_delay(
        &dataset.inputs,
        fit.model.specification(),
    ));
    notes.extend(note_of_late_channels(&problem, &fit));
    notes.extend(notes_of_motion_noise(&problem, &fit));
    notes.extend(contradicting(&problem, &fit, floor.rms, progress));
    Ok(Comparison {
        has_gap: !fit.is_at_floor(floor.rms),
        compared: Compared {
            title: dataset.title.clone(),
            gap: gap(&problem, &fit, None, &floor),
            refitted: refitted(&fit, &[]),
            sensors: sensors(&problem, &fit),
            location: located(&problem, &fit, force.as_ref()),
            notes,
            nuisances,
            origin: Origin::of(specification, dataset, seed),
            pictures,
        },
    })
}

/// Searches for effects that explain the difference between a specification and records: effects of
/// the catalogue and, if none explains it, an unnamed expression.
///
/// # Errors
///
/// Wrong labels of the records, a model that cannot be simulated on them, or an effect that makes
/// the specification invalid.
pub fn discover(
    specification: Specification<'_>,
    dataset: Dataset,
    catalogue: &[Effect],
    seed: u64,
    progress: &Progress<'_>,
) -> Result<Discovery, DiscoverError> {
    let stop = Stop::default();
    discover_until(specification, dataset, catalogue, seed, progress, &stop)
}

/// Searches as [`discover`], until a stop is requested.
///
/// # Errors
///
/// As [`discover`]; [`DiscoverError::Stopped`].
pub fn discover_until(
    specification: Specification<'_>,
    mut dataset: Dataset,
    catalogue: &[Effect],
    seed: u64,
    progress: &Progress<'_>,
    stop: &Stop,
) -> Result<Discovery, DiscoverError> {
    let Specification { path, text, order } = specification;
    let without_site = user_effects::check(catalogue, path, text)?;
    for note in &without_site {
        progress(&format!("note: {note}"));
    }
    dataset.notes.extend(without_site);
    let original = text;
    let text = &with_declared(text, path, &dataset.inputs)?;
    let mut problem = EstimationProblem::new(&dataset, order, path, text);
    problem.stop = stop.clone();
    let null = null(&problem, text, seed, progress);
    // What failed because somebody asked to stop says nothing of the records.
    stop.check()?;
    let Null {
        fit,
        floor: before,
        force,
    } = null?;
    let mut location = located(&problem, &fit, force.as_ref());
    stop.arm();
    let found = search(&problem, fit, catalogue, before.rms, progress);
    stop.check()?;
    let mut found = found?;
    if found.unfinished.is_none() {
        unnamed(&problem, &mut found, before.rms, progress);
    }
    stop.check()?;
    let floor = match found.accepted.is_empty() {
        true => before,
        false => noise_floor(&problem, found.best(), seed),
    };
    let (null, best) = (&found.null, found.best());
    let after = force.as_ref().zip(found.last.as_ref());
    let after = after
        .and_then(|(force, last)| residual_force(&problem, last, Some(force.profiled_equation())));
    if let Some(after) = &after {
        location += &format!(" {}", described_after(after));
    }
    stop.check()?;
    let extended = extended(&problem, text, best, &found.accepted)?;
    let context = Context {
        problem: &problem,
        fit: null,
        floor: floor.rms,
        effects: catalogue,
        progress,
    };
    // An experiment takes as long as some fits: not after a limit.
    let experiments = match &found.unfinished {
        None => experiments(context, &found),
        Some(_) => Experiments::none(found.accepted.len(), found.rejected.len()),
    };
    stop.check()?;
    let pictures = Pictures {
        playback: Playback::of(&problem, (null, best), &found.accepted, &extended),
        overlay: overlay(&problem, null, found.last.as_ref()),
        residuals: figures(&problem, null, found.last.as_ref()),
        experiments: drawn(&problem, &experiments.files),
        force: force.as_ref().map(|force| {
            let equation = force.profiled_equation().to_owned();
            (equation, force_section(force, after.as_ref()))
        }),
    };
    let gap = gap(&problem, null, Some(best), &floor);
    let nuisances = nuisances(&problem, best);
    let mut notes = [problem.dataset.notes.clone(), bound_notes(&nuisances)].concat();
    notes.extend(note_of_input_delay(
        &problem.dataset.inputs,
        null.model.specification(),
    ));
    let late = note_of_late_channels(&problem, best);
    for note in (late.into_iter())
        .chain(Left::of(&gap, Stage::After).note())
        .chain(notes_of_motion_noise(&problem, best))
        .chain(notes_of_units(&problem, &found))
    {
        progress(&format!("note: {note}"));
        notes.push(note);
    }
    if let Some(unfinished) = &found.unfinished {
        let most = stop.most().map_or(0.0, |most| most.as_secs_f64());
        let note = format!("the search reached its time limit of {most} s: {unfinished}");
        progress(&format!("note: {note}"));
        notes.push(note);
    }
    // Each record alone takes as long as all together: not after a limit.
    if found.unfinished.is_none() {
        // What has no name explains the records instead.
        let unconfirmed = found.unconfirmed.as_ref();
        let unconfirmed = unconfirmed.filter(|_| found.last.is_none());
        if let Some(of) = unconfirmed {
            let note = note_of_unconfirmed(of, null, floor.rms);
            progress(&format!("note: {note}"));
            notes.push(note);
        }
        let fit = unconfirmed.map_or(best, |of| &of.fit);
        notes.extend(contradicting(&problem, fit, floor.rms, progress));
    }
    stop.check()?;
    let is_sure =
        !Left::of(&gap, Stage::After).is_much() && !nuisances.iter().any(Nuisance::is_at_bound);
    let certainty = Certainty {
        is_sure,
        floor: floor.rms,
    };
    Ok(Discovery {
        verdict: match (found.accepted.is_empty(), best.is_at_floor(floor.rms)) {
            (false, _) => Verdict::EffectsFound,
            (true, true) => Verdict::NoSignificantGap,
            (true, false) => Verdict::Unexplained,
        },
        effects: effects(&problem, &found, &experiments, certainty),
        rejected: rejected(&problem.judged, &found, &experiments, false),
        not_testable: rejected(&problem.judged, &found, &experiments, true),
        experiments: experiments.files,
        closure: closure(null, best, &floor),
        steps: steps(&found),
        resimulation: resimulated(&problem, best, &extended)?,
        validation: None,
        unfinished: found.unfinished.clone(),
        original: original.to_owned(),
        extended,
        compared: Compared {
            title: problem.dataset.title.clone(),
            gap,
            refitted: refitted(best, &found.accepted),
            sensors: sensors(&problem, best),
            location,
            notes,
            nuisances,
            origin: Origin::of(specification, problem.dataset, seed),
            pictures,
        },
    })
}

/// What training records speak for and held-out ones do not, in a sentence. What comes behind it holds
/// with that in the model.
fn note_of_unconfirmed(of: &Unconfirmed, null: &Fit, floor: f64) -> String {
    let Unconfirmed { label, own, fit } = of;
    let sizes: Vec<String> = own.iter().map(|id| size(fit, *id, floor)).collect();
    format!(
        "with {label} ({}) the training residual is {:.1} standard deviations instead of {:.1}; the test \
         records do not confirm it: {:.1} instead of {:.1}. They may lack another effect, or be from another \
         machine",
        sizes.join(", "),
        fit.train.rms,
        null.train.rms,
        fit.test.rms,
        null.test.rms
    )
}

/// An unknown of a fit with its standard deviation, in its parameter's unit.
fn size(fit: &Fit, id: UnknownId, floor: f64) -> String {
    let unknown = &fit.unknowns[id];
    let (estimate, sd) = (
        fit.train.estimate.theta[id],
        fit.sd_beside_misfit(id, floor),
    );
    let value = unknown.what.stated(estimate);
    let name = unknown.what.parameter().unwrap_or(&unknown.label);
    let mut parameters = fit.model.specification().parameters.iter();
    let parameter = parameters.find(|parameter| parameter.name == name);
    format!(
        "`{name}` = {}",
        stated(parameter, (value, (sd * value / estimate).abs()))
    )
}

/// Which records contradict each other. `progress` is told.
fn contradicting(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    floor: f64,
    progress: &Progress<'_>,
) -> Vec<String> {
    let found = contradictions(problem, fit, floor, progress);
    for sentence in &found {
        progress(&format!("note: {sentence}"));
    }
    found
}

/// The null model's fit, the floor and the residual force there.
fn null(
    problem: &EstimationProblem<'_>,
    text: &str,
    seed: u64,
    progress: &Progress<'_>,
) -> Result<Null, DiscoverError> {
    for note in channel_checks::check(problem, text)? {
        progress(&format!("note: {note}"));
    }
    progress("fitting the original model");
    let fit = null_fit(problem, text)?;
    let floor = noise_floor(problem, &fit, seed);
    let force = residual_force(problem, &fit, None);
    Ok(Null { fit, floor, force })
}
