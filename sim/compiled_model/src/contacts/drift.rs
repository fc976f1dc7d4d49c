//! Drifts of distances by the rounding of rates that surfaces hold.

/// Accelerations by the force of a surface that holds, and the rounding with which it holds the rates.
pub(crate) struct HeldDirection {
    /// Accelerations by the whole force, one for each degree of freedom.
    pub column: Vec<f64>,
    /// Time since which the surface holds, s.
    pub since: f64,
    /// Rounding of the rates at once and per second, relative to `column`, s and 1.
    pub roundings: [f64; 2],
}

/// Rounding of the rate of a distance by one surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct Drift {
    /// Time since which the surface holds, s.
    pub since: f64,
    /// Rate, in the unit of the distance per second.
    pub rate: f64,
    /// Growth of the rate, per second.
    pub growth: f64,
}

impl Drift {
    /// Returns the largest drift of the distance at a time, s.
    pub fn distance(self, t: f64) -> f64 {
        let elapsed = (t - self.since).max(0.0);
        elapsed * (self.rate + 0.5 * self.growth * elapsed)
    }

    /// Returns the largest rate of the drift at a time, s.
    pub fn rate(self, t: f64) -> f64 {
        self.rate + self.growth * (t - self.since).max(0.0)
    }
}
