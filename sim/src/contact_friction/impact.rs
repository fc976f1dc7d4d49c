//! Impact at a single contact with friction: the rates as functions of the normal impulse (E. J. Routh), with
//! energetic restitution (W. J. Stronge, *Impact Mechanics*, chapter 8). The work of the normal impulse during
//! restitution is e^2 times the work during compression, so no energy is gained.

/// Impact at one contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SingleImpact {
    /// Changes of the rate of the distance and of the slip, by a unit normal impulse and by a unit tangential
    /// impulse.
    pub w: [[f64; 2]; 2],
    /// Rate of the distance (negative) and slip, before the impact.
    pub rates: [f64; 2],
    /// Coefficient of friction.
    pub friction: f64,
    /// Coefficient of restitution.
    pub restitution: f64,
}

/// Largest slip that counts as zero, as a fraction of the largest slip.
const SLIP_ROUNDING: f64 = 1e-14;

/// Maximum number of intervals with constant slip direction: sliding, sticking or reversed sliding, in
/// compression and in restitution.
const MAX_INTERVALS: usize = 8;

/// Returns the normal and the tangential impulse; `None` if the rate of the distance does not return to zero.
pub fn energetic_impulse(impact: &SingleImpact) -> Option<[f64; 2]> {
    let SingleImpact {
        w,
        rates: [mut normal_rate, mut slip],
        friction,
        restitution,
    } = *impact;
    let mut impulse = [0.0, 0.0];
    let mut work = 0.0;
    // Remaining work of restitution; known after compression.
    let mut remaining: Option<f64> = None;
    let smallest_slip = SLIP_ROUNDING * slip.abs().max(w[1][0].abs() * normal_rate.abs() / w[0][0]);
    for _ in 0..MAX_INTERVALS {
        if slip.abs() <= smallest_slip {
            slip = 0.0;
        }
        let ratio = tangential_ratio(&w, friction, slip);
        let normal_growth = w[0][0] + w[0][1] * ratio;
        let slip_growth = w[1][0] + w[1][1] * ratio;
        let until_stop = match slip * slip_growth < 0.0 {
            true => -slip / slip_growth,
            false => f64::INFINITY,
        };
        let until_end = match remaining {
            None if normal_growth > 0.0 => -normal_rate / normal_growth,
            None => f64::INFINITY,
            // v x + a x^2/2 = work
            Some(work) => {
                let root = normal_rate * normal_rate + 2.0 * normal_growth * work;
                2.0 * work / (normal_rate + root.max(0.0).sqrt())
            }
        };
        let length = until_stop.min(until_end);
        if !length.is_finite() {
            return None;
        }
        let done = length * (normal_rate + 0.5 * normal_growth * length);
        impulse[0] += length;
        impulse[1] += ratio * length;
        normal_rate += normal_growth * length;
        slip += slip_growth * length;
        match (&mut remaining, until_end <= until_stop) {
            (Some(_), true) => return Some(impulse),
            (Some(rest), false) => *rest -= done,
            (None, is_end) => {
                work += done;
                if is_end {
                    normal_rate = 0.0;
                    remaining = Some(-work * restitution * restitution);
                    if restitution == 0.0 {
                        return Some(impulse);
                    }
                }
            }
        }
        if until_stop <= until_end {
            slip = 0.0;
        }
    }
    None
}

/// Returns the ratio of tangential to normal impulse at this slip.
fn tangential_ratio(w: &[[f64; 2]; 2], friction: f64, slip: f64) -> f64 {
    if slip != 0.0 {
        return -slip.signum() * friction;
    }
    let sticking = -w[1][0] / w[1][1];
    match sticking.is_finite() {
        true => sticking.clamp(-friction, friction),
        false => 0.0,
    }
}
