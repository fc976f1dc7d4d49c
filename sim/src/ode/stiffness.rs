//! Detects stiffness: stability instead of accuracy limits the steps.
//!
//! Stability limits a step of an explicit method to a few times the fastest decay time, at any tolerance. If
//! the projected number of steps exceeds the limit, a power iteration with differences of the rates finds the
//! fastest decay. The system is stiff if the steps are as long as the stability limit for this decay. Otherwise
//! the motion itself is fast, and the simulation continues to the limit on steps.

use super::error::SolveError;
use super::system::System;

/// Number of steps between two checks: a fraction of a second of computing time.
const STEPS_PER_CHECK: u64 = 1 << 13;

/// Number of successive checks that must exceed the limit.
const MIN_EXCEEDING_CHECKS: u32 = 3;

/// Number of power iterations for the fastest decay; eigenvalues of similar size need not be separated.
const POWER_ITERATIONS: usize = 12;

/// Shortest step that stability limits, in units of the fastest decay time: the decaying component is gone and
/// causes no error.
const MIN_LIMITED_DECAY_TIMES: f64 = 0.3;

/// Shortest step that stability limits for a vibration, which causes errors as long as it lasts.
const MIN_LIMITED_VIBRATION_TIMES: f64 = 2.0;

/// Relative change of the state for differences of the rates.
const DIFFERENCE_FRACTION: f64 = 1e-7;

/// Step rate of a simulation, as of the last check.
pub struct StepRate {
    /// Time (s) and number of steps at the last check.
    last: (f64, u64),
    hopeless: u32,
}

/// Progress of a simulation.
pub struct Progress<'a> {
    /// Current time, s.
    pub t: f64,
    /// Current state.
    pub y: &'a [f64],
    /// Length of a step, s.
    pub step: f64,
    /// Number of steps so far, including rejected ones, and the limit on this number.
    pub steps: (u64, u64),
    /// Limit on the number of steps if stability limits their length.
    pub max_steps_if_stiff: u64,
    /// End of the simulation, s.
    pub end: f64,
}

impl StepRate {
    /// Step rate at the start, whose time is `t` (s).
    pub fn new(t: f64) -> Self {
        Self {
            last: (t, 0),
            hopeless: 0,
        }
    }

    /// Checks the step rate if a check is due.
    ///
    /// # Errors
    /// The system is stiff, and the simulation would not end within the limit on steps.
    pub fn check<S: System + ?Sized>(
        &mut self,
        system: &S,
        progress: &Progress<'_>,
    ) -> Result<(), SolveError> {
        let (t, (steps, most)) = (progress.t, progress.steps);
        let done = steps - self.last.1;
        if done < STEPS_PER_CHECK {
            return Ok(());
        }
        let needed = (progress.end - t) / (t - self.last.0) * done as f64;
        self.last = (t, steps);
        let most = most.min(progress.max_steps_if_stiff);
        if needed < most.saturating_sub(steps) as f64 {
            self.hopeless = 0;
            return Ok(());
        }
        self.hopeless += 1;
        if self.hopeless < MIN_EXCEEDING_CHECKS {
            return Ok(());
        }
        self.hopeless = 0;
        match find_fastest_mode(system, progress) {
            Some(fastest) if fastest.limits(progress.step) => Err(SolveError::Stiff {
                t,
                state: fastest.state,
                within: 1.0 / fastest.rate,
                steps: needed,
            }),
            _ => Ok(()),
        }
    }
}

/// Mode with the fastest divergence or convergence of neighbouring motions.
struct FastestMode {
    /// Magnitude of the eigenvalue, 1/s.
    rate: f64,
    /// True if neighbouring motions converge, instead of oscillating about each other.
    decays: bool,
    /// Index of the state with the largest component.
    state: usize,
}

impl FastestMode {
    /// Returns true if stability for this mode limits steps of this length, s.
    fn limits(&self, step: f64) -> bool {
        let limit = if self.decays {
            MIN_LIMITED_DECAY_TIMES
        } else {
            MIN_LIMITED_VIBRATION_TIMES
        };
        self.rate * step > limit
    }
}

/// Finds the fastest mode at the current state by power iteration.
fn find_fastest_mode<S: System + ?Sized>(
    system: &S,
    progress: &Progress<'_>,
) -> Option<FastestMode> {
    let (t, y) = (progress.t, progress.y);
    let sizes: Vec<f64> = y.iter().map(|y| y.abs().max(progress.step)).collect();
    let mut base = vec![0.0; y.len()];
    let mut moved = base.clone();
    system.rates(t, y, &mut base);
    // Initial direction, relative to the sizes of the states, with all components nonzero.
    let mut direction: Vec<f64> = (0..y.len()).map(|i| 1.0 + 0.1 * (i as f64).cos()).collect();
    let (mut rate, mut along) = (0.0_f64, 0.0_f64);
    for _ in 0..POWER_ITERATIONS {
        let length = direction.iter().map(|d| d * d).sum::<f64>().sqrt();
        if !(length.is_finite() && length > 0.0) {
            return None;
        }
        direction.iter_mut().for_each(|d| *d /= length);
        let steps = direction.iter().zip(&sizes).map(|(d, size)| d * size);
        let near: Vec<f64> = y
            .iter()
            .zip(steps)
            .map(|(y, d)| y + DIFFERENCE_FRACTION * d)
            .collect();
        system.rates(t, &near, &mut moved);
        let differences = moved.iter().zip(&base).zip(&sizes);
        let next: Vec<f64> = differences
            .map(|((a, b), size)| (a - b) / (DIFFERENCE_FRACTION * size))
            .collect();
        rate = next.iter().map(|d| d * d).sum::<f64>().sqrt();
        along = next.iter().zip(&direction).map(|(a, b)| a * b).sum();
        direction = next;
    }
    let most = |(_, a): &(usize, &f64), (_, b): &(usize, &f64)| a.abs().total_cmp(&b.abs());
    let (state, _) = direction.iter().enumerate().max_by(most)?;
    rate.is_finite().then_some(FastestMode {
        rate,
        decays: along < -0.5 * rate,
        state,
    })
}
