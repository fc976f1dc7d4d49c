//! Random smooth models that are right: their certificates must say so, and must not say so
//! of models that differ in a single term by a ten-millionth.
//!
//! A few models each time; more of another seed by
//!
//! ```console
//! $ EOMGEN_SMOOTH_MODELS=300 EOMGEN_SMOOTH_SEED=7 \
//!       cargo test --release -p eomgen-tests --test equations smooth_models -- --nocapture
//! ```

use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::program::evaluator::Point;
use eomgen_model_spec::model::Model;
use eomgen_tests::certified::{certificate, certificate_with, checked};
use eomgen_tests::models::variant;
use eomgen_tests::smooth_models::{SmoothModel, SmoothModels};

fn number(name: &str, absent: u64) -> u64 {
    let given = std::env::var(name).ok();
    given.map_or(absent, |text| text.parse().expect("a whole number"))
}

/// Whether the motion can begin: of a model that is no machine at its own initial state
/// nothing is asked.
fn begins(model: &Model) -> bool {
    let mut evaluator = variant(model, 0).evaluator;
    let state = model.initial_state(&[]).expect("a state");
    let inputs = vec![0.0; model.inputs.len()];
    let mut rates = vec![0.0; state.len()];
    let point = Point {
        t: 0.0,
        state: &state,
        inputs: &inputs,
    };
    evaluator.rates(point, &mut rates);
    evaluator.pivots_are_positive() && rates.iter().all(|rate| rate.is_finite())
}

/// The next model of which something can be asked.
fn next(models: &mut SmoothModels) -> (SmoothModel, Model) {
    loop {
        let written = models.model();
        let model = checked(&written.text);
        if begins(&model) {
            return (written, model);
        }
    }
}

#[test]
fn right_models_are_not_called_wrong() {
    let (count, seed) = (
        number("EOMGEN_SMOOTH_MODELS", 12),
        number("EOMGEN_SMOOTH_SEED", 1),
    );
    let mut models = SmoothModels::new(seed);
    let mut alarms = Vec::new();
    for place in 0..count {
        let (written, model) = next(&mut models);
        let certificate = certificate(&model, &model);
        if !certificate.passed {
            let failures: Vec<_> = certificate.failures().collect();
            alarms.push(format!("# {place}\n{}{failures:#?}", written.text));
        }
    }
    println!(
        "{} false alarms of {count} right models, seed {seed}",
        alarms.len()
    );
    assert!(
        alarms.len() as u64 <= count / 300,
        "{} of {count}:\n{}",
        alarms.len(),
        alarms.join("\n\n")
    );
}

/// What is judged beside the equations themselves.
const OUTPUTS: [Output; 5] = [
    Output::BiasForces,
    Output::InverseDynamics,
    Output::GuardRates,
    Output::Jacobians,
    Output::Products,
];

#[test]
fn what_is_requested_of_right_models_is_not_called_wrong() {
    let (count, seed) = (
        number("EOMGEN_SMOOTH_MODELS", 12),
        number("EOMGEN_SMOOTH_SEED", 1),
    );
    let mut models = SmoothModels::new(seed);
    let mut alarms = Vec::new();
    for place in 0..count {
        let (written, model) = next(&mut models);
        let certificate = certificate_with(&model, &model, &OUTPUTS);
        let made = certificate
            .checks
            .iter()
            .find(|check| check.name == "rates_by_state");
        assert!(
            made.is_some_and(|check| check.skipped.is_none()),
            "# {place}: {made:?}"
        );
        if !certificate.passed {
            let failures: Vec<_> = certificate.failures().collect();
            alarms.push(format!("# {place}\n{}{failures:#?}", written.text));
        }
    }
    println!(
        "{} false alarms of {count} models, seed {seed}",
        alarms.len()
    );
    assert!(
        alarms.len() as u64 <= count / 300,
        "{}",
        alarms.join("\n\n")
    );
}

/// A term may be so small beside the others of its row, at every state, that a ten-millionth of
/// it is within the row's rounding. Of such a term a thousandth has to be seen, and few terms may
/// be such.
#[test]
fn a_term_that_differs_by_a_ten_millionth_is_seen() {
    let (count, seed) = (
        number("EOMGEN_SMOOTH_MODELS", 12) / 3,
        number("EOMGEN_SMOOTH_SEED", 1),
    );
    let mut models = SmoothModels::new(seed);
    let (mut faults, mut within_rounding, mut unseen) = (0, 0, Vec::new());
    for _ in 0..count {
        let (written, model) = next(&mut models);
        for (section, name, term) in &written.terms {
            let line = written
                .text
                .lines()
                .find(|line| line.starts_with(&format!("{name} = ")))
                .expect("the term's line");
            let is_seen = |factor: &str| {
                let wrong = format!("\"({term})*{factor}\"");
                let wrong = line.replace(&format!("\"{term}\""), &wrong);
                let subject = checked(&written.text.replace(line, &wrong));
                !certificate(&model, &subject).passed
            };
            faults += 1;
            if is_seen("1.0000001") {
                continue;
            }
            within_rounding += 1;
            if !is_seen("1.001") {
                unseen.push(format!("[{section}] {line}\n{}", written.text));
            }
        }
    }
    let not_seen = unseen.len();
    println!(
        "of {faults} faults {within_rounding} are within rounding, {not_seen} not seen, seed {seed}"
    );
    assert!(unseen.is_empty(), "{}", unseen.join("\n\n"));
    assert!(within_rounding * 100 <= faults);
}
