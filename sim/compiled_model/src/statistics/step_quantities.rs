//! Quantities inside a step, which the meters of a motion share.

use std::collections::HashMap;

use eomgen_codegen::program::evaluator::Enclosure;
use eomgen_sim::ode::{Interior, ObservedStep};

use super::Quantity;
use super::polynomial::chebyshev_point;
use super::state_bounds::{STATE_DEGREE, bound_states};

/// Observables of a model at a point and over a time interval.
pub(crate) trait Observables {
    /// Writes the observables at a time (s) and a state.
    fn write(&mut self, at: (f64, &[f64]), out: &mut [f64]);

    /// Writes the bounds of the observables between two times (s) from bounds of the state. Returns false if no bounds
    /// are known, for example while a surface or a contact holds the motion.
    fn bound(&mut self, span: (f64, f64), state: &[Enclosure], out: &mut [Enclosure]) -> bool;

    /// Returns the number of coordinates and modes.
    fn degrees_of_freedom(&self) -> usize;
}

/// Cache of the quantities in a step.
#[derive(Clone, Debug, Default)]
pub(super) struct QuantityCache {
    /// Observables at the last cached time.
    observables: Vec<f64>,
    bounds: Vec<Enclosure>,
    /// Rows of `values` by time; the key is the bit pattern of the time in s.
    times: HashMap<u64, usize>,
    /// Quantities at the cached times, one row per time; `None` if the state is unknown.
    values: Vec<Option<f64>>,
    /// Rows of `panel_bounds` by panel; the key is the bit pattern of both times in s.
    panels: HashMap<[u64; 2], usize>,
    /// Bounds of the quantities over the cached panels, one row per panel.
    panel_bounds: Vec<Option<Enclosure>>,
}

impl QuantityCache {
    pub fn new(observables: usize) -> Self {
        Self {
            observables: vec![0.0; observables],
            bounds: vec![Enclosure::UNKNOWN; observables],
            ..Self::default()
        }
    }

    pub fn clear(&mut self) {
        self.times.clear();
        self.values.clear();
        self.panels.clear();
        self.panel_bounds.clear();
    }
}

/// Quantities inside a step.
pub(super) struct StepQuantities<'q, 's> {
    pub quantities: &'q [Quantity],
    pub step: &'q mut ObservedStep<'s>,
    pub observables: &'q mut dyn Observables,
    pub cache: &'q mut QuantityCache,
}

impl<'q, 's> StepQuantities<'q, 's> {
    /// Returns the quantity with an index.
    pub fn quantity(&mut self, place: usize) -> QuantityInStep<'_, 'q, 's> {
        QuantityInStep {
            inside: self,
            place,
        }
    }

    fn value(&mut self, place: usize, t: f64) -> Option<f64> {
        let row = match self.cache.times.get(&t.to_bits()) {
            Some(row) => *row,
            None => {
                let state = self.state(t);
                self.add_values(t, state.as_deref())
            }
        };
        self.cache.values[row * self.quantities.len() + place]
    }

    fn bound(&mut self, place: usize, panel: (f64, f64)) -> Option<Enclosure> {
        let row = match self.cache.panels.get(&panel_key(panel)) {
            Some(row) => *row,
            None => self.add_bounds(panel),
        };
        self.cache.panel_bounds[row * self.quantities.len() + place]
    }

    fn state(&mut self, t: f64) -> Option<Vec<f64>> {
        let ((begin, first), (end, last)) = (self.step.start, self.step.end);
        if t == begin {
            Some(first.to_vec())
        } else if t == end {
            Some(last.to_vec())
        } else {
            (self.step.state_inside)(t, Interior::Accurate)
        }
    }

    /// Adds the quantities at a time and returns their row.
    fn add_values(&mut self, t: f64, state: Option<&[f64]>) -> usize {
        let cache = &mut *self.cache;
        let is_observable = |own: &Quantity| matches!(own, Quantity::Observable(_));
        if let Some(state) = state
            && self.quantities.iter().any(is_observable)
        {
            self.observables.write((t, state), &mut cache.observables);
        }
        let measured = self.quantities.iter().map(|quantity| match *quantity {
            Quantity::State(own) => state.map(|state| state[own]),
            Quantity::Observable(own) => state.map(|_| cache.observables[own]),
        });
        cache.values.extend(measured);
        let row = cache.values.len() / self.quantities.len() - 1;
        cache.times.insert(t.to_bits(), row);
        row
    }

    /// Adds the bounds over a panel and returns their row.
    fn add_bounds(&mut self, panel: (f64, f64)) -> usize {
        let bounds = self.state_bounds(panel).map(|state| {
            let known = &mut self.cache.bounds;
            let is_bounded = self.observables.bound(panel, &state, known);
            (state, is_bounded)
        });
        let cache = &mut *self.cache;
        let measured = self.quantities.iter().map(|quantity| {
            let (state, is_bounded) = bounds.as_ref()?;
            let bound = match *quantity {
                Quantity::State(own) => state.get(own),
                Quantity::Observable(own) => cache.bounds.get(own).filter(|_| *is_bounded),
            };
            let is_finite = |bound: &&Enclosure| {
                let value = bound.value();
                value.low.is_finite() && value.high.is_finite()
            };
            bound.filter(is_finite).copied()
        });
        cache.panel_bounds.extend(measured);
        let row = cache.panel_bounds.len() / self.quantities.len() - 1;
        cache.panels.insert(panel_key(panel), row);
        row
    }

    /// Returns the bounds of the state over a panel; `None` if a state inside is unknown.
    fn state_bounds(&mut self, (from, to): (f64, f64)) -> Option<Vec<Enclosure>> {
        let mut states = Vec::with_capacity(STATE_DEGREE + 1);
        for index in 0..=STATE_DEGREE {
            let t = match index {
                0 => from,
                STATE_DEGREE => to,
                _ => from + chebyshev_point(index, STATE_DEGREE) * (to - from),
            };
            let state = self.state(t)?;
            self.add_values(t, Some(&state));
            states.push(state);
        }
        Some(bound_states(
            &states,
            self.observables.degrees_of_freedom(),
            to - from,
        ))
    }
}

/// One quantity inside a step.
pub(super) struct QuantityInStep<'p, 'q, 's> {
    inside: &'p mut StepQuantities<'q, 's>,
    place: usize,
}

impl QuantityInStep<'_, '_, '_> {
    /// Returns the value at a time (s); `None` if the state is unknown.
    pub fn value(&mut self, t: f64) -> Option<f64> {
        self.inside.value(self.place, t)
    }

    /// Returns the bounds between two times (s); `None` if no bounds are known.
    pub fn bound(&mut self, panel: (f64, f64)) -> Option<Enclosure> {
        self.inside.bound(self.place, panel)
    }
}

fn panel_key((from, to): (f64, f64)) -> [u64; 2] {
    [from.to_bits(), to.to_bits()]
}
