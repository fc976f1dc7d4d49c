//! Every constant that decides something, in one place, with its reason.

/// Standard deviation of a sensor's gain before it is estimated: a calibrated sensor.
pub const GAIN_PRIOR: f64 = 0.01;

/// Standard deviation of a sensor's bias, in noises.
pub const BIAS_PRIOR: f64 = 10.0;

/// Standard deviation of a sensor's delay, in samples: held somewhere between two of them.
pub const DELAY_PRIOR: f64 = 0.5;

/// The longest delay that a fit may take, in samples: four standard deviations.
pub const LONGEST_DELAY: f64 = 2.0;

/// Standard deviation of a window's initial state around where the window before ended, in
/// ranges of the state's own motion: next to nothing is known, yet a state that the window
/// does not show stays where it may be.
pub const START_PRIOR: f64 = 0.02;
