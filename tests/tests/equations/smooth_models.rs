//! Tests of certificates of random smooth models: a correct model must pass, and a model with a relative error of 1e-7
//! in a single term must fail.
//!
//! By default only a few models are tested. To test more models, or to use another seed, run:
//!
//! ```console
//! $ EOMGEN_SMOOTH_MODELS=300 EOMGEN_SMOOTH_SEED=7 \
//!       cargo test --release -p eomgen-tests --test equations smooth_models -- --nocapture
//! ```

use eomgen_codegen::mechanics::outputs::Output;
use eomgen_codegen::program::evaluator::Point;
use eomgen_model_spec::model::Model;
use eomgen_tests::certified::{certify, certify_outputs, check_model};
use eomgen_tests::models::variant;
use eomgen_tests::smooth_models::{SmoothModel, SmoothModels};

fn number(name: &str, absent: u64) -> u64 {
    let given = std::env::var(name).ok();
    given.map_or(absent, |text| text.parse().expect("a whole number"))
}

/// Returns true if the mass matrix is positive definite and the rates are finite at the initial state.
fn has_valid_initial_state(model: &Model) -> bool {
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

fn next_valid_model(models: &mut SmoothModels) -> (SmoothModel, Model) {
    loop {
        let written = models.model();
        let model = check_model(&written.text);
        if has_valid_initial_state(&model) {
            return (written, model);
        }
    }
}

#[test]
fn certificates_of_correct_models_pass() {
    let (count, seed) = (
        number("EOMGEN_SMOOTH_MODELS", 12),
        number("EOMGEN_SMOOTH_SEED", 1),
    );
    let mut models = SmoothModels::new(seed);
    let mut alarms = Vec::new();
    for place in 0..count {
        let (written, model) = next_valid_model(&mut models);
        let certificate = certify(&model, &model);
        if !certificate.passed {
            let failures: Vec<_> = certificate.failures().collect();
            alarms.push(format!("# {place}\n{}{failures:#?}", written.text));
        }
    }
    println!(
        "{} false alarms for {count} correct models, seed {seed}",
        alarms.len()
    );
    assert!(
        alarms.len() as u64 <= count / 300,
        "{} of {count}:\n{}",
        alarms.len(),
        alarms.join("\n\n")
    );
}

const OUTPUTS: [Output; 5] = [
    Output::BiasForces,
    Output::InverseDynamics,
    Output::GuardRates,
    Output::Jacobians,
    Output::Products,
];

#[test]
fn requested_outputs_of_correct_models_pass() {
    let (count, seed) = (
        number("EOMGEN_SMOOTH_MODELS", 12),
        number("EOMGEN_SMOOTH_SEED", 1),
    );
    let mut models = SmoothModels::new(seed);
    let mut alarms = Vec::new();
    for place in 0..count {
        let (written, model) = next_valid_model(&mut models);
        let certificate = certify_outputs(&model, &model, &OUTPUTS);
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
        "{} false alarms for {count} models, seed {seed}",
        alarms.len()
    );
    assert!(
        alarms.len() as u64 <= count / 300,
        "{}",
        alarms.join("\n\n")
    );
}

/// If a term is small compared with its row at every state, 1e-7 of the term can be below the row's rounding error. In
/// such a term a relative error of 1e-3 must be detected, and such terms must be rare.
#[test]
fn relative_error_of_1e_7_in_a_term_is_detected() {
    let (count, seed) = (
        number("EOMGEN_SMOOTH_MODELS", 12) / 3,
        number("EOMGEN_SMOOTH_SEED", 1),
    );
    let mut models = SmoothModels::new(seed);
    let (mut faults, mut within_rounding, mut unseen) = (0, 0, Vec::new());
    for _ in 0..count {
        let (written, model) = next_valid_model(&mut models);
        for (section, name, term) in &written.terms {
            let line = written
                .text
                .lines()
                .find(|line| line.starts_with(&format!("{name} = ")))
                .expect("the term's line");
            let is_seen = |factor: &str| {
                let wrong = format!("\"({term})*{factor}\"");
                let wrong = line.replace(&format!("\"{term}\""), &wrong);
                let subject = check_model(&written.text.replace(line, &wrong));
                !certify(&model, &subject).passed
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
        "{faults} faults: {within_rounding} within rounding, {not_seen} not detected, seed {seed}"
    );
    assert!(unseen.is_empty(), "{}", unseen.join("\n\n"));
    assert!(within_rounding * 100 <= faults);
}
