//! Estimation from distant initial values. Each trial of the unknowns estimates the initial states
//! again along the records, because initial states fitted at wrong unknowns stay in local minima
//! due to impacts. The result is refined in [`crate::fit::gauss_newton`].

use crate::ids::UnknownId;
use nalgebra::DVector;

use crate::fit::gauss_newton::{
    Estimate, apply_fraction, compute_derivatives, eliminate_initial_states, evaluate_cost,
    solve_step,
};
use crate::fit::prior::{InitialStatePrior, InitialStates};
use crate::fit::sensitivity::WindowDerivatives;
use crate::fit::shooting::{Residual, Shooting};
use crate::thresholds;

/// Function that estimates the initial states for given unknowns. The optional argument contains
/// the initial states for similar unknowns. Returns the prior and the states.
pub type EstimateInitialStates<'f> = dyn Fn(&[f64], Option<&[Vec<f64>]>) -> InitialStates + 'f;

/// Result of a continuation.
#[derive(Default)]
pub struct ContinuationResult {
    /// Prior of the initial states of the windows.
    pub prior: InitialStatePrior,
    /// Final estimate.
    pub estimate: Estimate,
    /// True if further steps would decrease the cost only slightly.
    pub is_converged: bool,
}

/// Type of the derivatives with respect to the unknowns.
#[derive(Clone, Copy, PartialEq)]
enum Derivatives {
    /// Derivatives from tangent vectors. With impacts they grow without bound and are valid only
    /// for tiny changes.
    Tangents,
    /// Differences of simulated motions, for unknowns without a prior.
    Secants,
}

/// Continuation on a set of windows.
struct Continuation<'a> {
    shooting: &'a Shooting<'a>,
    follow: &'a EstimateInitialStates<'a>,
    /// Change of each unknown for a secant, SI.
    sizes: Vec<f64>,
}

/// Runs the continuation from the best of several initial values, with at most `steps` steps.
pub fn run_continuation(
    shooting: &Shooting<'_>,
    guesses: &[Vec<f64>],
    follow: &EstimateInitialStates<'_>,
    steps: usize,
) -> ContinuationResult {
    let mut path = Continuation::new(shooting, follow);
    let guessed = guesses
        .iter()
        .map(|theta| path.evaluate(theta.clone(), None));
    let best = guessed.min_by(|a, b| a.estimate.cost.total_cmp(&b.estimate.cost));
    let mut present = best.unwrap_or_default();
    path.make_steps(&mut present, steps, Derivatives::Tangents);
    present
}

/// Continues with secants if tangent vectors fail and the residual is far above the noise.
pub fn continue_by_secants(
    shooting: &Shooting<'_>,
    present: &mut ContinuationResult,
    follow: &EstimateInitialStates<'_>,
) {
    Continuation::new(shooting, follow).make_steps(
        present,
        thresholds::MAX_SECANT_STEPS,
        Derivatives::Secants,
    );
}

/// Replaces the derivatives with respect to unknowns without a prior by secants.
pub fn replace_by_secants(
    shooting: &Shooting<'_>,
    estimate: &Estimate,
    mut tangents: Vec<Option<WindowDerivatives>>,
    follow: &EstimateInitialStates<'_>,
) -> Vec<Option<WindowDerivatives>> {
    Continuation::new(shooting, follow).insert_secants(estimate, &mut tangents);
    tangents
}

impl<'a> Continuation<'a> {
    fn new(shooting: &'a Shooting<'a>, follow: &'a EstimateInitialStates<'a>) -> Self {
        let sizes = shooting.unknowns.iter();
        Self {
            shooting,
            follow,
            sizes: sizes
                .map(|unknown| thresholds::FIRST_SECANT_IN_SCALES * unknown.scale)
                .collect(),
        }
    }

    /// Evaluates the estimate for given unknowns.
    fn evaluate(&self, theta: Vec<f64>, before: Option<&[Vec<f64>]>) -> ContinuationResult {
        let InitialStates {
            prior,
            states: initial_states,
        } = (self.follow)(&theta, before);
        let estimate = evaluate_cost(self.shooting, &prior, theta, initial_states);
        ContinuationResult {
            prior,
            estimate,
            is_converged: false,
        }
    }

    /// Returns the RMS residual, in standard deviations.
    fn compute_residual_rms(&self, present: &Estimate) -> f64 {
        let count = self.shooting.fraction * self.shooting.windows.measurement_count();
        (present.squares.iter().sum::<f64>() / count).sqrt()
    }

    /// Makes at most `steps` steps; stops if the decrease of the cost is small.
    fn make_steps(
        &mut self,
        present: &mut ContinuationResult,
        steps: usize,
        derivatives: Derivatives,
    ) {
        for _ in 0..steps {
            if derivatives == Derivatives::Secants
                && self.compute_residual_rms(&present.estimate)
                    < thresholds::MAX_FLOOR_RATIO_AT_FLOOR
            {
                return;
            }
            let before = present.estimate.cost;
            let Some(next) = self.try_step(present, derivatives) else {
                present.is_converged = true;
                return;
            };
            *present = next;
            present.is_converged =
                before - present.estimate.cost < thresholds::MIN_CONTINUATION_DECREASE * before;
            if present.is_converged {
                return;
            }
        }
    }

    /// Returns the next estimate, if its cost is lower.
    fn try_step(
        &mut self,
        present: &ContinuationResult,
        derivatives: Derivatives,
    ) -> Option<ContinuationResult> {
        let ContinuationResult {
            prior, estimate, ..
        } = present;
        let mut linear = compute_derivatives(self.shooting, estimate);
        if derivatives == Derivatives::Secants && !self.insert_secants(estimate, &mut linear) {
            return None;
        }
        let windows = eliminate_initial_states(prior, estimate, &linear);
        let change = solve_step(self.shooting, estimate, &windows, 0.0);
        thresholds::STEP_FRACTIONS.iter().find_map(|part| {
            let theta = apply_fraction(self.shooting, estimate, &change, *part);
            let next = self.evaluate(theta, Some(&estimate.initial_states));
            (next.estimate.cost < estimate.cost).then_some(next)
        })
    }

    /// Replaces derivatives by secants. Returns false if no derivative was replaced.
    fn insert_secants(
        &mut self,
        estimate: &Estimate,
        linear: &mut [Option<WindowDerivatives>],
    ) -> bool {
        // The lower limit avoids a size that depends on rounding if the residual is far below the
        // noise.
        let wanted =
            thresholds::SECANT_OUTPUT_CHANGE * self.compute_residual_rms(estimate).max(1.0);
        let mut is_replaced = false;
        let all = self.shooting.unknowns;
        for (id, unknown) in UnknownId::first(all.len()).zip(all) {
            if unknown.prior.is_some() || unknown.bounds.is_point() {
                continue;
            }
            let mut secant = self.compute_secant(estimate, linear, id);
            let moved = secant.compute_change_rms();
            if moved > 0.0
                && !(wanted / thresholds::SECANT_CHANGE_TOLERANCE
                    ..wanted * thresholds::SECANT_CHANGE_TOLERANCE)
                    .contains(&moved)
            {
                self.sizes[id] = secant.size * wanted / moved;
                secant = self.compute_secant(estimate, linear, id);
            }
            for (linear, change) in linear.iter_mut().zip(&secant.changes) {
                if let (Some(linear), Some(change)) = (linear, change) {
                    let column = change / secant.size;
                    linear.by_unknown.set_column(id.index(), &column);
                    is_replaced = true;
                }
            }
        }
        is_replaced
    }

    /// Computes the change of the residuals of each window due to a change of an unknown.
    fn compute_secant(
        &self,
        estimate: &Estimate,
        linear: &[Option<WindowDerivatives>],
        of: UnknownId,
    ) -> Secant {
        let (unknown, size) = (&self.shooting.unknowns[of], self.sizes[of]);
        let value = estimate.theta[of];
        let mut theta = estimate.theta.clone();
        let ends = [value + size, value - size].map(|end| unknown.clamp(end));
        theta[of] = ends.into_iter().find(|end| *end != value).unwrap_or(value);
        let size = theta[of] - value;
        let initial_states = (self.follow)(&theta, Some(&estimate.initial_states)).states;
        let residuals = self.shooting.compute_residuals(&theta, &initial_states);
        let changed = |(residual, linear): (Option<Residual>, &Option<WindowDerivatives>)| {
            let (residual, linear) = (residual?, linear.as_ref()?);
            let change = DVector::from_vec(residual.values) - &linear.residual;
            (size != 0.0 && change.iter().all(|c| c.is_finite())).then_some(change)
        };
        let changes = residuals.into_iter().zip(linear).map(changed).collect();
        Secant { size, changes }
    }
}

/// Change of the residuals due to a change of an unknown.
struct Secant {
    /// Change of the unknown, SI.
    size: f64,
    /// Change of the residuals of each window, in standard deviations; `None` if a simulation
    /// failed.
    changes: Vec<Option<DVector<f64>>>,
}

impl Secant {
    /// Returns the RMS change, in standard deviations.
    fn compute_change_rms(&self) -> f64 {
        let all = || self.changes.iter().flatten();
        let count: usize = all().map(DVector::len).sum();
        (all().map(DVector::norm_squared).sum::<f64>() / count.max(1) as f64).sqrt()
    }
}
