//! Usual rates of measured quantities.

use std::collections::BTreeMap;

use eomgen_model_spec::model::Model;

use crate::model::smoothing::{differentiate_column, smooth_column};
use crate::model::unknowns::ExpectedSensor;
use eomgen_records::dataset::{Dataset, Quantity};

/// Returns the usual rate of each measured observable and coordinate, by its name in the model. It
/// is the RMS of its slope, or of the rate if the rate is measured or given.
pub fn compute_usual_rates(dataset: &Dataset, model: &Model) -> BTreeMap<String, f64> {
    let record = &dataset.train[0];
    let mut rates = BTreeMap::new();
    for (index, coordinate) in dataset.motion.iter().enumerate() {
        let slopes = record.given_motion_rate(index, dataset.motion.len(), model.inputs.len());
        rates.insert(coordinate.clone(), compute_rms(&slopes));
    }
    let channels = dataset.channels.iter().zip(&record.channels);
    for (channel, column) in channels {
        let sensor = ExpectedSensor::from_channel(channel, model);
        let smooth = smooth_column(&record.times, column);
        let smooth: Vec<f64> = smooth.iter().map(|value| sensor.quantity(*value)).collect();
        let (name, slopes) = match channel.quantity {
            // An acceleration does not determine the rate; states and inputs have no site.
            Quantity::Acceleration(_) | Quantity::State(_) | Quantity::Input(_) => continue,
            Quantity::ObservedRate(rate) if rate.times > 1 => continue,
            Quantity::ObservedRate(rate) => (&model.observables[rate.observable].name, smooth),
            Quantity::Rate(coordinate) => (&model.coordinates[coordinate].name, smooth),
            Quantity::Observable(observable) => (
                &model.observables[observable].name,
                differentiate_column(&record.times, &smooth),
            ),
            Quantity::Coordinate(coordinate) => (
                &model.coordinates[coordinate].name,
                differentiate_column(&record.times, &smooth),
            ),
        };
        rates.insert(name.clone(), compute_rms(&slopes));
    }
    rates
}

fn compute_rms(values: &[f64]) -> f64 {
    (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt()
}
