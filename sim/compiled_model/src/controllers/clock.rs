//! Order of samples and output actions of several controllers.

use std::collections::VecDeque;

use eomgen_model_spec::schedule::Schedule;
use eomgen_sim::ode::Settings;

use super::memory::{NextSample, PendingOutputs};
use crate::error::Error;

/// Largest difference of two times at the same instant, as a fraction of the shortest period. It is far below any
/// intended difference and above the rounding errors of the times.
const COINCIDENCE: f64 = 1e-9;

/// Times of the next samples and pending output actions.
pub struct Clock {
    schedules: Vec<Schedule>,
    /// Index of the next sample of each controller.
    next: Vec<f64>,
    /// Outputs that have not acted yet, in the order of their samples.
    pending: VecDeque<PendingOutputs>,
    shortest: f64,
}

impl Clock {
    /// Creates a clock at a time (s). The first sample of each controller is not before this time.
    pub fn new(schedules: Vec<Schedule>, start: f64) -> Self {
        let periods = schedules.iter().map(|schedule| schedule.period);
        let shortest = periods.reduce(f64::min).unwrap_or(0.0);
        let mut clock = Self {
            next: Vec::with_capacity(schedules.len()),
            pending: VecDeque::new(),
            schedules,
            shortest,
        };
        let within = clock.tolerance(start);
        let first = |schedule: &Schedule| {
            ((start - within - schedule.offset) / schedule.period)
                .ceil()
                .max(0.0)
        };
        clock.next = clock.schedules.iter().map(first).collect();
        clock
    }

    /// Returns the largest difference (s) of times at the same instant.
    pub fn tolerance(&self, t: f64) -> f64 {
        let rounding = 8.0 * f64::EPSILON * t.abs();
        rounding.max(COINCIDENCE * self.shortest)
    }

    /// Checks that each controller has at most as many samples between two times (s) as a solver may take steps.
    ///
    /// # Errors
    /// A period that is too short for the span.
    pub fn check_sample_count(&self, (now, until): (f64, f64)) -> Result<(), Error> {
        let most = Settings::default().max_steps as f64;
        let count = |schedule: &Schedule| (until - now.max(schedule.offset)) / schedule.period;
        match self.schedules.iter().find(|one| count(one) > most) {
            Some(schedule) => Err(Error::Request(format!(
                "the period of a controller, {:e} s, needs {:.1e} samples up to the end, but the limit is {most:e}: \
                 give a longer period, or a shorter time",
                schedule.period,
                count(schedule)
            ))),
            None => Ok(()),
        }
    }

    fn sample_time(&self, controller: usize) -> f64 {
        let schedule = self.schedules[controller];
        schedule.offset + self.next[controller] * schedule.period
    }

    /// Returns the next sample of each controller.
    pub fn next_samples(&self) -> Vec<NextSample> {
        let all = self.schedules.iter().zip(&self.next);
        let sample = |(schedule, number): (&Schedule, &f64)| NextSample {
            period: schedule.period,
            offset: schedule.offset,
            number: *number,
        };
        all.map(sample).collect()
    }

    /// Returns the outputs that have not acted yet, in the order of their samples.
    pub fn pending(&self) -> impl Iterator<Item = &PendingOutputs> {
        self.pending.iter()
    }

    /// Continues at a time (s) with the given next samples and pending outputs. A controller whose sample times differ
    /// from those in `samples` has its next sample after this time.
    pub fn resume(&mut self, t: f64, samples: &[NextSample], pending: &[PendingOutputs]) {
        let within = self.tolerance(t);
        for (controller, known) in samples.iter().enumerate() {
            let Schedule { period, offset, .. } = self.schedules[controller];
            self.next[controller] = match (period, offset) == (known.period, known.offset) {
                true => known.number,
                false => (((t + within - offset) / period).floor() + 1.0).max(0.0),
            };
        }
        self.pending = pending.to_vec().into();
    }

    /// Returns the time (s) of the next sample or action.
    pub fn next_instant(&self) -> Option<f64> {
        let samples = (0..self.schedules.len()).map(|controller| self.sample_time(controller));
        let actions = self.pending.iter().map(|pending| pending.time);
        samples.chain(actions).reduce(f64::min)
    }

    /// Returns the controllers with a sample at an instant.
    pub fn due_samples(&self, instant: f64) -> Vec<usize> {
        let within = self.tolerance(instant);
        let is_due = |controller: &usize| self.sample_time(*controller) <= instant + within;
        (0..self.schedules.len()).filter(is_due).collect()
    }

    /// Moves a controller to its next sample. The outputs of the sample at `instant` act after its delay.
    pub fn complete_sample(&mut self, instant: f64, controller: usize, values: Vec<f64>) {
        self.next[controller] += 1.0;
        self.pending.push_back(PendingOutputs {
            time: instant + self.schedules[controller].delay,
            controller,
            values,
        });
    }

    /// Returns the outputs that act at an instant, in the order of their samples.
    pub fn take_actions(&mut self, instant: f64) -> Vec<PendingOutputs> {
        let within = self.tolerance(instant);
        let all = std::mem::take(&mut self.pending);
        let (due, later): (Vec<_>, Vec<_>) = all
            .into_iter()
            .partition(|pending| pending.time <= instant + within);
        self.pending = later.into();
        due
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn schedule(period: f64, offset: f64, delay: f64) -> Schedule {
        Schedule {
            period,
            offset,
            delay,
        }
    }

    #[test]
    fn rounded_sample_times_coincide() {
        // In floating point, 3*0.1 is greater than 0.3.
        let mut clock = Clock::new(vec![schedule(0.1, 0.0, 0.0), schedule(0.3, 0.0, 0.0)], 0.0);
        let mut taken = Vec::new();
        while taken.len() < 7 {
            let instant = clock.next_instant().expect("a sample");
            let due = clock.due_samples(instant);
            for controller in &due {
                clock.complete_sample(instant, *controller, Vec::new());
            }
            clock.take_actions(instant);
            taken.push(due);
        }
        let (both, one) = (vec![0, 1], vec![0]);
        let one_two = [both.clone(), one.clone(), one.clone()];
        assert_eq!(taken[..6], [&one_two[..], &one_two[..]].concat());
        assert_eq!(taken[6], both);
    }

    #[test]
    fn outputs_act_after_their_delay() {
        let mut clock = Clock::new(vec![schedule(1.0, 0.25, 1.5)], 0.0);
        assert_eq!(clock.next_instant(), Some(0.25));
        assert_eq!(clock.due_samples(0.25), [0]);
        clock.complete_sample(0.25, 0, vec![7.0]);
        assert_eq!(clock.next_instant(), Some(1.25));
        assert!(clock.take_actions(1.25).is_empty());
        assert_eq!(clock.due_samples(1.25), [0]);
        clock.complete_sample(1.25, 0, vec![8.0]);
        assert_eq!(clock.next_instant(), Some(1.75));
        assert!(clock.due_samples(1.75).is_empty());
        let due = clock.take_actions(1.75);
        assert_eq!((due.len(), due[0].values[0]), (1, 7.0));
    }

    #[test]
    fn continuation_takes_each_sample_once() {
        let mut clock = Clock::new(vec![schedule(0.1, 0.0, 0.25)], 0.0);
        for sample in 0..4 {
            let instant = clock.next_instant().expect("a sample");
            clock.complete_sample(instant, 0, vec![f64::from(sample)]);
            clock.take_actions(instant);
        }
        let pending: Vec<_> = clock.pending().cloned().collect();
        assert_eq!(pending.len(), 3);
        // The samples at 0.3 s have been taken. With a period of 0.15 s the sample at 0.3 s has been taken too.
        for (period, next) in [(0.1, 0.4), (0.15, 0.45), (0.08, 0.32)] {
            let mut other = Clock::new(vec![schedule(period, 0.0, 0.25)], 0.3);
            other.resume(0.3, &clock.next_samples(), &pending);
            let found = other.sample_time(0);
            assert!((found - next).abs() < 1e-12, "{found}, {next}");
            assert!(other.pending().eq(&pending));
        }
    }

    #[test]
    fn first_sample_is_not_before_the_start() {
        let first = |start: f64| Clock::new(vec![schedule(0.1, 0.05, 0.0)], start).next_instant();
        assert_eq!(first(0.0), Some(0.05));
        assert_eq!(first(-3.0), Some(0.05));
        let later = first(10.0).expect("a sample");
        assert!((later - 10.05).abs() < 1e-12, "{later}");
    }
}
