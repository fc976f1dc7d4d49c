//! Bounds of a function within a step.
//!
//! At the present time of the flow each function is known with three derivatives and a bound m of
//! the fourth. The cubic through them minus m s^4/24 is a lower bound over a step, 0 <= s <= h, and
//! plus m s^4/24 an upper one; their derivatives bound the rate. In Bernstein's basis the
//! coefficients of a bound enclose it. If those of the lower bound are above the lower limit, and
//! those of the upper bound below the upper limit, the step contains no crossing. If a function
//! certainly ends below its limit, and either falls or is concave throughout the step, the step
//! contains exactly one crossing.
//!
//! Modes too fast for a step are bounded by their amplitudes. After a limit has just been left they
//! are bounded by their rates instead: they change the function by at most their rate times the
//! time.

use super::event_evaluation::Local;

/// Behaviour of a function within a step.
pub(super) enum Verdict {
    /// It keeps its limits.
    WithinLimits,
    /// It crosses a limit, and that once.
    Crossing { upper: bool },
    /// Nothing is certain.
    Undecided,
}

/// Classifies a function between two limits over the next `length` s.
#[inline(always)]
pub(super) fn classify_step(local: &Local, [low, high]: [f64; 2], length: f64) -> Verdict {
    let [value, rate, second, third] = local.derivatives;
    let h = length;
    let (a, b) = (rate * h, 0.5 * second * h * h);
    let (c, m) = (third * h * h * h / 6.0, local.fourth * h * h * h * h / 24.0);
    let (first, middle, late) = (0.25 * a, 0.5 * a + b / 6.0, 0.75 * a + 0.5 * b + 0.25 * c);
    let end = a + b + c;
    let (above, below) = (value - low, high - value);
    let noise = local.noise + local.drift_noise * h;
    // Up to rounding a limit is not reached; moving inward from it is safe.
    let margin = |distance: f64| distance.max(0.0) + noise;
    let room = Room {
        ends: [above + end + m + local.fast, below - end + m + local.fast],
        margins: [above, below].map(|distance| margin(distance) - local.fast),
        margins_here: [
            margin(above + local.fast_here),
            margin(below - local.fast_here),
        ],
        // The coefficients of the rate are four times the differences of the value's, those
        // of the second derivative twelve times the second ones.
        fast_difference: 0.25 * local.fast_rate * h,
        fast_bend: local.fast_second * h * h / 12.0,
        leaves: (rate.abs() - local.fast_rate) * h > 8.0 * noise,
    };
    let bounds = Bounds {
        lower: [0.0, first, middle, late, end - m],
        upper: [0.0, first, middle, late, end + m],
    };
    bounds.judge(&room)
}

/// The distances that a function has to its limits, the lower one first.
struct Room {
    /// The most that can be left at the end of the step.
    ends: [f64; 2],
    /// Distances from the limits at the start for any values of the fast modes, at least the
    /// rounding error.
    margins: [f64; 2],
    /// Distances from the limits at the start for the present values of the fast modes, at least
    /// the rounding error.
    margins_here: [f64; 2],
    /// A bound of the fast modes' contribution to differences of coefficients.
    fast_difference: f64,
    /// The same for second differences.
    fast_bend: f64,
    /// True if the function moves by more than rounding at first.
    leaves: bool,
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
        let [down, up] = [lower.map(|c| -c), *upper];
        let (safe_below, safe_above) = (room.is_kept(0, &down), room.is_kept(1, &up));
        if safe_below && safe_above {
            return Verdict::WithinLimits;
        }
        if safe_above && room.is_crossed(0, upper) {
            return Verdict::Crossing { upper: false };
        }
        if safe_below && room.is_crossed(1, &lower.map(|c| -c)) {
            return Verdict::Crossing { upper: true };
        }
        Verdict::Undecided
    }
}

impl Room {
    /// Returns true if a limit is kept by a function whose way towards it has these bounds.
    #[inline(always)]
    fn is_kept(&self, limit: usize, towards: &[f64; 5]) -> bool {
        let most = towards.iter().fold(0.0, |most, c| greater(*c, most));
        if self.margins[limit] >= most {
            return true;
        }
        let fast = [0.0, 1.0, 2.0, 3.0, 4.0].map(|place| place * self.fast_difference);
        let with_fast = towards.iter().zip(fast);
        let most = with_fast.fold(0.0, |most, (c, fast)| greater(c + fast, most));
        self.margins_here[limit] >= most
    }

    /// Returns true if a limit is crossed, and that once, by a function whose way from it has
    /// these bounds.
    #[inline(always)]
    fn is_crossed(&self, limit: usize, from: &[f64; 5]) -> bool {
        let difference = |place: usize| from[place + 1] - from[place];
        let falls = || (0..4).all(|place| difference(place) + self.fast_difference < 0.0);
        let bends = || {
            let bend = |place: usize| difference(place + 1) - difference(place);
            self.leaves && (0..3).all(|place| bend(place) + self.fast_bend < 0.0)
        };
        self.ends[limit] < 0.0 && (falls() || bends())
    }
}

/// The greater of two numbers, in one instruction: which of them if one is no number is of no
/// concern, as nothing is certain then.
#[inline(always)]
fn greater(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}
