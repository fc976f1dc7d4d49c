//! Directions of differentiation: by state, inputs and parameters.

use super::check_context::CheckContext;
use crate::differences::{Direction, Slope, slopes};
use crate::oracle::{Oracle, OracleError};
use crate::outputs::requested_jacobians;
use crate::random::Random;
use crate::sampler::Sample;
use crate::sizes;
use eomgen_model_spec::model::ParameterValue;

/// Maximum number of directions at a state. With more variables, random directions are used.
const DIRECTIONS: usize = 40;
/// Maximum number of coordinates up to which every variable has its own direction, and number of directions of larger
/// models.
const SMALL_MODEL_LIMITS: (usize, usize) = (12, 8);

/// Step of the differences of projected states, relative to the sizes of the states.
const TANGENT_STEP: f64 = 1.0 / 128.0;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum VariableKind {
    State,
    Inputs,
    Parameters,
}

/// Returns directions that change one kind of variable each: every single variable, or some single variables and random
/// combinations. With dependent constraints, state directions are tangential to the constraints, and variables that
/// change the constraints are omitted.
pub(super) fn directions(
    judged: &CheckContext<'_>,
    sample: &Sample,
    names: &[String],
    parameters_too: bool,
    random: &mut Random,
) -> Result<Vec<(VariableKind, Direction)>, OracleError> {
    let has_products = names.iter().any(|name| name == "products");
    if !has_products && requested_jacobians(names).is_empty() {
        return Ok(Vec::new());
    }
    let oracle = judged.oracle;
    let (states, inputs) = (oracle.state_length(), oracle.input_count());
    let still = Direction::zero(states, inputs, judged.parameters.len());
    let small = oracle.size() <= SMALL_MODEL_LIMITS.0;
    let mut found = Vec::new();
    for entries in draw_directions(&sizes::state_sizes(oracle)?, small, random) {
        let direction = Direction {
            state: entries,
            ..still.clone()
        };
        found.push((VariableKind::State, direction));
    }
    for entries in draw_directions(&vec![1.0; inputs], small, random) {
        let direction = Direction {
            inputs: entries,
            ..still.clone()
        };
        found.push((VariableKind::Inputs, direction));
    }
    let independent = independent_sizes(judged);
    for entries in draw_directions(&independent, small, random) {
        let direction = Direction {
            parameters: entries,
            ..still.clone()
        };
        if small || parameters_too {
            found.push((VariableKind::Parameters, direction));
        }
    }
    if oracle.has_dependent_constraints() {
        return Ok(move_along_constraints(oracle, sample, found));
    }
    Ok(found)
}

/// Returns the directions that do not change the constraints; state directions are projected to be tangential.
fn move_along_constraints(
    oracle: &Oracle,
    sample: &Sample,
    directions: Vec<(VariableKind, Direction)>,
) -> Vec<(VariableKind, Direction)> {
    let mut found = Vec::new();
    for (kind, mut direction) in directions {
        let is_kept = match kind {
            VariableKind::State => {
                let along = tangent(oracle, sample, &direction.state);
                along.map(|along| direction.state = along).is_some()
            }
            VariableKind::Inputs => !oracle.has_prescribed_motion(),
            VariableKind::Parameters => false,
        };
        if is_kept {
            found.push((kind, direction));
        }
    }
    found
}

/// Returns the derivative of the projected state along a direction; `None` if a projection fails.
fn tangent(oracle: &Oracle, sample: &Sample, direction: &[f64]) -> Option<Vec<f64>> {
    let along = slopes(TANGENT_STEP, |length| {
        let entries = sample.state.iter().zip(direction);
        let mut moved: Vec<f64> = entries.map(|(from, by)| from + length * by).collect();
        let is_found = oracle.project(sample.time, &mut moved, &sample.inputs);
        let entries = moved.into_iter().map(|value| Slope { value, scale: 0.0 });
        is_found.then(|| entries.collect())
    })?;
    Some(along.iter().map(|slope| slope.value).collect())
}

/// Returns the magnitudes of independent parameters; 0 for derived parameters and for parameters with the value 0.
pub(super) fn independent_sizes(judged: &CheckContext<'_>) -> Vec<f64> {
    let parameters = judged.model.parameters.iter().zip(judged.parameters);
    parameters
        .map(|(parameter, value)| match parameter.value {
            ParameterValue::Number(_) => value.abs(),
            ParameterValue::Expression(_) => 0.0,
        })
        .collect()
}

/// Draws vectors with entries of these sizes; with one nonzero entry each if `small` or few entries.
pub(super) fn draw_directions(sizes: &[f64], small: bool, random: &mut Random) -> Vec<Vec<f64>> {
    let alone = |index: usize| {
        let entries = sizes.iter().enumerate();
        let entry = |(other, size): (usize, &f64)| if other == index { *size } else { 0.0 };
        entries.map(entry).collect::<Vec<f64>>()
    };
    let moving: Vec<usize> = (0..sizes.len())
        .filter(|index| sizes[*index] > 0.0)
        .collect();
    if small && moving.len() <= DIRECTIONS {
        return moving.into_iter().map(alone).collect();
    }
    let mut found: Vec<Vec<f64>> = (2..SMALL_MODEL_LIMITS.1)
        .filter_map(|_| random.pick(&moving).map(|index| alone(*index)))
        .collect();
    for _ in 0..2 {
        found.push(
            sizes
                .iter()
                .map(|size| size * random.away_from_zero())
                .collect(),
        );
    }
    found
}
