//! How long steps may be where a motion is followed by steps of about one length.

use crate::thresholds;

/// The longest step, s.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LongestStep(pub f64);

impl LongestStep {
    /// Into how many steps a time, s, is parted. Samples that come a little late need no more.
    pub fn steps(self, time: f64) -> usize {
        let steps = (time / self.0 - thresholds::JITTER).ceil();
        steps.max(1.0) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::LongestStep;

    #[test]
    fn a_time_of_many_samples_has_as_many_steps_as_they() {
        let longest = LongestStep(0.005);
        assert_eq!(longest.steps(0.005), 1);
        assert_eq!(longest.steps(0.00502), 1);
        assert_eq!(longest.steps(0.0001), 1);
        assert_eq!(longest.steps(0.01), 2);
        assert_eq!(longest.steps(1.5), 300);
    }
}
