//! Search for the first time at which a function of a regime reaches one of its limits.
//!
//! `bounds` classifies each function within a step. If the step contains no crossing, it is made. If it
//! contains exactly one crossing, Newton's method locates it. Otherwise the step is halved. The search
//! evaluates bounds instead of samples, so it misses no crossing.
//!
//! Modes too fast for a step are bounded by their amplitudes. A function within rounding of its limit crosses
//! it only if its rate points outward. Otherwise two surfaces within 1e-11 s of each other would be entered and
//! left endlessly.

use fearless_simd::Simd;

use crate::registers::dispatch_registers;

use super::bounds::{Verdict, classify_step};
use super::event_evaluation::Local;
use super::event_function::Limits;
use super::flow::Flow;
use super::regime::Regime;

/// Maximum number of Newton steps to a crossing. Usually two or three are needed.
const MAX_NEWTON_STEPS: usize = 60;

/// Largest error of a step to the zero of a cubic, relative to the bound on the rounding error of the function.
/// This bound is usually pessimistic.
const ROOT_TOLERANCE_ROUNDINGS: f64 = 1e-3;

/// Distance beyond a limit, in rounding errors, above which a function has jumped.
const JUMP_ROUNDINGS: f64 = 64.0;

/// Result of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum SearchResult {
    /// The flow is at the time at which this function reaches its upper or lower limit.
    Limit {
        /// Index of the function.
        event_function: usize,
        /// True for the upper limit.
        upper: bool,
    },
    /// No function reaches a limit before the end of the search.
    Nothing,
}

/// Counters of a search and its scratch memory.
#[derive(Clone, Debug, Default)]
pub(super) struct SearchStatistics {
    /// Number of steps.
    pub steps: u64,
    /// Number of Newton steps.
    pub newton: u64,
    /// Certain crossings within the current step.
    crossings: Vec<Crossing>,
}

/// Searches from the current time of the flow to `end` after its start, s. `first` is the step-table index of
/// the first step, and is set to that of the last step.
#[inline(always)]
pub(super) fn search<S: Simd>(
    simd: S,
    flow: &mut Flow,
    regime: &Regime,
    end: f64,
    first: &mut usize,
    effort: &mut SearchStatistics,
) -> SearchResult {
    let steps = &regime.step_table.steps;
    let last = steps.len() - 1;
    let mut index = (*first).min(last);
    while flow.tau < end {
        // The first step can be the shortest one that extends beyond the end.
        while index < last && steps[index + 1].length >= end - flow.tau {
            index += 1;
        }
        let mut halved = false;
        let outcome = loop {
            match step(simd, flow, regime, index, steps[index].length, end, effort) {
                StepOutcome::Halve if index < last => {
                    index += 1;
                    halved = true;
                }
                StepOutcome::Halve => break search_grazing(flow, regime, end, effort),
                other => break other,
            }
        };
        *first = index;
        flow.end_departures(simd, regime);
        match outcome {
            StepOutcome::Limit(found) => return found,
            StepOutcome::End => return SearchResult::Nothing,
            StepOutcome::Made | StepOutcome::Halve if !halved => index = index.saturating_sub(2),
            StepOutcome::Made | StepOutcome::Halve => {}
        }
    }
    SearchResult::Nothing
}

enum StepOutcome {
    Halve,
    Made,
    End,
    Limit(SearchResult),
}

/// A crossing that certainly occurs.
#[derive(Clone, Copy, Debug)]
struct Crossing {
    event_function: usize,
    upper: bool,
    /// Bounds of the crossing time since the start of the flow, s.
    within: [f64; 2],
    /// Crossing time estimated by the cubic, s.
    guess: f64,
}

/// Searches with steps shorter than those of the step table, down to a length in which no function changes by
/// more than its rounding. A function that grazes its limit then neither reaches nor leaves it.
#[cold]
fn search_grazing(
    flow: &mut Flow,
    regime: &Regime,
    end: f64,
    effort: &mut SearchStatistics,
) -> StepOutcome {
    dispatch_registers!(simd => search_grazing_by(simd, flow, regime, end, effort))
}

#[inline(always)]
fn search_grazing_by<S: Simd>(
    simd: S,
    flow: &mut Flow,
    regime: &Regime,
    end: f64,
    effort: &mut SearchStatistics,
) -> StepOutcome {
    let last = regime.step_table.steps.len() - 1;
    let mut length = regime.step_table.steps[last].length;
    for event_function in 0..regime.event_functions.len() {
        flow.evaluate_function(simd, regime, event_function);
    }
    loop {
        length *= 0.5;
        if !flow.is_finite() {
            return StepOutcome::End;
        }
        if is_still(flow, regime, length) {
            flow.shift(simd, regime, length);
            effort.steps += 1;
            return StepOutcome::Made;
        }
        match step(simd, flow, regime, last, length, end, effort) {
            StepOutcome::Halve => {}
            other => return other,
        }
    }
}

/// Returns true if no function changes by more than its rounding within `length` s.
fn is_still(flow: &Flow, regime: &Regime, length: f64) -> bool {
    let steps = &regime.step_table.steps;
    (0..regime.event_functions.len()).all(|event_function| {
        flow.local(regime, event_function, &steps[steps.len() - 1], |local| {
            let [_, rate, second, third] = local.derivatives.map(f64::abs);
            let fourth = 0.25 * length * local.fourth;
            let moved = length * (rate + 0.5 * length * (second + length * (third + fourth) / 3.0));
            // The rounding of the time limits the accuracy even if the function is exact.
            moved <= local.noise || length <= f64::MIN_POSITIVE
        })
    })
}

/// Tries a step of `length` s, at most the length of the step in the table.
#[inline(always)]
fn step<S: Simd>(
    simd: S,
    flow: &mut Flow,
    regime: &Regime,
    index: usize,
    length: f64,
    end: f64,
    effort: &mut SearchStatistics,
) -> StepOutcome {
    let step = &regime.step_table.steps[index];
    effort.crossings.clear();
    let origin = flow.tau;
    let until = origin + length;
    for event_function in 0..regime.event_functions.len() {
        // Each function has its own interval between evaluations.
        if flow.is_safe(event_function, until) {
            continue;
        }
        if !flow.is_evaluated(event_function) {
            flow.evaluate_function(simd, regime, event_function);
            if let Some(found) = find_reached_limit(flow, regime, event_function) {
                return StepOutcome::Limit(found);
            }
        }
        let limits = regime.event_functions[event_function].limits;
        let verdict = flow.local(
            regime,
            event_function,
            step,
            #[inline(always)]
            |local| classify_step(local, [limits.low, limits.high], length),
        );
        match verdict {
            Verdict::WithinLimits => flow.record_safe_time(event_function, until),
            Verdict::Undecided => return StepOutcome::Halve,
            Verdict::Crossing { upper } => {
                let guess = flow.local(
                    regime,
                    event_function,
                    step,
                    #[inline(always)]
                    |local| Distance::to(local, &limits, upper).first_guess(length),
                );
                effort.crossings.push(Crossing {
                    event_function,
                    upper,
                    within: [origin, until],
                    guess: origin + guess,
                });
            }
        }
    }
    effort.steps += 1;
    let Some(first) = locate_first_crossing(simd, flow, regime, effort) else {
        if until >= end {
            return StepOutcome::End;
        }
        if length == step.length {
            flow.step(simd, regime, step);
        } else {
            flow.shift(simd, regime, length);
        }
        return StepOutcome::Made;
    };
    if flow.tau >= end {
        return StepOutcome::End;
    }
    StepOutcome::Limit(SearchResult::Limit {
        event_function: first.event_function,
        upper: first.upper,
    })
}

/// Moves to the first of the certain crossings: to the crossing with the smallest estimate, then back to those
/// of other functions that turn out to be earlier.
#[inline(always)]
fn locate_first_crossing<S: Simd>(
    simd: S,
    flow: &mut Flow,
    regime: &Regime,
    effort: &mut SearchStatistics,
) -> Option<Crossing> {
    let guesses = effort.crossings.iter().copied();
    let mut first = guesses.reduce(|a, b| if b.guess < a.guess { b } else { a })?;
    flow.shift(simd, regime, first.guess - flow.tau);
    refine_crossing(simd, flow, regime, &first, &mut effort.newton);
    let seeming = first.event_function;
    for crossing in &effort.crossings {
        if crossing.event_function == seeming {
            continue;
        }
        let here = distance(simd, flow, regime, crossing.event_function, crossing.upper);
        if here.value < -here.noise && crossing.within[0] < flow.tau {
            first = Crossing {
                within: [crossing.within[0], crossing.within[1].min(flow.tau)],
                ..*crossing
            };
            let [near, far] = first.within;
            let guess = (flow.tau + here.newton()).clamp(near, far);
            flow.shift(simd, regime, guess - flow.tau);
            refine_crossing(simd, flow, regime, &first, &mut effort.newton);
        }
    }
    Some(first)
}

/// Returns a limit that a function has already reached at the current time.
fn find_reached_limit(flow: &Flow, regime: &Regime, event_function: usize) -> Option<SearchResult> {
    let limits = &regime.event_functions[event_function].limits;
    if flow.is_between(event_function, limits.low, limits.high) {
        return None;
    }
    let step = regime.step_table.steps.last()?;
    let noise = flow.start_rate_noise(regime, event_function);
    let upper = flow.local(regime, event_function, step, |local| {
        [false, true]
            .into_iter()
            .find(|upper| Distance::to(local, limits, *upper).is_reached(noise))
    })?;
    Some(SearchResult::Limit {
        event_function,
        upper,
    })
}

/// Returns a limit that a jump exceeded: a jump of an input, or of the function itself at the switch of another
/// one. Only families that may have jumped are examined.
#[inline(always)]
pub(super) fn find_jumped_function<S: Simd>(
    simd: S,
    flow: &mut Flow,
    regime: &Regime,
    may_have_jumped: impl Fn(usize) -> bool,
) -> Option<SearchResult> {
    for (event_function, of) in regime.event_functions.iter().enumerate() {
        if !may_have_jumped(of.limits.family) {
            continue;
        }
        for upper in [false, true] {
            let here = distance(simd, flow, regime, event_function, upper);
            if here.value < -JUMP_ROUNDINGS * here.noise {
                return Some(SearchResult::Limit {
                    event_function,
                    upper,
                });
            }
        }
    }
    None
}

/// Returns the distance of a function to a limit at the current time, evaluated again.
#[inline(always)]
fn distance<S: Simd>(
    simd: S,
    flow: &mut Flow,
    regime: &Regime,
    event_function: usize,
    upper: bool,
) -> Distance {
    let steps = &regime.step_table.steps;
    flow.evaluate_function(simd, regime, event_function);
    // No mode is fast compared with the shortest step.
    flow.local(
        regime,
        event_function,
        &steps[steps.len() - 1],
        #[inline(always)]
        |local| Distance::to(local, &regime.event_functions[event_function].limits, upper),
    )
}

/// Moves from a time near a crossing to the crossing, and counts the Newton steps.
#[inline(always)]
fn refine_crossing<S: Simd>(
    simd: S,
    flow: &mut Flow,
    regime: &Regime,
    crossing: &Crossing,
    newton: &mut u64,
) {
    let [mut near, mut far] = crossing.within;
    for _ in 0..MAX_NEWTON_STEPS {
        *newton += 1;
        let here = distance(simd, flow, regime, crossing.event_function, crossing.upper);
        // If the distance grows, the motion has not yet turned towards the limit.
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
        // The residual of the cubic and its truncation error are below rounding.
        let squared = shift * shift;
        let rest = here.cubic(shift).abs() + here.fourth * squared * squared / 24.0;
        if settled || rest <= ROOT_TOLERANCE_ROUNDINGS * here.noise {
            return;
        }
    }
}

/// Distance to a limit with its derivatives; the limit is reached at 0.
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

    /// Returns true if the limit is reached at the current time and the motion leads beyond it, given the
    /// rounding error of the rate at the start.
    fn is_reached(&self, start_rate_noise: f64) -> bool {
        let leads_outward = self.rate < -(self.rate_noise + start_rate_noise);
        let is_beyond = self.value < -4.0 * self.noise && self.rate < 0.0;
        is_beyond || (leads_outward && self.value <= 0.0)
    }

    /// Returns the zero of the cubic through value and derivatives, for a certain crossing.
    fn first_guess(&self, length: f64) -> f64 {
        // Zero of the parabola. It is also valid for a motion from rest; if the distance grows first, it is the
        // later zero.
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

    /// Returns the step to a close zero of the cubic.
    fn newton(&self) -> f64 {
        let first = -self.value / self.rate;
        let s = -self.value / (self.rate + 0.5 * first * self.second);
        s - self.cubic(s) / self.slope(s)
    }

    /// Returns the value of the cubic after a time.
    fn cubic(&self, s: f64) -> f64 {
        self.value + s * (self.rate + s * (0.5 * self.second + s * self.third / 6.0))
    }

    /// Returns the derivative of the cubic after a time.
    fn slope(&self, s: f64) -> f64 {
        self.rate + s * (self.second + s * 0.5 * self.third)
    }
}
