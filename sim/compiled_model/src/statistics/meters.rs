//! Meters of one motion, which share the states inside its steps.

use eomgen_sim::ode::{Interior, ObservedStep};

use super::meter::Meter;
use super::{Measurement, Quantity};

/// Meters of a motion. Each measures as if it were alone.
#[derive(Clone, Debug, Default)]
pub(crate) struct Meters {
    meters: Vec<Meter>,
    /// Observables at the last of these times.
    observables: Vec<f64>,
    /// Times of the present step at which the quantities are known, s.
    times: Vec<f64>,
    /// Quantities at these times, one row per time; `None` if the state is unknown.
    values: Vec<Option<f64>>,
}

/// Function that writes the observables at a time (s) and a state.
pub(crate) type WriteObservables<'o> = dyn FnMut(f64, &[f64], &mut [f64]) + 'o;

impl Meters {
    /// Creates meters of a motion with a relative tolerance (`None` for an exact motion) of a model with this number of
    /// observables.
    pub fn new(measurements: &[Measurement], tolerance: Option<f64>, observables: usize) -> Self {
        let meters = measurements.iter();
        Self {
            meters: meters.map(|own| Meter::new(*own, tolerance)).collect(),
            observables: vec![0.0; observables],
            ..Self::default()
        }
    }

    /// Continues with a solver of a relative tolerance.
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
    pub fn observe_step(
        &mut self,
        step: &mut ObservedStep<'_>,
        write_observables: &mut WriteObservables<'_>,
    ) {
        let Self {
            meters,
            observables,
            times,
            values,
        } = self;
        let quantities = meters.iter().map(|meter| meter.measurement.quantity);
        let quantities: Vec<Quantity> = quantities.collect();
        let is_observable = |own: &Quantity| matches!(own, Quantity::Observable(_));
        let has_observables = quantities.iter().any(is_observable);
        let is_shared = quantities.len() > 1;
        times.clear();
        values.clear();
        let ((begin, first), (end, last)) = (step.start, step.end);
        let mut value_of = |place: usize, t: f64| {
            let known = is_shared.then(|| times.iter().rposition(|known| *known == t));
            let row = known.flatten().unwrap_or_else(|| {
                let inside;
                let state = if t == begin {
                    Some(first)
                } else if t == end {
                    Some(last)
                } else {
                    inside = (step.state_inside)(t, Interior::Accurate);
                    inside.as_deref()
                };
                if let Some(state) = state.filter(|_| has_observables) {
                    write_observables(t, state, observables);
                }
                let measured = quantities.iter().map(|quantity| match *quantity {
                    Quantity::State(own) => state.map(|state| state[own]),
                    Quantity::Observable(own) => state.map(|_| observables[own]),
                });
                values.extend(measured);
                times.push(t);
                times.len() - 1
            });
            values[row * quantities.len() + place]
        };
        for (place, meter) in meters.iter_mut().enumerate() {
            meter.observe_step((begin, end), &mut |t| value_of(place, t));
        }
    }
}
