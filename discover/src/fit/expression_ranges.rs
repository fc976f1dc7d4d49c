//! Ranges of expressions of a model along the motions of a fit.

use std::collections::{BTreeMap, BTreeSet};

use eomgen_codegen::program::evaluator::Point;
use eomgen_model_spec::edit::{self, Edit, NewTerm, Section};

use crate::fit::fit_result::Fit;
use crate::fit::shooting::Shooting;
use crate::ids::{ObservableId, WindowId};
use crate::interval::Interval;
use crate::model::estimation_model::EstimationModel;
use crate::model::problem::EstimationProblem;
use crate::model::specification_texts::edited_source;
use crate::thresholds;

/// Returns the smallest and largest value of each expression along the training windows of a fit,
/// SI. Windows whose simulation failed are left out.
pub fn compute_ranges(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    expressions: &BTreeSet<String>,
) -> BTreeMap<String, Interval> {
    let Some((model, shown)) = with_observables(problem, fit, expressions) else {
        return BTreeMap::new();
    };
    let theta = &fit.train.estimate.theta;
    let whole = Shooting::new(problem, &model, &problem.train, &fit.unknowns, &fit.ranges);
    let mut evaluator = model.create_evaluator(&whole.parameter_values(theta));
    let values = fit.training_shooting(problem).parameter_values(theta);
    let Ok(mut simulation) = fit.model.create_simulation(&values) else {
        return BTreeMap::new();
    };
    let nothing = Interval::new(f64::INFINITY, f64::NEG_INFINITY);
    let mut found = vec![nothing; shown.len()];
    let mut observables = vec![0.0; model.program().observables.len()];
    let all = problem.train.windows.len();
    let count = all.min(thresholds::MAX_SCREENING_WINDOWS);
    for window in (0..count).map(|k| WindowId::new(k * all / count)) {
        let initial = &fit.train.estimate.initial_states[window];
        let window = &problem.train.windows[window];
        let inputs = problem.train.inputs(window);
        let states = simulation.simulate_states(initial, &window.times, inputs);
        for (t, state) in window.times.iter().zip(states.unwrap_or_default()) {
            let point = Point {
                t: *t,
                state: &state,
                inputs: &inputs.evaluate(*t),
            };
            evaluator.observables(point, &mut observables);
            for (travel, observable) in found.iter_mut().zip(&shown) {
                let value = observables[*observable];
                *travel = Interval::new(travel.low.min(value), travel.high.max(value));
            }
        }
    }
    let found = expressions.iter().cloned().zip(found);
    found
        .filter(|(_, travel)| travel.low.is_finite() && travel.high.is_finite())
        .collect()
}

/// Derives the equations of a fit with an observable for each expression; `None` if an expression
/// cannot be added.
fn with_observables(
    problem: &EstimationProblem<'_>,
    fit: &Fit,
    expressions: &BTreeSet<String>,
) -> Option<(EstimationModel, Vec<ObservableId>)> {
    let name = |number: usize| format!("travel_of_place_{number}");
    let edits = expressions.iter().enumerate().map(|(number, expression)| {
        Edit::AddTerm(NewTerm {
            section: Section::Observables,
            name: name(number),
            value: expression.clone(),
            doc: String::new(),
            source: String::new(),
        })
    });
    let edits: Vec<Edit> = edits.collect();
    let source = edited_source(&problem.path, &fit.texts.full);
    let text = edit::apply(&source, &edits).ok()?;
    let model = EstimationModel::derive_equations(&text, &problem.path, problem.order, &[]).ok()?;
    if model.states != fit.model.states {
        return None;
    }
    let observable = |number: usize| {
        let mut observables = model.specification().observables.iter();
        let position = observables.position(|observable| observable.name == name(number));
        position.map(ObservableId::new)
    };
    let shown = (0..edits.len()).map(observable).collect::<Option<Vec<_>>>();
    let shown = shown?;
    Some((model, shown))
}
