//! The first time at which a function of a regime reaches one of its limits.
//!
//! Where the flow stands, each function is known with three derivatives and a bound m of the
//! fourth: for the distance d to a limit the cubic through them minus m s^4/24 is a lower
//! bound over a step, 0 <= s <= h, and plus m s^4/24 an upper one. If the coefficients of the
//! lower bound in Bernstein's basis are positive, no crossing lies within the step, and it
//! is made. If instead the distance must fall all the way and below zero, exactly one
//! crossing lies within it, and it is polished by Newton's method. Otherwise the step is
//! halved. Nothing is sampled, nothing can be jumped.
//!
//! Modes too fast for a step are bounded by their amplitudes. Rounding: a function at its
//! limit up to rounding crosses it only if its rate leads outward; otherwise two surfaces
//! left within 1e-11 s of each other would be entered and left for ever.

use super::flow::{Flow, Local};
use super::functional::Limits;
use super::regime::Regime;

/// Newton steps towards a crossing; two or three are usual.
const POLISHING: usize = 60;

/// What Newton's next step would still correct, relative to the rounding of the function,
/// which is a bound and mostly far from reached.
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

/// What a step does to a function.
enum Verdict {
    Safe,
    Crossing { upper: bool },
    Unknown,
}

/// How a search went, for those who count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Effort {
    /// Steps made.
    pub steps: u64,
    /// Newton steps made.
    pub newton: u64,
}

/// Searches from where the flow stands to `end` after its start, s. `first` is the rung to
/// begin with and is left where the next search should begin.
pub(super) fn search(
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
        loop {
            match step(flow, regime, place, rungs[place].length, end, effort) {
                Outcome::Halve if place < last => {
                    place += 1;
                    halved = true;
                }
                Outcome::Halve => match creep(flow, regime, end, effort) {
                    Outcome::Limit(found) => {
                        *first = place;
                        return found;
                    }
                    Outcome::End => return Found::Nothing,
                    _ => break,
                },
                Outcome::Made => {
                    if !halved {
                        place = place.saturating_sub(1);
                    }
                    break;
                }
                Outcome::End => {
                    *first = place;
                    return Found::Nothing;
                }
                Outcome::Limit(found) => {
                    *first = place;
                    return found;
                }
            }
        }
    }
    *first = place;
    Found::Nothing
}

enum Outcome {
    Halve,
    Made,
    End,
    Limit(Found),
}

/// A crossing that is certain to come.
#[derive(Clone, Copy)]
struct Crossing {
    functional: usize,
    upper: bool,
    /// How long it takes by the cubic, s.
    guess: f64,
}

/// Steps shorter than those of the ladder, down to where no function moves by more than its
/// rounding: what grazes a limit there neither reaches nor leaves it.
fn creep(flow: &mut Flow, regime: &Regime, end: f64, effort: &mut Effort) -> Outcome {
    let last = regime.ladder.rungs.len() - 1;
    let mut length = regime.ladder.rungs[last].length;
    for functional in 0..regime.functionals.len() {
        flow.sum_up(regime, functional);
    }
    loop {
        length *= 0.5;
        if !flow.is_finite() {
            return Outcome::End;
        }
        if is_still(flow, regime, length) {
            flow.shift(regime, length);
            effort.steps += 1;
            return Outcome::Made;
        }
        match step(flow, regime, last, length, end, effort) {
            Outcome::Halve => {}
            other => return other,
        }
    }
}

/// Whether no function moves by more than its rounding within `length` s.
fn is_still(flow: &Flow, regime: &Regime, length: f64) -> bool {
    let rungs = &regime.ladder.rungs;
    (0..regime.functionals.len()).all(|functional| {
        let local = flow.local(regime, functional, &rungs[rungs.len() - 1]);
        let [_, rate, second, third] = local.derivatives.map(f64::abs);
        let fourth = 0.25 * length * local.fourth;
        let moved = length * (rate + 0.5 * length * (second + length * (third + fourth) / 3.0));
        // A limit without rounding of its own still has that of the time.
        moved <= local.noise || length <= f64::MIN_POSITIVE
    })
}

/// Tries a step of `length` s, at most that of the rung.
fn step(
    flow: &mut Flow,
    regime: &Regime,
    place: usize,
    length: f64,
    end: f64,
    effort: &mut Effort,
) -> Outcome {
    let rung = &regime.ladder.rungs[place];
    let (mut earliest, mut crossings): (Option<Crossing>, usize) = (None, 0);
    let until = flow.tau + length;
    for functional in 0..regime.functionals.len() {
        // Each function is looked at as often as it asks for.
        if flow.is_safe(functional, until) {
            continue;
        }
        if !flow.is_summed_up(functional) {
            flow.sum_up(regime, functional);
            if let Some(found) = reached(flow, regime, functional) {
                return Outcome::Limit(found);
            }
        }
        let local = flow.local(regime, functional, rung);
        let limits = regime.functionals[functional].limits;
        match over(&local, [limits.low, limits.high], length) {
            Verdict::Safe => flow.note_safe(functional, until),
            Verdict::Unknown => return Outcome::Halve,
            Verdict::Crossing { upper } => {
                crossings += 1;
                let guess = Distance::to(&local, &limits, upper).first_guess(length);
                if earliest.is_none_or(|other| guess < other.guess) {
                    earliest = Some(Crossing {
                        functional,
                        upper,
                        guess,
                    });
                }
            }
        }
    }
    effort.steps += 1;
    let Some(crossing) = earliest else {
        if flow.tau + length >= end {
            return Outcome::End;
        }
        if length == rung.length {
            flow.step(regime, rung);
        } else {
            flow.shift(regime, length);
        }
        return Outcome::Made;
    };
    let origin = flow.tau;
    flow.shift(regime, crossing.guess);
    polish(flow, regime, &crossing, (origin, length), effort);
    let first = match crossings {
        1 => crossing,
        _ => earliest_of_all(flow, regime, crossing, origin, effort),
    };
    if flow.tau >= end {
        return Outcome::End;
    }
    Outcome::Limit(Found::Limit {
        functional: first.functional,
        upper: first.upper,
    })
}

/// Where a flow stands at one crossing, goes back to those of other functions that turn out
/// to come before.
fn earliest_of_all(
    flow: &mut Flow,
    regime: &Regime,
    crossing: Crossing,
    origin: f64,
    effort: &mut Effort,
) -> Crossing {
    let mut first = crossing;
    for functional in 0..regime.functionals.len() {
        for upper in [false, true] {
            if functional == crossing.functional {
                continue;
            }
            let here = distance(flow, regime, functional, upper);
            if here.value < -here.noise && here.rate < 0.0 {
                let length = flow.tau - origin;
                let guess = (length + here.newton()).clamp(0.0, length);
                flow.shift(regime, origin + guess - flow.tau);
                first = Crossing {
                    functional,
                    upper,
                    guess,
                };
                polish(flow, regime, &first, (origin, length), effort);
            }
        }
    }
    first
}

/// A limit that a function has reached here already.
fn reached(flow: &Flow, regime: &Regime, functional: usize) -> Option<Found> {
    let limits = &regime.functionals[functional].limits;
    if flow.is_between(functional, limits.low, limits.high) {
        return None;
    }
    let local = flow.local(regime, functional, regime.ladder.rungs.last()?);
    [false, true]
        .into_iter()
        .find(|upper| Distance::to(&local, limits, *upper).is_reached())
        .map(|upper| Found::Limit { functional, upper })
}

/// A limit that was passed by a jump: of an input, or of the function itself when another
/// one switched. Functions of the group `except` are where they belong.
pub(super) fn passed(flow: &mut Flow, regime: &Regime, except: Option<usize>) -> Option<Found> {
    for (functional, of) in regime.functionals.iter().enumerate() {
        if Some(of.limits.group) == except {
            continue;
        }
        for upper in [false, true] {
            let here = distance(flow, regime, functional, upper);
            if here.value < -JUMP * here.noise {
                return Some(Found::Limit { functional, upper });
            }
        }
    }
    None
}

/// The distance of a function to a limit here, summed up anew.
fn distance(flow: &mut Flow, regime: &Regime, functional: usize, upper: bool) -> Distance {
    let rungs = &regime.ladder.rungs;
    flow.sum_up(regime, functional);
    // The shortest step has no fast modes.
    let local = flow.local(regime, functional, &rungs[rungs.len() - 1]);
    Distance::to(&local, &regime.functionals[functional].limits, upper)
}

/// Goes from near a crossing to it; it lies within `length` after `origin`.
fn polish(
    flow: &mut Flow,
    regime: &Regime,
    crossing: &Crossing,
    (origin, length): (f64, f64),
    effort: &mut Effort,
) {
    let (mut near, mut far) = (origin, origin + length);
    for _ in 0..POLISHING {
        effort.newton += 1;
        let here = distance(flow, regime, crossing.functional, crossing.upper);
        if here.value > 0.0 {
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
        flow.shift(regime, shift);
        // The rest of a Newton step that small is below rounding.
        let rest = shift
            * shift
            * (here.second.abs() + shift.abs() * (here.third.abs() + here.fourth * shift.abs()));
        if settled || rest <= REST * here.noise {
            return;
        }
    }
}

/// What can be said of a function between two limits over the next `length` s.
fn over(local: &Local, [low, high]: [f64; 2], length: f64) -> Verdict {
    let [value, rate, second, third] = local.derivatives;
    let h = length;
    let (a, b) = (rate * h, 0.5 * second * h * h);
    let (c, m) = (third * h * h * h / 6.0, local.fourth * h * h * h * h / 24.0);
    let (first, middle, late) = (0.25 * a, 0.5 * a + b / 6.0, 0.75 * a + 0.5 * b + 0.25 * c);
    let end = a + b + c;
    let lowest = first.min(middle).min(late).min(end - m).min(0.0);
    let highest = first.max(middle).max(late).max(end + m).max(0.0);
    // Up to rounding a limit is not reached; moving inward from it is safe.
    let (above, below) = (value - low, high - value);
    let noise = local.noise + local.drift_noise * h;
    let low_margin = above.max(0.0) + noise - local.fast;
    let high_margin = below.max(0.0) + noise - local.fast;
    let safe_below = low_margin + lowest >= 0.0;
    let safe_above = high_margin - highest >= 0.0;
    if safe_below && safe_above {
        return Verdict::Safe;
    }
    let slopes = [a, a + 2.0 / 3.0 * b, a + 4.0 / 3.0 * b + c];
    let last = a + 2.0 * b + 3.0 * c;
    let fast_rate = local.fast_rate * h;
    let falls = slopes.iter().fold(last + 4.0 * m, |s, t| s.max(*t)) + fast_rate < 0.0;
    let rises = slopes.iter().fold(last - 4.0 * m, |s, t| s.min(*t)) - fast_rate > 0.0;
    if falls && safe_above && above + end + m + local.fast < 0.0 {
        Verdict::Crossing { upper: false }
    } else if rises && safe_below && below - end + m + local.fast < 0.0 {
        Verdict::Crossing { upper: true }
    } else {
        Verdict::Unknown
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

    /// Whether the limit is reached here and the motion leads beyond it.
    fn is_reached(&self) -> bool {
        let leads_outward = self.rate < -self.rate_noise;
        let is_beyond = self.value < -4.0 * self.noise && self.rate < 0.0;
        is_beyond || (leads_outward && self.value <= 0.0)
    }

    /// Where the cubic through value and derivatives crosses zero, for a certain crossing.
    fn first_guess(&self, length: f64) -> f64 {
        // The zero of the parabola, also where the motion starts from rest.
        let discriminant = (self.rate * self.rate - 2.0 * self.second * self.value).max(0.0);
        let mut s = 2.0 * self.value / (discriminant.sqrt() - self.rate);
        for _ in 0..2 {
            let value =
                self.value + s * (self.rate + s * (0.5 * self.second + s * self.third / 6.0));
            let slope = self.rate + s * (self.second + s * 0.5 * self.third);
            s -= value / slope;
        }
        if s >= 0.0 && s <= length {
            s
        } else {
            0.5 * length
        }
    }

    /// The step to the zero, with the curvature.
    fn newton(&self) -> f64 {
        let first = -self.value / self.rate;
        let curvature = self.rate + 0.5 * first * self.second;
        -self.value / curvature
    }
}
