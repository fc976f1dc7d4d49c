//! Drifts of distances by rounding errors of rates that surfaces hold.

/// Direction of the force of a surface that holds the motion, and the rounding errors of the held rates.
pub(crate) struct HeldDirection {
    /// Accelerations by the whole force, one for each degree of freedom.
    pub column: Vec<f64>,
    /// Time at which the surface began to hold, s.
    pub since: f64,
    /// Rounding error of the rates, relative to `column`: constant part in s, and growth per second.
    pub roundings: [f64; 2],
}

/// Drift of a distance due to rounding errors of the rate that one surface holds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Drift {
    /// Time at which the surface began to hold, s.
    pub since: f64,
    /// Rate, in the unit of the distance per second.
    pub rate: f64,
    /// Growth of the rate, per second.
    pub growth: f64,
}

impl Drift {
    /// Returns the largest drift of the distance at a time (s).
    pub fn distance(self, t: f64) -> f64 {
        let elapsed = (t - self.since).max(0.0);
        elapsed * (self.rate + 0.5 * self.growth * elapsed)
    }

    /// Returns the largest rate of the drift at a time (s).
    pub fn rate(self, t: f64) -> f64 {
        self.rate + self.growth * (t - self.since).max(0.0)
    }
}
