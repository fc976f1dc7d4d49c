//! Comparison and search, from specification and records to the result.

use eomgen_records::dataset::Dataset;
use maud::Markup;

use crate::catalogue::effect::Effect;
use crate::catalogue::user_effects;
use crate::empirical::add_empirical_effect;
use crate::error::DiscoverError;
use crate::experiment::next_experiment::Experiments;
use crate::experiment::propose_experiments;
use crate::fit::contradiction::{describe_contradictions, format_estimate};
use crate::fit::fit_result::Fit;
use crate::fit::noise_floor::{NoiseFloor, compute_noise_floor};
use crate::fit::null_model::fit_null_model;
use crate::ids::UnknownId;
use crate::model::channel_checks;
use crate::model::constraint_checks::check_constraints;
use crate::model::input_faults::add_declared_faults;
use crate::model::problem::EstimationProblem;
use crate::model::stop::StopRequest;
use crate::model::unknowns::note_input_delay;
use crate::report::common_delay::note_common_delay;
use crate::report::common_lag::note_common_lag;
use crate::report::declared_noise::note_declared_noise;
use crate::report::discovery::{
    Certainty, compute_closure, compute_gap, describe_deviations, list_nuisances, list_refitted,
    list_rejected, list_sensors, list_steps, summarise_effects,
};
use crate::report::experiment::draw_experiments;
use crate::report::held_input::note_held_input;
use crate::report::high_floor::note_high_floor;
use crate::report::initial_states::describe_contradicted_initial_states;
use crate::report::location::describe_location;
use crate::report::motion_noise::note_motion_noise;
use crate::report::origin::{Origin, Specification};
use crate::report::overlay::draw_overlays;
use crate::report::pictures::{draw_force_section, draw_residuals};
use crate::report::playback::Playback;
use crate::report::remaining_gap::{ModelStage, RemainingGap};
use crate::report::resimulation::resimulate;
use crate::report::result::{
    CommonResult, Comparison, Discovery, Nuisance, ResultFigures, Verdict,
};
use crate::report::units::note_wrong_units;
use crate::report::write_back::write_extended;
use crate::residual_force::estimate_residual_force;
use crate::residual_force::types::ResidualForce;
use crate::residual_force::wording::describe_remaining_force;
use crate::search::context::RoundContext;
use crate::search::member_fits::fit_members;
use crate::search::search;
use crate::search::unconfirmed_hypothesis::UnconfirmedHypothesis;
use crate::threads::prepare_threads;
use crate::thresholds;

/// Receiver of progress lines.
pub type Progress<'p> = dyn Fn(&str) + Sync + 'p;

/// Fit of the null model, its noise floor and residual force.
struct NullResult {
    fit: Fit,
    floor: NoiseFloor,
    force: Option<ResidualForce>,
    /// Notes on the constraints.
    notes: Vec<String>,
}

/// Compares a specification with records. `seed`: seed of the noise of the replica.
///
/// # Errors
///
/// Wrong columns of the records, or a model that cannot be simulated on them.
pub fn compare(
    specification: Specification<'_>,
    dataset: &Dataset,
    seed: u64,
    progress: &Progress<'_>,
) -> Result<Comparison, DiscoverError> {
    prepare_threads();
    let Specification { path, text, order } = specification;
    let text = &add_declared_faults(text, path, &dataset.inputs)?;
    let problem = EstimationProblem::new(dataset, order, path, text);
    let NullResult {
        fit,
        floor,
        force,
        notes: of_constraints,
    } = fit_null(&problem, text, seed, progress)?;
    let pictures = ResultFigures {
        playback: Playback::NotNeeded,
        overlay: draw_overlays(&problem, &fit, None),
        residuals: draw_residuals(&problem, &fit, None),
        experiments: Markup::default(),
        force: force.as_ref().map(|force| draw_force_section(force, None)),
    };
    let nuisances = list_nuisances(&problem, &fit);
    let mut notes = [
        dataset.notes.clone(),
        of_constraints,
        describe_deviations(&nuisances),
    ]
    .concat();
    notes.extend(note_input_delay(&dataset.inputs, fit.model.specification()));
    notes.extend(note_common_delay(&problem, &fit));
    notes.extend(note_held_input(&problem, &fit));
    notes.extend(note_motion_noise(&problem, &fit));
    notes.extend(note_declared_noise(&problem, &fit));
    for note in note_high_floor(&problem, &floor) {
        progress(&format!("note: {note}"));
        notes.push(note);
    }
    notes.extend(find_contradictions(&problem, &fit, floor.rms, progress));
    Ok(Comparison {
        has_gap: !fit.is_at_floor(floor.rms),
        compared: CommonResult {
            title: choose_title(dataset, &fit),
            gap: compute_gap(&problem, &fit, None, &floor),
            refitted: list_refitted(&fit, &[]),
            sensors: list_sensors(&problem, &fit),
            noise_floor: floor.rms,
            location: describe_location(&problem, &fit, &floor, force.as_ref()),
            notes,
            nuisances,
            origin: Origin::record_inputs(specification, dataset, seed),
            pictures,
        },
    })
}

/// Searches for effects that explain the difference between a specification and records. If no
/// effect of the catalogue explains it, an empirical expression is tried.
///
/// # Errors
///
/// Wrong columns of the records, a model that cannot be simulated on them, or an effect that makes
/// the specification invalid.
pub fn discover(
    specification: Specification<'_>,
    dataset: Dataset,
    catalogue: &[Effect],
    seed: u64,
    progress: &Progress<'_>,
) -> Result<Discovery, DiscoverError> {
    let stop = StopRequest::default();
    discover_until(specification, dataset, catalogue, seed, progress, &stop)
}

/// Searches like [`discover`], but ends if a stop is requested.
///
/// # Errors
///
/// Errors of [`discover`]; [`DiscoverError::Stopped`].
pub fn discover_until(
    specification: Specification<'_>,
    mut dataset: Dataset,
    catalogue: &[Effect],
    seed: u64,
    progress: &Progress<'_>,
    stop: &StopRequest,
) -> Result<Discovery, DiscoverError> {
    prepare_threads();
    let Specification { path, text, order } = specification;
    let without_site = user_effects::check_user_effects(catalogue, path, text)?;
    for note in &without_site {
        progress(&format!("note: {note}"));
    }
    dataset.notes.extend(without_site);
    let original = text;
    let text = &add_declared_faults(text, path, &dataset.inputs)?;
    let mut problem = EstimationProblem::new(&dataset, order, path, text);
    problem.stop = stop.clone();
    let null = fit_null(&problem, text, seed, progress);
    // Simulations also fail after a stop request. In this case no other error is reported.
    stop.check_not_stopped()?;
    let NullResult {
        fit,
        floor: before,
        force,
        notes: of_constraints,
    } = null?;
    stop.start_timer();
    let found = search(&problem, fit, catalogue, before.rms, progress);
    stop.check_not_stopped()?;
    let mut found = found?;
    if found.unfinished.is_none() {
        add_empirical_effect(&problem, &mut found, before.rms, progress);
    }
    stop.check_not_stopped()?;
    let floor = match found.accepted.is_empty() {
        true => before,
        false => compute_noise_floor(&problem, found.best_fit(), seed),
    };
    let (null, best) = (&found.null_fit, found.best_fit());
    let after = force.as_ref().zip(found.extended_fit.as_ref());
    let after = after.and_then(|(force, last)| {
        estimate_residual_force(&problem, last, Some(force.profiled_equation_name()))
    });
    let mut location = describe_location(&problem, null, &floor, force.as_ref());
    if let Some(after) = &after {
        location += &format!(" {}", describe_remaining_force(after));
    }
    stop.check_not_stopped()?;
    let extended = write_extended(&problem, text, best, &found.accepted, floor.rms)?;
    let context = RoundContext {
        problem: &problem,
        fit: null,
        floor: floor.rms,
        effects: catalogue,
        progress,
    };
    // Experiments take as long as some fits; both are skipped after the time limit.
    let (classes, experiments) = match &found.unfinished {
        None => {
            let classes = fit_members(context, &found);
            let experiments = propose_experiments(context, &found, &classes);
            (classes, experiments)
        }
        Some(_) => (
            found.accepted.iter().map(|_| Vec::new()).collect(),
            Experiments::empty(found.accepted.len(), found.rejected.len()),
        ),
    };
    stop.check_not_stopped()?;
    let pictures = ResultFigures {
        playback: Playback::build(&problem, (null, best), &found.accepted, &extended),
        overlay: draw_overlays(&problem, null, found.extended_fit.as_ref()),
        residuals: draw_residuals(&problem, null, found.extended_fit.as_ref()),
        experiments: draw_experiments(&problem, &experiments.files),
        force: force
            .as_ref()
            .map(|force| draw_force_section(force, after.as_ref())),
    };
    let gap = compute_gap(&problem, null, Some(best), &floor);
    let nuisances = list_nuisances(&problem, best);
    let mut notes = [
        problem.dataset.notes.clone(),
        of_constraints,
        describe_deviations(&nuisances),
    ]
    .concat();
    notes.extend(note_input_delay(
        &problem.dataset.inputs,
        null.model.specification(),
    ));
    let late = note_common_delay(&problem, best);
    for note in (late.into_iter())
        .chain(note_common_lag(best, &found.accepted))
        .chain(note_held_input(&problem, best))
        .chain(RemainingGap::from_channels(&gap, ModelStage::Extended).note_missing_in_training())
        .chain(note_motion_noise(&problem, best))
        .chain(note_declared_noise(&problem, best))
        .chain(note_high_floor(&problem, &floor))
        .chain(note_wrong_units(&problem, &found))
    {
        progress(&format!("note: {note}"));
        notes.push(note);
    }
    if let Some(unfinished) = &found.unfinished {
        let most = stop.time_limit().map_or(0.0, |most| most.as_secs_f64());
        let note = format!("the search reached its time limit of {most} s: {unfinished}");
        progress(&format!("note: {note}"));
        notes.push(note);
    }
    // Single fits take as long as the joint fit and are skipped after the time limit.
    if found.unfinished.is_none() {
        // Without accepted effects, an unconfirmed hypothesis is part of the model for this check.
        let unconfirmed = found.unconfirmed.as_ref();
        let unconfirmed = unconfirmed.filter(|_| found.extended_fit.is_none());
        if let Some(of) = unconfirmed {
            let note = note_of_unconfirmed(of, null, floor.rms);
            progress(&format!("note: {note}"));
            notes.push(note);
        }
        let fit = unconfirmed.map_or(best, |of| &of.fit);
        notes.extend(find_contradictions(&problem, fit, floor.rms, progress));
    }
    stop.check_not_stopped()?;
    let unknowns = found.accepted.iter().map(|effect| effect.unknowns.len());
    let may_imitate = !best.is_at_floor(floor.rms)
        && unknowns.sum::<usize>() > thresholds::MAX_UNKNOWNS_ABOVE_FLOOR;
    let is_sure = !RemainingGap::from_channels(&gap, ModelStage::Extended).is_large()
        && !may_imitate
        && !nuisances.iter().any(Nuisance::is_at_bound);
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
        effects: summarise_effects(&problem, &found, (&classes, &experiments), certainty),
        rejected: list_rejected(&problem.tested_hypotheses, &found, &experiments, false),
        untestable: list_rejected(&problem.tested_hypotheses, &found, &experiments, true),
        experiments: experiments.files,
        closure: compute_closure(null, best, &floor),
        steps: list_steps(&found),
        resimulation: resimulate(&problem, best, &extended)?,
        validation: None,
        curve: found.curve.clone(),
        unfinished: found.unfinished.clone(),
        original: original.to_owned(),
        extended,
        compared: CommonResult {
            title: choose_title(problem.dataset, best),
            gap,
            refitted: list_refitted(best, &found.accepted),
            sensors: list_sensors(&problem, best),
            noise_floor: floor.rms,
            location,
            notes,
            nuisances,
            origin: Origin::record_inputs(specification, problem.dataset, seed),
            pictures,
        },
    })
}

/// Returns the title of a dataset, or the name of the model if the dataset has no title.
fn choose_title(dataset: &Dataset, fit: &Fit) -> String {
    match dataset.title.as_str() {
        "" => fit.model.specification().title.clone(),
        title => title.to_owned(),
    }
}

/// Describes a hypothesis that training records support but held-out records do not. The following
/// notes refer to the model with this hypothesis.
fn note_of_unconfirmed(of: &UnconfirmedHypothesis, null: &Fit, floor: f64) -> String {
    let UnconfirmedHypothesis {
        label,
        effect_unknowns: own,
        fit,
    } = of;
    let sizes: Vec<String> = own
        .iter()
        .map(|id| format_unknown(fit, *id, floor))
        .collect();
    format!(
        "with {label} ({}) the training residual is {:.1} noise floors instead of {:.1}; the test \
         records do not confirm it: {:.1} instead of {:.1}. They may lack another effect, or be from another \
         machine",
        sizes.join(", "),
        fit.train.rms / floor,
        null.train.rms / floor,
        fit.test.rms / floor,
        null.test.rms / floor
    )
}

/// Formats an unknown of a fit with its standard deviation, in the unit of its parameter.
fn format_unknown(fit: &Fit, id: UnknownId, floor: f64) -> String {
    let unknown = &fit.unknowns[id];
    let (estimate, sd) = (fit.train.estimate.theta[id], fit.sd_with_misfit(id, floor));
    let value = unknown.kind.value_in_specification(estimate);
    let name = unknown.kind.parameter_name().unwrap_or(&unknown.label);
    let mut parameters = fit.model.specification().parameters.iter();
    let parameter = parameters.find(|parameter| parameter.name == name);
    format!(
        "`{name}` = {}",
        format_estimate(parameter, (value, (sd * value / estimate).abs()))
    )
}

/// Finds records that contradict the declared initial state or each other. Reports each note as
/// progress.
fn find_contradictions(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    floor: f64,
    progress: &Progress<'_>,
) -> Vec<String> {
    let mut found = describe_contradicted_initial_states(problem, &fit.model);
    found.extend(describe_contradictions(problem, fit, floor, progress));
    for sentence in &found {
        progress(&format!("note: {sentence}"));
    }
    found
}

/// Fits the null model, and computes its noise floor and residual force.
fn fit_null(
    problem: &EstimationProblem<'_>,
    text: &str,
    seed: u64,
    progress: &Progress<'_>,
) -> Result<NullResult, DiscoverError> {
    for note in channel_checks::check_channels(problem, text)? {
        progress(&format!("note: {note}"));
    }
    let notes = check_constraints(problem, text)?;
    for note in &notes {
        progress(&format!("note: {note}"));
    }
    progress("fitting the original model");
    let fit = fit_null_model(problem, text)?;
    let floor = compute_noise_floor(problem, &fit, seed);
    let force = estimate_residual_force(problem, &fit, None);
    Ok(NullResult {
        fit,
        floor,
        force,
        notes,
    })
}
