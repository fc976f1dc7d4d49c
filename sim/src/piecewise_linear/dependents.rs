//! Surfaces whose functions feel the sides of others, as that of sign(deadzone(p, b)) does, or
//! are of inputs alone. Within a regime such a function may have one value throughout: it is
//! on no side of a threshold then that it equals, and nothing is to be watched. Whenever
//! another surface is crossed, or an input jumps, its place is decided anew: by its value, and
//! on a threshold by its rates.

use nalgebra::Complex;

use super::coincidence::{Crossing, coincident_rank};
use super::groups::Place;
use super::propagator::Propagator;

/// A value is on a threshold if it differs by no more than this part of its terms.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Where a motion stands when places are decided.
#[derive(Clone, Copy)]
pub(super) struct Standing<'a> {
    pub state: &'a [f64],
    pub inputs: &'a [f64],
    pub phases: &'a [Complex<f64>],
}

/// What asks for a decision.
#[derive(Clone, Copy)]
pub(super) enum Asking<'a> {
    /// A motion that begins.
    Start,
    /// Inputs that changed, or a function that a jump led over its limit, in the regime with
    /// this outline.
    Jump(usize),
    /// A surface that is crossed.
    Crossing(&'a Crossing),
}

impl Propagator {
    /// Whether any surface depends on others.
    pub(super) fn has_dependents(&self) -> bool {
        self.dependent.contains(&true)
    }

    /// Decides the places of dependent functions, and of all at a start, inner ones first; until
    /// they agree with each other, or as often as there are any.
    pub(super) fn settle(
        &mut self,
        places: &mut [Place],
        asking: Asking<'_>,
        standing: Standing<'_>,
    ) {
        for _ in 0..=places.len() {
            let before = places.to_vec();
            for group in 0..places.len() {
                if self.dependent[group] || matches!(asking, Asking::Start) {
                    places[group] = self.decided(group, places, asking, standing);
                }
            }
            if places == before {
                return;
            }
        }
    }

    /// Decides only those that have one value throughout the regime with these places.
    pub(super) fn settle_resting(&mut self, places: &mut [Place], standing: Standing<'_>) {
        for _ in 0..=places.len() {
            let before = places.to_vec();
            for group in 0..places.len() {
                if self.dependent[group] {
                    let outline = self.outline(places);
                    if let Some(place) = self.outlines[outline].resting(group, standing.inputs) {
                        places[group] = place;
                    }
                }
            }
            if places == before {
                return;
            }
        }
    }

    /// Whether any function feels on which side of its threshold a group is that is held there:
    /// others may then be in other places on either side, and no combination of two regimes
    /// tells the motion.
    pub(super) fn is_felt(&mut self, places: &[Place], group: usize) -> bool {
        let Place::On(rank) = places[group] else {
            return false;
        };
        let mut beside = |place: Place| {
            let mut places = places.to_vec();
            places[group] = place;
            self.outline(&places)
        };
        let [below, above] = [Place::Between(rank), Place::Between(rank + 1)].map(&mut beside);
        let (below, above) = (&self.outlines[below], &self.outlines[above]);
        (0..places.len()).any(|other| !below.same_function(above, other))
    }

    fn decided(
        &mut self,
        group: usize,
        places: &[Place],
        asking: Asking<'_>,
        standing: Standing<'_>,
    ) -> Place {
        let present = places[group];
        let here = self.outline(places);
        let outline = &self.outlines[here];
        if let Some(place) = outline.resting(group, standing.inputs) {
            return place;
        }
        let before = match asking {
            Asking::Start => None,
            Asking::Jump(before) => Some(before),
            Asking::Crossing(crossing) => {
                if crossing.group == group {
                    return present;
                }
                if let Some((rank, _)) = coincident_rank(outline, group, crossing) {
                    return self.led(group, rank, places, standing);
                }
                Some(crossing.outline)
            }
        };
        if before.is_some_and(|before| outline.same_function(&self.outlines[before], group)) {
            return present;
        }
        let function = &outline.functions[group];
        let value = function.value(standing.state, standing.inputs, standing.phases);
        let thresholds = &outline.thresholds[group];
        let size = match before {
            // A motion begins where it is said to.
            None => 0.0,
            Some(_) => function.size(standing.state, standing.inputs, standing.phases),
        };
        let tied = thresholds.iter().position(|threshold| {
            (value - threshold).abs() <= ROUNDING * size.max(threshold.abs())
        });
        match tied {
            Some(rank) if before.is_some() && is_beside(present, rank) => present,
            Some(rank) => self.led(group, rank, places, standing),
            None => outline.place_at(group, value),
        }
    }

    /// Where the rates on both sides of a threshold lead a function that is on it.
    fn led(
        &mut self,
        group: usize,
        rank: usize,
        places: &[Place],
        standing: Standing<'_>,
    ) -> Place {
        let mut with = |place: Place| {
            let mut places = places.to_vec();
            places[group] = place;
            self.settle_resting(&mut places, standing);
            places[group] = place;
            let outline = self.outline(&places);
            self.rate_in(outline, &self.outlines[outline].functions[group], standing)
        };
        let (below, slack_below) = with(Place::Between(rank));
        let (above, slack_above) = with(Place::Between(rank + 1));
        let slack = slack_below.max(slack_above);
        if above > slack && below >= -slack || below > slack && above >= -slack {
            Place::Between(rank + 1)
        } else if above < -slack && below > slack {
            Place::On(rank)
        } else if below < -slack && above <= slack || !is_beside(places[group], rank) {
            Place::Between(rank)
        } else {
            places[group]
        }
    }
}

/// Whether a place borders on a threshold.
fn is_beside(place: Place, rank: usize) -> bool {
    match place {
        Place::Between(above) => above == rank || above == rank + 1,
        Place::On(on) => on == rank,
    }
}
