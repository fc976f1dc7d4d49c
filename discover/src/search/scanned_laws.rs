//! Hypotheses of laws with a shape, started from a scan along the reference motion.

use crate::catalogue::candidate::Candidate;
use crate::free_function::curves::{Curve, fit_curves};
use crate::free_function::law_scan::{ScannedLaw, scan_laws};
use crate::free_function::scene::Scene;
use crate::ids::ResponseId;
use crate::search::context::RoundContext;
use crate::search::hypothesis::Hypothesis;
use crate::search::hypothesis_fits::{run_full_fits, run_preliminary_fits};
use crate::search::pool::CandidatePool;
use crate::search::screening::screen_candidates;
use crate::search::tested_pool::TestedPool;
use crate::thresholds;

/// Scans the laws with a shape among candidates and fits the best ones from their scanned shapes and
/// sizes. `curve`: adequate free function, if there is one. `fraction`: fraction of each window over
/// which fits begin. `None` if no law promises a smaller residual.
pub fn fit_scanned_laws(
    context: RoundContext<'_>,
    (scene, curve): (&Scene<'_>, Option<&Curve>),
    candidates: &[Candidate],
    fraction: f64,
) -> Option<TestedPool> {
    let (problem, fit) = (context.problem, context.fit);
    let scan = scan_laws(scene, candidates);
    let laws: Vec<ScannedLaw> = scan.laws;
    let best = laws.first()?.rms;
    (context.progress)(&format!(
        "scanned {} laws over decades; best: {}, which leaves {best:.2} of {:.2} standard deviations in \
         short segments",
        laws.len(),
        laws[0].candidate.label(),
        scan.rms_without
    ));
    if best > (1.0 - thresholds::MIN_HELD_OUT_REDUCTION) * scan.rms_without {
        return None;
    }
    // A law that leaves much more than a free function is not what is missing.
    let least = curve.map_or(f64::INFINITY, |curve| curve.train_rms.max(curve.test_rms));
    let most = thresholds::MAX_SCANNED_RIVAL_RATIO * best.min(least);
    let chosen: Vec<ScannedLaw> = (laws.into_iter())
        .filter(|law| law.rms < most.min(scan.rms_without))
        .take(thresholds::MAX_FULL_FITS_PER_ROUND)
        .collect();
    if chosen.is_empty() {
        return None;
    }
    let candidates: Vec<Candidate> = chosen.iter().map(|law| law.candidate.clone()).collect();
    let screening = screen_candidates(problem, fit, &candidates, fraction);
    let pool = CandidatePool::new(context, &candidates, &screening, fraction == 1.0);
    let hypotheses = ResponseId::first(screening.responses.len()).map(|response| {
        let law = &chosen[screening.responses[response].candidate.index()];
        Hypothesis {
            responses: vec![response],
            replaced_parameter: None,
            predicted_sizes: law.sizes.clone(),
        }
    });
    let preliminaries = run_preliminary_fits(&pool, hypotheses.collect());
    let fitted_hypotheses = run_full_fits(&pool, preliminaries);
    Some(TestedPool {
        candidates,
        screening,
        fitted_hypotheses,
    })
}

/// Returns the free function with the smallest held-out residual, if it is adequate: it explains most
/// of the gap, and held-out records keep hardly more than training records.
pub fn find_adequate_curve(context: RoundContext<'_>, scene: &Scene<'_>) -> Option<Curve> {
    let mut curves = fit_curves(scene);
    let least = curves.iter().map(|curve| curve.test_rms);
    let least = least.fold(f64::INFINITY, f64::min);
    // A force on the only coordinate and the input that acts on it are the same.
    curves.retain(|curve| curve.test_rms <= (1.0 + thresholds::MAX_CLASS_DIFFERENCE) * least);
    let own = curves.iter().position(|curve| curve.is_own_variable);
    let best = curves.into_iter().nth(own.unwrap_or(0))?;
    let (over, of) = (&best.variable, &best.equation);
    let (train, test) = (best.train_rms, best.test_rms);
    let alone = scene.segments.alone.rms();
    (context.progress)(&format!(
        "best free function: {of} over {over}, which leaves {train:.2} (training) and {test:.2} (test) of \
         {alone:.2} standard deviations in short segments"
    ));
    let is_adequate = best.log_evidence > thresholds::MIN_INFORMATION_GAIN
        && test <= thresholds::MAX_HELD_OUT_RATIO * train.max(context.floor)
        && train.max(test) < thresholds::MAX_LEFT_BY_CURVE * alone;
    is_adequate.then_some(best)
}
