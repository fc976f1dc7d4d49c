//! Bounds of a function within a step.
//!
//! Each function is known at the current time of the flow with three derivatives and a bound m of the fourth
//! derivative. For 0 <= s <= h, the cubic Taylor polynomial minus m s^4/24 is a lower bound and plus m s^4/24
//! an upper bound. Their derivatives bound the rate. In the Bernstein basis the coefficients of a bound enclose
//! its values. If the coefficients of the lower bound are above the lower limit, and those of the upper bound
//! below the upper limit, the step contains no crossing. If a function certainly ends below its lower limit,
//! and is decreasing or concave in the whole step, the step contains exactly one crossing; likewise for the
//! upper limit.
//!
//! Modes too fast for a step are bounded by their amplitudes. Just after a function has left a limit, they are
//! bounded by their rates instead: they change the function by at most their rate times the time.

use super::event_evaluation::Local;

/// Behaviour of a function within a step.
pub(super) enum Verdict {
    /// The function stays within its limits.
    WithinLimits,
    /// The function crosses a limit exactly once.
    Crossing { upper: bool },
    /// The bounds are too wide for a decision.
    Undecided,
}

/// Classifies a function with two limits over the next `length` s.
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
    // A limit is not reached if the distance is within rounding; motion away from the limit is safe.
    let margin = |distance: f64| distance.max(0.0) + noise;
    let room = Room {
        ends: [above + end + m + local.fast, below - end + m + local.fast],
        margins: [above, below].map(|distance| margin(distance) - local.fast),
        margins_here: [
            margin(above + local.fast_here),
            margin(below - local.fast_here),
        ],
        // The coefficients of the rate are 4 times the first differences of the value's coefficients. Those of
        // the second derivative are 12 times the second differences.
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

/// Distances of a function to its lower and to its upper limit.
struct Room {
    /// Largest possible distance at the end of the step; negative beyond the limit.
    ends: [f64; 2],
    /// Smallest distance at the start for any phase of the fast modes, and at least the rounding error.
    margins: [f64; 2],
    /// Distance at the start for the current phase of the fast modes, and at least the rounding error.
    margins_here: [f64; 2],
    /// Bound of the fast modes' contribution to first differences of coefficients.
    fast_difference: f64,
    /// Bound of the fast modes' contribution to second differences of coefficients.
    fast_bend: f64,
    /// True if the function initially changes by more than rounding.
    leaves: bool,
}

/// Bernstein coefficients of the lower and upper bound, relative to the value at the start.
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
    /// Returns true if a function does not reach a limit, given Bernstein coefficients that bound its change
    /// towards this limit.
    #[inline(always)]
    fn is_kept(&self, limit: usize, towards: &[f64; 5]) -> bool {
        let most = towards.iter().fold(0.0, |most, c| greater(*c, most));
        if self.margins[limit] >= most {
            return true;
        }
        let fast = [0.0, 1.0, 2.0, 3.0, 4.0].map(|index| index * self.fast_difference);
        let with_fast = towards.iter().zip(fast);
        let most = with_fast.fold(0.0, |most, (c, fast)| greater(c + fast, most));
        self.margins_here[limit] >= most
    }

    /// Returns true if a function crosses a limit exactly once, given Bernstein coefficients that bound its
    /// change away from this limit.
    #[inline(always)]
    fn is_crossed(&self, limit: usize, from: &[f64; 5]) -> bool {
        let difference = |index: usize| from[index + 1] - from[index];
        let falls = || (0..4).all(|index| difference(index) + self.fast_difference < 0.0);
        let bends = || {
            let bend = |index: usize| difference(index + 1) - difference(index);
            self.leaves && (0..3).all(|index| bend(index) + self.fast_bend < 0.0)
        };
        self.ends[limit] < 0.0 && (falls() || bends())
    }
}

/// Returns the greater of two numbers in one instruction. The result for NaN does not matter, because the
/// verdict is then undecided.
#[inline(always)]
fn greater(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}
