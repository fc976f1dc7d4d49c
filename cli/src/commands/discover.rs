//! `eomgen compare` and `eomgen discover`: a model and its measurements. What is compared and
//! what is found is the library's.

use eomgen_validate::certificate::Check;
use std::path::Path;
use std::time::Instant;

use discover::catalogue::{self, user_effects};
use discover::empirical::unnamed;
use discover::fit::fitted::Fit;
use discover::fit::noise_floor::{NoiseFloor, floor};
use discover::fit::null_model::null_fit;
use discover::model::channel_checks;
use discover::model::problem::EstimationProblem;
use discover::report::resimulation::rerun;
use discover::report::{discovery as document, location, page, write_back};
use discover::residual_force::residual_force;
use discover::residual_force::wording::described_after;
use discover::search::search;
use eomgen_records::dataset::Dataset;
use eomgen_records::read_dataset;
use model_spec::source::Source;
use serde_json::{Value, json};

use super::validate;
use crate::arguments;
use crate::model::{load, orders};
use crate::output::write_file;
use crate::problem::{Outcome, Problem, say, warn};

/// Runs `compare`.
pub fn compare(options: &arguments::Compare) -> Outcome {
    tell(options.json, &compared(options)?, &options.out)
}

/// Runs `discover`.
pub fn discover(options: &arguments::Discover) -> Outcome {
    tell(options.json, &discovered(options)?, &options.out)
}

/// Compares; the document that is left beside the page.
pub fn compared(options: &arguments::Compare) -> Outcome<Value> {
    let begin = Instant::now();
    let (text, order, dataset) = inputs(&options.spec, &options.dataset, options.order.as_deref())?;
    let problem =
        EstimationProblem::new(&dataset, order, &options.spec.display().to_string(), &text);
    let (fit, floor) = null(&problem, &text, options.seed)?;
    let done = fit.is_at_floor(floor.rms);
    let force = residual_force(&problem, &fit, None);
    let place = location::located(&problem, &fit, force.as_ref());
    let mut result = document::compared(&problem, &fit, &floor, done, &place);
    result["seconds"] = json!(begin.elapsed().as_secs_f64());
    let forces = force.as_ref().map(|force| (force, None));
    let page = page::page(&problem, (&fit, None), forces, &result, (&text, &text));
    write_json(&options.out.join("comparison.json"), &result)?;
    write_file(&options.out.join("report.html"), page.as_bytes())?;
    Ok(result)
}

/// Discovers; the document that is left beside the page and the specification.
pub fn discovered(options: &arguments::Discover) -> Outcome<Value> {
    let begin = Instant::now();
    let (text, order, mut dataset) =
        inputs(&options.spec, &options.dataset, options.order.as_deref())?;
    let effects = catalogue::effects(options.effects.as_deref()).map_err(Problem::Specification)?;
    let path = options.spec.display().to_string();
    let homeless = user_effects::placed(&effects, &path, &text).map_err(Problem::discovery)?;
    for note in &homeless {
        warn(&format!("note: {note}"));
    }
    dataset.notes.extend(homeless);
    let problem = EstimationProblem::new(&dataset, order, &path, &text);
    let (fit, floor_before) = null(&problem, &text, options.seed)?;
    let force = residual_force(&problem, &fit, None);
    let mut place = location::located(&problem, &fit, force.as_ref());
    let mut found =
        search(&problem, fit, &effects, floor_before.rms, &warn).map_err(Problem::discovery)?;
    unnamed(&problem, &mut found, floor_before.rms, &warn);
    let floor = match found.accepted.is_empty() {
        true => floor_before,
        false => floor(&problem, found.best(), options.seed),
    };
    let done = found.best().is_at_floor(floor.rms);
    let left = force.as_ref().zip(found.last.as_ref());
    let left = left
        .and_then(|(force, last)| residual_force(&problem, last, Some(force.profiled_equation())));
    if let Some(left) = &left {
        place += &format!(" {}", described_after(left));
    }
    let extended = write_back::extended(&problem, &text, found.best(), &found.accepted)
        .map_err(Problem::discovery)?;
    let mut result = document::discovered(&problem, &found, &floor, done, &place);
    let mut validation = validated(&problem.path, &extended, order)?;
    if !validation.is_null() {
        let left = rerun(&problem, found.best(), &extended).map_err(Problem::discovery)?;
        validation["train_in_noises"] = json!(left.train);
        validation["test_in_noises"] = json!(left.test);
    }
    let ladder = result["ladder"].as_array_mut();
    if let Some(last) = ladder.and_then(|steps| steps.last_mut()) {
        last["validated"] = validation["passed"].clone();
    }
    result["validation"] = validation;
    result["seconds"] = json!(begin.elapsed().as_secs_f64());
    let page = page::page(
        &problem,
        (&found.null, found.last.as_ref()),
        force.as_ref().map(|force| (force, left.as_ref())),
        &result,
        (&text, &extended),
    );
    write_file(&options.out.join("extended.toml"), extended.as_bytes())?;
    write_file(&options.out.join("report.html"), page.as_bytes())?;
    write_json(&options.out.join("discovery.json"), &result)?;
    Ok(result)
}

/// What the checks of `validate` say of the specification that was written: its equations are
/// derived anew and set beside the independent oracle and the emitted source. Null where fields
/// have different orders, for which there are no such checks.
fn validated(path: &str, text: &str, order: Option<usize>) -> Outcome<Value> {
    let checked = model_spec::check(Source::new(path, text));
    let model = checked.map_err(Problem::Specification)?.model;
    let orders = model.orders(order);
    let orders = orders.map_err(|error| Problem::model(&model.source, error))?;
    if orders.iter().any(|other| *other != orders[0]) {
        return Ok(Value::Null);
    }
    let certificate = validate::of(&model, &orders, &[])?;
    let names = |wanted: fn(&Check) -> bool| -> Vec<&str> {
        let checks = certificate.checks.iter().filter(|check| wanted(check));
        checks.map(|check| check.name.as_str()).collect()
    };
    Ok(json!({
        "passed": certificate.passed,
        "checks": names(|check| !check.skipped),
        "failed": names(|check| !check.passed && !check.skipped),
    }))
}

/// The specification's text, the order asked for, and the dataset.
fn inputs(
    spec: &Path,
    dataset: &Path,
    order: Option<&str>,
) -> Outcome<(String, Option<usize>, Dataset)> {
    let model = load(spec)?.model;
    let text = model.source.text.to_string();
    orders(&model, order)?;
    let order = order.and_then(|order| order.trim().parse().ok());
    let dataset = read_dataset(dataset, &model).map_err(Problem::records)?;
    for note in &dataset.notes {
        warn(&format!("note: {note}"));
    }
    Ok((text, order, dataset))
}

/// The null model's fit and the floor there.
fn null(problem: &EstimationProblem<'_>, text: &str, seed: u64) -> Outcome<(Fit, NoiseFloor)> {
    let notes = channel_checks::check(problem, text);
    for note in notes.map_err(Problem::records)? {
        warn(&format!("note: {note}"));
    }
    warn("fitting the model as it is");
    let fit = null_fit(problem, text).map_err(Problem::discovery)?;
    let floor = floor(problem, &fit, seed);
    Ok((fit, floor))
}

fn write_json(path: &Path, document: &Value) -> Outcome {
    write_file(path, format!("{document:#}\n").as_bytes())
}

fn tell(as_json: bool, result: &Value, out: &Path) -> Outcome {
    if as_json {
        return say(&format!("{result:#}\n"));
    }
    let mut text = format!(
        "{}: {}\n",
        out.display(),
        result["verdict"].as_str().unwrap_or("")
    );
    for effect in result["effects"].as_array().into_iter().flatten() {
        let word = |key: &str| effect[key].as_str().unwrap_or("").to_owned();
        text += &format!("  {} on {}\n", word("effect"), word("on"));
    }
    for (name, gap) in result["gap"].as_object().into_iter().flatten() {
        let number = |value: &Value| {
            value
                .as_f64()
                .map_or_else(|| "-".to_owned(), |v| format!("{v:.3e}"))
        };
        let test = gap.get("after").map_or_else(
            || format!("test {}", number(&gap["test"])),
            |after| {
                format!(
                    "test {} -> {}",
                    number(&gap["before"]["test"]),
                    number(&after["test"])
                )
            },
        );
        text += &format!(
            "  {name}: {test} {}, floor {}\n",
            gap["unit"].as_str().unwrap_or(""),
            number(&gap["floor"])
        );
    }
    say(&text)
}
