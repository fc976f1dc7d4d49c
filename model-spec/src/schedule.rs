//! Times of sampled controllers.

/// Times of a controller for given parameter values, in s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Schedule {
    /// Time between two samples.
    pub period: f64,
    /// Time of the first sample.
    pub offset: f64,
    /// Time between a sample and the effect of its outputs.
    pub delay: f64,
}

impl Schedule {
    /// Returns the first time that is not admissible: its name, its value in s, and the requirement.
    pub fn find_fault(&self) -> Option<(&'static str, f64, &'static str)> {
        let not_negative = "a time of 0 or more";
        let times = [
            ("period", self.period, self.period > 0.0, "a time above 0"),
            ("offset", self.offset, self.offset >= 0.0, not_negative),
            ("delay", self.delay, self.delay >= 0.0, not_negative),
        ];
        let mut faults = times.into_iter();
        let fault = faults.find(|(_, time, fits, _)| !(time.is_finite() && *fits));
        fault.map(|(name, time, _, rule)| (name, time, rule))
    }
}
