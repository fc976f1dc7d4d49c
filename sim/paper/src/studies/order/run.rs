//! Orders, backlash, times and recorded quantities of the study.

use std::f64::consts::PI;

use crate::studies::case::{Amplitude, Record};

/// Highest compared order, and the reference order.
pub const HIGHEST_ORDER: usize = 16;
pub const REFERENCE_ORDER: usize = 32;
/// Forcing frequency, rad/s, which the paper does not give for Fig. 4, and half-backlash of the
/// chaotic case, um.
pub const OMEGA: f64 = 10.0 * PI;
pub const BACKLASH: u32 = 25;
/// Sampling intervals, s: for series, and for long-time statistics.
pub const SAMPLING_INTERVAL_S: f64 = 1.0 / 20_480.0;
pub const COARSE_INTERVAL_S: f64 = 1.0 / 4_096.0;
/// Recorded time from the start, s.
pub const START_TIME_S: f64 = 6.0;
/// Time from the start over which differences with backlash are taken, s.
pub const SHORT_TIME_S: f64 = 0.02;
/// Time of the statistics and of the transient before them, s.
pub const STATISTICS_TIME_S: f64 = 40.0;
pub const TRANSIENT_S: f64 = 60.0;
/// Orders in the figures of differences and spectra.
pub const SHOWN_ORDERS: [usize; 4] = [1, 4, 5, 16];

/// Series of one order at one backlash.
pub struct Run {
    pub order: usize,
    /// Series from the start.
    pub start: Record,
    /// Long-time statistics of x_sp, f_la and dr after the transient.
    pub statistics: [Amplitude; 3],
}
