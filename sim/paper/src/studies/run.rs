//! A motion after its transient, from rest at zero, that can be followed on.

use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::piecewise_linear::Propagator;

use super::arm::Case;
use super::error::StudyError;

/// A recorded motion.
pub(super) struct Run {
    /// Times, s, evenly spaced.
    pub times: Vec<f64>,
    /// The states there.
    pub states: Vec<Vec<f64>>,
    /// When the record begins, s.
    pub begin: f64,
    /// Switches since then.
    pub switches: usize,
    /// Samples per forcing period, and how many there are before the record.
    samples: usize,
    before: usize,
    step: f64,
}

impl Run {
    /// Waits for so many forcing periods.
    pub fn start(
        propagator: &mut Propagator,
        case: &Case,
        waited: usize,
        samples: usize,
    ) -> Result<Self, StudyError> {
        let step = case.period() / samples as f64;
        let begin = (waited * samples) as f64 * step;
        let initial = vec![0.0; propagator.states()];
        let none = HeldInputs::zero(0);
        let transient = propagator.simulate(&initial, (0.0, begin), &[], &none, &mut |_| {})?;
        Ok(Self {
            times: vec![begin],
            states: vec![transient.last],
            begin,
            switches: 0,
            samples,
            before: waited * samples,
            step,
        })
    }

    /// Follows the motion until so many forcing periods are recorded.
    pub fn extend(
        &mut self,
        propagator: &mut Propagator,
        periods: usize,
    ) -> Result<(), StudyError> {
        let new = self.times.len()..=periods * self.samples;
        let times: Vec<f64> = new
            .map(|sample| (self.before + sample) as f64 * self.step)
            .collect();
        let (Some(&end), Some(state)) = (times.last(), self.states.last()) else {
            return Ok(());
        };
        let none = HeldInputs::zero(0);
        let span = (self.end(), end);
        let trajectory = propagator.simulate(state, span, &times, &none, &mut |_| {})?;
        self.switches += trajectory.switches.len();
        self.times.extend(trajectory.times);
        self.states.extend(trajectory.states);
        Ok(())
    }

    /// When the record ends, s.
    pub fn end(&self) -> f64 {
        self.times.last().copied().unwrap_or(self.begin)
    }
}
