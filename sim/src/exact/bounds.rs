//! What a function certainly does within a step.
//!
//! Where the flow stands, each function is known with three derivatives and a bound m of the
//! fourth: the cubic through them minus m s^4/24 is a lower bound over a step, 0 <= s <= h,
//! and plus m s^4/24 an upper one; their derivatives bound its rate. In Bernstein's basis the
//! coefficients of a bound enclose it. If those of the lower one stay above the lower limit,
//! and those of the upper one below the upper limit, no crossing lies within the step. If
//! instead a function must fall all the way and below its limit, exactly one does.
//!
//! Modes too fast for a step are bounded by their amplitudes.

use super::watched::Local;

/// What a step does to a function.
pub(super) enum Verdict {
    /// It keeps its limits.
    Safe,
    /// It crosses a limit, and that once.
    Crossing { upper: bool },
    /// Nothing is certain.
    Unknown,
}

/// What can be said of a function between two limits over the next `length` s.
#[inline(always)]
pub(super) fn over(local: &Local, [low, high]: [f64; 2], length: f64) -> Verdict {
    let [value, rate, second, third] = local.derivatives;
    let h = length;
    let (a, b) = (rate * h, 0.5 * second * h * h);
    let (c, m) = (third * h * h * h / 6.0, local.fourth * h * h * h * h / 24.0);
    let (first, middle, late) = (0.25 * a, 0.5 * a + b / 6.0, 0.75 * a + 0.5 * b + 0.25 * c);
    let end = a + b + c;
    let (above, below) = (value - low, high - value);
    let noise = local.noise + local.drift_noise * h;
    let room = Room {
        above,
        below,
        // Up to rounding a limit is not reached; moving inward from it is safe.
        margin: [above.max(0.0), below.max(0.0)].map(|d| d + noise - local.fast),
        fast: local.fast,
        // The coefficients of the rate are four times the differences of the value's.
        fast_difference: 0.25 * local.fast_rate * h,
    };
    let bounds = Bounds {
        lower: [0.0, first, middle, late, end - m],
        upper: [0.0, first, middle, late, end + m],
    };
    bounds.judge(&room)
}

/// The distances that a function has to its limits.
struct Room {
    above: f64,
    below: f64,
    /// What is left of them below and above for certain, or rounding.
    margin: [f64; 2],
    /// A bound of the fast modes' contribution, and to differences of coefficients.
    fast: f64,
    fast_difference: f64,
}

/// Coefficients of the bounds in Bernstein's basis, relative to the value at the start.
struct Bounds {
    lower: [f64; 5],
    upper: [f64; 5],
}

impl Bounds {
    #[inline(always)]
    fn judge(&self, room: &Room) -> Verdict {
        let Self { lower, upper } = self;
        let [lowest, highest] = self.range();
        let [low_margin, high_margin] = room.margin;
        let safe_below = low_margin + lowest >= 0.0;
        let safe_above = high_margin - highest >= 0.0;
        if safe_below && safe_above {
            return Verdict::Safe;
        }
        let difference = |place: usize| upper[place + 1] - upper[place] + room.fast_difference;
        if safe_above
            && room.above + upper[4] + room.fast < 0.0
            && (0..4).all(|place| difference(place) < 0.0)
        {
            return Verdict::Crossing { upper: false };
        }
        let difference = |place: usize| lower[place + 1] - lower[place] - room.fast_difference;
        if safe_below
            && room.below - lower[4] + room.fast < 0.0
            && (0..4).all(|place| difference(place) > 0.0)
        {
            return Verdict::Crossing { upper: true };
        }
        Verdict::Unknown
    }

    /// What the function stays between.
    fn range(&self) -> [f64; 2] {
        let lowest = self.lower.iter().fold(0.0, |least, c| lesser(*c, least));
        let highest = self.upper.iter().fold(0.0, |most, c| greater(*c, most));
        [lowest, highest]
    }
}

/// The smaller of two numbers, in one instruction: which of them if one is no number is of no
/// concern, as nothing is certain then.
#[inline(always)]
fn lesser(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The greater of two numbers, likewise.
#[inline(always)]
fn greater(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}
