//! Meters of one motion, which share the states inside its steps.

use eomgen_sim::ode::ObservedStep;

use super::meter::Meter;
use super::step_quantities::{Observables, QuantityCache, StepQuantities};
use super::{Measurement, Quantity};

/// Meters of a motion. Their results are independent of each other.
#[derive(Clone, Debug, Default)]
pub(crate) struct Meters {
    meters: Vec<Meter>,
    cache: QuantityCache,
}

impl Meters {
    /// Creates meters of a motion with a relative tolerance (`None` for an exact motion). `observables` is the number
    /// of observables of the model.
    pub fn new(measurements: &[Measurement], tolerance: Option<f64>, observables: usize) -> Self {
        let meters = measurements.iter();
        Self {
            meters: meters.map(|own| Meter::new(*own, tolerance)).collect(),
            cache: QuantityCache::new(observables),
        }
    }

    /// Continues with a solver of another relative tolerance.
    pub fn continue_with(&mut self, tolerance: f64) {
        for meter in &mut self.meters {
            meter.continue_with(tolerance);
        }
    }

    pub fn is_empty(&self) -> bool {
        self.meters.is_empty()
    }

    /// Returns the statistics of the motion so far; `None` before the first measured step.
    pub fn results(&self) -> Vec<Option<f64>> {
        self.meters.iter().map(Meter::result).collect()
    }

    /// Measures a step.
    pub fn observe_step(&mut self, step: &mut ObservedStep<'_>, observables: &mut dyn Observables) {
        let quantities = self.meters.iter().map(|meter| meter.measurement.quantity);
        let quantities: Vec<Quantity> = quantities.collect();
        self.cache.clear();
        let span = (step.start.0, step.end.0);
        let mut inside = StepQuantities {
            quantities: &quantities,
            step,
            observables,
            cache: &mut self.cache,
        };
        for (place, meter) in self.meters.iter_mut().enumerate() {
            meter.observe_step(span, &mut inside.quantity(place));
        }
    }
}
