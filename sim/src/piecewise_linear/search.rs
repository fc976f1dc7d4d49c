//! The first time at which a function of a regime reaches one of its limits.
//!
//! What each function does within a step is told by `bounds`: if no crossing lies within it,
//! it is made; if exactly one does, that is polished by Newton's method; otherwise the step is
//! halved. Nothing is sampled, nothing can be jumped.
//!
//! Modes too fast for a step are bounded by their amplitudes. Rounding: a function at its
//! limit up to rounding crosses it only if its rate leads outward; otherwise two surfaces
//! left within 1e-11 s of each other would be entered and left for ever.

use fearless_simd::{Level, Simd, dispatch};

use super::bounds::{Verdict, over};
use super::flow::Flow;
use super::functional::Limits;
use super::regime::Regime;
use super::watched::Local;

/// Newton steps towards a crossing; two or three are usual.
const POLISHING: usize = 60;

/// What a step to the zero of a cubic may still be wrong by, relative to the rounding of the
/// function, which is a bound and mostly far from reached.
const REST: f64 = 1e-3;

/// A function that is beyond its limit by more than this many times its rounding has jumped.
const JUMP: f64 = 64.0;

/// What a search found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Found {
    /// The flow stands where this function has reached its upper or lower limit.
    Limit {
        /// The index of the function.
        functional: usize,
        /// Whether it is the upper limit.
        upper: bool,
    },
    /// No function reaches a limit before the end of the search.
    Nothing,
}

/// How a search went, for those who count, and its memory.
#[derive(Clone, Debug, Default)]
pub(super) struct Effort {
    /// Steps made.
    pub steps: u64,
    /// Newton steps made.
    pub newton: u64,
    /// What is certain to be crossed within the present step.
    crossings: Vec<Crossing>,
}

/// Searches from where the flow stands to `end` after its start, s. `first` is the rung to
/// begin with and becomes the one at which the last step was made.
#[inline(always)]
pub(super) fn search<S: Simd>(
    simd: S,
    flow: &mut Flow,
    regime: &Regime,
    end: f64,
    first: &mut usize,
    effort: &mut Effort,
) -> Found {
    let rungs = &regime.ladder.rungs;
    let last = rungs.len() - 1;
    let mut place = (*first).min(last);
    while flow.tau < end {
        // A step that leads beyond the end need not be longer than the first one that does.
        while place < last && rungs[place + 1].length >= end - flow.tau {
            place += 1;
        }
        let mut halved = false;
        let outcome = loop {
            match step(simd, flow, regime, place, rungs[place].length, end, effort) {
                Outcome::Halve if place < last => {
                    place += 1;
                    halved = true;
                }
                Outcome::Halve => break creep(flow, regime, end, effort),
                other => break other,
            }
        };
        *first = place;
        flow.end_departures(simd, regime);
        match outcome {
            Outcome::Limit(found) => return found,
            Outcome::End => return Found::Nothing,
            Outcome::Made | Outcome::Halve if !halved => place = place.saturating_sub(2),
            Outcome::Made | Outcome::Halve => {}
        }
    }
    Found::Nothing
}

enum Outcome {
    Halve,
    Made,
    End,
    Limit(Found),
}

/// A crossing that is certain to come.
#[derive(Clone, Copy, Debug)]
struct Crossing {
    functional: usize,
    upper: bool,
    /// Between these times after the start of the flow, s.
    within: [f64; 2],
    /// The time by the cubic, s.
    guess: f64,
}

/// Steps shorter than those of the ladder, down to where no function moves by more than its
/// rounding: what grazes a limit there neither reaches nor leaves it.
#[cold]
fn creep(flow: &mut Flow, regime: &Regime, end: f64, effort: &mut Effort) -> Outcome {
    dispatch!(Level::new(), simd => creep_by(simd, flow, regime, end, effort))
}

#[inline(always)]
fn creep_by<S: Simd>(
    simd: S,
    flow: &mut Flow,
    regime: &Regime,
    end: f64,
    effort: &mut Effort,
) -> Outcome {
    let last = regime.ladder.rungs.len() - 1;
    let mut length = regime.ladder.rungs[last].length;
    for functional in 0..regime.functionals.len() {
        flow.sum_up(simd, regime, functional);
    }
    loop {
        length *= 0.5;
        if !flow.is_finite() {
            return Outcome::End;
        }
        if is_still(flow, regime, length) {
            flow.shift(simd, regime, length);
            effort.steps += 1;
            return Outcome::Made;
        }
        match step(simd, flow, regime, last, length, end, effort) {
            Outcome::Halve => {}
            other => return other,
        }
    }
}

/// Whether no function moves by more than its rounding within `length` s.
fn is_still(flow: &Flow, regime: &Regime, length: f64) -> bool {
    let rungs = &regime.ladder.rungs;
    (0..regime.functionals.len()).all(|functional| {
        flow.local(regime, functional, &rungs[rungs.len() - 1], |local| {
            let [_, rate, second, third] = local.derivatives.map(f64::abs);
            let fourth = 0.25 * length * local.fourth;
            let moved = length * (rate + 0.5 * length * (second + length * (third + fourth) / 3.0));
            // A limit without rounding of its own still has that of the time.
            moved <= local.noise || length <= f64::MIN_POSITIVE
        })
    })
}

/// Tries a step of `length` s, at most that of the rung.
#[inline(always)]
fn step<S: Simd>(
    simd: S,
    flow: &mut Flow,
    regime: &Regime,
    place: usize,
    length: f64,
    end: f64,
    effort: &mut Effort,
) -> Outcome {
    let rung = &regime.ladder.rungs[place];
    effort.crossings.clear();
    let origin = flow.tau;
    let until = origin + length;
    for functional in 0..regime.functionals.len() {
        // Each function is looked at as often as it asks for.
        if flow.is_safe(functional, until) {
            continue;
        }
        if !flow.is_summed_up(functional) {
            flow.sum_up(simd, regime, functional);
            if let Some(found) = reached(flow, regime, functional) {
                return Outcome::Limit(found);
            }
        }
        let limits = regime.functionals[functional].limits;
        let verdict = flow.local(
            regime,
            functional,
            rung,
            #[inline(always)]
            |local| over(local, [limits.low, limits.high], length),
        );
        match verdict {
            Verdict::Safe => flow.note_safe(functional, until),
            Verdict::Unknown => return Outcome::Halve,
            Verdict::Crossing { upper } => {
                let guess = flow.local(
                    regime,
                    functional,
                    rung,
                    #[inline(always)]
                    |local| Distance::to(local, &limits, upper).first_guess(length),
                );
                effort.crossings.push(Crossing {
                    functional,
                    upper,
                    within: [origin, until],
                    guess: origin + guess,
                });
            }
        }
    }
    effort.steps += 1;
    let Some(first) = first_of_all(simd, flow, regime, effort) else {
        if until >= end {
            return Outcome::End;
        }
        if length == rung.length {
            flow.step(simd, regime, rung);
        } else {
            flow.shift(simd, regime, length);
        }
        return Outcome::Made;
    };
    if flow.tau >= end {
        return Outcome::End;
    }
    Outcome::Limit(Found::Limit {
        functional: first.functional,
        upper: first.upper,
    })
}

/// Goes to the first of the crossings that are certain: to the one that seems to be, then back
/// to those of other functions that turn out to come before.
#[inline(always)]
fn first_of_all<S: Simd>(
    simd: S,
    flow: &mut Flow,
    regime: &Regime,
    effort: &mut Effort,
) -> Option<Crossing> {
    let guesses = effort.crossings.iter().copied();
    let mut first = guesses.reduce(|a, b| if b.guess < a.guess { b } else { a })?;
    flow.shift(simd, regime, first.guess - flow.tau);
    polish(simd, flow, regime, &first, &mut effort.newton);
    let seeming = first.functional;
    for crossing in &effort.crossings {
        if crossing.functional == seeming {
            continue;
        }
        let here = distance(simd, flow, regime, crossing.functional, crossing.upper);
        if here.value < -here.noise && crossing.within[0] < flow.tau {
            first = Crossing {
                within: [crossing.within[0], crossing.within[1].min(flow.tau)],
                ..*crossing
            };
            let [near, far] = first.within;
            let guess = (flow.tau + here.newton()).clamp(near, far);
            flow.shift(simd, regime, guess - flow.tau);
            polish(simd, flow, regime, &first, &mut effort.newton);
        }
    }
    Some(first)
}

/// A limit that a function has reached here already.
fn reached(flow: &Flow, regime: &Regime, functional: usize) -> Option<Found> {
    let limits = &regime.functionals[functional].limits;
    if flow.is_between(functional, limits.low, limits.high) {
        return None;
    }
    let rung = regime.ladder.rungs.last()?;
    let noise = flow.start_rate_noise(regime, functional);
    let upper = flow.local(regime, functional, rung, |local| {
        [false, true]
            .into_iter()
            .find(|upper| Distance::to(local, limits, *upper).is_reached(noise))
    })?;
    Some(Found::Limit { functional, upper })
}

/// A limit that was passed by a jump: of an input, or of the function itself when another
/// one switched; of those groups that may have jumped.
#[inline(always)]
pub(super) fn passed<S: Simd>(
    simd: S,
    flow: &mut Flow,
    regime: &Regime,
    may_have_jumped: impl Fn(usize) -> bool,
) -> Option<Found> {
    for (functional, of) in regime.functionals.iter().enumerate() {
        if !may_have_jumped(of.limits.group) {
            continue;
        }
        for upper in [false, true] {
            let here = distance(simd, flow, regime, functional, upper);
            if here.value < -JUMP * here.noise {
                return Some(Found::Limit { functional, upper });
            }
        }
    }
    None
}

/// The distance of a function to a limit here, summed up anew.
#[inline(always)]
fn distance<S: Simd>(
    simd: S,
    flow: &mut Flow,
    regime: &Regime,
    functional: usize,
    upper: bool,
) -> Distance {
    let rungs = &regime.ladder.rungs;
    flow.sum_up(simd, regime, functional);
    // The shortest step has no fast modes.
    flow.local(
        regime,
        functional,
        &rungs[rungs.len() - 1],
        #[inline(always)]
        |local| Distance::to(local, &regime.functionals[functional].limits, upper),
    )
}

/// Goes from near a crossing to it, and counts Newton's steps.
#[inline(always)]
fn polish<S: Simd>(
    simd: S,
    flow: &mut Flow,
    regime: &Regime,
    crossing: &Crossing,
    newton: &mut u64,
) {
    let [mut near, mut far] = crossing.within;
    for _ in 0..POLISHING {
        *newton += 1;
        let here = distance(simd, flow, regime, crossing.functional, crossing.upper);
        // A motion that comes nearer no more has not turned back yet.
        if here.value > 0.0 || here.rate > 0.0 {
            near = flow.tau;
        } else {
            far = flow.tau;
        }
        let mut shift = here.newton();
        let next = flow.tau + shift;
        if !(near <= next && next <= far) {
            shift = 0.5 * (near + far) - flow.tau;
        }
        let settled =
            (here.rate * shift).abs() <= here.noise && here.value.abs() <= 8.0 * here.noise;
        if flow.tau + shift == flow.tau {
            return;
        }
        flow.shift(simd, regime, shift);
        // What is left of the cubic, and what it leaves out, are below rounding.
        let squared = shift * shift;
        let rest = here.cubic(shift).abs() + here.fourth * squared * squared / 24.0;
        if settled || rest <= REST * here.noise {
            return;
        }
    }
}

/// A distance to a limit with derivatives; the limit is reached where it is zero.
#[derive(Clone, Copy, Debug)]
struct Distance {
    value: f64,
    rate: f64,
    second: f64,
    third: f64,
    fourth: f64,
    noise: f64,
    rate_noise: f64,
}

impl Distance {
    fn to(local: &Local, limits: &Limits, upper: bool) -> Self {
        let (sign, limit) = if upper {
            (-1.0, limits.high)
        } else {
            (1.0, limits.low)
        };
        let [value, rate, second, third] = local.derivatives;
        Self {
            value: sign * (value - limit),
            rate: sign * rate,
            second: sign * second,
            third: sign * third,
            fourth: local.fourth,
            noise: local.noise,
            rate_noise: local.rate_noise,
        }
    }

    /// Whether the limit is reached here and the motion leads beyond it, given what rounding
    /// at the start may have made of the rate.
    fn is_reached(&self, start_rate_noise: f64) -> bool {
        let leads_outward = self.rate < -(self.rate_noise + start_rate_noise);
        let is_beyond = self.value < -4.0 * self.noise && self.rate < 0.0;
        is_beyond || (leads_outward && self.value <= 0.0)
    }

    /// Where the cubic through value and derivatives crosses zero, for a certain crossing.
    fn first_guess(&self, length: f64) -> f64 {
        // The zero of the parabola, also where the motion starts from rest, and the later one
        // where it turns back.
        let discriminant = (self.rate * self.rate - 2.0 * self.second * self.value).max(0.0);
        let mut s = if self.rate > 0.0 {
            -(discriminant.sqrt() + self.rate) / self.second
        } else {
            2.0 * self.value / (discriminant.sqrt() - self.rate)
        };
        for _ in 0..2 {
            s -= self.cubic(s) / self.slope(s);
        }
        if s >= 0.0 && s <= length {
            s
        } else {
            0.5 * length
        }
    }

    /// The step to the zero of the cubic, from near it.
    fn newton(&self) -> f64 {
        let first = -self.value / self.rate;
        let s = -self.value / (self.rate + 0.5 * first * self.second);
        s - self.cubic(s) / self.slope(s)
    }

    /// The cubic after a time.
    fn cubic(&self, s: f64) -> f64 {
        self.value + s * (self.rate + s * (0.5 * self.second + s * self.third / 6.0))
    }

    /// Its derivative.
    fn slope(&self, s: f64) -> f64 {
        self.rate + s * (self.second + s * 0.5 * self.third)
    }
}
