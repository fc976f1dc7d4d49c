//! The band near a switching surface in which rates that grow as a root are interpolated; see `roots`.

/// Fraction to which a switching function falls before its gradient is computed again.
const APPROACH_FRACTION: f64 = 0.25;

/// Band around a switching surface near which rates grow as a root.
pub(super) struct RootBand {
    /// Index of the switching function.
    pub(super) guard: usize,
    /// Value of the switching function at the edge of the band.
    pub(super) width: f64,
    /// Change of the state from the surface to the edge of the band.
    pub(super) to_edge: Vec<f64>,
    /// Derivatives of the switching function with respect to the states.
    pub(super) gradient: Vec<f64>,
}

/// History of a switching function on the way to its surface.
pub(super) struct GuardHistory {
    /// Magnitude of the switching function when its gradient was last computed, or its largest magnitude since
    /// then.
    reference: f64,
    /// Decision about the rates near the surface; `None` until the motion is near it.
    pub(super) decision: Option<RootDecision>,
}

/// Decision about the rates near a surface.
#[derive(Clone, Copy)]
pub(super) struct RootDecision {
    /// True if the rates grow as a root of the switching function.
    pub(super) is_root: bool,
    /// Value of the switching function at the edge of the band.
    pub(super) width: f64,
}

impl GuardHistory {
    /// History before the first point.
    pub(super) const fn new() -> Self {
        Self {
            reference: f64::INFINITY,
            decision: None,
        }
    }

    /// Records the magnitude of the switching function. Returns true if its gradient is needed: in the band of
    /// a root, and when the magnitude has fallen to [`APPROACH_FRACTION`] of its reference.
    pub(super) fn follow(&mut self, magnitude: f64) -> bool {
        if let Some(RootDecision { is_root, width }) = self.decision {
            if APPROACH_FRACTION * magnitude <= width {
                return is_root;
            }
            self.decision = None;
            self.reference = magnitude;
        }
        if magnitude >= APPROACH_FRACTION * self.reference {
            self.reference = self.reference.max(magnitude);
            return false;
        }
        self.reference = magnitude;
        true
    }
}

impl RootBand {
    /// Returns the band in which the errors `allowed` to the states can change the sign of a switching function with
    /// this gradient; `None` if they do not change it.
    pub(super) fn new(guard: usize, gradient: &[f64], allowed: &[f64]) -> Option<Self> {
        let changes = gradient.iter().zip(allowed);
        let width: f64 = changes
            .map(|(slope, allowed)| (slope * allowed).abs())
            .sum();
        let steps = gradient.iter().zip(allowed);
        let steps = steps.map(|(slope, allowed)| match *slope == 0.0 {
            true => 0.0,
            false => allowed * slope.signum(),
        });
        width.is_normal().then(|| Self {
            guard,
            width,
            to_edge: steps.collect(),
            gradient: gradient.to_vec(),
        })
    }

    /// Returns the position of a point in the band from the value of the switching function: -1 and 1 at the
    /// edges, larger magnitudes outside.
    pub(super) fn position(&self, value: f64) -> f64 {
        (value / self.width).clamp(-1.0, 1.0)
    }

    /// Returns the state on the surface next to `y`, given the value of the switching function at `y`.
    pub(super) fn state_on_surface(&self, y: &[f64], value: f64) -> Vec<f64> {
        let steps = y.iter().zip(&self.to_edge);
        steps
            .map(|(y, step)| y - step * value / self.width)
            .collect()
    }

    /// Returns the states at the two edges of the band next to `y`, given the position of `y`.
    pub(super) fn edges(&self, y: &[f64], position: f64) -> [Vec<f64>; 2] {
        [-1.0, 1.0].map(|edge| {
            let moved = y.iter().zip(&self.to_edge);
            moved
                .map(|(y, step)| y + step * (edge - position))
                .collect()
        })
    }
}

/// Returns true if the surface `guard` has one of these bands.
pub(super) fn has_band(bands: &[RootBand], guard: usize) -> bool {
    bands.iter().any(|band| band.guard == guard)
}
