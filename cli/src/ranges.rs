//! Warnings about coordinates, states and inputs that leave their ranges.

use eomgen_model_spec::model::Model;
use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::ode::Trajectory;

use crate::error::{Error, Result, warn};

/// Warns about every coordinate, state and input that leaves its range, with the time of the first sample outside.
pub fn warn_of_ranges(model: &Model, trajectory: &Trajectory, inputs: &HeldInputs) -> Result {
    let error = |error| Error::model(&model.source, error);
    let coordinates = model.coordinate_ranges().map_err(error)?;
    for (place, coordinate) in model.coordinates.iter().enumerate() {
        let samples = trajectory.times.iter().zip(&trajectory.states);
        let values = samples.map(|(t, state)| (*t, state[place]));
        let unit = coordinate.unit.to_string();
        warn_of_first(&coordinate.name, &unit, coordinates[place], values);
    }
    let states = model.state_ranges().map_err(error)?;
    for (place, first_order) in model.states.iter().enumerate() {
        let samples = trajectory.times.iter().zip(&trajectory.states);
        let values = samples.map(|(t, state)| {
            let first = state.len() - model.states.len();
            (*t, state[first + place])
        });
        let unit = first_order.unit.to_string();
        warn_of_first(&first_order.name, &unit, states[place], values);
    }
    let ranges = model.input_ranges().map_err(error)?;
    for (place, input) in model.inputs.iter().enumerate() {
        let times = trajectory.times.iter();
        let values = times.map(|t| (*t, inputs.evaluate(*t)[place]));
        warn_of_first(&input.name, &input.unit.to_string(), ranges[place], values);
    }
    Ok(())
}

/// Warns about the first value outside the range.
fn warn_of_first(
    name: &str,
    unit: &str,
    range: Option<(f64, f64)>,
    mut values: impl Iterator<Item = (f64, f64)>,
) {
    let Some((low, high)) = range else { return };
    let outside = |(_, value): &(f64, f64)| !(low..=high).contains(value);
    if let Some((t, value)) = values.find(outside) {
        warn(&format!(
            "warning: `{name}` leaves its range {low} to {high} {unit}: it is {value} at t = {t} s; \
             later results are outside the validity of the model"
        ));
    }
}
