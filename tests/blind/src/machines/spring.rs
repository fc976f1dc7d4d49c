//! Spring between two bodies with its hidden effects. Its laws differ from the laws of the
//! catalogue: contact after backlash or at a stop begins smoothly, and hardening is a hyperbolic
//! sine.

/// Spring with declared stiffness and damping and with hidden effects, which are zero if absent.
#[derive(Clone, Debug, PartialEq)]
pub struct Spring {
    /// Force per deflection.
    pub stiffness: f64,
    /// Force per rate of the deflection.
    pub damping: f64,
    /// Half of the backlash.
    pub play: f64,
    /// Hardening: coefficient of the cubic force at small deflections.
    pub hardening: f64,
    /// Stop on the positive side: stiffness, and deflection at contact.
    pub upper: (f64, f64),
    /// Stop on the negative side: stiffness, and deflection at contact.
    pub lower: (f64, f64),
}

/// Width of the smooth transition to contact, relative to the backlash or to the deflection at
/// contact.
const TRANSITION_FRACTION: f64 = 1.0 / 30.0;

/// Ratio of damping to stiffness of a stop, s.
const STOP_LOSS: f64 = 2e-3;

impl Spring {
    /// Returns the spring without hidden effects.
    pub fn declared(stiffness: f64, damping: f64) -> Self {
        Self {
            stiffness,
            damping,
            play: 0.0,
            hardening: 0.0,
            upper: (0.0, 1.0),
            lower: (0.0, 1.0),
        }
    }

    /// Returns the restoring force for the deflection `p` and its rate `v`.
    pub fn force(&self, p: f64, v: f64) -> f64 {
        let (p_held, v_held) = match self.play > 0.0 {
            true => {
                let (above, meets_above) = smooth_excess(p, self.play);
                let (below, meets_below) = smooth_excess(-p, self.play);
                (above - below, v * (meets_above + meets_below))
            }
            false => (p, v),
        };
        let elastic = if self.hardening > 0.0 {
            let a = (6.0 * self.hardening / self.stiffness).sqrt();
            self.stiffness * (a * p_held).sinh() / a
        } else {
            self.stiffness * p_held
        };
        elastic + self.damping * v_held + stop_force(self.upper, p, v)
            - stop_force(self.lower, -p, -v)
    }
}

/// Returns the force of a stop for a deflection towards the stop. The force is never attractive.
fn stop_force((stiffness, at): (f64, f64), p: f64, v: f64) -> f64 {
    if stiffness == 0.0 {
        return 0.0;
    }
    let (depth, meets) = smooth_excess(p, at);
    (stiffness * (depth + STOP_LOSS * meets * v)).max(0.0)
}

/// Returns the smoothed excess of a deflection over a limit, and its derivative.
fn smooth_excess(p: f64, limit: f64) -> (f64, f64) {
    let excess = p - limit;
    let root = excess.hypot(TRANSITION_FRACTION * limit);
    (0.5 * (excess + root), 0.5 * (1.0 + excess / root))
}

#[cfg(test)]
mod tests {
    use super::Spring;

    #[test]
    fn backlash_is_subtracted_from_large_deflections_only() {
        let mut spring = Spring::declared(100.0, 0.5);
        spring.play = 0.02;
        assert!(spring.force(0.005, 0.0).abs() < 0.005 * 100.0 * 0.01);
        assert!((spring.force(0.1, 0.0) - 100.0 * 0.08).abs() < 1e-3);
        assert!((spring.force(-0.1, -2.0) + 100.0 * 0.08 + 0.5 * 2.0).abs() < 2e-3);
    }

    #[test]
    fn spring_hardens_cubically_and_stop_only_pushes() {
        let mut spring = Spring::declared(100.0, 0.0);
        spring.hardening = 500.0;
        let cubic = |p: f64| 100.0 * p + 500.0 * p.powi(3);
        assert!((spring.force(0.05, 0.0) - cubic(0.05)).abs() < 1e-2 * 500.0 * 0.05f64.powi(3));
        let mut stopped = Spring::declared(0.0, 0.0);
        stopped.upper = (1000.0, 0.1);
        assert!((stopped.force(0.2, 0.0) - 100.0).abs() < 0.1);
        assert_eq!(stopped.force(0.1, -1e3), 0.0);
        assert!(stopped.force(-0.3, 0.0) < 0.1);
        stopped.lower = (1000.0, 0.1);
        assert!((stopped.force(-0.2, 0.0) + 100.0).abs() < 0.1);
    }
}
