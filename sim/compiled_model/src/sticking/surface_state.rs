//! States of single surfaces.

/// State of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum SurfaceState {
    /// The sign of the function determines the side.
    Free,
    /// The surface holds the motion, which came from the side `from`, -1 or 1, at the time `since`, s.
    Holding { from: f64, since: f64 },
    /// The surface exerts its largest force towards this side. Other surfaces hold the motion since this time, s. This
    /// ends when its function exceeds the errors `allowed`: constant part, and growth per second.
    Bearing {
        from: f64,
        side: f64,
        since: f64,
        allowed: [f64; 2],
    },
    /// Closed contacts stop the motion since this time, s, and the surface exerts no force. This ends when its function
    /// exceeds the errors `allowed`: constant part, and growth per second.
    Unloaded {
        from: f64,
        since: f64,
        allowed: [f64; 2],
    },
    /// Breakaway to this side has occurred, but the switching function is still zero within rounding; the surface is
    /// displaced by `moved`.
    Leaving { side: f64, moved: f64 },
}

impl SurfaceState {
    pub(super) fn is_on(self) -> bool {
        self.came_from().is_some()
    }

    /// Returns the side from which the motion came, if the surface holds it.
    pub(super) fn came_from(self) -> Option<f64> {
        match self {
            Self::Holding { from, .. }
            | Self::Bearing { from, .. }
            | Self::Unloaded { from, .. } => Some(from),
            Self::Free | Self::Leaving { .. } => None,
        }
    }

    /// Returns true if contacts or other surfaces stopped the motion, but the function has the given value at a time
    /// (s) and is no longer within the allowed errors.
    pub(super) fn is_moved_by_others(self, (t, function): (f64, f64)) -> bool {
        match self {
            Self::Unloaded { since, allowed, .. } | Self::Bearing { since, allowed, .. } => {
                function.abs() > find_allowed(allowed, t - since)
            }
            _ => false,
        }
    }

    /// Returns the displacement of the surface until the motion has left it.
    pub(super) fn displacement(self) -> f64 {
        match self {
            Self::Leaving { side, moved } => side * moved,
            Self::Free | Self::Holding { .. } | Self::Bearing { .. } | Self::Unloaded { .. } => 0.0,
        }
    }
}

/// Returns the side, -1 or 1, from which a motion came to a surface in the given state. `sign` is the sign of its
/// function.
pub(super) fn side_of_arrival(state: SurfaceState, sign: f64) -> f64 {
    let by_sign = if sign < 0.0 { -1.0 } else { 1.0 };
    state.came_from().unwrap_or(by_sign)
}

/// Returns the allowed error of a function after a time (s), from its constant part and its growth per second.
pub(super) fn find_allowed([at_once, per_second]: [f64; 2], elapsed: f64) -> f64 {
    at_once + per_second * elapsed.abs() + f64::MIN_POSITIVE
}
