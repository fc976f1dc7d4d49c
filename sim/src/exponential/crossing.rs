//! Time of a surface crossing within a step.

use super::surfaces::Side;

/// Number of bisections of the interval with a crossing before its refinement.
const BISECTIONS: usize = 30;

/// Value and rate of a function at one end of a step.
type End = (f64, f64);

/// Returns the time since the start of a step of this length, s, at which a function leaves its side for the
/// first time. The function is approximated by the cubic through values and rates at both ends.
#[inline(always)]
pub fn find_first_crossing(side: Side, (begin, end): (End, End), length: f64) -> Option<f64> {
    let sign = match side {
        Side::Held => return None,
        Side::Below => -1.0,
        Side::Above => 1.0,
    };
    // With this sign the function is positive on its side.
    let (a, da) = ((sign * begin.0).max(0.0), sign * begin.1 * length);
    let (b, db) = (sign * end.0, sign * end.1 * length);
    if b >= 0.0 && (da >= 0.0 || db <= 0.0 || a + da > 0.0) {
        return None;
    }
    find_crossing([a, da, b, db]).map(|s| s * length)
}

/// Returns the first time at which a function becomes negative in a step of length 1; `a` and `da` are value
/// and rate at the start, `b` and `db` at the end.
#[inline(never)]
fn find_crossing([a, da, b, db]: [f64; 4]) -> Option<f64> {
    let (c, d) = (3.0 * (b - a) - 2.0 * da - db, 2.0 * (a - b) + da + db);
    let value = |s: f64| a + s * (da + s * (c + s * d));
    let mut last = 1.0;
    // Minimum of the cubic, if it exists.
    let discriminant = c * c - 3.0 * da * d;
    if discriminant > 0.0 {
        let root = discriminant.sqrt();
        let candidates = [
            (-c + root) / (3.0 * d),
            (-c - root) / (3.0 * d),
            -0.5 * da / c,
        ];
        for s in candidates {
            if s > 0.0 && s < last && value(s) < 0.0 {
                last = s;
            }
        }
    }
    if value(last) >= 0.0 {
        return None;
    }
    // A motion that has just crossed the surface has value 0 at the start. The crossing sought is the later
    // one, at which it leaves the side again.
    let mut first = 0.0;
    if a == 0.0 {
        if da <= 0.0 {
            return Some(0.0);
        }
        first = 1e-6;
        if value(first) < 0.0 {
            return Some(0.0);
        }
    }
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (first + last);
        if value(middle) < 0.0 {
            last = middle;
        } else {
            first = middle;
        }
    }
    Some(last)
}
