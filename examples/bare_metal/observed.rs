//! Simulates the arm with feedback of the observer's estimate for half a second. The run is bit-identical on a
//! microcontroller and on any other machine. The observer receives only sensor values, and some of them are NaN.
#![no_std]
#![forbid(unsafe_code)]

use controller::{Coefficients, Inputs, STEP, State, displaced, driven};
use observer::{DEVIATION, MEASURED, Observer, SENSORS};

/// Number of steps per measurement.
pub const STEPS: u32 = 50;
/// Number of measurements, one per millisecond.
pub const MEASUREMENTS: u32 = 500;
/// Number of measurements between printed states.
pub const SHOWN: u32 = 100;
/// Period, in measurements, with which the sun's encoder returns NaN.
const LOST: u32 = 7;
/// Range of measurements in which all sensors return NaN.
const ALL_LOST: core::ops::Range<u32> = 200..220;

/// Arm with its observer.
pub struct Rig {
    /// State of the arm.
    pub arm: State,
    /// Observer of the arm.
    pub observer: Observer,
    measurements: u32,
    noise: u64,
}

impl Rig {
    /// Creates the arm with the carrier displaced by 2 mm; the observer does not know the displacement.
    pub fn new(coefficients: &Coefficients) -> Self {
        Self {
            arm: displaced(),
            observer: Observer::new(coefficients),
            measurements: 0,
            noise: 7,
        }
    }

    /// Returns a random number with mean 0 and standard deviation 1: the sum of three uniform numbers from -1 to 1.
    fn noise(&mut self) -> f64 {
        let mut sum = 0.0;
        for _ in 0..3 {
            // Knuth's constants of a 64-bit linear congruential generator.
            self.noise = self
                .noise
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            sum += (self.noise >> 40) as f64 / f64::from(1_u32 << 23) - 1.0;
        }
        sum
    }

    /// Simulates until the next measurement and updates the observer.
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
