//! The arm under the observer's torque, for half a second: the same run on a microcontroller and on any other
//! machine, to the bit. The observer sees the arm by its sensors alone, and these fail at times.
#![no_std]
#![forbid(unsafe_code)]

use controller::{Coefficients, Inputs, STEP, State, displaced, driven};
use observer::{DEVIATION, MEASURED, Observer, SENSORS};

/// Steps from one measurement to the next.
pub const STEPS: u32 = 50;
/// Measurements of the run, one each millisecond.
pub const MEASUREMENTS: u32 = 500;
/// After so many the state is printed.
pub const SHOWN: u32 = 100;
/// Of so many measurements the sun's encoder loses one: it says NaN.
const LOST: u32 = 7;
/// From this one up to that, all sensors say NaN.
const ALL_LOST: core::ops::Range<u32> = 200..220;

/// The arm and its observer.
pub struct Rig {
    /// The state of the arm.
    pub arm: State,
    /// What the observer takes it for.
    pub observer: Observer,
    measurements: u32,
    noise: u64,
}

impl Rig {
    /// The carrier is displaced by 2 mm, which the observer does not know.
    pub fn new(coefficients: &Coefficients) -> Self {
        Self {
            arm: displaced(),
            observer: Observer::new(coefficients),
            measurements: 0,
            noise: 7,
        }
    }

    /// A number of mean 0 and standard deviation 1: the sum of three uniform ones from -1 to 1.
    fn noise(&mut self) -> f64 {
        let mut sum = 0.0;
        for _ in 0..3 {
            // Knuth's constants for a linear congruential generator of 64 bits.
            self.noise = self
                .noise
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            sum += (self.noise >> 40) as f64 / f64::from(1_u32 << 23) - 1.0;
        }
        sum
    }

    /// Up to the next measurement, and that.
    pub fn measure(&mut self, coefficients: &Coefficients) {
        let begin = self.measurements * STEPS;
        for count in begin..begin + STEPS {
            let t = f64::from(count) * STEP;
            let torque = self.observer.torque();
            self.arm = driven(t, &self.arm, torque, coefficients);
            self.observer.step(t, torque, coefficients);
        }
        self.measurements += 1;
        let t = f64::from(begin + STEPS) * STEP;
        let observables = arm::observables(t, &self.arm, &Inputs::default(), coefficients);
        let mut values = [0.0; SENSORS];
        for sensor in 0..SENSORS {
            values[sensor] = observables[MEASURED[sensor]] + DEVIATION[sensor] * self.noise();
        }
        if ALL_LOST.contains(&self.measurements) {
            values = [f64::NAN; SENSORS];
        } else if self.measurements % LOST == 0 {
            values[0] = f64::NAN;
        }
        self.observer.measured(t, &values, coefficients);
    }
}
