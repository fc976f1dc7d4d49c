//! Round of the search. Excitation windows are used in turn until the accepted effects leave a
//! small residual. Pairs are tested if the residual is large; undeclared parameters are tested as
//! well.

use crate::catalogue::candidate::{Candidate, list_candidates};
use crate::catalogue::effect::Effect;
use crate::catalogue::sites::find_sites;
use crate::catalogue::usual_motion::UsualMotion;
use crate::fit::fit_result::Fit;
use crate::ids::CandidateId;
use crate::residual_force::ripple_orders::find_ripple_orders;
use crate::search::context::RoundContext;
use crate::search::dropped_priors::list_prior_candidates;
use crate::search::excitation_window::{ExcitationWindow, fit_without_play};
use crate::search::hypothesis_fits::FittedHypothesis;
use crate::search::motion_of_fit::compute_usual_motion;
use crate::search::pairs::fit_pairs;
use crate::search::parameter_offsets::list_offsets;
use crate::search::pool::CandidatePool;
use crate::search::screening::{Screening, screen_candidates};
use crate::search::single_candidates::{SingleFits, fit_singles};
use crate::search::tested_pool::TestedPool;
use crate::thresholds;

/// Round of the search.
pub struct SearchRound<'l> {
    /// Context of the round.
    pub context: RoundContext<'l>,
    /// True if no effect was accepted yet.
    pub is_first_round: bool,
}

/// Results of a round before the test of pairs.
pub struct RoundTests {
    /// Tested pools: one for each excitation window, and one for undeclared parameters.
    pub tested: Vec<TestedPool>,
    seen: Vec<ExcitationWindow>,
    has_offsets: bool,
    /// True if the residual of an accepted hypothesis is so small that pairs are not tested.
    is_explained: bool,
}

impl RoundTests {
    /// Returns true if pairs are still to be tested and no single candidate is accepted.
    pub fn lacks_effect(&self) -> bool {
        !self.is_explained && !is_any(&self.tested, &|fitted| fitted.verdict.is_ok())
    }
}

impl SearchRound<'_> {
    /// Tests single candidates.
    pub fn test_single_candidates(&self) -> RoundTests {
        let mut tested: Vec<TestedPool> = Vec::new();
        let mut seen: Vec<ExcitationWindow> = Vec::new();
        let mut has_offsets = false;
        for window in self.choose_windows() {
            if *window == ExcitationWindow::BacklashRemoved {
                // In a model without play, candidates outside the teeth are predicted too poorly.
                // Therefore this window is used only if no other candidate is accepted.
                if is_any(&tested, &|fitted| fitted.verdict.is_ok()) {
                    continue;
                }
                // Fits with closed play are slow and are skipped if an undeclared parameter
                // explains the records.
                if self.is_first_round && !self.context.is_near_floor() {
                    tested.push(self.test_offsets());
                    has_offsets = true;
                    if is_any(&tested, &|fitted| self.is_enough(fitted)) {
                        break;
                    }
                }
            }
            let Some(found) = self.test_in_window(*window) else {
                continue;
            };
            let number = seen.len();
            tested.insert(number, found);
            seen.push(*window);
            // Near the noise floor a further excitation window is cheap, and a nearly equal
            // candidate may be the correct one.
            let is_done = match self.context.is_near_floor() {
                true => is_any(&tested, &|fitted| self.is_enough(fitted)),
                false => is_any(&tested, &|fitted| self.is_close(fitted)),
            };
            if is_done {
                break;
            }
        }
        // Undeclared parameters are tested before effects with several unknowns: while the residual
        // is large, a wrong parameter value competes with the first effect, with pairs and with
        // effects that have a shape.
        let is_simple =
            |best: &FittedHypothesis| best.effect_unknowns.len() == 1 && self.is_near_floor(best);
        if self.is_first_round
            && !has_offsets
            && !find_best_accepted(&tested).is_some_and(is_simple)
        {
            tested.push(self.test_offsets());
            has_offsets = true;
        }
        let is_explained = |fitted: &FittedHypothesis| self.is_enough(fitted);
        let is_explained_by_offset = has_offsets
            && tested.last().is_some_and(|offsets| {
                let mut fitted = offsets.fitted_hypotheses.iter();
                fitted.any(|fitted| self.is_near_floor(fitted))
            });
        RoundTests {
            is_explained: is_explained_by_offset || is_any(&tested, &is_explained),
            tested,
            seen,
            has_offsets,
        }
    }

    /// Tests pairs if no single candidate explains the records, and returns all tested pools.
    pub fn test_pairs(&self, singles: RoundTests) -> Vec<TestedPool> {
        let RoundTests {
            mut tested,
            seen,
            mut has_offsets,
            is_explained,
        } = singles;
        if !is_explained {
            self.add_pairs(&seen, &mut tested);
        }
        let is_accepted = |fitted: &FittedHypothesis| fitted.verdict.is_ok();
        if !has_offsets && !self.context.is_near_floor() && !is_any(&tested, &is_accepted) {
            tested.push(self.test_offsets());
            has_offsets = true;
        }
        if has_offsets {
            remove_unclear(&mut tested);
        }
        tested
    }

    fn choose_windows(&self) -> &'static [ExcitationWindow] {
        match (
            self.context.problem.estimates_initial_states(),
            self.context.is_near_floor(),
            self.is_first_round,
        ) {
            // After a large accepted effect, a small effect is visible only over whole windows.
            (false, _, _) | (true, true, false) => &[ExcitationWindow::Whole],
            (true, true, true) => &[
                ExcitationWindow::Whole,
                ExcitationWindow::Beginnings,
                ExcitationWindow::BacklashRemoved,
            ],
            (true, false, _) => &[
                ExcitationWindow::Beginnings,
                ExcitationWindow::BacklashRemoved,
                ExcitationWindow::Whole,
            ],
        }
    }

    /// Returns true if a hypothesis is accepted and explains most of the gap.
    fn is_close(&self, fitted: &FittedHypothesis) -> bool {
        fitted.verdict.is_ok() && self.context.explains_most_of_gap(&fitted.fit)
    }

    /// Returns true if a hypothesis is accepted and its residual is slightly larger than that of a
    /// correct model.
    fn is_near_floor(&self, fitted: &FittedHypothesis) -> bool {
        let little = thresholds::MAX_FLOOR_RATIO_TO_STOP * self.context.floor;
        fitted.verdict.is_ok() && fitted.fit.is_below(little)
    }

    /// Returns true if a hypothesis is accepted and its residual is that of a correct model.
    fn is_enough(&self, fitted: &FittedHypothesis) -> bool {
        fitted.verdict.is_ok() && fitted.fit.is_at_floor(self.context.floor)
    }

    /// Screens candidates in an excitation window and fits them one by one. Periodic candidates are
    /// screened only if the others have a poor prediction or result. `None` if the model has no
    /// play to close or a stop was requested.
    pub(crate) fn test_in_window(&self, window: ExcitationWindow) -> Option<TestedPool> {
        self.context.problem.stop.check_not_stopped().ok()?;
        let closed = match window {
            ExcitationWindow::BacklashRemoved => {
                Some(fit_without_play(self.context.problem, self.context.fit)?)
            }
            ExcitationWindow::Whole | ExcitationWindow::Beginnings => None,
        };
        if closed.is_some() {
            (self.context.progress)("fitting the model without play");
        }
        let fit = closed.as_ref().unwrap_or(self.context.fit);
        let (mut candidates, repeating) = self.split_candidates(fit, window);
        (self.context.progress)(&format!("screening {} candidates", candidates.len()));
        let screened = screen_candidates(
            self.context.problem,
            fit,
            &candidates,
            window.window_fraction(),
        );
        let (mut from, mut fitted_hypotheses) = (CandidateId::new(0), Vec::new());
        let mut preliminary_outcomes = Vec::new();
        if repeating.is_empty() || self.predicts_enough(&screened) {
            let singles = fit_singles(&self.create_pool(window, &candidates, &screened), from);
            fitted_hypotheses = singles.fitted_hypotheses;
            preliminary_outcomes = singles.preliminary_outcomes;
            if repeating.is_empty() || fitted_hypotheses.iter().any(|fitted| self.is_close(fitted))
            {
                return Some(TestedPool {
                    candidates,
                    screening: screened,
                    fitted_hypotheses,
                    preliminary_outcomes,
                });
            }
            from = CandidateId::new(candidates.len());
        }
        (self.context.progress)(&format!(
            "screening {} periodic candidates",
            repeating.len()
        ));
        // Periodic candidates are appended, so that the indices of fitted candidates do not change.
        let singles = candidates.len();
        candidates.extend(repeating);
        let rescreened = screen_candidates(
            self.context.problem,
            fit,
            &candidates,
            window.window_fraction(),
        );
        if self.context.problem.stop.check_not_stopped().is_err() {
            // The interrupted screening lacks responses, so that its indices differ from those in
            // the fits.
            candidates.truncate(singles);
            return Some(TestedPool {
                candidates,
                screening: screened,
                fitted_hypotheses,
                preliminary_outcomes,
            });
        }
        let screened = rescreened;
        let periodic = fit_singles(&self.create_pool(window, &candidates, &screened), from);
        fitted_hypotheses.extend(periodic.fitted_hypotheses);
        preliminary_outcomes.extend(periodic.preliminary_outcomes);
        Some(TestedPool {
            candidates,
            screening: screened,
            fitted_hypotheses,
            preliminary_outcomes,
        })
    }

    /// Creates the pool of candidates of an excitation window.
    fn create_pool<'r>(
        &'r self,
        window: ExcitationWindow,
        candidates: &'r [Candidate],
        screening: &'r Screening,
    ) -> CandidatePool<'r> {
        let pool = CandidatePool::new(
            self.context,
            candidates,
            screening,
            window == ExcitationWindow::Whole,
        );
        match window {
            // Without play, the linear prediction is accurate, so few initial sizes suffice.
            ExcitationWindow::BacklashRemoved => CandidatePool {
                max_preliminary_fits: 2 * thresholds::PARALLEL_FIT_COUNT,
                size_fractions: &thresholds::INITIAL_SIZE_FRACTIONS[..2],
                ..pool
            },
            ExcitationWindow::Whole | ExcitationWindow::Beginnings => pool,
        }
    }

    /// Adds pairs for one excitation window after the other until some are accepted.
    fn add_pairs(&self, seen: &[ExcitationWindow], tested: &mut [TestedPool]) {
        for (window, tested) in seen.iter().zip(tested) {
            let pool = self.create_pool(*window, &tested.candidates, &tested.screening);
            let pairs = fit_pairs(&pool, &tested.fitted_hypotheses);
            let fitted_hypotheses = &mut tested.fitted_hypotheses;
            fitted_hypotheses.extend(pairs);
            if fitted_hypotheses
                .iter()
                .any(|fitted| fitted.verdict.is_ok())
            {
                break;
            }
        }
    }

    /// Screens and fits undeclared parameters and errors of inputs.
    fn test_offsets(&self) -> TestedPool {
        let offsets = list_offsets(self.context);
        (self.context.progress)(&format!(
            "screening {} parameters of the model and of inputs",
            offsets.len()
        ));
        let window = self.choose_windows()[0];
        let screening = screen_candidates(
            self.context.problem,
            self.context.fit,
            &offsets,
            window.window_fraction(),
        );
        let SingleFits {
            fitted_hypotheses,
            preliminary_outcomes,
        } = fit_singles(
            &self.create_pool(window, &offsets, &screening),
            CandidateId::new(0),
        );
        TestedPool {
            candidates: offsets,
            screening,
            fitted_hypotheses,
            preliminary_outcomes,
        }
    }

    /// Returns the candidates of an excitation window, and separately the periodic candidates,
    /// which are numerous. Periodic errors of teeth are much larger than their deflection, and
    /// often larger than their play. They are therefore screened in the model with closed play,
    /// which is used for nothing else.
    fn split_candidates(
        &self,
        fit: &Fit,
        window: ExcitationWindow,
    ) -> (Vec<Candidate>, Vec<Candidate>) {
        let (problem, has_play) = (
            self.context.problem,
            window != ExcitationWindow::BacklashRemoved,
        );
        let model = fit.model.specification();
        let sites = find_sites(model);
        let motion = UsualMotion {
            orders: find_ripple_orders(problem, fit),
            ..compute_usual_motion(problem, fit, &sites)
        };
        // With given motion nothing is simulated, so states cannot be added.
        let is_given = problem.dataset.gives_motion();
        let may_be = |effect: &&Effect| {
            !(effect.scales_stiffness()
                || effect.is_only_scanned()
                || is_given && effect.adds_states())
        };
        let effects = self.context.effects.iter().filter(may_be);
        let mut all = list_candidates(model, effects, &sites, &motion);
        all.extend(list_prior_candidates(problem, fit));
        all.retain(|c| {
            (c.angle_order.is_none() || c.on_mesh != has_play) && (has_play || c.on_mesh)
        });
        all.into_iter()
            .partition(|c| c.angle_order.is_none() || !has_play)
    }

    /// Returns true if a screened candidate has a predicted improvement of most of the gap.
    fn predicts_enough(&self, screening: &Screening) -> bool {
        let best = screening
            .responses
            .iter()
            .map(|r| r.cost_decrease)
            .fold(0.0, f64::max);
        let floor = self.context.floor * self.context.floor * screening.number_count;
        best > thresholds::MIN_EXPLAINED_FRACTION * (screening.predict(&[]).cost - floor)
    }
}

/// Removes accepted undeclared parameters, which are the last pool, if another accepted single
/// unknown is nearly as good, or if several unknowns are clearly better. Then removes accepted
/// hypotheses with several unknowns that are not clearly better than the remaining undeclared
/// parameters.
fn remove_unclear(tested: &mut [TestedPool]) {
    let Some((offsets, tested)) = tested.split_last_mut() else {
        return;
    };
    let others = tested.iter().flat_map(|tested| &tested.fitted_hypotheses);
    let others: Vec<&FittedHypothesis> = others.filter(|fitted| fitted.verdict.is_ok()).collect();
    offsets.fitted_hypotheses.retain(|fitted| {
        let is_clear = |other: &&FittedHypothesis| match other.effect_unknowns.len() {
            1 => fitted.fit.is_clearly_below(&other.fit),
            _ => !other.fit.is_clearly_below(&fitted.fit),
        };
        fitted.verdict.is_err() || others.iter().all(is_clear)
    });
    let accepted = offsets.fitted_hypotheses.iter();
    let accepted: Vec<&FittedHypothesis> =
        accepted.filter(|fitted| fitted.verdict.is_ok()).collect();
    for tested in tested {
        tested.fitted_hypotheses.retain(|fitted| {
            fitted.effect_unknowns.len() == 1
                || fitted.verdict.is_err()
                || (accepted.iter()).all(|offset| fitted.fit.is_clearly_below(&offset.fit))
        });
    }
}

/// Returns the accepted hypothesis with the smallest residual.
fn find_best_accepted(tested: &[TestedPool]) -> Option<&FittedHypothesis> {
    let all = tested.iter().flat_map(|tested| &tested.fitted_hypotheses);
    let accepted = all.filter(|fitted| fitted.verdict.is_ok());
    accepted.min_by(|a, b| a.fit.rms().total_cmp(&b.fit.rms()))
}

/// Returns true if a condition applies to any fitted hypothesis.
fn is_any(tested: &[TestedPool], is: &dyn Fn(&FittedHypothesis) -> bool) -> bool {
    tested
        .iter()
        .any(|tested| tested.fitted_hypotheses.iter().any(is))
}
