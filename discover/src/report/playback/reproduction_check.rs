//! Check if a page can simulate a motion. The solver of the page must need few steps and must
//! reproduce the residuals of the fit.

use eomgen_codegen::program::evaluator::Point;
use eomgen_compiled_model::{ExportedMotion, SolverOptions};
use eomgen_page::play;
use eomgen_sim::inputs::HeldInputs;

use crate::fit::fit_result::Fit;
use crate::model::estimation_model::EstimationModel;
use crate::model::problem::EstimationProblem;
use crate::report::playback::record_excerpt::{ExcerptWindow, RecordExcerpt};
use crate::report::quantity::format_quantity;

/// Maximum number of steps in one window and in all windows: some seconds of computation in a
/// browser.
const MAX_STEPS: u64 = 400_000;

/// Maximum relative difference between the residuals of page and fit. Both are accurate to a small
/// fraction of the noise, but the methods differ; the error limit of the fit is `MAX_STEP_ERROR`.
/// If impacts amplify the difference, the motion is not reproducible and the page would contradict
/// the report.
const MAX_RELATIVE_DIFFERENCE: f64 = 0.05;

/// Checks that the solver of pages reproduces the residuals of the fit, with the values in the
/// extended specification.
///
/// # Errors
///
/// The reason why a page cannot simulate the motion, in words.
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
        if steps > MAX_STEPS {
            return Err(too_many_steps());
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
        // The comparison is false for NaN.
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

/// Alternative for a motion that a page cannot simulate.
const ALTERNATIVE: &str =
    "`eomgen simulate extended.toml --record DATASET.toml` computes it with the other solvers";

fn too_many_steps() -> String {
    format!(
        "the motion needs more than {MAX_STEPS} steps, because it is too fast or too long for a page; {ALTERNATIVE}"
    )
}

/// Returns the sensor values of a window and the number of steps. Returns the reason if the page's
/// solver cannot simulate it.
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
    let mut evaluator = model.create_evaluator(&model.values);
    let inputs = &problem.dataset.test[0].inputs;
    let start = best.map_state(model, &best.test.estimate.initial_states[piece.window]);
    let Some(&begin) = times.first() else {
        return Err("the test record has an empty window".to_owned());
    };
    let options = SolverOptions {
        tolerance: play::TOLERANCE,
        ..SolverOptions::default()
    };
    let exported = model.export().map_err(|error| error.to_string())?;
    let mut motion = ExportedMotion::new(exported, options);
    let failed = |error: eomgen_compiled_model::Error| {
        format!(
            "the engine of pages fails in the window of the test record from {begin:.6} s: {error}; {ALTERNATIVE}"
        )
    };
    let given = HeldInputs::constant(inputs.last_sample(begin).to_vec());
    motion.start((begin, &start), given).map_err(failed)?;
    let mut quantities = Vec::new();
    let mut buffers = model.measured.create_buffers();
    for t in times.iter() {
        motion.advance(*t).map_err(failed)?;
        if motion.step_count() > MAX_STEPS {
            return Err(too_many_steps());
        }
        let held = inputs.last_sample(*t);
        if *t > begin {
            let before = motion.inputs().last_sample(*t).to_vec();
            let changed = motion.inputs().with_held_step(*t, &before, held);
            motion.set_inputs(changed).map_err(failed)?;
        }
        let point = Point {
            t: *t,
            state: motion.state(),
            inputs: held,
        };
        model
            .measured
            .append(&mut evaluator, point, &mut buffers, &mut quantities);
    }
    let shooting = best.training_shooting(problem);
    let sensors = shooting.sensor_values(&best.train.estimate.theta);
    Ok((
        shooting.apply_sensors(&output_times, &sensors, &quantities),
        motion.step_count(),
    ))
}
