//! Scan of laws with a shape or a memory along the reference motion of the records. The first-order
//! search does not find such laws.

use crate::catalogue::candidate::{Candidate, list_candidates};
use crate::catalogue::sites::find_sites;
use crate::fit::fit_result::Fit;
use crate::free_function::curves::{Curve, fit_curves};
use crate::free_function::law_scan::{ScannedLaw, scan_laws};
use crate::free_function::scene::Scene;
use crate::ids::ResponseId;
use crate::search::context::RoundContext;
use crate::search::excitation_window::ExcitationWindow;
use crate::search::hypothesis::Hypothesis;
use crate::search::hypothesis_fits::{run_full_fits, run_preliminary_fits};
use crate::search::motion_of_fit::compute_usual_motion;
use crate::search::pool::CandidatePool;
use crate::search::screening::screen_candidates;
use crate::search::search_result::RejectedCandidate;
use crate::search::tested_pool::TestedPool;
use crate::thresholds;

/// Result of a scan.
pub struct ScanResult {
    /// Free function that explains the residual best, if it is adequate.
    pub curve: Option<Curve>,
    /// The best laws with their fits; `None` if no law has a sufficiently small residual.
    pub tested: Option<TestedPool>,
    /// Laws without a fit.
    pub unfitted: Vec<RejectedCandidate>,
}

/// Scans free functions and laws along the reference motion of the records, and fits the best laws.
/// `answer`: fit with the accepted effects. `None` if the records cannot be followed.
pub fn scan_records(context: RoundContext<'_>, answer: &Fit) -> Option<ScanResult> {
    (context.progress)(
        "a residual above the noise floor remains: scanning laws along the recorded motion",
    );
    let scene = Scene::follow_records(context.problem, context.fit)?;
    let curve = find_adequate_curve(context, &scene);
    let scan = scan_laws(&scene, &list_laws(context));
    let Some(best) = scan.laws.first() else {
        return Some(ScanResult {
            curve,
            tested: None,
            unfitted: Vec::new(),
        });
    };
    (context.progress)(&format!(
        "scanned {} laws over decades; best: {}, with a residual of {:.2} instead of {:.2} standard deviations \
         in short segments",
        scan.laws.len(),
        best.candidate.label(),
        best.rms,
        scan.rms_without
    ));
    // A law must have a clearly smaller residual than the accepted effects, close most of the gap,
    // and have a residual similar to that of the free function.
    let by_answer = scene.evaluate_fit(answer).unwrap_or(scan.rms_without);
    let by_curve = curve
        .as_ref()
        .map_or(f64::INFINITY, |curve| curve.train_rms.max(curve.test_rms));
    let gap = (scan.rms_without - context.floor).max(0.0);
    let most = (thresholds::MAX_SCANNED_RIVAL_RATIO * by_curve.min(best.rms))
        .min((1.0 - thresholds::MIN_HELD_OUT_REDUCTION) * by_answer.min(scan.rms_without))
        .min(context.floor + thresholds::MAX_REMAINING_WITH_CURVE * gap);
    let mut laws = scan.laws;
    let count = laws.iter().take_while(|law| law.rms < most).count();
    let others = laws.split_off(count.min(thresholds::MAX_FULL_FITS_PER_ROUND));
    let mut unfitted: Vec<RejectedCandidate> = others
        .into_iter()
        .map(|law| {
            let reason = format!(
                "along the recorded motion, in short segments, its residual is {:.2} standard deviations; with the \
                 accepted effects it is {by_answer:.2}",
                law.rms
            );
            reject_unfitted(law.candidate, reason)
        })
        .collect();
    if laws.is_empty() {
        (context.progress)(&format!(
            "no law has a small residual that is clearly below the residual of the accepted effects, {by_answer:.2} \
             standard deviations"
        ));
        return Some(ScanResult {
            curve,
            tested: None,
            unfitted,
        });
    }
    let tested = fit_scanned_laws(context, laws);
    unfitted.extend(list_failed(context, &tested));
    Some(ScanResult {
        curve,
        tested: Some(tested),
        unfitted,
    })
}

/// Fits scanned laws, starting from their scanned shapes and sizes.
fn fit_scanned_laws(context: RoundContext<'_>, laws: Vec<ScannedLaw>) -> TestedPool {
    let candidates: Vec<Candidate> = laws.iter().map(|law| law.candidate.clone()).collect();
    let window = match context.starts_with_whole_windows() {
        true => ExcitationWindow::Whole,
        false => ExcitationWindow::Beginnings,
    };
    let screening = screen_candidates(
        context.problem,
        context.fit,
        &candidates,
        window.window_fraction(),
    );
    let is_whole = window == ExcitationWindow::Whole;
    let pool = CandidatePool {
        most_evaluations: Some(limit_evaluations(context)),
        ..CandidatePool::new(context, &candidates, &screening, is_whole)
    };
    let hypotheses = ResponseId::first(screening.responses.len()).map(|response| {
        let law = &laws[screening.responses[response].candidate.index()];
        Hypothesis {
            responses: vec![response],
            replaced_parameter: None,
            predicted_sizes: law.sizes.clone(),
        }
    });
    let preliminaries = run_preliminary_fits(&pool, hypotheses.collect());
    let fitted_hypotheses = run_full_fits(&pool, preliminaries);
    TestedPool {
        candidates,
        screening,
        fitted_hypotheses,
        preliminary_outcomes: Vec::new(),
    }
}

/// Returns the maximum number of evaluations of the rates in the fit of a law.
fn limit_evaluations(context: RoundContext<'_>) -> u64 {
    let records = context.problem.dataset.train.iter();
    let samples: usize = records.map(|record| record.times.len()).sum();
    thresholds::MAX_FIT_EVALUATIONS_PER_SAMPLE * samples as u64
}

/// Returns the scanned laws whose fit failed.
fn list_failed(context: RoundContext<'_>, tested: &TestedPool) -> Vec<RejectedCandidate> {
    let responses = ResponseId::first(tested.screening.responses.len());
    let failed = responses.filter(|response| {
        let mut fitted = tested.fitted_hypotheses.iter();
        !fitted.any(|fitted| fitted.responses.contains(response))
    });
    let most = limit_evaluations(context) as f64;
    let reject = |response: ResponseId| {
        let candidate = tested.screening.responses[response].candidate;
        let reason = format!("no fit succeeds within {most:.1e} evaluations of the rates");
        reject_unfitted(tested.candidates[candidate].clone(), reason)
    };
    failed.map(reject).collect()
}

fn reject_unfitted(candidate: Candidate, reason: String) -> RejectedCandidate {
    RejectedCandidate {
        candidate,
        reason,
        best_of_round: None,
        is_fitted: false,
        is_untestable: false,
        p_value: None,
    }
}

/// Returns the candidates at all sites.
fn list_laws(context: RoundContext<'_>) -> Vec<Candidate> {
    let model = context.fit.model.specification();
    let sites = find_sites(model);
    let motion = compute_usual_motion(context.problem, context.fit, &sites);
    let effects = context.effects.iter();
    let effects = effects.filter(|effect| !effect.scales_stiffness());
    list_candidates(model, effects, &sites, &motion)
}

/// Returns the free function with the smallest held-out residual, if it is adequate. It must
/// explain most of the gap, and the held-out residual must hardly exceed the training residual.
fn find_adequate_curve(context: RoundContext<'_>, scene: &Scene<'_>) -> Option<Curve> {
    let mut curves = fit_curves(scene);
    let least = curves.iter().map(|curve| curve.test_rms);
    let least = least.fold(f64::INFINITY, f64::min);
    // Curves with equal residuals remain: a force on the only coordinate and the input that drives
    // it are equivalent.
    curves.retain(|curve| curve.test_rms <= (1.0 + thresholds::MAX_CLASS_DIFFERENCE) * least);
    let own = curves.iter().position(|curve| curve.is_own_variable);
    let best = curves.into_iter().nth(own.unwrap_or(0))?;
    let (over, of) = (&best.variable, &best.equation);
    let (train, test) = (best.train_rms, best.test_rms);
    let alone = scene.segments.nuisance_fit.rms();
    (context.progress)(&format!(
        "best free function: {of} over {over}, which leaves {train:.2} (training) and {test:.2} (test) of \
         {alone:.2} standard deviations in short segments"
    ));
    let is_adequate = best.log_evidence > thresholds::MIN_INFORMATION_GAIN
        && test <= thresholds::MAX_HELD_OUT_RATIO * train.max(context.floor)
        && train.max(test) < thresholds::MAX_REMAINING_WITH_CURVE * alone;
    is_adequate.then_some(best)
}
