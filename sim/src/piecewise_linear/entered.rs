//! The regimes of a model: made when a motion first enters them, and kept; and which of them a
//! motion begins in.

use nalgebra::Complex;

use super::beyond::Beyond;
use super::clock::Clock;
use super::coincidence::factor;
use super::decomposition::Failure;
use super::dependents::{Asking, Standing};
use super::error::ExactError;
use super::functional::{Limits, Linear};
use super::groups::Place;
use super::propagator::Propagator;
use super::regime::Regime;
use super::sliding::slide;

/// A regime that has been entered.
pub(super) struct Entered {
    pub places: Vec<Place>,
    pub regime: Regime,
    /// The group's function as the regime has it, for each group.
    pub functions: Vec<Linear>,
    /// The rung at which the last search ended.
    pub rung: usize,
    /// For each function and limit the regime beyond, once it is known.
    pub beyond: Vec<[Option<Beyond>; 2]>,
}

impl Propagator {
    /// A regime that has been made.
    pub(super) fn made(&self, index: usize) -> &Regime {
        &self.regimes[index].regime
    }

    /// The regime with these places, made if it is new.
    pub(super) fn regime(&mut self, places: &[Place], t: f64) -> Result<usize, ExactError> {
        if let Some(&known) = self.known.get(places) {
            return Ok(known);
        }
        let mut sides = vec![0.0; self.evaluator.guard_count()];
        let held = places
            .iter()
            .position(|place| matches!(place, Place::On(_)));
        let (system, mut parts) = match held {
            None => {
                for (group, place) in self.groups.iter().zip(places) {
                    group.write_sides(*place, 0.0, &mut sides);
                }
                (self.evaluator.system(&sides), Vec::new())
            }
            Some(group) => {
                let guard = self.groups[group].first;
                if self.has_dependents()
                    && (0..places.len()).any(|group| self.is_felt(places, group))
                {
                    return Err(ExactError::Held { t, guard });
                }
                let sliding = slide(&mut self.evaluator, &self.groups, places)
                    .ok_or(ExactError::Held { t, guard })?;
                (sliding.system, sliding.parts)
            }
        };
        let functions: Vec<Linear> = self
            .groups
            .iter()
            .map(|group| group.function(&system))
            .collect();
        let mut watched = Vec::new();
        for (index, (group, place)) in self.groups.iter().zip(places).enumerate() {
            watched.push(match place {
                Place::Between(above) => {
                    let function = functions[index].clone();
                    let limits = if self.is_at_rest(&functions, places, index) {
                        Limits::none(index)
                    } else {
                        group.limits(&system, index, *above)
                    };
                    (function, limits)
                }
                Place::On(_) => (
                    parts.remove(0),
                    Limits {
                        group: index,
                        low: 0.0,
                        high: 1.0,
                    },
                ),
            });
        }
        let regime = Regime::new(system, watched, self.slow).map_err(|failure| match failure {
            Failure::NotFinite => ExactError::NotFinite,
            Failure::NotConverged => ExactError::NotConverged,
        })?;
        let beyond = vec![[None; 2]; regime.functionals.len()];
        self.regimes.push(Entered {
            places: places.to_vec(),
            regime,
            functions,
            rung: 0,
            beyond,
        });
        let index = self.regimes.len() - 1;
        self.known.insert(places.to_vec(), index);
        Ok(index)
    }

    /// Whether a function keeps its value throughout the regime with these places, for which it
    /// was decided: it is still, or in proportion to one that is held.
    fn is_at_rest(&self, functions: &[Linear], places: &[Place], group: usize) -> bool {
        let held = |(other, place): (&Linear, &Place)| {
            matches!(place, Place::On(_)) && factor(&functions[group], other).is_some()
        };
        let mut others = functions.iter().zip(places);
        self.has_dependents()
            && (self.dependent[group] && functions[group].is_still() || others.any(held))
    }

    /// The places of all groups at a state, below a threshold that is met, and the groups
    /// and ranks of those that are.
    pub(super) fn places_at(
        &mut self,
        state: &[f64],
        inputs: &[f64],
        phases: &[Complex<f64>],
    ) -> (Vec<Place>, Vec<(usize, usize)>) {
        let mut sides = vec![0.0; self.evaluator.guard_count()];
        let mut places = vec![Place::Between(0); self.groups.len()];
        let mut tied = Vec::new();
        // A function may depend on the places of others: once more until all agree.
        for _ in 0..=self.groups.len() {
            for (group, place) in self.groups.iter().zip(&places) {
                group.write_sides(*place, 0.0, &mut sides);
            }
            let system = self.evaluator.system(&sides);
            tied.clear();
            let mut found = Vec::new();
            for (index, group) in self.groups.iter().enumerate() {
                let value = group.function(&system).value(state, inputs, phases);
                let mut above = 0;
                for rank in 0..group.ranks.len() {
                    let threshold = group.threshold(&system, rank);
                    if (value - threshold).abs() <= 4.0 * f64::EPSILON * threshold.abs() {
                        tied.push((index, rank));
                    } else if value > threshold {
                        above = rank + 1;
                    }
                }
                found.push(Place::Between(above));
            }
            if found == places {
                break;
            }
            places = found;
        }
        (places, tied)
    }

    /// The regime of a motion that begins at a state.
    pub(super) fn regime_at(
        &mut self,
        clock: Clock,
        state: &[f64],
        inputs: &[f64],
    ) -> Result<usize, ExactError> {
        let phases = self.phases_at(clock);
        if self.has_dependents() {
            let standing = Standing {
                state,
                inputs,
                phases: &phases,
            };
            let mut places = vec![Place::Between(0); self.groups.len()];
            self.settle(&mut places, Asking::Start, standing);
            return self.regime(&places, clock.time());
        }
        let (mut places, tied) = self.places_at(state, inputs, &phases);
        let mut found = self.regime(&places, clock.time())?;
        for (group, rank) in tied {
            let mut side = |propagator: &mut Self, place: Place| {
                places[group] = place;
                propagator.regime(&places, clock.time())
            };
            let (down, up) = (
                side(self, Place::Between(rank))?,
                side(self, Place::Between(rank + 1))?,
            );
            let below = self.rate(down, group, state, inputs, &phases);
            let above = self.rate(up, group, state, inputs, &phases);
            found = if above > 0.0 && below >= 0.0 {
                side(self, Place::Between(rank + 1))?
            } else if above < 0.0 && below > 0.0 {
                side(self, Place::On(rank))?
            } else {
                side(self, Place::Between(rank))?
            };
        }
        Ok(found)
    }
}
