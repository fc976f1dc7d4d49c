//! Through a surface: into the regime beyond it, or onto it where the rates lead back.

use super::coincidence::{Crossing, coincident_rank};
use super::dependents::{Asking, Standing};
use super::error::ExactError;
use super::functional::Linear;
use super::groups::Place;
use super::propagator::Propagator;
use super::saltation;

/// A limit that a motion has reached.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limit {
    /// The regime it leaves.
    pub before: usize,
    /// The function that reached its limit, and its group.
    pub functional: usize,
    pub group: usize,
    /// Whether it is the upper limit.
    pub upper: bool,
    /// Whether a jump led over it.
    pub leapt: bool,
    /// When, s.
    pub t: f64,
}

/// How a motion goes on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Passage {
    /// The regime it enters.
    pub after: usize,
    /// Where the constant saltation matrix is kept, if it is constant.
    pub saltation: Option<usize>,
    /// Whether functions of other groups may jump.
    pub moves_others: bool,
}

impl Limit {
    /// The rank of the threshold, given the place of its group, and whether its surfaces are
    /// positive beyond.
    pub fn rank(&self, place: Place) -> (usize, bool) {
        match (place, self.upper) {
            (Place::Between(above), true) => (above, true),
            (Place::Between(above), false) => (above - 1, false),
            (Place::On(rank), upper) => (rank, upper),
        }
    }

    fn outward(&self) -> f64 {
        if self.upper { 1.0 } else { -1.0 }
    }
}

impl Propagator {
    /// How a motion passes a limit of its regime.
    pub(super) fn passage(
        &mut self,
        limit: &Limit,
        standing: Standing<'_>,
    ) -> Result<Passage, ExactError> {
        if self.has_dependents() {
            let after = self.beyond_with_dependents(limit, standing)?;
            return Ok(Passage {
                after,
                saltation: self.saltation(limit, after),
                moves_others: true,
            });
        }
        let Limit { before, group, .. } = *limit;
        let known = self.regimes[before].beyond[limit.functional][usize::from(limit.upper)];
        let beyond = match known {
            Some(beyond) => beyond,
            None => self.find_beyond(limit)?,
        };
        let mut passage = Passage {
            after: beyond.regime,
            saltation: beyond.saltation,
            moves_others: beyond.moves_others,
        };
        if beyond.jumps && !limit.leapt {
            let Standing {
                state,
                inputs,
                phases,
            } = standing;
            let rate = |index: usize| self.rate(index, group, state, inputs, phases);
            let (here, there) = (rate(before), rate(beyond.regime));
            // A motion that has just left the surface, or hardly gets there, has no rate there
            // but rounding.
            let slack = self.rate_rounding(beyond.regime, group, state);
            if there * limit.outward() < -slack && here * limit.outward() > -slack {
                let mut places = self.regimes[before].places.clone();
                places[group] = Place::On(limit.rank(places[group]).0);
                passage.after = self.regime(&places, limit.t)?;
                passage.saltation = None;
                passage.moves_others = true;
            }
        }
        Ok(passage)
    }

    /// The regime beyond a limit where functions feel the sides of others.
    fn beyond_with_dependents(
        &mut self,
        limit: &Limit,
        standing: Standing<'_>,
    ) -> Result<usize, ExactError> {
        let group = limit.group;
        let places = self.regimes[limit.before].places.clone();
        let outline = self.outline(&places);
        let rank = limit.rank(places[group]).0;
        let crossing = Crossing {
            group,
            function: self.outlines[outline].functions[group].clone(),
            threshold: self.outlines[outline].thresholds[group][rank],
            outline,
        };
        let mut after = places.clone();
        after[group] = places[group].beyond(limit.upper);
        if limit.leapt {
            self.settle(&mut after, Asking::Jump(outline), standing);
            return self.regime(&after, limit.t);
        }
        self.settle(&mut after, Asking::Crossing(&crossing), standing);
        if matches!(places[group], Place::Between(_))
            && self.leads_back(limit, &crossing, &after, standing)
        {
            let held = self.held(limit, &crossing, &places, standing);
            let (t, guard) = (limit.t, self.groups[group].ranks[rank][0]);
            let held = held.ok_or(ExactError::Held { t, guard })?;
            return self.regime(&held, limit.t);
        }
        self.regime(&after, limit.t)
    }

    /// Whether the rates beyond a surface lead back to it, where those before lead onto it.
    fn leads_back(
        &mut self,
        limit: &Limit,
        crossing: &Crossing,
        after: &[Place],
        standing: Standing<'_>,
    ) -> bool {
        let after = self.outline(after);
        let (here, _) = self.rate_in(crossing.outline, &crossing.function, standing);
        let (there, slack) = self.rate_in(after, &crossing.function, standing);
        there * limit.outward() < -slack && here * limit.outward() > -slack
    }

    /// The places held on the surface that makes the rates lead back: the one that is crossed
    /// or, of those that coincide with it, the outermost one whose side alone does so.
    fn held(
        &mut self,
        limit: &Limit,
        crossing: &Crossing,
        places: &[Place],
        standing: Standing<'_>,
    ) -> Option<Vec<Place>> {
        let others = (0..places.len())
            .rev()
            .filter(|index| *index != limit.group);
        for index in std::iter::once(limit.group).chain(others) {
            if index != limit.group && !self.dependent[index] {
                continue;
            }
            let outline = &self.outlines[crossing.outline];
            let Some((rank, factor)) = coincident_rank(outline, index, crossing) else {
                continue;
            };
            let upper = limit.upper == (factor > 0.0);
            let inside = Place::Between(if upper { rank } else { rank + 1 });
            if places[index] != inside {
                continue;
            }
            let mut alone = places.to_vec();
            alone[index] = inside.beyond(upper);
            if self.leads_back(limit, crossing, &alone, standing) {
                alone[index] = Place::On(rank);
                return (!self.is_felt(&alone, index)).then_some(alone);
            }
        }
        None
    }

    /// The rate of a function in an outline, and what rounding may make of it.
    pub(super) fn rate_in(
        &self,
        outline: usize,
        function: &Linear,
        standing: Standing<'_>,
    ) -> (f64, f64) {
        let (rate, rounding) = self.outlines[outline].rate(function, standing);
        (
            rate + self.explicit_rate(function, standing.phases),
            rounding,
        )
    }

    /// Where the constant saltation matrix of a passage is kept, if it is constant.
    fn saltation(&mut self, limit: &Limit, after: usize) -> Option<usize> {
        let key = (limit.before, limit.functional, limit.upper, after);
        if let Some(&known) = self.passed.get(&key) {
            return known;
        }
        let entered = &self.regimes[limit.before];
        let functional = &entered.regime.functionals[limit.functional];
        let limits = &functional.limits;
        let held = matches!(self.regimes[after].places[limit.group], Place::On(_));
        let constant = saltation::constant(
            &entered.regime.system,
            &self.regimes[after].regime.system,
            &functional.linear,
            if limit.upper { limits.high } else { limits.low },
        );
        let place = constant.filter(|_| !held).map(|u| {
            self.saltations.push(u);
            self.saltations.len() - 1
        });
        self.passed.insert(key, place);
        place
    }
}
