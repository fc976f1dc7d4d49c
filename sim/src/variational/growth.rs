//! Growth of a tangent vector over intervals.

use super::tangent_system::TangentSystem;
use crate::ode::{Settings, SolveError, System, Trajectory, simulate};

const SIZE_SAMPLES: usize = 64;

/// Largest decay exponent of a vector over one piece of an interval. The solver's error is relative to the
/// largest length of the vector. With this limit it remains a small fraction of the last length.
const MAX_SHRINKAGE_EXPONENT: f64 = 4.0;

const MAX_PIECES: u32 = 4096;

/// Times of the measurements of growth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasurementTimes {
    /// Start of the motion, s.
    pub start: f64,
    /// Time before the first measurement, s. In its second half the vector aligns with the fastest growing
    /// direction.
    pub transient: f64,
    /// Time between two measurements, s.
    pub interval: f64,
    /// Number of measurements.
    pub intervals: usize,
}

/// Measured growth of a tangent vector.
#[derive(Clone, Debug, PartialEq)]
pub struct GrowthMeasurements {
    /// Growth exponents ln(|v_after| / |v_before|) of the intervals.
    pub growth_exponents: Vec<f64>,
    /// Number of events over the whole time.
    pub switches: u64,
}

/// Error of the measurement of growth.
#[derive(Clone, Debug, PartialEq)]
pub enum GrowthError {
    /// The simulation of the motion failed.
    Motion(SolveError),
    /// At this time, s, the motion crosses several switching surfaces at once or touches one, so
    /// neighbouring motions do not remain close.
    SimultaneousCrossing(f64),
    /// The length of the vector underflowed or overflowed.
    NoLength,
}

impl From<SolveError> for GrowthError {
    fn from(error: SolveError) -> Self {
        Self::Motion(error)
    }
}

/// Measures the growth of a tangent vector along the motion from `initial` at its start.
///
/// The system must implement its own Jacobian: finite differences would cross switching surfaces. `felt` is
/// true for each state that a rate or a switching function depends on. Other states, such as the angle of an
/// unrestrained rotation, do not contribute to the length. The step limit of `settings` applies to all
/// intervals together.
///
/// # Errors A motion that cannot be simulated, neighbouring motions that do not remain close, invalid times, or
/// no state for which `felt` is true.
pub fn measure_growth(
    system: &dyn System,
    initial: &[f64],
    felt: &[bool],
    (stretches, check): (&MeasurementTimes, &dyn Fn()),
    settings: &Settings,
) -> Result<GrowthMeasurements, GrowthError> {
    let MeasurementTimes {
        start,
        transient,
        interval,
        intervals,
    } = *stretches;
    let problem =
        if !(transient >= 0.0 && interval > 0.0 && (start + transient + interval).is_finite()) {
            Some("expected a transient of 0 s or more and an interval above 0 s")
        } else if felt.len() != initial.len() || !felt.contains(&true) {
            Some("no rate depends on any state")
        } else {
            None
        };
    if let Some(problem) = problem {
        let problem = problem.to_owned();
        return Err(SolveError::Request { problem }.into());
    }
    let mut carried = MotionWithTangent::new(system, (start, initial), felt, settings);
    carried.simulate_motion(start + 0.5 * transient)?;
    let turns = (0.5 * transient / interval).ceil();
    for turn in 1..=turns as usize {
        check();
        carried.simulate_interval(start + 0.5 * transient * (1.0 + turn as f64 / turns))?;
    }
    let growths = (1..=intervals).map(|index| {
        check();
        carried.simulate_interval(start + transient + index as f64 * interval)
    });
    Ok(GrowthMeasurements {
        growth_exponents: growths.collect::<Result<_, _>>()?,
        switches: carried.switches,
    })
}

/// A motion with a tangent vector of length 1.
struct MotionWithTangent<'a> {
    system: &'a dyn System,
    felt: &'a [bool],
    settings: Settings,
    t: f64,
    y: Vec<f64>,
    v: Vec<f64>,
    sizes: Vec<f64>,
    pieces: u32,
    switches: u64,
}

impl<'a> MotionWithTangent<'a> {
    /// Starts with the unit vector of the first state that contributes to the length, with small components of
    /// the others.
    fn new(
        system: &'a dyn System,
        (start, initial): (f64, &[f64]),
        felt: &'a [bool],
        settings: &Settings,
    ) -> Self {
        let mut turned = std::iter::once(1.0).chain((2..).map(|k: u32| 0.1 / f64::from(k)));
        let mut entry = |felt: &bool| {
            if *felt {
                turned.next().unwrap_or(0.0)
            } else {
                0.0
            }
        };
        let mut carried = Self {
            system,
            felt,
            settings: *settings,
            t: start,
            y: initial.to_vec(),
            v: felt.iter().map(&mut entry).collect(),
            sizes: initial.iter().map(|y| y.abs()).collect(),
            pieces: 1,
            switches: 0,
        };
        let length = carried.tangent_length();
        carried.v.iter_mut().for_each(|v| *v /= length);
        carried
    }

    fn simulate_motion(&mut self, end: f64) -> Result<(), GrowthError> {
        if end <= self.t {
            return Ok(());
        }
        let begin = self.t;
        let sample = |look: usize| match look {
            SIZE_SAMPLES => end,
            _ => begin + (end - begin) * look as f64 / SIZE_SAMPLES as f64,
        };
        let samples: Vec<f64> = (0..=SIZE_SAMPLES).map(sample).collect();
        let span = (self.t, end);
        let quiet = &mut |_: f64| {};
        let motion = simulate(self.system, &self.y, span, &samples, &self.settings, quiet)?;
        motion
            .states
            .iter()
            .for_each(|state| self.raise_sizes(state));
        self.y = self.count_work(motion);
        self.t = end;
        Ok(())
    }

    /// Simulates motion and vector until `end`, s, and returns the growth exponent of the vector.
    fn simulate_interval(&mut self, end: f64) -> Result<f64, GrowthError> {
        let (begin, mut growth, mut least) = (self.t, 0.0, 0.0_f64);
        for piece in 1..=self.pieces {
            let until = match piece == self.pieces {
                true => end,
                false => begin + (end - begin) * f64::from(piece) / f64::from(self.pieces),
            };
            let grown = self.simulate_piece(until)?;
            least = least.min(grown);
            growth += grown;
        }
        let finer = (-least / MAX_SHRINKAGE_EXPONENT).ceil().max(1.0) as u32;
        self.pieces = self.pieces.saturating_mul(finer).min(MAX_PIECES);
        Ok(growth)
    }

    fn simulate_piece(&mut self, end: f64) -> Result<f64, GrowthError> {
        if end <= self.t {
            return Ok(0.0);
        }
        let states = self.y.len();
        let beside = TangentSystem::new(self.system, self.sizes.clone());
        let (start, span) = ([&*self.y, &*self.v].concat(), (self.t, end));
        let motion = simulate(&beside, &start, span, &[], &self.settings, &mut |_| {})?;
        if let Some(t) = beside.simultaneous_crossing_time() {
            return Err(GrowthError::SimultaneousCrossing(t));
        }
        let mut last = self.count_work(motion);
        self.v = last.split_off(states);
        self.raise_sizes(&last);
        self.y = last;
        self.t = end;
        for (v, felt) in self.v.iter_mut().zip(self.felt) {
            *v = if *felt { *v } else { 0.0 };
        }
        let length = self.tangent_length();
        if !(length > 0.0 && length.is_finite()) {
            return Err(GrowthError::NoLength);
        }
        self.v.iter_mut().for_each(|v| *v /= length);
        Ok(length.ln())
    }

    fn tangent_length(&self) -> f64 {
        self.v.iter().map(|v| v * v).sum::<f64>().sqrt()
    }

    fn raise_sizes(&mut self, state: &[f64]) {
        for (size, y) in self.sizes.iter_mut().zip(state) {
            *size = size.max(y.abs());
        }
    }

    /// Adds steps and events of a motion to the totals and returns its last state.
    fn count_work(&mut self, motion: Trajectory) -> Vec<f64> {
        let work = motion.statistics;
        let steps = work.steps + work.rejected_steps + work.trial_steps;
        self.settings.max_steps = self.settings.max_steps.saturating_sub(steps);
        self.switches += motion.events.len() as u64;
        motion.final_state
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    /// Oscillator x'' = -x - c x' + cos(1.3 t), with a damper and a force step for x > 0.2.
    struct Struck {
        c: f64,
        damper: f64,
        force: f64,
        /// Fixed side of the surface, or 0.
        side: Cell<f64>,
    }

    impl Struck {
        fn is_struck(&self, y: &[f64]) -> bool {
            match self.side.get() {
                0.0 => y[0] > 0.2,
                side => side > 0.0,
            }
        }
    }

    impl System for Struck {
        fn state_count(&self) -> usize {
            2
        }

        fn rates(&self, t: f64, y: &[f64], out: &mut [f64]) {
            let struck = if self.is_struck(y) {
                self.force + self.damper * y[1]
            } else {
                0.0
            };
            (out[0], out[1]) = (y[1], -y[0] - self.c * y[1] - struck + (1.3 * t).cos());
        }

        fn jacobian(&self, _t: f64, y: &[f64], out: &mut [f64]) {
            let damper = if self.is_struck(y) { self.damper } else { 0.0 };
            out.copy_from_slice(&[0.0, 1.0, -1.0, -self.c - damper]);
        }

        fn guard_count(&self) -> usize {
            1
        }

        fn guards(&self, _t: f64, y: &[f64], out: &mut [f64]) {
            out[0] = y[0] - 0.2;
        }

        fn fix_sides(&self, sides: Option<&[f64]>) {
            self.side.set(sides.map_or(0.0, |sides| sides[0]));
        }
    }

    const FELT: [bool; 2] = [true; 2];

    #[test]
    fn growth_of_linear_oscillator_is_minus_half_its_damping() -> Result<(), GrowthError> {
        let system = Struck {
            c: 0.3,
            damper: 0.0,
            force: 0.0,
            side: Cell::new(0.0),
        };
        let period = std::f64::consts::TAU / (1.0_f64 - 0.15 * 0.15).sqrt();
        let stretches = MeasurementTimes {
            start: 0.0,
            transient: 2.0,
            interval: period,
            intervals: 5,
        };
        let settings = Settings::default();
        let found = measure_growth(&system, &[0.1, 0.0], &FELT, (&stretches, &|| {}), &settings)?;
        // A vector returns to its direction after half a period.
        for growth in found.growth_exponents {
            assert!((growth / period + 0.15).abs() < 1e-8, "{growth}");
        }
        Ok(())
    }

    #[test]
    fn growth_over_jump_matches_two_neighbouring_motions() -> Result<(), GrowthError> {
        for (damper, force) in [(2.0, 0.0), (0.0, 0.5), (-0.4, 0.3), (1.0, -0.2)] {
            let system = Struck {
                c: 0.1,
                damper,
                force,
                side: Cell::new(0.0),
            };
            let stretches = MeasurementTimes {
                start: 0.0,
                transient: 0.0,
                interval: 10.0,
                intervals: 1,
            };
            let settings = Settings::with_tolerance(1e-12);
            let start = [0.1, 0.4];
            let found = measure_growth(&system, &start, &FELT, (&stretches, &|| {}), &settings)?;
            assert!(found.switches > 1, "{damper}");
            let (small, norm) = (1e-6, 1.0_f64.hypot(0.05));
            let end = |side: f64| {
                let moved = [
                    start[0] + side * small / norm,
                    start[1] + side * 0.05 * small / norm,
                ];
                simulate(&system, &moved, (0.0, 10.0), &[], &settings, &mut |_| {})
            };
            let (above, below) = (end(1.0)?.final_state, end(-1.0)?.final_state);
            let apart = f64::hypot(above[0] - below[0], above[1] - below[1]);
            let growth = (apart / (2.0 * small)).ln();
            let found = found.growth_exponents[0];
            assert!(
                (found - growth).abs() < 1e-5,
                "{damper} {force}: {found} for {growth}"
            );
        }
        Ok(())
    }
}
