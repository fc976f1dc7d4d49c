//! Maximum step size of an integration with nearly constant steps.

use crate::thresholds;

/// Maximum step, s.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LongestStep(pub f64);

impl LongestStep {
    /// Returns the number of steps for an interval, s. A slightly longer sample interval needs no
    /// additional step.
    pub fn count_steps(self, time: f64) -> usize {
        let steps = (time / self.0 - thresholds::SAMPLING_JITTER).ceil();
        steps.max(1.0) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::LongestStep;

    #[test]
    fn sample_intervals_need_no_additional_steps() {
        let longest = LongestStep(0.005);
        assert_eq!(longest.count_steps(0.005), 1);
        assert_eq!(longest.count_steps(0.00502), 1);
        assert_eq!(longest.count_steps(0.0001), 1);
        assert_eq!(longest.count_steps(0.01), 2);
        assert_eq!(longest.count_steps(1.5), 300);
    }
}
