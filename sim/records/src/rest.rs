//! Removal of samples at rest and at reversals of given motion.

use eomgen_model_spec::ids::{CoordinateId, DefinitionId};
use eomgen_model_spec::model::{Expr, ExprKind, Model};

use crate::dataset::{Dataset, Quantity};
use crate::noise;
use crate::record::Record;

/// Rate below which a coordinate counts as at rest, in standard deviations of its noise.
const REST_SPEED_OVER_NOISE: f64 = 4.0;

/// Rate below which a coordinate counts as at rest if no noise is known, relative to the largest rate in the record.
const MIN_RELATIVE_RATE: f64 = 1e-9;

/// Removes samples of inputs while their coordinate is at rest, because the friction force is then unknown.
pub(crate) fn remove_rest(dataset: &mut Dataset, model: &Model) -> Vec<String> {
    let mut notes = Vec::new();
    for place in 0..dataset.channels.len() {
        let Quantity::Input(input) = dataset.channels[place].quantity else {
            continue;
        };
        let coordinates = find_driven_coordinates(model, input);
        let name = &dataset.channels[place].name;
        for record in dataset.train.iter_mut().chain(&mut dataset.test) {
            let resting = find_samples_at_rest(record, model, &coordinates);
            let mut count = 0;
            for (value, rests) in record.channels[place].iter_mut().zip(resting) {
                if rests && value.is_finite() {
                    *value = f64::NAN;
                    count += 1;
                }
            }
            if count > 0 {
                notes.push(format!(
                    "{}: {count} of {} samples of `{name}` are ignored: the friction force at rest and at reversals is unknown",
                    record.name,
                    record.times.len()
                ));
            }
        }
    }
    notes
}

fn find_driven_coordinates(model: &Model, input: usize) -> Vec<usize> {
    let mut found = Vec::new();
    for force in &model.forces {
        if !contains_part(
            model,
            &force.value,
            &|kind| matches!(kind, ExprKind::Input(id) if id.index() == input),
        ) {
            continue;
        }
        for coordinate in 0..model.coordinates.len() {
            let is = |kind: &ExprKind| matches!(kind, ExprKind::Coordinate(id) if *id == CoordinateId::new(coordinate));
            if !found.contains(&coordinate) && contains_part(model, &force.on, &is) {
                found.push(coordinate);
            }
        }
    }
    found
}

fn contains_part(model: &Model, expr: &Expr, is: &dyn Fn(&ExprKind) -> bool) -> bool {
    let mut found = false;
    let mut definitions: Vec<DefinitionId> = Vec::new();
    let mut look = |expr: &Expr, definitions: &mut Vec<DefinitionId>| {
        expr.visit(&mut |part| {
            found |= is(&part.kind);
            if let ExprKind::Definition(id) = part.kind
                && !definitions.contains(&id)
            {
                definitions.push(id);
            }
        });
    };
    look(expr, &mut definitions);
    let mut next = 0;
    while let Some(id) = definitions.get(next).copied() {
        look(&model.definitions[id].value, &mut definitions);
        next += 1;
    }
    found
}

/// Returns true for samples at which a coordinate is at rest or reverses, because the friction force is then unknown.
fn find_samples_at_rest(record: &Record, model: &Model, coordinates: &[usize]) -> Vec<bool> {
    let (inputs, count) = (model.inputs.len(), model.coordinates.len());
    let mut resting = vec![false; record.times.len()];
    for coordinate in coordinates {
        let rates = record.given_motion_rate(*coordinate, count, inputs);
        let largest = rates
            .iter()
            .fold(0.0, |most: f64, rate| most.max(rate.abs()));
        let noise = noise::estimate_noise(&rates).unwrap_or(0.0);
        let least = (REST_SPEED_OVER_NOISE * noise).max(MIN_RELATIVE_RATE * largest);
        for (sample, rests) in resting.iter_mut().enumerate() {
            let near = sample.saturating_sub(1)..(sample + 2).min(rates.len());
            let turns = rates[near].windows(2).any(|pair| pair[0] * pair[1] <= 0.0);
            *rests |= rates[sample].abs() <= least || turns;
        }
    }
    resting
}
