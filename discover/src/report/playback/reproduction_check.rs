//! Check if a page can simulate a motion: explicit steps at the tolerance of the page must be few
//! and must reproduce the residuals of the fit.

use std::cell::RefCell;

use eomgen_codegen::program::evaluator::Point;
use eomgen_compiled_model::DrivenModel;
use eomgen_sim::ode::{Names, Settings, SolveError, Surface, UnsupportedSticking, simulate};

use crate::fit::fit_result::Fit;
use crate::model::estimation_model::EstimationModel;
use crate::model::problem::EstimationProblem;
use crate::report::playback::record_excerpt::{ExcerptWindow, RecordExcerpt};
use crate::report::quantity::format_quantity;
use crate::thresholds;

/// The relative tolerance of `motion.js`.
const TOLERANCE: f64 = 1e-7;

/// The most steps in a window, and in all: some seconds of a browser's time.
const MOST_STEPS: u64 = 400_000;

/// Largest relative difference between the residuals of the page and of the fit. Both are accurate
/// to a small fraction of the noise, with different methods; the fit stops at `MAX_STEP_ERROR`. If
/// impacts amplify this difference, the motion is not reproducible and the page would contradict
/// the report.
const MAX_RELATIVE_DIFFERENCE: f64 = 0.05;

/// Checks that explicit steps reproduce the residuals of the fit, with the numbers of the extended
/// specification.
///
/// # Errors
///
/// The reason why a page cannot simulate it, in words.
pub(super) fn check_reproduces_fit(
    problem: &EstimationProblem<'_>,
    best: &Fit,
    model: &EstimationModel,
    stretch: &RecordExcerpt,
) -> Result<(), String> {
    let channels = problem.noise.len();
    let mut sums = vec![0.0; channels];
    let mut counts = vec![0.0; channels];
    let mut steps = 0;
    for piece in &stretch.windows {
        let (seen, own) = simulate_outputs(problem, best, model, stretch, piece)?;
        steps += own;
        if steps > MOST_STEPS {
            return Err(format!(
                "the motion needs more than {MOST_STEPS} of the explicit steps that a page takes, because it is too \
                 fast or too long; {CURE}"
            ));
        }
        let measured = stretch.measured[piece.first_sample * channels..].iter();
        for (number, (seen, measured)) in seen.iter().zip(measured).enumerate() {
            if !measured.is_finite() {
                continue;
            }
            counts[number % channels] += 1.0;
            if piece.compared_samples.contains(&(number / channels)) {
                sums[number % channels] += (seen - measured).powi(2);
            }
        }
    }
    let left = sums.iter().zip(&counts).zip(&stretch.rms_before_after);
    for (channel, ((sum, count), [_, fitted])) in problem.dataset.channels.iter().zip(left) {
        let left = f64::sqrt(sum / f64::max(*count, 1.0));
        // NaN fails the comparison.
        let agree = (left - fitted).abs() <= MAX_RELATIVE_DIFFERENCE * fitted;
        if !agree {
            let [left, fitted] =
                [left, *fitted].map(|left| format_quantity(left, 3, &channel.unit));
            return Err(format!(
                "the motion is so sensitive that another method has a residual of {left} in {} instead of \
                 {fitted}",
                channel.name
            ));
        }
    }
    Ok(())
}

/// The way to a simulation that a page cannot compute.
const CURE: &str =
    "`eomgen simulate extended.toml --record DATASET.toml` computes it with the other solvers";

/// Returns the reason why explicit steps fail, with the names of states and switching surfaces.
fn explain(error: &SolveError, states: &[String], surfaces: &[Surface]) -> String {
    if let SolveError::Sticking { t, guard } | SolveError::TooManySwitches { t, guard, .. } = error
        && let Some(surface) = surfaces.get(*guard)
    {
        return format!(
            "from t = {t:.6} s the motion stays where `{}` is zero, as at rest under dry friction, which these \
             steps do not follow",
            surface.formula
        );
    }
    error.format_named(&Names {
        states,
        surfaces,
        unsupported_sticking: UnsupportedSticking::Formula,
    })
}

/// Returns the sensor values of a window and the number of steps, or the reason why explicit steps cannot
/// simulate it.
fn simulate_outputs(
    problem: &EstimationProblem<'_>,
    best: &Fit,
    model: &EstimationModel,
    stretch: &RecordExcerpt,
    piece: &ExcerptWindow,
) -> Result<(Vec<f64>, u64), String> {
    let samples = &stretch.times[piece.first_sample..piece.first_sample + piece.samples];
    let output_times = problem.output_rate.times(samples);
    let times = &output_times.times;
    let evaluator = RefCell::new(model.create_evaluator(&model.values));
    let inputs = &problem.dataset.test[0].inputs;
    let settings = Settings {
        max_steps: MOST_STEPS,
        max_switch_rate: thresholds::MAX_SWITCHES_PER_SECOND,
        ..Settings::with_tolerance(TOLERANCE)
    };
    let start = best.map_state(model, &best.test.estimate.initial_states[piece.window]);
    let (Some(&begin), Some(&end)) = (times.first(), times.last()) else {
        return Err("the test record has an empty window".to_owned());
    };
    let span = (begin, end);
    let sided = model.create_sided_model(&model.values);
    let driven = DrivenModel::new(&evaluator, inputs)
        .with_typical_sizes(model.typical_sizes())
        .with_sides(
            sided.map_err(|error| error.to_string())?,
            settings.tolerance,
        )
        .without_holding();
    let trajectory = simulate(&driven, &start, span, times, &settings, &mut |_| {});
    let trajectory = trajectory.map_err(|error| {
        let reason = explain(&error, &model.program().state_names(), &driven.surfaces());
        format!(
            "explicit steps, which a page takes, fail in the window of the test record from {:.6} s to {:.6} s: \
             {reason}; {CURE}",
            begin, end
        )
    })?;
    let mut quantities = Vec::new();
    let mut buffers = model.measured.create_buffers();
    let mut evaluator = evaluator.borrow_mut();
    for (t, state) in times.iter().zip(&trajectory.states) {
        let point = Point {
            t: *t,
            state,
            inputs: inputs.last_sample(*t),
        };
        model
            .measured
            .append(&mut evaluator, point, &mut buffers, &mut quantities);
    }
    let shooting = best.training_shooting(problem);
    let sensors = shooting.sensor_values(&best.train.estimate.theta);
    let work = trajectory.statistics.steps + trajectory.statistics.rejected_steps;
    Ok((
        shooting.apply_sensors(&output_times, &sensors, &quantities),
        work,
    ))
}

#[cfg(test)]
mod tests {
    use eomgen_sim::ode::SurfaceKind;

    use super::*;

    #[test]
    fn motion_at_rest_is_the_reason_of_a_failed_simulation() {
        let surfaces = [Surface {
            formula: "dot(x)".to_owned(),
            kind: SurfaceKind::Speed,
        }];
        let error = SolveError::Sticking { t: 0.25, guard: 0 };
        let reason = explain(&error, &["x".to_owned()], &surfaces);
        assert!(
            reason.starts_with("from t = 0.250000 s the motion stays where `dot(x)` is zero"),
            "{reason}"
        );
        let unknown = SolveError::NotFinite { t: 0.5, state: 0 };
        assert!(explain(&unknown, &["x".to_owned()], &surfaces).contains("x"));
    }
}
