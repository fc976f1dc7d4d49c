//! Motion after its transient, from rest at zero. It can be extended.

use eomgen_sim::inputs::HeldInputs;
use eomgen_sim::piecewise_linear::Propagator;

use super::arm::Case;
use super::error::StudyError;

pub(super) struct Run {
    /// Evenly spaced times, s.
    pub times: Vec<f64>,
    /// States at the recorded times.
    pub states: Vec<Vec<f64>>,
    /// Start of the record, s.
    pub begin: f64,
    /// Number of switches in the record.
    pub switches: usize,
    /// Numbers of samples: per forcing period, and before the record.
    samples: usize,
    before: usize,
    step: f64,
}

impl Run {
    /// Simulates the transient, which has `waited` forcing periods.
    pub fn start(
        propagator: &mut Propagator,
        case: &Case,
        waited: usize,
        samples: usize,
    ) -> Result<Self, StudyError> {
        let step = case.period() / samples as f64;
        let begin = (waited * samples) as f64 * step;
        let initial = vec![0.0; propagator.state_count()];
        let none = HeldInputs::zero(0);
        let transient = propagator.simulate(&initial, (0.0, begin), &[], &none, &mut |_| {})?;
        Ok(Self {
            times: vec![begin],
            states: vec![transient.final_state],
            begin,
            switches: 0,
            samples,
            before: waited * samples,
            step,
        })
    }

    /// Extends the record to `periods` forcing periods.
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
        // Without play, the contact changes from one flank of a mesh to the other at one instant.
        let instants = trajectory.events.chunk_by(|a, b| a.t == b.t);
        self.switches += instants.count();
        self.times.extend(trajectory.times);
        self.states.extend(trajectory.states);
        Ok(())
    }

    pub fn end(&self) -> f64 {
        self.times.last().copied().unwrap_or(self.begin)
    }
}
